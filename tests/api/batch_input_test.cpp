// Forces, torques and impulses, and bodies that are moved by none.
#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {}  // namespace

TEST_CASE("forces act through one call of step and are cleared", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Scene scene = one_crate(space);
    const MassProperties m = mass_properties(scene, scene.bodies[0]);
    const double inertia = m.inertia(2, 2);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      const double tight = pick(table, 1e-5, 1e-12);
      Batch batch(compile(scene), options_of(table, 9));
      batch.add_force(4, batch.body_in_row(0), m.mass * Vec3(3, 1, 0));
      batch.add_force(4, batch.body_in_row(0), m.mass * Vec3(0, 1, 0));  // forces add up
      batch.add_torque(4, batch.body_in_row(0), inertia * Vec3(0, 0, 6));
      batch.step(30);
      const double t = 0.5;
      CHECK((velocity(batch, 4, 0) - t * Vec3(3, 2, 0)).norm() < tight);
      CHECK((position(batch, 4, 0) - 0.5 * t * t * Vec3(3, 2, 0)).norm() < tight);
      CHECK(spin(batch, 4, 0).z() == approx(6 * t, 10 * tight));
      batch.step(30);
      CHECK((velocity(batch, 4, 0) - t * Vec3(3, 2, 0)).norm() < tight);
      CHECK(spin(batch, 4, 0).z() == approx(6 * t, 10 * tight));
      for (int w = 0; w < 9; ++w)
        if (w != 4) CHECK(velocity(batch, w, 0).norm() + position(batch, w, 0).norm() == 0);
    }
  }
}

TEST_CASE("forces and impulses at a point turn the body about its centre", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = one_crate(space);
    scene.bodies[0].shapes[0].position = Vec3(0.3, -0.2, 0);  // off the body frame
    scene.bodies[0].position = Vec3(2, 1, 0);
    const MassProperties m = mass_properties(scene, scene.bodies[0]);
    const Vec3 center = scene.bodies[0].position + m.center;
    CHECK((m.center - Vec3(0.3, -0.2, 0)).norm() < 1e-12);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      const double tight = pick(table, 1e-5, 1e-12);
      Batch batch(compile(scene), options_of(table, 3));
      // Impulses act at once.
      batch.add_impulse_at(0, batch.body_in_row(0), m.mass * Vec3(0, 2, 0),
                           center + Vec3(0.5, 0, 0));
      CHECK((velocity(batch, 0, 0) - Vec3(0, 2, 0)).norm() < tight);
      CHECK(spin(batch, 0, 0).z() ==
            Approx(m.mass / m.inertia(2, 2)).epsilon(pick(table, 1e-5, 1e-12)));
      batch.add_impulse(1, batch.body_in_row(0), m.mass * Vec3(1, 0, 0));
      batch.add_angular_impulse(1, batch.body_in_row(0), m.inertia(2, 2) * Vec3(0, 0, 3));
      CHECK((velocity(batch, 1, 0) - Vec3(1, 0, 0)).norm() < tight);
      CHECK((spin(batch, 1, 0) - Vec3(0, 0, 3)).norm() < 10 * tight);
      // A force through the centre does not turn it; beside it, the lever arm counts.
      batch.add_force_at(2, batch.body_in_row(0), m.mass * Vec3(1, 0, 0), center + Vec3(0.7, 0, 0));
      batch.add_force_at(2, batch.body_in_row(0), m.mass * Vec3(1, 0, 0),
                         center + Vec3(0, 0.25, 0));
      batch.step();
      const double dt = scene.options.dt;
      CHECK((velocity(batch, 2, 0) - Vec3(2 * dt, 0, 0)).norm() < tight);
      CHECK(spin(batch, 2, 0).z() ==
            Approx(-0.25 * m.mass * dt / m.inertia(2, 2)).epsilon(pick(table, 1e-4, 1e-10)));
    }
  }
}

TEST_CASE("an angular impulse goes through the whole inertia tensor", "[fast][batch]") {
  Scene scene = one_crate(Space::spatial);
  scene.bodies[0].shapes[0].geometry = Box{{0.2, 0.4, 0.7}};
  scene.bodies[0].rotation = Quat(0.5, -0.1, 0.7, 0.3).normalized();
  const MassProperties m = mass_properties(scene, scene.bodies[0]);
  const Mat3 r = scene.bodies[0].rotation.toRotationMatrix();
  const Vec3 impulse(30, -50, 20);
  const Vec3 expected = (r * m.inertia * r.transpose()).inverse() * impulse;
  for (const Table& table : all_tables()) {
    Batch batch(compile(scene), options_of(table));
    batch.add_angular_impulse(0, batch.body_in_row(0), impulse);
    CHECK((spin(batch, 0, 0) - expected).norm() < pick(table, 1e-5, 1e-12) * expected.norm());
  }
}

TEST_CASE("kinematic bodies ignore forces and keep their velocity", "[fast][batch]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = one_crate(space, 10);
    scene.bodies[0].motion = Motion::kinematic;
    scene.bodies[0].linear_velocity = Vec3(0.5, 0, 0);
    scene.bodies[0].angular_velocity = Vec3(0, 0, 1);
    scene.add(body_of(shape_of(round_of(space, 0.3)), Vec3(0.2, 0, 0)));  // overlaps it
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table));
      batch.add_force(0, batch.body_in_row(0), Vec3(1e4, 0, 0));
      batch.add_impulse(0, batch.body_in_row(0), Vec3(1e4, 0, 0));
      batch.add_torque(0, batch.body_in_row(0), Vec3(0, 0, 1e4));
      batch.step(60);
      CHECK((velocity(batch, 0, 0) - Vec3(0.5, 0, 0)).norm() == 0);
      CHECK((spin(batch, 0, 0) - Vec3(0, 0, 1)).norm() == 0);
      CHECK((position(batch, 0, 0) - Vec3(0.5, 0, 0)).norm() < pick(table, 1e-5, 1e-12));
    }
  }
}

TEST_CASE("a kinematic platform carries a box", "[fast][batch]") {
  // A cube, and what is not one: its inertia is a tensor, and a kinematic body has none.
  for (const auto& [space, half] : {std::pair(Space::planar, Vec3(0.25, 0.25, 0)),
                                    std::pair(Space::spatial, Vec3(0.25, 0.25, 0.25)),
                                    std::pair(Space::spatial, Vec3(0.3, 0.2, 0.25))}) {
    Scene scene = empty_scene(space);
    const Geometry platform = slab_of(space, 1, 0.1);
    scene.add(body_of(shape_of(platform), -0.1 * up_of(space), Motion::kinematic));
    scene.bodies[0].linear_velocity = Vec3(0.5, 0, 0) + 0.3 * up_of(space);
    scene.add(body_of(shape_of(box_of(space, half)), 0.25 * up_of(space)));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table));
      batch.step(180);
      CHECK((velocity(batch, 0, 1) - scene.bodies[0].linear_velocity).norm() < 1e-3);
      const Vec3 on_top = position(batch, 0, 1) - position(batch, 0, 0);
      CHECK(on_top.dot(up_of(space)) == approx(0.35, 2e-3));
      CHECK(std::abs(on_top.x()) < 0.1);  // slipped only while it was picked up
    }
  }
}

}  // namespace manyworlds::test
