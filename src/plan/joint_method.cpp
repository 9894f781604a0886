#include "src/plan/joint_method.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <variant>

#include <Eigen/Eigenvalues>

#include "src/plan/joint_trees.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/stiff_drives.hpp"
#include "src/plan/substeps.hpp"

namespace manyworlds {

namespace {

// The parts of a joint are swept over one after the other: what the point does turns a body about
// its centre, and what holds its rotation moves the point. That
// converges ever more slowly with m r^2 / I, I across the arm.
double lever_of(const Scene& scene, BodyId id, const Frame& frame) {
  if (!id || scene.at(id).motion != Motion::dynamic) return 0;
  const MassProperties of = mass_properties(scene, scene.at(id));
  const Vec3 arm = frame.position - of.center;
  const double arm2 = arm.squaredNorm();
  if (arm2 == 0 || of.mass == 0) return 0;
  if (scene.space == Space::planar) return of.mass * arm2 / of.inertia(2, 2);
  // What turns the body about the arm itself does not move the point.
  const Vec3 along = arm / std::sqrt(arm2), x = along.unitOrthogonal(), y = along.cross(x);
  Eigen::Matrix2d across;
  across << x.dot(of.inertia * x), x.dot(of.inertia * y), x.dot(of.inertia * y),
      y.dot(of.inertia * y);
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(across).eigenvalues()(0);
  return of.mass * arm2 / least;
}

std::string need_of_levers(const Scene& scene, const std::vector<bool>& in_tree) {
  constexpr double kMost = 30;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (!in_tree[j]) continue;
    const Joint& joint = scene.joints[j];
    const double lever = std::max(lever_of(scene, joint.body_a, joint.frame_a),
                                  lever_of(scene, joint.body_b, joint.frame_b));
    if (lever > kMost) {
      return joint_text(j) + " connects a compact body on a long arm (m r^2 / I is " +
             short_text(lever) + ")";
    }
  }
  return {};
}

// Each contact of a tree's body, and each row attached to one, takes a way to the root and back in
// every pass: all along a chain they cost the square of its length.
bool is_long_and_loaded(const Scene& scene, const SceneTrees& trees) {
  constexpr int kMost = 64;     // joints
  constexpr int kMostRows = 4;  // joints attached to trees
  int rows = 0;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const auto is_long = [&](BodyId on) {
      return on && trees.joints_with[static_cast<std::size_t>(on.index())] > kMost;
    };
    const Joint& joint = scene.joints[j];
    rows += !trees.has_joint[j] && (is_long(joint.body_a) || is_long(joint.body_b)) ? 1 : 0;
  }
  if (rows > kMostRows) return true;
  const auto joined = joined_bodies(scene);
  const auto bodies = static_cast<int>(scene.bodies.size());
  const auto body = [&](int i) -> const Body& { return scene.at(BodyId(i)); };
  for (int i = 0; i < bodies; ++i) {
    if (trees.joints_with[static_cast<std::size_t>(i)] <= kMost) continue;
    for (int j = 0; j < bodies; ++j) {
      if (i == j || !filters_let_touch(body(i), body(j))) continue;
      if (joined.count(std::minmax(i, j)) == 0) return true;
    }
  }
  return false;
}

// Sweeps share a load around a loop only in many passes: between two ends the sag of a row follows
// its length by a root, so that what each joint stretches by shows many times over, and linkages
// that fall by much of their size in a step come apart.
std::string need_of_loops(const Scene& scene, const SceneTrees& trees) {
  constexpr int kMost = 32;
  // g dt^2 times the sum of 1 / arm: 33 joints with arms of 1 m reach it at 1/60 s.
  constexpr double kMostFall = 0.09;
  const double fall = scene.options.gravity.norm() * scene.options.dt * scene.options.dt;
  for (std::size_t b = 0; b < trees.joints_in_loops.size(); ++b) {
    const int joints = trees.joints_in_loops[b];
    const std::string connected = std::to_string(joints) + " joints are connected in loops";
    if (joints > kMost) return connected;
    const double share = fall * trees.inverse_arms[b];
    if (share > kMostFall) {
      return connected + ", which fall by " + short_text(share / joints) +
             " of their arms in a step";
    }
  }
  return {};
}

// Loads that go down through light bodies.
std::string need_of_masses(const Scene& scene, const SceneTrees& trees) {
  std::map<int, std::pair<double, double>> range;  // of what hangs together, kg
  for (std::size_t b = 0; b < trees.hangs_with.size(); ++b) {
    if (trees.hangs_with[b] < 0 || scene.bodies[b].motion != Motion::dynamic) continue;
    const double mass = mass_properties(scene, scene.bodies[b]).mass;
    const auto [at, fresh] = range.try_emplace(trees.hangs_with[b], mass, mass);
    at->second.first = std::min(at->second.first, mass);
    at->second.second = std::max(at->second.second, mass);
    const double ratio = at->second.second / at->second.first;
    if (ratio > kRatioOfFourSubsteps) {
      return "masses of connected bodies differ by a factor of " + short_text(ratio);
    }
  }
  return {};
}
std::string need_of_light_links(const Scene& scene, const SceneTrees& trees) {
  const std::vector<LightRow> rows = light_rows(scene, trees);
  if (rows.empty()) return {};
  const LightRow& row = rows.front();
  return std::to_string(row.joints) + " joints in a row carry loads of " + short_text(row.ratio) +
         " times the mass of their links";
}

}  // namespace

std::string need_of_trees(const std::vector<Scene>& extremes, double length_unit) {
  const Scene& first = extremes.front();
  const Options& o = first.options;
  if (o.solver.method != Solver::tgs_soft) return {};
  const SceneTrees trees = trees_of(first);
  const std::vector<bool>& in_tree = trees.has_joint;
  const auto at_once = [](const std::string& why) { return "solved at once: " + why; };
  if (std::find(in_tree.begin(), in_tree.end(), true) == in_tree.end()) return {};
  if (is_long_and_loaded(first, trees)) return {};
  if (o.joint.frequency) {  // what is asked for to be soft is swept over
    const double share = *o.joint.frequency * o.dt / o.substeps.value_or(kLeastSubsteps);
    if (share <= kContactShare) return {};
    return at_once("joint.frequency of " + short_text(*o.joint.frequency) +
                   " Hz is too stiff for sweeps");
  }
  const SubstepNeed loads = need_of_joints(extremes, length_unit, in_tree);
  if (loads.substeps > kLeastSubsteps) return at_once(loads.why);
  for (std::size_t j = 0; j < first.joints.size(); ++j) {
    if (!in_tree[j]) continue;
    const Joint& joint = first.joints[j];
    if (std::holds_alternative<FixedJoint>(joint.type)) {
      return at_once(joint_text(j) + " is fixed");
    }
    // Sweeps overshoot loads that come suddenly, by half.
    if (may_break(joint)) {
      return at_once(joint_text(j) + " can break");
    }
  }
  for (const Scene& scene : extremes) {
    for (const std::string& why :
         {need_of_loops(scene, trees), need_of_levers(scene, in_tree), need_of_masses(scene, trees),
          need_of_light_links(scene, trees), need_of_drives(scene, trees)}) {
      if (!why.empty()) return at_once(why);
    }
  }
  return {};
}

}  // namespace manyworlds
