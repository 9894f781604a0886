// What passive trees of Solver::newton keep: energy, momentum and angular momentum, to the order of
// the integrator.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/newton_scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Kept {
  double energy = 0;
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
};
Vec3 vector_of(const Batch& batch, Observed what) {
  Numbers v(3);
  batch.read(what, 0, v);
  return {v[0], v[1], v[2]};
}
Kept kept_of(const Batch& batch) {
  Numbers kinetic(1), potential(1);
  batch.read(Observed::kinetic_energy, 0, kinetic);
  batch.read(Observed::potential_energy, 0, potential);
  return {kinetic[0] + potential[0], vector_of(batch, Observed::momentum),
          vector_of(batch, Observed::angular_momentum)};
}

// By how much what is kept has changed after `seconds` in steps of 1 / rate.
Kept change_of(Scene scene, Integrator integrator, int rate, double seconds, const Table& table) {
  scene.options.integrator = integrator;
  scene.options.dt = 1.0 / rate;
  BatchOptions options = options_of(table);
  options.observe.what = {Observer::motion};
  Batch batch(compile(scene), options);
  batch.look();
  const Kept start = kept_of(batch);
  batch.step(static_cast<int>(std::lround(seconds * rate)));
  const Kept end = kept_of(batch);
  return {end.energy - start.energy, end.momentum - start.momentum, end.angular - start.angular};
}

// Two rods of 1 kg and 1 m on hinges about y, level at the start.
Scene level_rods() {
  Scene scene = newton_scene(9.81);
  for (int i = 0; i < 2; ++i) {
    scene.add(lump(Space::spatial, 1, Vec3(1, 12, 12) / 144, {i + 0.5, 0, 0}));
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i),
                       at({static_cast<double>(i), 0, 0}, z_to_y()), HingeJoint{}));
  }
  return scene;
}

// Five bodies on ball joints in a zigzag that flies and spins without gravity.
Scene flying_chain() {
  Scene scene = newton_scene(0);
  const auto corner = [](int i) { return Vec3(0.8 * i, 0.3 * (i % 2), 0.2 * (i % 3)); };
  for (int i = 0; i < 5; ++i) {
    scene.add(lump(Space::spatial, 1 + 0.2 * i, Vec3(0.02, 0.05, 0.06) * (1 + i),
                   (corner(i) + corner(i + 1)) / 2));
    if (i == 0) continue;
    scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), at(corner(i)), BallJoint{}));
  }
  scene.bodies[0].linear_velocity = {1, 0.5, -0.3};
  scene.bodies[0].angular_velocity = {0.5, 1, 2};
  return scene;
}

}  // namespace

TEST_CASE("the energy of a double pendulum drifts with the order of the integrator",
          "[fast][newton]") {
  for (const Table& table : widest_tables()) {
    if (table.precision != Precision::f64) continue;
    const auto drift = [&](Integrator integrator, int rate) {
      return std::abs(change_of(level_rods(), integrator, rate, 1, table).energy);
    };
    const double coarse = drift(Integrator::runge_kutta4, 100),
                 fine = drift(Integrator::runge_kutta4, 200);
    INFO(coarse << ", " << fine);
    CHECK(coarse < 1e-3);
    CHECK(coarse / fine > 12);  // 2^4, or a power more
    CHECK(drift(Integrator::runge_kutta4, 4000) < 1e-11);
    const double first = drift(Integrator::symplectic_euler, 1000),
                 second = drift(Integrator::symplectic_euler, 2000);
    INFO(first << ", " << second);
    CHECK(first / second == Approx(2).epsilon(0.1));
  }
}

TEST_CASE("a free chain of ball joints keeps its momenta and its energy", "[fast][newton]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    if (table.precision == Precision::f32) {
      const Kept change = change_of(flying_chain(), Integrator::runge_kutta4, 500, 1, table);
      CHECK(change.momentum.norm() < 1e-3);
      CHECK(change.angular.norm() < 1e-2);
      CHECK(std::abs(change.energy) < 1e-2);
      continue;
    }
    const auto change = [&](int rate) {
      return change_of(flying_chain(), Integrator::runge_kutta4, rate, 1, table);
    };
    const Kept coarse = change(100), fine = change(200), exact = change(8000);
    CHECK(coarse.momentum.norm() < 1e-3);
    CHECK(coarse.momentum.norm() / fine.momentum.norm() > 12);
    CHECK(coarse.angular.norm() / fine.angular.norm() > 12);
    CHECK(std::abs(coarse.energy / fine.energy) > 12);
    // To rounding, of 10 N s, 30 N m s and 50 J.
    CHECK(exact.momentum.norm() < 1e-11);
    CHECK(exact.angular.norm() < 1e-10);
    CHECK(std::abs(exact.energy) < 1e-10);
  }
}

}  // namespace manyworlds::test
