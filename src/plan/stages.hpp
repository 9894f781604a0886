// The stages of a step: what a plan runs of them and why. The pipeline runs this list (src/step/),
// `manyworlds plan` prints it, and a profile is timed by its names.
#pragma once

#include <array>
#include <string>

namespace manyworlds {

enum class StepStage {
  free_motion,  // whole steps of bodies that nothing touches or joins
  flight,       // the same by another integrator, also before the solver
  begin,
  broad_phase,
  collide,
  tree,    // whole steps of bodies in joint coordinates, but for finding their contacts
  joints,  // all passes over rows of joints
  warm_start,
  bias,
  advance,
  relax,
  resist,
  restitute,
  store,
  finish,
  settle,   // of batches with sleep
  audit,    // of energy, in some steps
  observe,  // of batches with observers
};
inline constexpr int kStepStages = 18;
inline constexpr std::array<const char*, kStepStages> kStepStageNames = {
    "free_motion", "flight",     "begin",  "broad_phase", "collide", "tree",
    "joints",      "warm_start", "bias",   "advance",     "relax",   "resist",
    "restitute",   "store",      "finish", "settle",      "audit",   "observe"};
inline const char* to_string(StepStage stage) {
  return kStepStageNames[static_cast<std::size_t>(stage)];
}

struct PlanStage {
  bool in = false;
  std::string why = {};
};

// Those that the plan decides about: the first so many, up to finish.
inline constexpr int kPlannedStages = static_cast<int>(StepStage::finish) + 1;
using PlanStages = std::array<PlanStage, kPlannedStages>;

}  // namespace manyworlds
