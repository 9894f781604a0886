// What turns on to new points within a step finds them there.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

double deepest_of(Batch& batch, int steps) {
  double deepest = 0;
  for (int i = 0; i < steps; ++i) {
    batch.step();
    deepest = std::max(deepest, batch.measure_contacts().max_penetration);
  }
  return deepest;
}

}  // namespace

// A quarter of a radian in a step: a tip that goes down along its tangent at the start of the step
// comes out 3 mm off, and a flat landing leaves the other tip 12 mm deep.
TEST_CASE("planks that spin go no deeper than their rows are off", "[fast][physics]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    const Vec3 axis = space == Space::planar ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitY());
    const Geometry plank = space == Space::planar ? Geometry(Polygon::box(0.1, 0.01))
                                                  : Geometry(Box{{0.1, 0.01, 0.01}});
    for (int k = 0; k < 32; ++k) {
      Scene scene = empty_scene(space);
      scene.add(body_of(shape_of(ground_of(space)), Vec3::Zero(), Motion::fixed));
      Body body = body_of(shape_of(plank), 0.16 * up);
      body.rotation = Quat(Eigen::AngleAxisd(0.1 * k, axis));
      body.angular_velocity = 15 * axis;
      body.linear_velocity = -up;
      scene.add(body);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        INFO(name(table) << " angle " << 0.1 * k);
        CHECK(deepest_of(batch, 20) < 0.004);
      }
    }
  }
}

// Sixteen bodies of a kind in a shaft: they lie on edges, rims and sides, and rock.
TEST_CASE("what drops on edges and sides rocks on to points that are there", "[slow][physics]") {
  for (const Geometry& shape : {Geometry(Cylinder{0.05, 0.05}), Geometry(Capsule{0.03, 0.03}),
                                Geometry(Box{{0.05, 0.03, 0.04}})}) {
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(Plane{}), Vec3::Zero(), Motion::fixed));
    for (const Vec3& inward : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
      scene.add(body_of(shape_of(Plane{inward, -0.2}), Vec3::Zero(), Motion::fixed));
    }
    for (int i = 0; i < 16; ++i) {
      const Vec3 at(0.16 * (i % 2) - 0.08, 0.16 * (i / 2 % 2) - 0.08, 0.1 + 0.17 * (i / 4));
      Body body = body_of(shape_of(shape), at);
      body.jitter.any_orientation = true;
      body.jitter.position = Vec3::Constant(0.005);
      scene.add(body);
    }
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 16));
      INFO(name(table) << " shape " << shape.index());
      CHECK(deepest_of(batch, 120) < 0.035);
    }
  }
}

}  // namespace manyworlds::test
