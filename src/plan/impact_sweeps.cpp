// Sweeps after impacts (kernels/solver/strikes.hpp) are for worlds of few bodies. In a crowd they
// cost most, since in nearly every step something hits something in one of the lanes, and are worth
// least: a pile that falls differently is as good a pile. With them bins of 20 boxes take six times
// as long while they fill, and a row of 15 dominoes eight times (docs/design.md).
#include "src/plan/impact_sweeps.hpp"

#include <algorithm>

namespace manyworlds {

namespace {

constexpr int kSweeps = 64;
constexpr int kCrowd = 12;  // moving bodies: the most that the plan has swept

bool can_be_hit(const Body& body) {
  return body.motion == Motion::dynamic &&
         std::any_of(body.shapes.begin(), body.shapes.end(),
                     [](const Shape& shape) { return shape.filter.mask != 0; });
}

}  // namespace

SweepsChoice choose_impact_sweeps(const Scene& scene) {
  if (scene.options.solver.method != Solver::tgs_soft) return {0, "for tgs-soft only"};
  if (!scene.joints.empty()) return {0, "joints do not take part in impacts yet"};
  const auto bodies = std::count_if(scene.bodies.begin(), scene.bodies.end(), can_be_hit);
  if (bodies > kCrowd) {
    return {0, std::to_string(bodies) + " bodies move, more than " + std::to_string(kCrowd)};
  }
  if (bodies == 0) return {0, "no body can be hit"};
  return {kSweeps, "no more than " + std::to_string(kCrowd) + " bodies move"};
}

}  // namespace manyworlds
