// Which joints are solved at once (kernels/direct/), and in what order.
#include "src/plan/joint_trees.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <type_traits>
#include <variant>
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/soft_constraint.hpp"

namespace manyworlds {

namespace {

using kernels::PartKind;

// A joint with its parts, whose bodies are those of all of them.
struct TreeJoint {
  std::vector<int> parts;
  int body_a = 0, body_b = 0;
};

bool fits(const Joint& joint) {
  const auto of_type = [](const auto& type) {
    using Type = std::decay_t<decltype(type)>;
    if constexpr (std::is_same_v<Type, BallJoint>) return !type.cone && !type.twist;
    return std::is_same_v<Type, HingeJoint> || std::is_same_v<Type, SliderJoint> ||
           std::is_same_v<Type, FixedJoint> || std::is_same_v<Type, WheelJoint>;
  };
  return std::visit(of_type, joint.type);
}

class JointTreeBuilder {
 public:
  explicit JointTreeBuilder(PlanData& plan)
      : plan_(plan), joints_(plan.scene.joints.size()), in_tree_(trees_of(plan.scene).has_joint) {
    const auto bodies = plan.bodies.size();
    at_.resize(bodies), component_.assign(bodies, -1), placed_.assign(bodies, false);
    for (std::size_t i = 0; i < plan.parts.size(); ++i) {
      TreeJoint& joint = joints_[static_cast<std::size_t>(plan.parts[i].joint)];
      joint.parts.push_back(static_cast<int>(i));
      joint.body_a = plan.parts[i].what.body_a, joint.body_b = plan.parts[i].what.body_b;
    }
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (joints_[j].parts.empty()) continue;
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
      const auto& joints = at_[static_cast<std::size_t>(b)];
      if (!joints.empty() && in_tree_[static_cast<std::size_t>(joints.front())]) grow(component);
    }
    auto& edge_of = plan_.trees_of_joints.edge_of;
    edge_of.assign(plan_.bodies.size(), -1);
    int index = 0;
    for (const kernels::TreeEdge& edge : plan_.trees_of_joints.edges) {
      edge_of[static_cast<std::size_t>(edge.child)] = index++;
      for (const int part : {edge.hold, edge.turn, edge.slide, edge.angle}) {
        if (part < 0) continue;
        solve_at_once(plan_.parts[static_cast<std::size_t>(part)]);
        ++plan_.trees_of_joints.parts;
      }
    }
  }

 private:
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
  // From what is given, or else from the heaviest body on.
  void grow(const std::vector<int>& bodies) {
    std::vector<int> order;
    const auto place = [&](int body) {
      order.push_back(body), placed_[static_cast<std::size_t>(body)] = true;
    };
    for (const int body : bodies) {
      for (const int j : at_[static_cast<std::size_t>(body)]) {
        const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
        if (prescribed(joint.body_a) || prescribed(joint.body_b)) {
          add_edge(j, body), place(body);
        }
      }
    }
    if (order.empty()) {
      const auto lighter = [&](int a, int b) {
        return plan_.bodies[static_cast<std::size_t>(a)].mass <
               plan_.bodies[static_cast<std::size_t>(b)].mass;
      };
      place(*std::max_element(bodies.begin(), bodies.end(), lighter));
      plan_.trees_of_joints.roots.push_back(order.front());
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (const int j : at_[static_cast<std::size_t>(order[i])]) {
        const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
        const int next = joint.body_a == order[i] ? joint.body_b : joint.body_a;
        if (prescribed(next) || placed_[static_cast<std::size_t>(next)]) continue;
        add_edge(j, next), place(next);
      }
    }
    auto& all = plan_.trees_of_joints.bodies;
    all.insert(all.end(), order.begin(), order.end());
  }

  void add_edge(int j, int child) {
    const TreeJoint& joint = joints_[static_cast<std::size_t>(j)];
    kernels::TreeEdge edge{};
    edge.child = child;
    edge.reversed = joint.body_a == child;
    edge.parent = edge.reversed ? joint.body_b : joint.body_a;
    edge.prescribed = prescribed(edge.parent);
    edge.hold = edge.turn = edge.slide = edge.angle = -1;
    for (const int part : joint.parts) {
      switch (plan_.parts[static_cast<std::size_t>(part)].what.kind) {
        case PartKind::point: edge.hold = part; break;
        case PartKind::line: edge.hold = part, edge.slides = true; break;
        case PartKind::lock: edge.turn = part, edge.locked = true; break;
        case PartKind::swing: edge.turn = part; break;
        case PartKind::slide: edge.slide = part; break;
        default: edge.angle = part;
      }
    }
    edge.ball = plan_.scene.space == Space::spatial && edge.turn < 0;
    plan_.trees_of_joints.edges.push_back(edge);
  }

  // Gaps are closed in a substep, or as fast as joints are said to be.
  void solve_at_once(PlanPart& part) const {
    const Options& o = plan_.scene.options;
    const double h = o.dt / *o.substeps;
    part.what.direct = true;
    part.constants.soft = {1 / h, 0, 0};
    if (o.joint.frequency) {
      part.constants.soft.bias_rate =
          *o.joint.frequency > 0
              ? soft_constraint(*o.joint.frequency, o.joint.damping_ratio, h).rate
              : 0;
    }
  }

  PlanData& plan_;
  std::vector<TreeJoint> joints_;
  std::vector<bool> in_tree_;         // [joint]
  std::vector<std::vector<int>> at_;  // [body] joints
  std::vector<int> component_;        // [body] its first body
  std::vector<bool> placed_;          // [body] in its tree
};

}  // namespace

// Bodies that hang together are a tree where there is a joint less than there are bodies, and at
// most one more that holds to what is not dynamic.
SceneTrees trees_of(const Scene& scene) {
  struct Component {
    int bodies = 1, between = 0, anchors = 0;
    bool fits = true;
    bool is_tree() const { return fits && anchors <= 1 && between == bodies - 1; }
    int joints() const { return between + anchors; }
  };
  std::vector<std::size_t> parent(scene.bodies.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto moves = [&](BodyId body) { return body && scene.at(body).motion == Motion::dynamic; };
  const auto root = [&](BodyId body) { return find(static_cast<std::size_t>(body.index())); };
  std::vector<Component> of(scene.bodies.size());
  for (const Joint& joint : scene.joints) {
    if (!moves(joint.body_a) || !moves(joint.body_b)) continue;
    const std::size_t a = root(joint.body_a), b = root(joint.body_b);
    if (a != b) parent[b] = a, of[a].bodies += of[b].bodies;
  }
  for (const Joint& joint : scene.joints) {
    const bool a = moves(joint.body_a), b = moves(joint.body_b);
    if (!a && !b) continue;
    Component& component = of[root(a ? joint.body_a : joint.body_b)];
    (a && b ? component.between : component.anchors) += 1;
    component.fits &= fits(joint);
  }
  SceneTrees out;
  for (const Joint& joint : scene.joints) {
    const bool a = moves(joint.body_a), b = moves(joint.body_b);
    out.has_joint.push_back((a || b) && of[root(a ? joint.body_a : joint.body_b)].is_tree());
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Component& component = of[find(i)];
    const bool hangs = component.joints() > 0 && component.is_tree();
    out.of_body.push_back(hangs ? static_cast<int>(find(i)) : -1);
    out.joints_with.push_back(hangs ? component.joints() : 0);
  }
  return out;
}

void collect_joint_trees(PlanData& plan) {
  const FloatMode mode;
  const Options& o = plan.scene.options;
  plan.trees_of_joints = {};
  if (o.joint.method != JointMethod::tree || o.solver.method != Solver::tgs_soft) return;
  JointTreeBuilder(plan).build();
}

}  // namespace manyworlds
