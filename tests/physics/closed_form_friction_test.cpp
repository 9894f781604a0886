// Rolling, sliding and stopping against closed forms, in both spaces.
#include <catch2/catch.hpp>

#include <cmath>

#include "scenes/known_motion.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

using scenes::incline, scenes::kG;

// Spin that goes with rolling along +x.
double forward_spin(const Batch& batch) {
  return space_of(batch) == Space::planar ? -spin(batch, 0, 0).z() : spin(batch, 0, 0).y();
}

}  // namespace

TEST_CASE("a ball rolls down a slope without slip", "[fast][closed_form]") {
  const double slope = 15 * kPi / 180, radius = 0.05;
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = incline(space, slope, 1, round_of(space, radius), radius);
    scene.options.length_unit = 0.1;
    // a = g sin / (1 + I / (m r^2)): 5/7 for a sphere, 2/3 for a disc.
    const double a = kG * std::sin(slope) * (space == Space::planar ? 2.0 / 3 : 5.0 / 7);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(60);
      INFO(name(table) << " v " << velocity(batch, 0, 0).transpose() << " expected " << a);
      CHECK(velocity(batch, 0, 0).x() == Approx(a).epsilon(5.5e-4));
      CHECK(forward_spin(batch) * radius == Approx(a).epsilon(5.5e-4));
      // Symplectic positions are off by at most v h / 2.
      CHECK(position(batch, 0, 0).x() == approx(0.5 * a, 0.5 * a / 240 + 1e-3 * a));
      CHECK(std::abs(position(batch, 0, 0).dot(up_of(space)) - radius) < 1e-3);
    }
  }
}

TEST_CASE("a sliding block stops after v^2 / (2 mu g)", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = incline(space, 0, 0.3, cube_of(space, 0.25), 0.25);
    scene.bodies[1].linear_velocity = Vec3(5, 0, 0);
    const double time = 5 / (0.3 * kG), distance = 0.5 * 5 * time;
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      while (batch.time() < time - 0.1) batch.step();
      INFO(name(table) << " v " << velocity(batch, 0, 0).transpose());
      CHECK(velocity(batch, 0, 0).x() == approx(5 - 0.3 * kG * batch.time(), 5e-3));
      batch.step(60);
      CHECK(velocity(batch, 0, 0).norm() < 1e-3);
      // Symplectic bias of v0 h / 2 with the substep h.
      CHECK(position(batch, 0, 0).x() == Approx(distance - 0.5 * 5 / 240).epsilon(2e-3));
    }
  }
}

TEST_CASE("a sliding ball grips at 5/7 or 2/3 of its speed", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = incline(space, 0, 0.2, round_of(space, 0.5), 0.5);
    scene.bodies[1].linear_velocity = Vec3(5, 0, 0);
    const bool disc = space == Space::planar;
    const double grip_time = disc ? 5 / (3 * 0.2 * kG) : 2 * 5 / (7 * 0.2 * kG);
    const double rolling = disc ? 5 * 2.0 / 3 : 5 * 5.0 / 7;
    const double grip_x = 5 * grip_time - 0.5 * 0.2 * kG * grip_time * grip_time;
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      while (batch.time() < grip_time - 0.05) batch.step();
      INFO(name(table));
      CHECK(velocity(batch, 0, 0).x() == Approx(5 - 0.2 * kG * batch.time()).epsilon(1e-3));
      CHECK(forward_spin(batch) * 0.5 < velocity(batch, 0, 0).x());
      while (batch.time() < 1.5) batch.step();
      CHECK(velocity(batch, 0, 0).x() == Approx(rolling).epsilon(1e-3));
      CHECK(forward_spin(batch) * 0.5 == Approx(rolling).epsilon(1e-3));
      const double x = grip_x + rolling * (batch.time() - grip_time);
      CHECK(position(batch, 0, 0).x() == Approx(x).epsilon(2e-3));
    }
  }
}

TEST_CASE("a block slides down a slope at g (sin - mu cos)", "[fast][closed_form]") {
  const double slope = 30 * kPi / 180, a = kG * (std::sin(slope) - 0.4 * std::cos(slope));
  for (Space space : {Space::planar, Space::spatial}) {
    const Geometry slab = slab_of(space, 0.5, 0.2);
    const Scene scene = incline(space, slope, 0.4, slab, 0.2);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(60);
      const double v = velocity(batch, 0, 0).x();
      INFO(name(table) << " v " << v);
      CHECK(v == Approx(a).epsilon(2e-3));
      batch.step(60);
      CHECK(velocity(batch, 0, 0).x() - v == Approx(a).epsilon(1e-3));
      CHECK(velocity(batch, 0, 0).dot(up_of(space)) == Approx(0).margin(1e-3));
    }
  }
}

// A pyramid instead of a cone would steer and stop differently along the axes and the diagonals.
TEST_CASE("friction is the same in twelve directions", "[fast][closed_form]") {
  const double mu = std::sqrt(0.9 * 0.8), v0 = 20;
  for (bool spinning_ball : {false, true}) {
    for (const Table& table : all_tables()) {
      for (int k = 0; k < 12; ++k) {
        const double angle = k * kPi / 6 + 0.1;
        const Vec3 along(std::cos(angle), std::sin(angle), 0);
        const Geometry geometry =
            spinning_ball ? round_of(Space::spatial, 0.5) : slab_of(Space::spatial, 0.5, 0.1);
        Scene scene = incline(Space::spatial, 0, 0.9, geometry, spinning_ball ? 0.5 : 0.1);
        scene.bodies[0].shapes[0].material.friction = 0.8;
        scene.bodies[1].linear_velocity = v0 * along;
        Batch batch(compile(scene), options_of(table));
        batch.step(30);  // the ball still slips: it would grip after 0.69 s
        // The last term is the known bias of symplectic positions.
        const double v = v0 - mu * kG * 0.5;
        const double x = v0 * 0.5 - 0.5 * mu * kG * 0.25 - 0.5 * (v0 - v) / 240;
        const Vec3 at = position(batch, 0, 0);
        const double lateral = Vec3(at - along.dot(at) * along).head<2>().norm();
        INFO(name(table) << " direction " << k << " ball " << spinning_ball);
        CHECK(along.dot(at) == Approx(x).epsilon(1e-3));
        CHECK(lateral < 1e-3 * x);
        CHECK(along.dot(velocity(batch, 0, 0)) == Approx(v).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("a spinning block stops by its twist friction and stays on its spot",
          "[fast][closed_form]") {
  Scene scene = incline(Space::spatial, 0, 0.5, Box{{0.4, 0.4, 0.1}}, 0.1);
  scene.bodies[1].angular_velocity = Vec3(0, 0, 5);
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.step(120);
    INFO(name(table));
    CHECK(spin(batch, 0, 0).norm() < 1e-2);
    CHECK(position(batch, 0, 0).head<2>().norm() < 1e-2);
  }
}

TEST_CASE("a ball on a moving belt takes the belt's speed", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, kG);
    const Geometry belt = slab_of(space, 20, 0.5);
    scene.add(body_of(shape_of(belt, 0.5), -0.5 * up_of(space), Motion::kinematic));
    scene.bodies[0].linear_velocity = Vec3(2, 0, 0);
    scene.add(body_of(shape_of(round_of(space, 0.5), 0.5), 0.5 * up_of(space)));
    // Sliding friction until the contact point moves with the belt: then the ball keeps the
    // speed it has, 2/7 (sphere) or 1/3 (disc) of the belt's.
    const double expected = 2 * (space == Space::planar ? 1.0 / 3 : 2.0 / 7);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(90);
      INFO(name(table));
      CHECK(velocity(batch, 0, 1).x() == Approx(expected).epsilon(2e-3));
      CHECK(position(batch, 0, 0).x() == Approx(3).epsilon(pick(table, 1e-5, 1e-12)));
    }
  }
}

TEST_CASE("what slides over level tiles passes their seams, and a raised tile stops it",
          "[fast][closed_form]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    for (const bool ball : {false, true}) {
      for (const double raised : {0.0, 0.2}) {
        Scene scene;
        scene.space = space;
        scene.options.gravity = -kG * up_of(space);
        const Material smooth{0, 0};
        for (int i = 0; i < 8; ++i) {
          Body tile;
          tile.motion = Motion::fixed;
          const double top = i == 5 ? raised : 0;
          tile.position = Vec3(i + 0.5, 0, 0) + (top - 0.5) * up_of(space);
          const Vec3 half = space == Space::planar ? Vec3(0.5, 0.5, 0) : Vec3(0.5, 1, 0.5);
          tile.shapes.push_back(scenes::shape_of(scenes::box_of(space, half), smooth));
          scene.add(tile);
        }
        const Vec3 half = space == Space::planar ? Vec3(0.3, 0.3, 0) : Vec3(0.3, 0.3, 0.3);
        const Geometry geometry =
            ball ? round_of(space, 0.3) : Geometry(scenes::box_of(space, half));
        Body body = scenes::body_of(scenes::shape_of(geometry, smooth), Vec3::Zero());
        body.position = Vec3(0.5, 0, 0) + 0.3 * up_of(space);
        body.linear_velocity = Vec3(5, 0, 0);
        scene.add(body);
        for (const Table& table : all_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(66);  // 5.5 m
          INFO(name(table) << " ball " << ball << " raised " << raised << " at "
                           << position(batch, 0, 0).transpose());
          if (raised > 0) {
            CHECK(velocity(batch, 0, 0).x() < 4);
          } else {
            CHECK(velocity(batch, 0, 0).x() == approx(5, 1e-3));
            CHECK(position(batch, 0, 0).dot(up_of(space)) == approx(0.3, 1e-3));
          }
          // It may tip over the edge that it hits.
          if (raised > 0 && !ball) CHECK(position(batch, 0, 0).x() < 5);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
