#include "model_tree.hpp"

#include <cstddef>
#include <variant>

namespace manyworlds::cli {
namespace {

class TreeWalk {
 public:
  explicit TreeWalk(const Plan& plan)
      : plan_(plan),
        scene_(plan.scene()),
        in_trees_(scene_.options.solver.method == Solver::newton),
        series_(scene_.bodies.size()),
        children_(scene_.bodies.size()),
        seen_(scene_.bodies.size(), false) {}

  std::vector<ModelBody> run() {
    for (std::size_t j = 0; j < scene_.joints.size(); ++j) {
      const Joint& joint = scene_.joints[j];
      if (joint.body_b && !joint.after) add_series(JointId(static_cast<int>(j)));
    }
    std::vector<BodyId> roots, moving;
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const BodyId body(static_cast<int>(b));
      if (!plan_.find_row(body)) continue;
      const BodyId parent = parent_of(body);
      (parent ? children_[static_cast<std::size_t>(parent.index())] : roots).push_back(body);
      moving.push_back(body);
    }
    for (const BodyId root : roots) add(root, -1, 0);
    for (const BodyId body : moving) add(body, -1, 0);  // those held in a circle
    return std::move(out_);
  }

 private:
  std::vector<JointId>& series_of(BodyId body) {
    return series_[static_cast<std::size_t>(body.index())];
  }
  // A joint and those that come after it.
  void add_series(JointId first) {
    std::vector<JointId>& series = series_of(scene_.at(first).body_b);
    series.push_back(first);
    for (bool found = true; found;) {
      found = false;
      for (std::size_t j = 0; j < scene_.joints.size() && !found; ++j) {
        found = scene_.joints[j].after == series.back();
        if (found) series.push_back(JointId(static_cast<int>(j)));
      }
    }
  }
  BodyId parent_of(BodyId body) {
    if (series_of(body).empty()) return {};
    const BodyId a = scene_.at(series_of(body).front()).body_a;
    return a && plan_.find_row(a) ? a : BodyId();
  }

  void add(BodyId body, int parent, int depth) {
    if (seen_[static_cast<std::size_t>(body.index())]) return;
    seen_[static_cast<std::size_t>(body.index())] = true;
    ModelBody& row = out_.emplace_back();
    row.body = body, row.parent = parent, row.depth = depth;
    if (series_of(body).empty()) row.root = numbered({}, 7, 6);
    for (const JointId joint : series_of(body)) {
      const JointType& type = scene_.at(joint).type;
      const bool ball = std::holds_alternative<BallJoint>(type);
      const bool fixed = std::holds_alternative<FixedJoint>(type);
      row.joints.push_back(numbered(joint, ball ? 4 : fixed ? 0 : 1, ball ? 3 : fixed ? 0 : 1));
    }
    const int own = static_cast<int>(out_.size()) - 1;
    for (const BodyId child : children_[static_cast<std::size_t>(body.index())]) {
      add(child, own, depth + 1);
    }
  }
  ModelJoint numbered(JointId joint, int positions, int velocities) {
    if (!in_trees_) return {.joint = joint};
    const ModelJoint out{joint, q_, v_, positions, velocities};
    q_ += positions, v_ += velocities;
    return out;
  }

  const Plan& plan_;
  const Scene& scene_;
  bool in_trees_;
  int q_ = 0, v_ = 0;
  std::vector<std::vector<JointId>> series_;   // [scene body]
  std::vector<std::vector<BodyId>> children_;  // [scene body]
  std::vector<bool> seen_;                     // [scene body]
  std::vector<ModelBody> out_;
};

}  // namespace

std::vector<ModelBody> model_tree(const Plan& plan) { return TreeWalk(plan).run(); }

}  // namespace manyworlds::cli
