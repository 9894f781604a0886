// How fast each side steps the model on one thread, alternately.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/compare/pair.hpp"

namespace manyworlds::compare {

struct Speed {
  Kernels kernels;
  int worlds = 0, mujoco_worlds = 0, steps = 0, rounds = 0;
  Effort effort;  // of both
  // World-steps/s of each round: ours, MuJoCo's in a loop over worlds and by its batches, those
  // with an mjData for each world or with one for all, whichever are faster.
  std::vector<double> ours, mujoco, mujoco_batch;
  double contacts = 0, mujoco_contacts = 0;  // per world after the last step
  std::uint64_t hash = 0;                    // of our state after the last step of each round
  bool same_hash = true;                     // over all rounds
};

// From states that worlds reach here in 500 steps, in which each is put back to the reference pose
// once, at random; controls change every 5 steps. MuJoCo steps `mujoco_worlds` of the worlds: one
// after the other in a plain loop of mj_step, and as a batch on one thread (mjbatch.h).
Speed compare_speed(Pair& pair, const Kernels& kernels, const Effort& effort, int worlds,
                    int mujoco_worlds, int steps, int rounds);

}  // namespace manyworlds::compare
