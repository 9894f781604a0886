// Capsules at rest, balanced, rolling and in scenes with every other shape.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Turns a capsule's axis to x.
Quat lying(Space space) {
  return Quat(space == Space::planar ? Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ())
                                     : Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));
}

Scene capsule_on(Space space, Geometry below, double height, const Quat& rotation) {
  Scene scene = empty_scene(space);
  scene.add(body_of(shape_of(std::move(below)), Vec3::Zero(), Motion::fixed));
  scene.add(body_of(shape_of(Capsule{0.2, 0.5}), height * up_of(space)));
  scene.bodies[1].rotation = rotation;
  return scene;
}

}  // namespace

TEST_CASE("a lying capsule rests on two points", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Geometry grounds[] = {ground_of(space), box_of(space, Vec3(2, 1, 1)),
                                box_of(space, Vec3(0.3, 1, 1))};
    for (const Geometry& below : grounds) {
      const double top = below.index() == ground_of(space).index() ? 0 : 1;
      const Scene scene = capsule_on(space, below, top + 0.2, lying(space));
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(240);
        INFO(name(table) << " x " << position(batch, 0, 0).transpose());
        CHECK(batch.contacts(0).size() == 2);
        CHECK(std::abs(position(batch, 0, 0).dot(up_of(space)) - top - 0.2) < 2e-3);
        CHECK(max_speed(batch, 0) < 1e-3);
        CHECK(spin(batch, 0, 0).norm() < 1e-3);
      }
    }
  }
}

TEST_CASE("a rolling capsule keeps its points' features", "[fast][collide]") {
  for (const Geometry& below : {Geometry(Plane{}), Geometry(Box{{3, 3, 1}})}) {
    const double top = std::holds_alternative<Plane>(below) ? 0 : 1;
    Scene scene = capsule_on(Space::spatial, below, top + 0.2, lying(Space::spatial));
    scene.bodies[1].linear_velocity = Vec3(0, 1, 0);
    scene.bodies[1].angular_velocity = Vec3(-5, 0, 0);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(5);
      const auto first = batch.contacts(0);
      REQUIRE(first.size() == 2);
      CHECK(first[0].feature != first[1].feature);
      for (int i = 0; i < 60; ++i) {
        batch.step();
        const auto now = batch.contacts(0);
        REQUIRE(now.size() == 2);
        for (std::size_t k = 0; k < 2; ++k) {
          CHECK(now[k].feature == first[k].feature);
          CHECK(now[k].normal_impulse > 0);  // carried on
        }
      }
      CHECK(velocity(batch, 0, 0).y() == Approx(1).epsilon(1e-3));
    }
  }
}

TEST_CASE("a capsule on its end stays balanced", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Scene scene = capsule_on(space, ground_of(space), 0.7, Quat::Identity());
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(120);
      INFO(name(table) << " x " << position(batch, 0, 0).transpose());
      CHECK(batch.contacts(0).size() == 1);
      CHECK(std::abs(position(batch, 0, 0).dot(up_of(space)) - 0.7) < 2e-3);
      CHECK(spin(batch, 0, 0).norm() < 1e-3);
    }
  }
}

TEST_CASE("a capsule lies on a capsule in a trough", "[fast][collide]") {
  // Three parallel ones: two fixed, one in the groove between them.
  Scene scene = empty_scene(Space::spatial);
  for (double y : {-0.2, 0.2}) {
    scene.add(body_of(shape_of(Capsule{0.2, 0.5}), Vec3(0, y, 0), Motion::fixed));
    scene.bodies.back().rotation = lying(Space::spatial);
  }
  const double height = std::sqrt(0.4 * 0.4 - 0.2 * 0.2);
  scene.add(body_of(shape_of(Capsule{0.2, 0.4}), Vec3(0, 0, height)));
  scene.bodies.back().rotation = lying(Space::spatial);
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(240);
    INFO(name(table) << " x " << position(batch, 0, 0).transpose());
    CHECK(batch.contacts(0).size() == 4);
    CHECK((position(batch, 0, 0) - Vec3(0, 0, height)).norm() < 3e-3);
    CHECK(max_speed(batch, 0) < 1e-3);
  }
}

TEST_CASE("a capsule rolls down a slope without slip", "[fast][closed_form]") {
  // Across its axis, which is y: a = g sin / (1 + I / (m r^2)).
  const double slope = 15 * kPi / 180, g = 9.81, radius = 0.05;
  Scene scene = empty_scene(Space::spatial);
  scene.options.gravity = g * Vec3(std::sin(slope), 0, -std::cos(slope));
  scene.options.length_unit = 0.1;
  scene.add(ground(Space::spatial, 1));
  scene.add(body_of(shape_of(Capsule{radius, 0.1}, 1), Vec3(0, 0, radius)));
  scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  const MassProperties m = mass_properties(scene, scene.bodies[1]);
  const double a = g * std::sin(slope) / (1 + m.inertia(2, 2) / (m.mass * radius * radius));
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(60);
    INFO(name(table) << " v " << velocity(batch, 0, 0).transpose() << " expected " << a);
    CHECK(velocity(batch, 0, 0).x() == Approx(a).epsilon(1e-3));
    CHECK(spin(batch, 0, 0).y() * radius == Approx(a).epsilon(1e-3));
    CHECK(std::abs(velocity(batch, 0, 0).y()) < 1e-3);
    CHECK(std::abs(position(batch, 0, 0).z() - radius) < 1e-3);
  }
}

TEST_CASE("coincident capsules part", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (const Geometry& other :
         {Geometry(Capsule{0.2, 0.5}), round_of(space, 0.3), cube_of(space, 0.3)}) {
      for (Motion motion : {Motion::dynamic, Motion::fixed}) {
        Scene scene = empty_scene(space, 0);
        scene.add(body_of(shape_of(other), Vec3(1, 2, 0), motion));
        scene.add(body_of(shape_of(Capsule{0.2, 0.5}), Vec3(1, 2, 0)));
        if (motion == Motion::fixed) scene.add(body_of(shape_of(other), Vec3(1, 2, 0)));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          INFO(name(table) << " shape " << other.index());
          REQUIRE(!batch.contacts(0).empty());
          for (const Contact& c : batch.contacts(0)) {
            CHECK(c.normal.norm() == approx(1, 1e-6));
            CHECK(c.point.allFinite());
            CHECK(c.separation < -0.1);
          }
          batch.step(120);
          CHECK(batch.status(0) == Status::ok);
          CHECK(max_penetration(batch, 0) < 0.1);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
