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
#include "src/plan/substeps.hpp"

namespace manyworlds {

namespace {

std::string joint_text(std::size_t j) { return "joint " + std::to_string(j); }

// The parts of a joint are swept over one after the other: what the point does turns a body about
// its centre, and what holds its rotation moves the point. With the square of the arm over that of
// the body's radius of gyration across it, that converges ever more slowly. 1/m^2 times m^2.
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
      return joint_text(j) + " holds a compact body on a long arm (m r^2 / I is " +
             short_text(lever) + ")";
    }
  }
  return {};
}

// Each contact of a tree's body walks to its root and back in every pass.
bool deep_and_touching(const Scene& scene, const std::vector<bool>& in_tree) {
  constexpr int kMost = 64;  // joints: as many contacts cost what the solve of the tree does
  std::map<int, int> joints;
  const std::vector<int> trees = trees_of_bodies(scene);
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    if (in_tree[j]) ++joints[trees[static_cast<std::size_t>(scene.joints[j].body_b.index())]];
  }
  for (std::size_t b = 0; b < trees.size(); ++b) {
    if (trees[b] < 0 || joints[trees[b]] <= kMost) continue;
    for (const Shape& shape : scene.bodies[b].shapes) {
      if (shape.filter.mask != 0) return true;
    }
  }
  return false;
}

// Loads that go down through light bodies.
std::string need_of_masses(const Scene& scene) {
  std::map<int, std::pair<double, double>> range;  // of a tree, kg
  const std::vector<int> trees = trees_of_bodies(scene);
  for (std::size_t b = 0; b < trees.size(); ++b) {
    if (trees[b] < 0) continue;
    const double mass = mass_properties(scene, scene.bodies[b]).mass;
    const auto [at, fresh] = range.try_emplace(trees[b], mass, mass);
    at->second.first = std::min(at->second.first, mass);
    at->second.second = std::max(at->second.second, mass);
    const double ratio = at->second.second / at->second.first;
    if (ratio > kRatioOfFourSubsteps) {
      return "jointed bodies have masses of 1 to " + short_text(ratio);
    }
  }
  return {};
}

}  // namespace

std::string need_of_trees(const std::vector<Scene>& extremes, double length_unit) {
  const Scene& first = extremes.front();
  const Options& o = first.options;
  if (o.solver.method != Solver::tgs_soft) return {};
  const std::vector<bool> in_tree = joints_of_trees(first);
  const auto at_once = [](const std::string& why) { return "at once, since " + why; };
  if (std::find(in_tree.begin(), in_tree.end(), true) == in_tree.end()) return {};
  if (deep_and_touching(first, in_tree)) return {};
  if (o.joint.frequency) {  // what is asked for to be soft is swept over
    const double share = *o.joint.frequency * o.dt / o.substeps.value_or(kLeastSubsteps);
    if (share <= kContactShare) return {};
    return at_once("joints of " + short_text(*o.joint.frequency) +
                   " Hz are stiffer than substeps of sweeps hold");
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
    if (std::isfinite(joint.break_force) || std::isfinite(joint.break_torque)) {
      return at_once(joint_text(j) + " may break");
    }
  }
  for (const Scene& scene : extremes) {
    for (const std::string& why : {need_of_levers(scene, in_tree), need_of_masses(scene)}) {
      if (!why.empty()) return at_once(why);
    }
  }
  return {};
}

}  // namespace manyworlds
