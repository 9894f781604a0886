// Which joints are solved at once (kernels/direct/), and in what order.
#include "src/plan/joint_trees.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/soft_constraint.hpp"

namespace manyworlds {

namespace {

using kernels::PartKind;

// s, of joints of loops that begin apart. A bridge of 160 links sags by the root of what has
// closed: in one second it is set swinging for half a minute.
constexpr double kClosingTime = 4;

// A joint with its parts, whose bodies are those of all of them.
struct TreeJoint {
  std::vector<int> parts;
  int body_a = 0, body_b = 0;
};

class JointTreeBuilder {
 public:
  explicit JointTreeBuilder(PlanData& plan)
      : plan_(plan), joints_(plan.scene.joints.size()), trees_(trees_of(plan.scene)) {
    const auto bodies = plan.bodies.size();
    at_.resize(bodies), component_.assign(bodies, -1), placed_.assign(bodies, false);
    seen_.assign(joints_.size(), false);
    for (std::size_t i = 0; i < plan.parts.size(); ++i) {
      TreeJoint& joint = joints_[static_cast<std::size_t>(plan.parts[i].joint)];
      joint.parts.push_back(static_cast<int>(i));
      joint.body_a = plan.parts[i].what.body_a, joint.body_b = plan.parts[i].what.body_b;
    }
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (!trees_.has_joint[j] || joints_[j].parts.empty()) continue;
      for (const int body : {joints_[j].body_a, joints_[j].body_b}) {
        if (!prescribed(body)) at_[static_cast<std::size_t>(body)].push_back(static_cast<int>(j));
      }
    }
  }

  void build() {
    const auto bodies = static_cast<int>(plan_.bodies.size());
    for (int b = 0; b < bodies; ++b) {
      if (prescribed(b) || component_[static_cast<std::size_t>(b)] >= 0) continue;
      const std::vector<int> component = gather(b);
      if (!at_[static_cast<std::size_t>(b)].empty()) grow(component);
    }
    finish(plan_.trees_of_joints);
  }

 private:
  void finish(PlanJointTrees& trees) {
    trees.edge_of.assign(plan_.bodies.size(), -1);
    for (std::size_t i = 0; i < trees.edges.size(); ++i) {
      trees.edge_of[static_cast<std::size_t>(trees.edges[i].child)] = static_cast<int>(i);
    }
    const auto count = [](const auto& list) { return static_cast<std::int32_t>(list.size()); };
    kernels::JointTrees& counts = trees.counts;
    counts.edges = count(trees.edges), counts.closures = count(closures_);
    counts.roots = count(trees.roots), counts.bodies = count(trees.bodies);
    counts.loops = count(trees.loops);
    for (kernels::JointLoops& loop : trees.loops) {
      loop.first += counts.edges, loop.end += counts.edges;
      loop.row = counts.loop_rows, loop.factor = counts.loop_factors;
      counts.loop_rows += loop.rows, counts.loop_factors += loop.rows * (loop.rows + 1) / 2;
    }
    trees.edges.insert(trees.edges.end(), closures_.begin(), closures_.end());
    for (const kernels::TreeEdge& edge : trees.edges) {
      counts.bounded |= edge.slide >= 0 || edge.angle >= 0 || edge.cone >= 0;
      for (const int part : {edge.hold, edge.turn, edge.slide, edge.angle, edge.cone}) {
        if (part < 0) continue;
        solve_at_once(plan_.parts[static_cast<std::size_t>(part)]);
        ++counts.parts;
      }
    }
    find_attached(trees);
  }
  void find_attached(PlanJointTrees& trees) const {
    std::vector<bool> of_tree(plan_.bodies.size() + 1, false);  // the last: the world
    for (const int body : trees.bodies) of_tree[static_cast<std::size_t>(body)] = true;
    for (PlanPart& part : plan_.parts) {
      kernels::JointPart& what = part.what;
      if (what.direct) continue;
      what.attached = of_tree[static_cast<std::size_t>(what.body_a)] ||
                      of_tree[static_cast<std::size_t>(what.body_b)];
      trees.counts.attached += what.attached ? 1 : 0;
    }
  }
  // The world and kinematic bodies move as they are told.
  bool prescribed(int body) const {
    return body == static_cast<int>(plan_.bodies.size()) ||
           plan_.bodies[static_cast<std::size_t>(body)].inv_mass == 0;
  }
  std::vector<int> gather(int first) {
    std::vector<int> out{first};
    component_[static_cast<std::size_t>(first)] = first;
    for (std::size_t i = 0; i < out.size(); ++i) {
      for (const int j : at_[static_cast<std::size_t>(out[i])]) {
        const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
        for (const int body : {joint.body_a, joint.body_b}) {
          if (prescribed(body) || component_[static_cast<std::size_t>(body)] >= 0) continue;
          component_[static_cast<std::size_t>(body)] = first;
          out.push_back(body);
        }
      }
    }
    return out;
  }
  // From what is given, or else from the heaviest body on, breadth first: so a chain between two
  // anchors is closed in its middle. Bounds come before all else, since they cannot close a loop.
  void grow(const std::vector<int>& bodies) {
    struct Step {
      int joint, child;
    };
    std::deque<Step> ahead;
    std::vector<int> order, closing;
    const auto look = [&](int j, int child) {
      const Joint& joint = plan_.scene.joints[static_cast<std::size_t>(j)];
      has_bounds(joint) ? ahead.push_front({j, child}) : ahead.push_back({j, child});
    };
    const auto place = [&](int body) {
      order.push_back(body), placed_[static_cast<std::size_t>(body)] = true;
      for (const int j : at_[static_cast<std::size_t>(body)]) {
        const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
        const int next = joint.body_a == body ? joint.body_b : joint.body_a;
        if (!prescribed(next) && !seen_[static_cast<std::size_t>(j)]) look(j, next);
      }
    };
    for (const int body : bodies) {
      for (const int j : at_[static_cast<std::size_t>(body)]) {
        const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
        if (prescribed(joint.body_a) || prescribed(joint.body_b)) look(j, body);
      }
    }
    if (ahead.empty()) {
      const auto lighter = [&](int a, int b) {
        return plan_.bodies[static_cast<std::size_t>(a)].mass <
               plan_.bodies[static_cast<std::size_t>(b)].mass;
      };
      const int heaviest = *std::max_element(bodies.begin(), bodies.end(), lighter);
      plan_.trees_of_joints.roots.push_back(heaviest);
      place(heaviest);
    }
    while (!ahead.empty()) {
      const Step step = ahead.front();
      ahead.pop_front();
      if (seen_[static_cast<std::size_t>(step.joint)]) continue;
      seen_[static_cast<std::size_t>(step.joint)] = true;
      if (placed_[static_cast<std::size_t>(step.child)]) {
        closing.push_back(step.joint);
      } else {
        plan_.trees_of_joints.edges.push_back(edge_of(step.joint, step.child));
        place(step.child);
      }
    }
    auto& all = plan_.trees_of_joints.bodies;
    all.insert(all.end(), order.begin(), order.end());
    if (!closing.empty()) close(closing, bodies);
  }

  void close(const std::vector<int>& joints, const std::vector<int>& bodies) {
    auto& loops = plan_.trees_of_joints.loops;
    kernels::JointLoops loop{};
    loop.first = static_cast<int>(closures_.size());
    for (const int j : joints) {
      const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
      closures_.push_back(edge_of(j, prescribed(joint.body_b) ? joint.body_a : joint.body_b));
      loop.rows += rows_of(closures_.back());
    }
    loop.end = static_cast<int>(closures_.size());
    for (const int body : bodies) {
      for (const int j : at_[static_cast<std::size_t>(body)]) loop.gradual |= gradual(j);
    }
    loops.push_back(loop);
  }
  bool gradual(int joint) const {
    return trees_.slack[static_cast<std::size_t>(joint)] > 0 &&
           !std::isfinite(plan_.scene.options.joint.pull_speed);
  }
  int rows_of(const kernels::TreeEdge& edge) const {
    const bool flat = plan_.scene.space == Space::planar;
    const int hold = (flat ? 2 : 3) - (edge.slides ? 1 : 0);
    if (edge.turn < 0) return hold;
    return hold + (flat ? 1 : edge.locked ? 3 : 2);
  }

  kernels::TreeEdge edge_of(int j, int child) const {
    const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
    kernels::TreeEdge edge{};
    edge.child = child;
    edge.reversed = joint.body_a == child;
    edge.parent = edge.reversed ? joint.body_b : joint.body_a;
    edge.prescribed = prescribed(edge.parent);
    edge.hold = edge.turn = edge.slide = edge.angle = edge.cone = -1;
    for (const int part : joint.parts) {
      switch (plan_.parts[static_cast<std::size_t>(part)].what.kind) {
        case PartKind::point: edge.hold = part; break;
        case PartKind::line: edge.hold = part, edge.slides = true; break;
        case PartKind::lock: edge.turn = part, edge.locked = true; break;
        case PartKind::swing: edge.turn = part; break;
        case PartKind::slide: edge.slide = part; break;
        case PartKind::cone: edge.cone = part; break;
        default: edge.angle = part;
      }
    }
    edge.ball = plan_.scene.space == Space::spatial && edge.turn < 0;
    return edge;
  }

  // Gaps are closed in a substep, or as fast as joints are said to be.
  void solve_at_once(PlanPart& part) const {
    const Options& o = plan_.scene.options;
    const double h = plan_.substep_dt();
    part.what.direct = true;
    part.constants.soft = {1 / h, 0, 0};
    if (o.joint.frequency) {
      part.constants.soft.bias_rate =
          *o.joint.frequency > 0
              ? soft_constraint(*o.joint.frequency, o.joint.damping_ratio, h).rate
              : 0;
    }
    const double slack = trees_.slack[static_cast<std::size_t>(part.joint)];
    const bool holds = part.what.kind == PartKind::point || part.what.kind == PartKind::line;
    if (!holds || !gradual(part.joint)) return;
    part.what.gradual = true;
    part.constants.pull = slack / kClosingTime, part.constants.slack = slack;
  }

  PlanData& plan_;
  std::vector<TreeJoint> joints_;
  SceneTrees trees_;
  std::vector<std::vector<int>> at_;  // [body] joints of trees
  std::vector<int> component_;        // [body] its first body
  std::vector<bool> placed_;          // [body] in its tree
  std::vector<bool> seen_;            // [joint] in its tree, or closes a loop
  std::vector<kernels::TreeEdge> closures_;
};

}  // namespace

void collect_joint_trees(PlanData& plan) {
  const FloatMode mode;
  const Options& o = plan.scene.options;
  plan.trees_of_joints = {};
  if (o.joint.method != JointMethod::tree || o.solver.method != Solver::tgs_soft) return;
  JointTreeBuilder(plan).build();
}

}  // namespace manyworlds
