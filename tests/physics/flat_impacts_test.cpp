// Impacts of bodies that land on two points at once in the plane.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Falls at 2 m/s from a height that the third step ends below.
Scene drop(Body body, double height) {
  Scene scene = empty_scene(Space::planar, 10);
  scene.add(ground(Space::planar, 0));
  body.position = Vec3(0, height + 0.1, 0), body.linear_velocity = Vec3(0, -2, 0);
  scene.add(body);
  return scene;
}

}  // namespace

// The two points are nearly one to the solver, the more the narrower the foot.
TEST_CASE("a narrow rod that lands upright stops", "[fast][closed_form]") {
  for (const double width : {0.2, 0.02, 0.002}) {
    const Scene scene = drop(body_of(shape_of(Polygon::box(width / 2, 0.5), 0), Vec3::Zero()), 0.5);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      double lowest = 1;
      for (int i = 0; i < 6; ++i) {
        batch.step();
        lowest = std::min(lowest, position(batch, 0, 0).y() - 0.5);
      }
      INFO(name(table) << " width " << width);
      CHECK(lowest > -1e-4);
      CHECK(velocity(batch, 0, 0).norm() < 0.01);
      CHECK(std::abs(spin(batch, 0, 0).z()) < 0.02);
    }
  }
}

// v' = v r^2 / (r^2 + k^2) of the centre, with the inner edge of the foot at the arm r and the
// radius of gyration k: the outer edge leaves.
TEST_CASE("a table that lands on one leg turns about it", "[fast][closed_form]") {
  for (const double width : {0.1, 0.02, 0.004}) {
    const double r = 0.5 - width / 2;
    Body table_top = body_of(shape_of(Polygon::box(width / 2, 0.3), 0), Vec3::Zero());
    table_top.shapes[0].position = Vec3(0.5, 0, 0);
    MassProperties m;
    m.mass = 10, m.inertia = 10 * 0.16 * Mat3::Identity();
    table_top.mass_properties = m;
    Scene scene = drop(table_top, 0.3);
    scene.options.gravity.setZero();
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(4);
      const double share = r * r / (r * r + 0.16);
      INFO(name(table) << " width " << width);
      CHECK(velocity(batch, 0, 0).y() == Approx(-2 * share).epsilon(0.02));
      CHECK(spin(batch, 0, 0).z() == Approx(2 * r / (r * r + 0.16)).epsilon(0.02).margin(1e-9));
    }
  }
}

}  // namespace manyworlds::test
