// Several contacts of one impact: restitution gives no energy that was not there, and what does
// not need that guard does not feel it.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A heavy ball falls on a light one that lies on the ground, which alone bounces. The substeps stop
// both. When the ground then takes its impulse back, the light ball keeps that of the heavy one, M
// v, and thrown back with e M v / m it would have e^2 M / m times the energy that came in.
Scene squeezed(Space space, double mass_ratio, double e) {
  Scene scene = empty_scene(space, 0);
  const Vec3 up = up_of(space);
  scene.add(ground(space, 0, e));
  scene.add(body_of(shape_of(round_of(space, 0.5), 0, 0), 0.5 * up));
  scene.add(body_of(shape_of(round_of(space, 0.5), 0, 0), 1.5 * up + 0.03 * Vec3::UnitX()));
  scene.bodies.back().shapes[0].density = 1000 * mass_ratio;
  scene.bodies.back().linear_velocity = -3 * up;
  return scene;
}

}  // namespace

TEST_CASE("a light body between a bouncing one and the ground gains no energy",
          "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double mass_ratio : {1.0, 10.0, 100.0}) {
      for (double e : {0.3, 0.6, 0.96}) {
        const Scene scene = squeezed(space, mass_ratio, e);
        for (const Table& table : all_tables()) {
          Batch batch(compile(scene), options_of(table));
          const double energy = kinetic_energy(batch, 0);
          const double mass = mass_properties(scene, scene.bodies.back()).mass;
          const double along = momenta(batch, 0).linear.x();
          for (int step = 0; step < 20; ++step) {
            batch.step();
            INFO(name(table) << " mass ratio " << mass_ratio << " e " << e << " step " << step
                             << " energy ratio " << kinetic_energy(batch, 0) / energy);
            CHECK(kinetic_energy(batch, 0) < (1 + 1e-4) * energy);
            // The ground is smooth.
            CHECK(momenta(batch, 0).linear.x() ==
                  approx(along, pick(table, 1e-5, 1e-12) * 3 * mass));
          }
        }
      }
    }
  }
}

TEST_CASE("a ball that bounces beside such a crowd bounces as if alone", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Body ball =
        body_of(shape_of(round_of(space, 0.25), 0, 0.9), 10 * Vec3::UnitX() + 0.3 * up_of(space));
    ball.linear_velocity = -3 * up_of(space);
    Scene crowd = squeezed(space, 100, 0.9), alone = empty_scene(space, 0);
    alone.add(ground(space, 0, 0.9));
    crowd.add(ball), alone.add(ball);
    for (const Table& table : all_tables()) {
      Batch among(compile(crowd), options_of(table)), apart(compile(alone), options_of(table));
      among.step(10), apart.step(10);
      INFO(name(table));
      CHECK(velocity(among, 0, 2) == velocity(apart, 0, 0));
      CHECK(position(among, 0, 2) == position(apart, 0, 0));
      CHECK(velocity(apart, 0, 0).dot(up_of(space)) == Approx(0.9 * 3).epsilon(1e-5));
    }
  }
}

// What moves by itself does work: v' = V + e (V - v) of a bat that comes with V.
TEST_CASE("a bat gives a ball more energy than it had", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double bat_speed : {4.0, -1.0}) {
      Scene scene = empty_scene(space, 0);
      scene.add(
          body_of(shape_of(cube_of(space, 0.5), 0, 0), -0.5 * Vec3::UnitX(), Motion::kinematic));
      scene.bodies[0].linear_velocity = Vec3(bat_speed, 0, 0);
      scene.add(body_of(shape_of(round_of(space, 0.25), 0, 0.8), Vec3(0.6, 0, 0)));
      scene.bodies[1].linear_velocity = Vec3(-3, 0, 0);
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(20);
        INFO(name(table) << " bat " << bat_speed);
        CHECK(velocity(batch, 0, 1).x() ==
              Approx(bat_speed + 0.8 * (bat_speed + 3)).epsilon(pick(table, 1e-5, 1e-12)));
      }
    }
  }
}

// A force's work counts like gravity's. Speeds at impact count gravity alone: within g dt.
TEST_CASE("a ball that a force pulls down bounces as in gravity", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Body ball = body_of(shape_of(round_of(space, 0.5), 0, 1), 1.5 * up_of(space));
    Scene falls = empty_scene(space, 10), pulled = empty_scene(space, 0);
    for (Scene* scene : {&falls, &pulled}) scene->add(ground(space)), scene->add(ball);
    const double mass = mass_properties(falls, ball).mass;
    for (const Table& table : all_tables()) {
      Batch a(compile(falls), options_of(table)), b(compile(pulled), options_of(table));
      for (int step = 0; step < 60; ++step) {
        b.add_force(0, b.body_in_row(0), -10 * mass * up_of(space));
        a.step(), b.step();
        INFO(name(table) << " step " << step);
        CHECK((velocity(a, 0, 0) - velocity(b, 0, 0)).norm() < 0.2);
      }
      CHECK(position(b, 0, 0).dot(up_of(space)) > 0.5);
    }
  }
}

}  // namespace manyworlds::test
