// Random controls and resets, by which robots are timed and tried out: new controls every few
// steps, uniform over their ranges, and episodes of the same length that begin at random times.
#pragma once

#include <cstdint>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::tools {

// What a world gets depends on its seed and the number of the step alone, not on its batch.
class RandomControls {
 public:
  static constexpr int kPeriod = 5;     // steps between two draws
  static constexpr int kEpisode = 500;  // steps

  RandomControls() = default;  // sets and resets nothing
  // Of batches of one kind. World i has the seed `seed` + i.
  RandomControls(const Batch& batch, std::uint64_t seed);

  // Resets are to this keyframe from now on.
  void reset_to(KeyframeId keyframe) { keyframe_ = keyframe; }

  // Whether a scene is driven unless the user says so: robots that have motors.
  static bool suit(const Plan& plan);

  // To be called before step `step` of the worlds' runs. Lost worlds are not reset, so that they
  // are found in the end.
  void apply(Batch& batch, std::int64_t step);
  // Steps from `step` on until apply() has something to do again.
  int steps_until_next(std::int64_t step) const;

 private:
  struct Range {
    double low, high;
  };

  std::uint64_t seed_ = 0;
  std::vector<Range> ranges_;  // [control]; empty: nothing is done
  std::vector<double> values_;
  std::vector<std::uint8_t> mask_;
  KeyframeId keyframe_;  // none: as the scene begins
};

}  // namespace manyworlds::tools
