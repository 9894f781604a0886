// Scenes of which every number varies from world to world, and what a world has of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/scene/variations.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

inline std::vector<double> numbers(const Batch& batch, Parameter parameter, int world) {
  std::vector<double> v(batch.size(parameter) / static_cast<std::size_t>(batch.worlds()));
  batch.read(parameter, world, v);
  return v;
}

// The scene with the numbers of one world of a batch built into it.
inline Scene built_with(const Batch& batch, int world) {
  Scene scene = batch.plan(0).scene();
  const std::vector<VariedNumber> varied = varied_numbers(scene);
  std::vector<double> values;
  for (const VariedNumber& n : varied) {
    const auto owners = owners_of(scene, n.parameter);
    const auto at = std::find(owners.begin(), owners.end(), n.of) - owners.begin();
    const auto item = static_cast<std::size_t>(at * info(n.parameter).numbers + n.component);
    values.push_back(numbers(batch, n.parameter, world)[item]);
  }
  scene.variations.clear();
  set_numbers(scene, varied, values.data());
  return scene;
}

inline Variation vary_three(Parameter parameter, const Vec3& low, const Vec3& high,
                            Draw draw = Draw::uniform) {
  Variation v;
  v.parameter = parameter;
  v.low = low, v.high = high, v.draw = draw;
  return v;
}
// Of one that has the parameter, without a range yet.
inline Variation vary_of(Parameter parameter, const NumberOwner& of) {
  Variation v = vary_three(parameter, Vec3::Zero(), Vec3::Zero());
  if (of.shape >= 0) {
    v.shape = ShapeId(BodyId(of.body), of.shape);
  } else if (of.body >= 0) {
    v.body = BodyId(of.body);
  }
  if (of.joint >= 0) v.joint = JointId(of.joint);
  if (of.control >= 0) v.control = ControlId(of.control);
  v.attractor = of.attractor;
  return v;
}
// One variation for each that has the parameter: of its own numbers, give or take `width`.
inline void vary_around(Scene& scene, Parameter parameter, double width) {
  const bool rotates = parameter == Parameter::axes_a || parameter == Parameter::axes_b ||
                       parameter == Parameter::initial_rotation ||
                       parameter == Parameter::shape_rotation ||
                       parameter == Parameter::initial_angular_velocity;
  for (const NumberOwner& of : owners_of(scene, parameter)) {
    if (!can_vary(scene, parameter, of)) continue;
    Variation v = vary_of(parameter, of);
    for (int c = 0; c < info(parameter).numbers; ++c) {
      if (scene.space == Space::planar && info(parameter).numbers == 3 && (c == 2) != rotates) {
        continue;
      }
      const double own = get_number(scene, parameter, of, c);
      v.low[c] = own - width, v.high[c] = own + width;
    }
    scene.variations.push_back(v);
  }
}

// The same by a share of its own numbers.
inline void vary_by_share(Scene& scene, Parameter parameter, double share) {
  for (const NumberOwner& of : owners_of(scene, parameter)) {
    if (!can_vary(scene, parameter, of)) continue;
    Variation v = vary_of(parameter, of);
    for (int c = 0; c < info(parameter).numbers; ++c) {
      const double own = get_number(scene, parameter, of, c), width = share * std::abs(own);
      v.low[c] = own - width, v.high[c] = own + width;
    }
    scene.variations.push_back(v);
  }
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
  return vary_three(Parameter::gravity, low, high, draw);
}

// Bodies of every kind, one of them of several shapes, everything of which varies.
Scene varied_crowd(Space space, bool polygons = false);

}  // namespace manyworlds::test
