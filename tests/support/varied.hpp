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
inline Scene varied_crowd(Space space, bool polygons = false) {
  Scene scene = capsule_crowd(space, polygons);
  Body two = body_of(shape_of(cube_of(space, 0.25)), Vec3(0.3, 0, 0) + 4 * up_of(space));
  two.shapes.push_back(shape_of(round_of(space, 0.3)));
  two.shapes[1].position = Vec3(0.4, 0.1, 0);
  two.jitter.angle = 1;
  scene.add(two);
  Variation size;
  size.parameter = Parameter::size;
  size.low.setConstant(0.15), size.high.setConstant(0.45);
  scene.variations = {size,
                      vary(Parameter::density, 200, 2000, Draw::log_uniform),
                      vary(Parameter::friction, 0.1, 0.9),
                      vary(Parameter::restitution, 0, 0.6),
                      gravity_between(-11 * up_of(space), -9 * up_of(space)),
                      vary(Parameter::gravity_scale, 0.8, 1.2),
                      vary(Parameter::linear_drag, 0, 0.3),
                      vary(Parameter::angular_drag, 0, 0.3)};
  for (int body : {2, 5}) {
    Variation mass = vary(Parameter::mass, 50, 500);
    mass.body = BodyId(body);
    scene.variations.push_back(mass);
  }
  return scene;
}

}  // namespace manyworlds::test
