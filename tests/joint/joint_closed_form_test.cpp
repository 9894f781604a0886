// Joints against closed forms: springs, motors, limits, sliders, wheels, pulleys.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Scene still_scene(Space space) { return empty_scene(space, 0); }

}  // namespace

TEST_CASE("a spring follows the recurrence of implicit Euler", "[fast][joint]") {
  for (Space space : kSpaces) {
    for (const double stiffness : {1e2, 1e4, 1e8}) {
      for (const double ratio : {0.0, 0.1, 1.0}) {
        Scene scene = still_scene(space);
        const double damping = ratio * 2 * std::sqrt(stiffness);
        const BodyId ball = add_ball(scene, {3, 0, 0});
        DistanceJoint spring;
        spring.length = 2;
        spring.spring = Spring{stiffness, damping, 0, 0};
        scene.add(joint_at(scene, {}, ball, at(Vec3::Zero()), spring));
        scene.joints[0].frame_b = {};
        const Plan plan = compile(scene);
        for (const Table& table : widest_tables()) {
          Batch batch(plan, options_of(table));
          INFO(name(table) << " k " << stiffness << " ratio " << ratio);
          const double h = 1.0 / 240;
          double x = 1, v = 0;
          for (int i = 0; i < 120; ++i) {
            for (int s = 0; s < 4; ++s) {
              v = (v - h * stiffness * x) / (1 + h * damping + h * h * stiffness);
              x += h * v;
            }
            batch.step();
          }
          CHECK(position(batch, 0, 0).x() - 2 == approx(x, pick(table, 1e-5, 1e-11)));
          CHECK(velocity(batch, 0, 0).x() == approx(v, pick(table, 1e-4, 1e-10)));
        }
      }
    }
  }
}

TEST_CASE("springs of any stiffness stay finite and come to rest", "[fast][joint]") {
  for (Space space : kSpaces) {
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8, 1e12}) {
      Scene scene = still_scene(space);
      const BodyId ball = add_ball(scene, {1, 0, 0});
      TargetJoint target;
      target.spring = Spring{stiffness, 2 * std::sqrt(stiffness), 0, 0};
      scene.add(joint_at(scene, {}, ball, at(Vec3::Zero()), target));
      scene.joints[0].frame_b = {};
      const Plan plan = compile(scene);
      for (const Table& table : widest_tables()) {
        Batch batch(plan, options_of(table));
        INFO(name(table) << " k " << stiffness);
        batch.step(600);
        CHECK(position(batch, 0, 0).norm() < 1e-6);
        CHECK(batch.status(0) == Status::ok);
      }
    }
  }
}

TEST_CASE("a motor turns its body with its torque, up to its speed", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = still_scene(space);
    const BodyId wheel = add_ball(scene, Vec3::Zero());
    HingeJoint hinge;
    hinge.drive = Drive{0, 8, std::nullopt, 0.5};
    scene.add(joint_at(scene, {}, wheel, at(Vec3::Zero()), hinge));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table));
      batch.step(60);  // I = 0.1 kg m^2
      CHECK(spin(batch, 0, 0).z() == Approx(5).epsilon(pick(table, 1e-5, 1e-12)));
      batch.step(60);
      CHECK(spin(batch, 0, 0).z() == Approx(8).epsilon(pick(table, 1e-5, 1e-12)));
    }
  }
}

TEST_CASE("a position drive holds a rod up with the torque that this takes", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(uniform_rod(space, 2, 1, {0.5, 0, 0}));
    HingeJoint hinge;
    hinge.drive = Drive{0, 0, Spring{500, 50, 0, 0}, 1e3};
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), hinge));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table));
      batch.step(300);
      // k angle = m g (l / 2) cos(angle)
      const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
      const double angle = -std::asin(along.dot(up_of(space)));
      CHECK(500 * angle == Approx(2 * 10 * 0.5 * std::cos(angle)).epsilon(1e-3));
      CHECK(spin(batch, 0, 0).norm() < 1e-3);
    }
  }
}

TEST_CASE("limits stop a hinge and a slider, and hold what leans on them", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(uniform_rod(space, 1, 1, {0.5, 0, 0}));
    HingeJoint hinge;
    hinge.limit = Limit{-0.5, 0.5, std::nullopt};
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), hinge));
    // Slides down along -up: x of the frame is up.
    const Quat up = rotation_to(Vec3::UnitX(), up_of(space));
    const BodyId lift = add_ball(scene, {5, 0, 0});
    SliderJoint slider;
    slider.limit = Limit{-2, 1, std::nullopt};
    scene.add(joint_at(scene, {}, lift, at({5, 0, 0}, up), slider));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table) << (space == Space::planar ? " planar" : " spatial"));
      double lowest = 0;
      for (int i = 0; i < 240; ++i) {
        batch.step();
        lowest = std::min(lowest, position(batch, 0, 1).dot(up_of(space)));
      }
      const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
      CHECK(std::asin(along.dot(up_of(space))) == approx(-0.5, 2e-3));
      CHECK(position(batch, 0, 1).dot(up_of(space)) == approx(-2, 2e-3));
      CHECK(lowest > -2.01);
      CHECK(max_speed(batch, 0) < 1e-2);
      CHECK(std::abs(position(batch, 0, 1).x() - 5) < 1e-4);
    }
  }
}

TEST_CASE("a bead slides down a wire as g sin of its slope", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 9.81);
    scene.options.dt = 1.0 / 240;
    const double slope = 0.4;
    const Vec3 down = std::cos(slope) * Vec3::UnitX() - std::sin(slope) * up_of(space);
    const BodyId bead = add_ball(scene, Vec3::Zero());
    scene.add(joint_at(scene, {}, bead, at(Vec3::Zero(), rotation_to(Vec3::UnitX(), down)),
                       SliderJoint{}));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table));
      batch.step(240);
      CHECK(velocity(batch, 0, 0).dot(down) == Approx(9.81 * std::sin(slope)).epsilon(1e-4));
      const Vec3 x = position(batch, 0, 0);
      CHECK((x - x.dot(down) * down).norm() < 1e-4);
      CHECK(spin(batch, 0, 0).norm() < 1e-4);
    }
  }
}

TEST_CASE("a wheel's suspension sags and swings as a damped oscillator", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 9.81);
    scene.options.dt = 1.0 / 960;
    const Quat up = rotation_to(Vec3::UnitX(), up_of(space));
    const BodyId chassis = add_ball(scene, Vec3::Zero(), 3);
    const double omega = 2 * kPi * 1.5, zeta = 0.3;
    WheelJoint wheel;
    wheel.suspension = Spring{0, 0, 1.5, zeta};
    scene.add(joint_at(scene, {}, chassis, at(Vec3::Zero(), up), wheel));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table));
      for (const double t : {0.25, 0.5, 1.0}) {
        while (batch.steps() < static_cast<std::int64_t>(t * 960)) batch.step();
        const double damped = omega * std::sqrt(1 - zeta * zeta);
        const double sag =
            9.81 / (omega * omega) *
            (1 - std::exp(-zeta * omega * t) *
                     (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t)));
        CHECK(-position(batch, 0, 0).dot(up_of(space)) == Approx(sag).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("Atwood's machine falls with (m1 - m2) g / (m1 + m2)", "[fast][joint]") {
  for (Space space : kSpaces) {
    for (const double ratio : {1.0, 2.0}) {
      Scene scene = empty_scene(space, 9.81);
      scene.options.dt = 1.0 / 240;
      const double m1 = 2, m2 = 1;
      const Vec3 up = up_of(space);
      const BodyId heavy = add_ball(scene, {-1, 0, 0}, m1), light = add_ball(scene, {1, 0, 0}, m2);
      PulleyJoint rope;
      rope.ground_a = Vec3(-1, 0, 0) + 5 * up;
      rope.ground_b = Vec3(1, 0, 0) + 5 * up;
      rope.ratio = ratio;
      Joint joint;
      joint.type = rope;
      joint.body_a = heavy, joint.body_b = light;
      scene.add(joint);
      const Plan plan = compile(scene);
      for (const Table& table : widest_tables()) {
        Batch batch(plan, options_of(table));
        INFO(name(table) << " ratio " << ratio);
        batch.step(120);
        // x1 + n x2 = const, downward positive.
        const double a = 9.81 * (ratio * ratio * m1 - ratio * m2) / (ratio * ratio * m1 + m2);
        CHECK(-velocity(batch, 0, 0).dot(up) == Approx(a * 0.5).epsilon(1e-3));
        CHECK(-position(batch, 0, 0).dot(up) == Approx(0.5 * a * 0.25).epsilon(1e-2));
        CHECK(velocity(batch, 0, 1).dot(up) == Approx(a * 0.5 / ratio).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("welded bodies fly as one, and keep their momenta", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = still_scene(space);
    for (int i = 0; i < 3; ++i) add_ball(scene, {0.3 * i, 0, 0}, 1 + i);
    for (int i = 0; i < 2; ++i) {
      scene.add(
          joint_at(scene, BodyId(i), BodyId(i + 1), at({0.3 * i + 0.15, 0, 0}), FixedJoint{}));
    }
    // About the common centre of mass, 0.4 m from the first body.
    const Vec3 spin_rate(0, 0, 3), flight(1, 2, 0);
    for (int i = 0; i < 3; ++i) {
      Body& b = scene.bodies[static_cast<std::size_t>(i)];
      b.angular_velocity = spin_rate;
      b.linear_velocity = flight + spin_rate.cross(b.position - Vec3(0.4, 0, 0));
    }
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table));
      INFO(name(table));
      const Momenta before = momenta(batch, 0);
      batch.step(120);
      const Momenta after = momenta(batch, 0);
      CHECK((after.linear - before.linear).norm() < pick(table, 1e-4, 1e-11));
      CHECK((after.angular - before.angular).norm() < 0.01 * before.angular.norm());
      CHECK(worst_gap(batch, 0) < 1e-3);
      for (int i = 0; i < 3; ++i) CHECK(spin(batch, 0, i).z() == Approx(3).epsilon(0.01));
    }
  }
}

}  // namespace manyworlds::test
