// `manyworlds report plan`: what each plan leaves out, and what that is worth. Every row is a
// variant of a scene's batch (a stage switched back on, another layout, another way to find pairs,
// four substeps where the plan takes more), timed alternately with the batch as it is by default;
// positions and velocities must end with the same bits, but with other substeps.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/batch.hpp"

namespace manyworlds::report {

struct WorthRow {
  std::string scene, variant;
  double plain = 0;        // world-steps per second, as by default
  double worth = 0;        // median of (time of the variant / time as by default)
  bool same_bits = false;  // of positions and velocities
  bool must_be_same = true;
  std::string holds = {};  // what it does, where that is what counts
  int bodies = 0;          // of a world; 0: not told
};

struct WorthOptions {
  std::vector<std::string> scenes;  // empty: the standard ones
  bool quick = false;
};

// `tell` is called before each row with what comes next and the share that is done.
std::vector<WorthRow> run_worth(const WorthOptions& options,
                                const std::function<void(const std::string&, double)>& tell);

// Of this thread, so that others on the machine matter little.
double processor_seconds();

// Trees of joints against sweeps (joint_methods.cpp), by the time of sweeps in 4 substeps.
std::vector<WorthRow> compare_joint_methods(bool quick);

nlohmann::ordered_json to_json(const std::vector<WorthRow>& rows);

}  // namespace manyworlds::report
