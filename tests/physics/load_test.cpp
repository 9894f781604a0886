// Loads: what forces press on something stays on it, however hard, and of any size.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr double kSizes[] = {1e-3, 0.01, 0.1, 1, 10, 100};  // m

// Steps under a constant force on the last body.
void press(Batch& batch, int body, const Vec3& force, int steps) {
  for (int i = 0; i < steps; ++i) {
    for (int w = 0; w < batch.worlds(); ++w) batch.add_force(w, batch.body_in_row(body), force);
    batch.step();
  }
}

}  // namespace

TEST_CASE("a cube carries loads of any size on ground and on a slab", "[fast][load]") {
  for (const Table& table : widest_tables()) {
    for (Space space : {Space::planar, Space::spatial}) {
      const Vec3 up = up_of(space);
      for (const double size : kSizes) {
        for (const double weights : {1.0, 1e3, 1e5}) {
          for (const bool slab : {false, true}) {
            Scene scene = empty_scene(space);
            scene.add(slab ? body_of(shape_of(slab_of(space, 3 * size, 0.25 * size)),
                                     -0.25 * size * up, Motion::fixed)
                           : ground(space));
            scene.add(body_of(shape_of(cube_of(space, size / 2)), size / 2 * up));
            const double mass = mass_properties(scene, scene.bodies[1]).mass;
            Batch batch(compile(scene), options_of(table));
            press(batch, 0, -weights * mass * 10 * up, 60);
            INFO(name(table) << (space == Space::planar ? " 2D " : " 3D ") << size << " m x "
                             << weights << (slab ? " on a slab" : ""));
            CHECK(batch.status(0) == Status::ok);
            CHECK(up.dot(position(batch, 0, 0)) / size == approx(0.5, 0.02));
          }
        }
      }
    }
  }
}

TEST_CASE("a pile carries what presses on its top", "[fast][load]") {
  for (const Table& table : widest_tables()) {
    for (const double size : {0.01, 0.1, 1.0}) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(ground(Space::spatial));
      for (int i = 0; i < 3; ++i) {
        scene.add(
            body_of(shape_of(cube_of(Space::spatial, size / 2)), Vec3(0, 0, size * (0.5 + i))));
      }
      const double weight = mass_properties(scene, scene.bodies[1]).mass * 10;
      Batch batch(compile(scene), options_of(table));
      press(batch, 2, Vec3(0, 0, -10 * weight), 300);
      INFO(name(table) << ' ' << size << " m");
      CHECK(position(batch, 0, 2).z() / size == approx(2.5, 0.25));
      CHECK(position(batch, 0, 2).head<2>().norm() < 0.1 * size);
    }
  }
}

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
      CHECK(position(batch, 0, 0).x() == approx(0.01, 3e-4));
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

// One finger of 0.1 kg holds a box of 1 kg at a wall.
TEST_CASE("a grip does not slip", "[fast][load]") {
  for (const Table& table : widest_tables()) {
    for (const double force : {20.0, 50.0, 100.0}) {
      Scene scene = empty_scene(Space::spatial);
      const auto add = [&](double half, double x, double mass, Motion motion) {
        Body body = body_of(shape_of(cube_of(Space::spatial, half), 0.6), {x, 0, 0}, motion);
        body.shapes[0].density = mass / (8 * half * half * half);
        scene.add(body);
      };
      add(0.2, -0.2, 1, Motion::fixed);
      add(0.03, 0.03, 1, Motion::dynamic);
      add(0.01, 0.07, 0.1, Motion::dynamic);
      Batch batch(compile(scene), options_of(table));
      press(batch, 1, {-force, 0, 0}, 300);
      INFO(name(table) << ' ' << force << " N");
      CHECK(position(batch, 0, 0).tail<2>().norm() < 1e-4);
    }
  }
}

}  // namespace manyworlds::test
