// What of a scene hangs together so that it can be solved at once.
#include <cmath>
#include <cstddef>
#include <numeric>
#include <type_traits>
#include <variant>
#include <vector>

#include "src/plan/joint_trees.hpp"

namespace manyworlds {

namespace {

bool fits(const Joint& joint) {
  const auto of_type = [](const auto& type) {
    using Type = std::decay_t<decltype(type)>;
    return std::is_same_v<Type, BallJoint> || std::is_same_v<Type, HingeJoint> ||
           std::is_same_v<Type, SliderJoint> || std::is_same_v<Type, FixedJoint> ||
           std::is_same_v<Type, WheelJoint>;
  };
  return std::visit(of_type, joint.type);
}

bool moves(const Scene& scene, BodyId body) {
  return body && scene.at(body).motion == Motion::dynamic;
}
std::size_t index(BodyId body) { return static_cast<std::size_t>(body.index()); }

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // Whether they were apart.
  bool join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    parent_[b] = a;
    return a != b;
  }

 private:
  std::vector<std::size_t> parent_;
};

constexpr double kClosedShare = 0.01;  // of a joint's arms

// How far a joint's frames are apart where the scene begins, m, and the sum of its arms.
struct StartGap {
  double length, arms;
};
StartGap start_gap(const Scene& scene, const Joint& joint) {
  const auto arm = [&](BodyId id, const Frame& frame) {
    if (!moves(scene, id)) return 0.0;
    return (frame.position - mass_properties(scene, scene.at(id)).center).norm();
  };
  const Vec3 gap = frame_in_world(scene, joint.body_b, joint.frame_b).position -
                   frame_in_world(scene, joint.body_a, joint.frame_a).position;
  double apart = gap.norm();
  if (std::holds_alternative<SliderJoint>(joint.type) ||
      std::holds_alternative<WheelJoint>(joint.type)) {
    const Quat axes = frame_in_world(scene, joint.body_a, joint.frame_a).rotation;
    const Vec3 along = axes.normalized() * Vec3::UnitX();
    apart = (gap - along.dot(gap) * along).norm();
  }
  return {apart, arm(joint.body_a, joint.frame_a) + arm(joint.body_b, joint.frame_b)};
}

}  // namespace

bool has_bounds(const Joint& joint) {
  const auto of_type = [](const auto& type) {
    using Type = std::decay_t<decltype(type)>;
    if constexpr (std::is_same_v<Type, HingeJoint> || std::is_same_v<Type, SliderJoint>) {
      return type.limit.has_value() || type.drive.has_value();
    }
    if constexpr (std::is_same_v<Type, BallJoint>) return type.cone || type.twist;
    return std::is_same_v<Type, WheelJoint>;
  };
  return std::visit(of_type, joint.type);
}

bool may_break(const Joint& joint) {
  return std::isfinite(joint.break_force) || std::isfinite(joint.break_torque);
}

namespace {

// [joint] whether it is part of a loop, in which all that does not move counts as one body: what is
// left when joints of bodies without another one have gone, and so on.
std::vector<bool> on_loops(const Scene& scene) {
  const std::size_t world = scene.bodies.size();
  const auto node = [&](BodyId body) { return moves(scene, body) ? index(body) : world; };
  std::vector<std::vector<std::size_t>> of(world + 1);
  std::vector<bool> left(scene.joints.size());
  std::vector<int> degree(world + 1);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const std::size_t a = node(scene.joints[j].body_a), b = node(scene.joints[j].body_b);
    left[j] = a != b && fits(scene.joints[j]);
    if (left[j]) of[a].push_back(j), of[b].push_back(j), ++degree[a], ++degree[b];
  }
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < world; ++i) {
    if (degree[i] == 1) ends.push_back(i);
  }
  while (!ends.empty()) {
    const std::size_t end = ends.back();
    ends.pop_back();
    for (const std::size_t j : of[end]) {
      if (!left[j]) continue;
      left[j] = false;
      const std::size_t a = node(scene.joints[j].body_a), b = node(scene.joints[j].body_b);
      const std::size_t next = a == end ? b : a;
      if (--degree[next] == 1 && next != world) ends.push_back(next);
    }
  }
  return left;
}

// Finds what joints of any type connect with the bodies of trees.
void find_hanging(const Scene& scene, SceneTrees& out) {
  struct Hanging {
    int joints = 0;
    bool has_tree = false;
  };
  const std::size_t bodies = scene.bodies.size();
  DisjointSets sets(bodies);
  for (const Joint& joint : scene.joints) {
    if (moves(scene, joint.body_a) && moves(scene, joint.body_b)) {
      sets.join(index(joint.body_a), index(joint.body_b));
    }
  }
  std::vector<Hanging> of(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    if (out.of_body[i] >= 0) of[sets.find(i)].has_tree = true;
  }
  for (const Joint& joint : scene.joints) {
    const BodyId moving = moves(scene, joint.body_a) ? joint.body_a : joint.body_b;
    if (moves(scene, moving)) ++of[sets.find(index(moving))].joints;
  }
  for (std::size_t i = 0; i < bodies; ++i) {
    const std::size_t by = sets.find(i);
    out.hangs_with.push_back(of[by].has_tree ? static_cast<int>(by) : -1);
    out.joints_hanging.push_back(of[by].joints);
  }
}

}  // namespace

SceneTrees trees_of(const Scene& scene) {
  constexpr int kMostClosures = 4;  // joints that close loops: each costs some solves of the tree
  struct Component {
    int joints = 0, closures = 0, in_loops = 0;
    double inverse_arms = 0;
    bool fits = true;
    bool is_tree() const { return fits && joints > 0 && closures <= kMostClosures; }
  };
  const std::size_t bodies = scene.bodies.size();
  const auto held = [&](const Joint& joint) {
    return fits(joint) && (moves(scene, joint.body_a) || moves(scene, joint.body_b));
  };
  DisjointSets together(bodies), held_together(bodies + 1);  // with all that does not move as one
  for (const Joint& joint : scene.joints) {
    if (fits(joint) && moves(scene, joint.body_a) && moves(scene, joint.body_b)) {
      together.join(index(joint.body_a), index(joint.body_b));
    }
  }
  const auto root = [&](const Joint& joint) {
    return together.find(index(moves(scene, joint.body_a) ? joint.body_a : joint.body_b));
  };
  std::vector<Component> of(bodies);
  for (const bool bounded : {true, false}) {  // those that cannot close a loop first
    for (const Joint& joint : scene.joints) {
      if (!held(joint) || has_bounds(joint) != bounded) continue;
      Component& component = of[root(joint)];
      ++component.joints;
      const std::size_t a = moves(scene, joint.body_a) ? index(joint.body_a) : bodies;
      const std::size_t b = moves(scene, joint.body_b) ? index(joint.body_b) : bodies;
      if (held_together.join(a, b)) continue;
      component.fits &= !bounded;
      ++component.closures;
    }
  }
  // How a load is shared around a loop is known to sweeps alone.
  for (const Joint& joint : scene.joints) {
    if (!held(joint) || !of[root(joint)].is_tree() || of[root(joint)].closures == 0) continue;
    of[root(joint)].fits = !may_break(joint);
  }
  SceneTrees out;
  const std::vector<bool> on_loop = on_loops(scene);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& joint = scene.joints[j];
    const bool at_once = held(joint) && of[root(joint)].is_tree();
    out.has_joint.push_back(at_once);
    out.slack.push_back(0);
    if (!at_once || !on_loop[j]) continue;
    ++of[root(joint)].in_loops;
    const StartGap gap = start_gap(scene, joint);
    of[root(joint)].inverse_arms += gap.arms > 0 ? 1 / gap.arms : 0;
    const double closed = kClosedShare * gap.arms;
    if (gap.length > closed) out.slack.back() = gap.length + closed;
  }
  for (std::size_t i = 0; i < bodies; ++i) {
    const Component& component = of[together.find(i)];
    out.of_body.push_back(component.is_tree() ? static_cast<int>(together.find(i)) : -1);
    out.joints_with.push_back(component.is_tree() ? component.joints : 0);
    out.joints_in_loops.push_back(component.in_loops);
    out.inverse_arms.push_back(component.inverse_arms);
  }
  find_hanging(scene, out);
  return out;
}

}  // namespace manyworlds
