// Motion without contacts against closed forms: exact drift, drag, torque-free rotation.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A body whose mass properties are given, so that only they matter.
Body rigid(double mass, const Vec3& inertia, Space space = Space::spatial) {
  Body body = body_of(shape_of(cube_of(space, 0.1)), Vec3::Zero());
  MassProperties m;
  m.mass = mass;
  m.inertia = inertia.asDiagonal();
  body.mass_properties = m;
  return body;
}

}  // namespace

TEST_CASE("a projectile follows the exact parabola", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool ground_below : {false, true}) {
      for (int substeps : {1, 4}) {
        Scene scene = empty_scene(space, 9.81);
        scene.options.substeps = substeps;
        const Vec3 x0 = Vec3(1, 0, 0) + 50 * up_of(space);
        const Vec3 v0 = Vec3(3, 0, 0) + 4 * up_of(space);
        Body ball = body_of(shape_of(round_of(space, 0.5)), x0);
        ball.linear_velocity = v0;
        scene.add(ball);
        Body crate = body_of(shape_of(cube_of(space, 0.5)), x0 + Vec3(5, 0, 0));
        crate.linear_velocity = v0;
        crate.gravity_scale = 0.5;
        crate.angular_velocity = Vec3(0, 0, 1);
        scene.add(crate);
        if (ground_below) scene.add(ground(space));
        for (const Table& table : all_tables()) {
          INFO(name(table) << " substeps " << substeps << " ground " << ground_below);
          Batch batch(compile(scene), options_of(table));
          for (int n = 1; n <= 120; ++n) {
            batch.step();
            const double t = n * scene.options.dt;
            const Vec3 g = scene.options.gravity;
            REQUIRE((position(batch, 0, 0) - (x0 + v0 * t + 0.5 * g * t * t)).norm() <
                    pick(table, 3e-4, 5e-12));
            REQUIRE(
                (position(batch, 0, 1) - (x0 + Vec3(5, 0, 0) + v0 * t + 0.25 * g * t * t)).norm() <
                pick(table, 3e-4, 5e-12));
            REQUIRE((velocity(batch, 0, 0) - (v0 + g * t)).norm() < pick(table, 1e-4, 1e-12));
            REQUIRE((velocity(batch, 0, 1) - (v0 + 0.5 * g * t)).norm() < pick(table, 1e-4, 1e-12));
          }
          const Energy e = batch.energy(0);
          const double t = 2;
          const MassProperties ball_mass = mass_properties(scene, scene.bodies[0]);
          const MassProperties crate_mass = mass_properties(scene, scene.bodies[1]);
          const double fall = x0.dot(up_of(space)) + 4 * t;
          CHECK(e.potential == Approx(9.81 * (ball_mass.mass * (fall - 0.5 * 9.81 * t * t) +
                                              0.5 * crate_mass.mass * (fall - 0.25 * 9.81 * t * t)))
                                   .epsilon(pick(table, 1e-4, 1e-10)));
          CHECK(e.kinetic == Approx(kinetic_energy(batch, 0)).epsilon(pick(table, 1e-5, 1e-12)));
        }
      }
    }
  }
}

// v' = v / (1 + h c). h is the substep (dt / substeps) or the whole step: which one is part of
// the contract's freedom, that it is one of them in every step is not.
TEST_CASE("drag follows the implicit law", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool ground_below : {false, true}) {
      Scene scene = empty_scene(space, 0);
      Body body = body_of(shape_of(cube_of(space, 0.5)), 5 * up_of(space));
      body.linear_velocity = Vec3(3, 0, 0) + 1 * up_of(space);
      body.angular_velocity = Vec3(0, 0, 2);
      body.linear_drag = 0.7;
      body.angular_drag = 1.3;
      scene.add(body);
      if (ground_below) scene.add(ground(space));
      const int substeps = *compile(scene).resolved().substeps;
      const double dt = scene.options.dt, h = dt / substeps;
      const auto factor = [&](double c, bool fine) {
        return fine ? std::pow(1 + h * c, -substeps) : 1 / (1 + dt * c);
      };
      for (const Table& table : all_tables()) {
        INFO(name(table) << " ground " << ground_below);
        Batch batch(compile(scene), options_of(table));
        batch.step();
        const double tight = pick(table, 2e-6, 1e-12);
        const double first = velocity(batch, 0, 0).x() / 3;
        const bool fine =
            std::abs(first - factor(0.7, true)) < std::abs(first - factor(0.7, false));
        for (int n = 1; n <= 60; ++n) {
          INFO("step " << n << (fine ? ", per substep" : ", per step"));
          const double linear = std::pow(factor(0.7, fine), n);
          const double angular = std::pow(factor(1.3, fine), n);
          REQUIRE((velocity(batch, 0, 0) - linear * body.linear_velocity).norm() < 10 * tight);
          REQUIRE(spin(batch, 0, 0).z() == approx(2 * angular, 10 * tight));
          batch.step();
        }
        // 61 steps: the continuous law within the first order of h.
        const double t = 61 * dt;
        const double x = 3 / 0.7 * (1 - std::exp(-0.7 * t));
        CHECK(position(batch, 0, 0).x() == Approx(x).epsilon(0.7 * (fine ? h : dt)));
      }
    }
  }
}

TEST_CASE("a steady spin turns by the exact angle", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    Body body = body_of(shape_of(cube_of(space, 0.5)), Vec3::Zero());
    body.angular_velocity = Vec3(0, 0, 5);
    scene.add(body);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table));
      batch.step(120);
      const Quat expected(Eigen::AngleAxisd(10.0, Vec3::UnitZ()));
      CHECK(angle_between(rotation(batch, 0, 0), expected) < pick(table, 1e-4, 1e-9));
      CHECK(rotation(batch, 0, 0).norm() == approx(1, pick(table, 1e-6, 1e-12)));
      CHECK(spin(batch, 0, 0).z() == approx(5, pick(table, 1e-6, 1e-12)));
    }
  }
}

// MuJoCo's free box (inertia of half sizes .1, .2, .3), spun about no principal axis. The
// reference is a quad-precision solution of Euler's equations.
TEST_CASE("a tumbling box keeps its energy, momentum and phase", "[fast][closed_form]") {
  Scene scene = empty_scene(Space::spatial, 0);
  Body body = rigid(1, Vec3(0.13, 0.10, 0.05) / 3);
  body.angular_velocity = Vec3(1, 2, 3);
  scene.add(body);
  const Quat at_1(-0.185362390179059707, 0.777715431194221472, 0.0258573602837081486,
                  0.600109064511319233);
  const Quat at_5(-0.3648637429868626, 0.0235633573425886834, 0.0212620010520073973,
                  -0.930519824912734775);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    const Momenta before = momenta(batch, 0);
    CHECK(kinetic_energy(batch, 0) == Approx(0.49 / 3).epsilon(1e-6));
    batch.step(60);
    CHECK(angle_between(rotation(batch, 0, 0), at_1) < 6e-3);
    batch.step(240);
    CHECK(angle_between(rotation(batch, 0, 0), at_5) < 6e-3);
    CHECK(kinetic_energy(batch, 0) == Approx(0.49 / 3).epsilon(1e-3));
    CHECK((momenta(batch, 0).angular - before.angular).norm() <
          pick(table, 2e-4, 1e-11) * before.angular.norm());
  }
}

// Axisymmetric free body: elementary functions. The spin is given in the body frame, which is the
// world frame at the start.
TEST_CASE("an axisymmetric body precesses by the closed form", "[fast][closed_form]") {
  const double transverse = 0.04, axial = 0.02, t = 2;
  const Vec3 w0(2, 4, 6);
  Scene scene = empty_scene(Space::spatial, 0);
  Body body = rigid(1, Vec3(transverse, transverse, axial));
  body.angular_velocity = w0;
  scene.add(body);
  const double s = (transverse - axial) / transverse * w0.z();
  const double ratio = w0.z() * axial / transverse;
  const double p = std::sqrt(w0.x() * w0.x() + w0.y() * w0.y() + ratio * ratio), c = ratio / p;
  const double cp = std::cos(p * t / 2), sp = std::sin(p * t / 2);
  const double cs = std::cos(s * t / 2), ss = std::sin(s * t / 2);
  const Quat expected(cp * cs - c * sp * ss, sp / p * (w0.x() * cs + w0.y() * ss),
                      sp / p * (-w0.x() * ss + w0.y() * cs), c * sp * cs + cp * ss);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    batch.step(120);
    CHECK(angle_between(rotation(batch, 0, 0), expected) < 6e-3);
  }
}

TEST_CASE("the tumbling error shrinks with the square of the step", "[fast][closed_form]") {
  Scene scene = empty_scene(Space::spatial, 0);
  Body body = rigid(1, Vec3(0.13, 0.10, 0.05) / 3);
  body.angular_velocity = Vec3(1, 2, 3);
  scene.add(body);
  const Quat at_1(-0.185362390179059707, 0.777715431194221472, 0.0258573602837081486,
                  0.600109064511319233);
  const Table table = widest_tables().back();
  if (table.precision != Precision::f64) return;  // a development build
  double previous = 0;
  for (int rate : {60, 120, 240}) {
    scene.options.dt = 1.0 / rate;
    Batch batch(compile(scene), options_of(table));
    batch.step(rate);
    const double error = angle_between(rotation(batch, 0, 0), at_1);
    INFO("rate " << rate << " error " << error << " before " << previous);
    if (previous > 0) CHECK(previous / error > 3.5);
    previous = error;
  }
}

// A dumbbell of two spheres whose body frame is at one of them: the centre of mass moves straight
// and the frame circles around it.
TEST_CASE("a body with an offset centre of mass turns about that centre", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    Body body = body_of(shape_of(round_of(space, 0.2)), Vec3(1, 2, 0));
    body.shapes.push_back(shape_of(round_of(space, 0.2)));
    body.shapes[1].position = Vec3(1, 0, 0);
    body.linear_velocity = Vec3(0.5, -0.25, 0);
    body.angular_velocity = Vec3(0, 0, 3);
    scene.add(body);
    CHECK((mass_properties(scene, body).center - Vec3(0.5, 0, 0)).norm() < 1e-12);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table));
      for (int n = 1; n <= 60; ++n) {
        batch.step();
        const double t = n * scene.options.dt;
        const Vec3 center = Vec3(1.5, 2, 0) + t * body.linear_velocity;
        const Quat turned(Eigen::AngleAxisd(3 * t, Vec3::UnitZ()));
        REQUIRE((position(batch, 0, 0) - (center + turned * Vec3(-0.5, 0, 0))).norm() <
                pick(table, 2e-5, 1e-10));
        REQUIRE((velocity(batch, 0, 0) - body.linear_velocity).norm() < pick(table, 1e-6, 1e-13));
      }
    }
  }
}

}  // namespace manyworlds::test
