// Scenes of which every number varies from world to world, and what a world has of them.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

inline std::vector<double> numbers(const Batch& batch, Parameter parameter, int world) {
  std::vector<double> v(batch.size(parameter) / static_cast<std::size_t>(batch.worlds()));
  batch.read(parameter, world, v);
  return v;
}

// A batch of one for each world of a batch of this seed: of the scene that `scene_of(batch, world)`
// says it is of.
template <class SceneOf>
std::vector<Batch> each_alone(const Batch& batch, const Table& table, std::uint64_t seed,
                              SceneOf scene_of) {
  std::vector<Batch> out;
  for (int w = 0; w < batch.worlds(); ++w) {
    BatchOptions one = options_of(table, 1);
    one.seed = seed + static_cast<std::uint64_t>(w);
    out.emplace_back(compile(scene_of(batch, w)), one);
  }
  return out;
}

inline Variation gravity_between(const Vec3& low, const Vec3& high, Draw draw = Draw::uniform) {
  Variation v;
  v.parameter = Parameter::gravity;
  v.low = low, v.high = high, v.draw = draw;
  return v;
}

// Bodies of every kind, one of them of several shapes, everything of which varies.
Scene varied_crowd(Space space, bool polygons = false);

}  // namespace manyworlds::test
