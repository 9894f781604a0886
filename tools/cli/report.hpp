// What a finished run is worth knowing: one set of keys, shared by `run --json` and
// `bench --json`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/batch.hpp"

#include "job.hpp"

namespace manyworlds::cli {

struct Report {
  struct StageShare {
    std::string stage;
    double fraction = 0;  // of the time of all stages
  };

  std::string scene;
  int worlds = 0;
  int steps = 0;  // timed
  int steps_per_call = 0;
  int threads = 0;
  Isa isa = Isa::scalar;
  Precision precision = Precision::f32;
  double dt = 0;  // s
  int substeps = 0;
  Solver solver = Solver::tgs_soft;
  int iterations = 0;  // per substep
  bool sleep = false;
  double world_steps_per_s = 0;
  double body_steps_per_s = 0;
  // All of the following describe the state after the last timed step.
  double contacts_per_world = 0;  // points
  double manifolds_per_world = 0;
  double max_penetration = 0;  // m
  double max_joint_gap = 0;    // m
  Energy mean_energy;          // J, over worlds
  std::size_t bytes_per_world = 0;
  double awake_fraction = 1;  // of worlds
  int lost_worlds = 0;
  int diverged_worlds = 0;  // that are not lost
  std::uint64_t hash = 0;
  std::vector<StageShare> stage_split;  // empty where it was interrupted
  std::string interrupted;              // "SIGINT"; empty: it went to its end
};

// Reads everything but the stage split off a batch that took `steps` steps in `seconds` s. Changes
// nothing in the batch.
Report measure(const Batch& batch, const Job& job, int steps, int steps_per_call, double seconds);

// Takes `steps` more steps with profiling on and returns where their time went. Timed runs have
// profiling off, because reading the clock between stages costs.
std::vector<Report::StageShare> profile_stages(Batch& batch, int steps, int steps_per_call,
                                               const RandomControls& controls);

nlohmann::ordered_json to_json(const Report& report);
// "tgs-soft", "sor with 10 iterations"
std::string solver_text(Solver solver, int iterations);

}  // namespace manyworlds::cli
