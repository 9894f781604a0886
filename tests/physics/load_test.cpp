// Loads: what forces press on something touches it.
#include <catch2/catch.hpp>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Steps under a constant force on the last body.
void press(Batch& batch, int body, const Vec3& force, int steps) {
  for (int i = 0; i < steps; ++i) {
    for (int w = 0; w < batch.worlds(); ++w) batch.add_force(w, batch.body_in_row(body), force);
    batch.step();
  }
}

}  // namespace

// By its speed it rests, and it was taken to be free and set back by 17 mm.
TEST_CASE("what a force presses on something touches it", "[fast][load]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      Scene scene = empty_scene(space, 0);
      scene.add(body_of(shape_of(cube_of(space, 0.5)), {-0.5, 0, 0}, Motion::fixed));
      scene.add(body_of(shape_of(cube_of(space, 0.01)), {0.01, 0, 0}));
      const double mass = mass_properties(scene, scene.bodies[1]).mass;
      Batch batch(compile(scene), options_of(table));
      press(batch, 0, {-500 * mass, 0, 0}, 10);
      INFO(name(table));
      CHECK(position(batch, 0, 0).x() == Approx(0.01).margin(1.5e-3));
    }
  }
}

TEST_CASE("a body that a force drives at another does not pass it", "[fast][load]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      Scene scene = empty_scene(space, 0);
      Body plate = body_of(shape_of(slab_of(space, 0.2, 0.01)), Vec3::Zero());
      plate.shapes[0].density = 1e5;
      scene.add(plate);
      scene.add(body_of(shape_of(round_of(space, 0.02)), 0.06 * up_of(space)));
      const double mass = mass_properties(scene, scene.bodies[1]).mass;
      Batch batch(compile(scene), options_of(table));
      press(batch, 1, -1000 * mass * up_of(space), 10);
      INFO(name(table));
      CHECK(up_of(space).dot(position(batch, 0, 1) - position(batch, 0, 0)) > 0.02);
    }
  }
}

}  // namespace manyworlds::test
