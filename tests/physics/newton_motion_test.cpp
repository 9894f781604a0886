// Links of Solver::newton move as closed forms say.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("a pendulum of the newton solver has the period of its small swings", "[fast][newton]") {
  Scene scene = newton_pendulum();
  scene.options.dt = 0.002;
  const double period = 2 * kPi * std::sqrt(kAboutHinge / (kMass * 10 * kLength));
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    put_angle(batch, kPi / 2 + 0.01);
    double before = 0.01, first = -1, last = -1;
    int crossings = 0;
    for (int i = 1; crossings < 21; ++i) {
      REQUIRE(i < 20000);
      batch.step();
      const double now = of(batch, Field::generalized_position)[0] - kPi / 2;
      if (before * now <= 0 && before != 0) {
        last = (i - now / (now - before)) * scene.options.dt;
        if (crossings++ == 0) first = last;
      }
      before = now;
    }
    CHECK((last - first) / 10 == Approx(period).epsilon(pick(table, 3e-4, 3e-5)));
  }
}

TEST_CASE("motors, dampers and springs of joints act by their members", "[fast][newton]") {
  Scene scene = newton_pendulum(0);
  Control motor;
  motor.kind = ControlKind::joint_force, motor.joint = JointId(0);
  motor.low = -2, motor.high = 2, motor.initial = 1;
  motor.actuator.gear = 5;
  scene.add(motor);
  const double h = scene.options.dt;
  const auto speed_after_a_step = [&](const Scene& s, double control, double q0, double v0) {
    Batch batch(compile(s), options_of(widest_tables().back()));
    put_angle(batch, q0, v0);
    const Numbers values = {control};
    batch.set_controls(0, values);
    batch.step();
    return of(batch, Field::generalized_velocity)[0];
  };
  CHECK(speed_after_a_step(scene, 1, 0, 0) == Approx(h * 5 / kAboutHinge).epsilon(1e-5));
  CHECK(speed_after_a_step(scene, 7, 0, 0) == Approx(h * 10 / kAboutHinge).epsilon(1e-5));
  Scene heavy = scene;
  heavy.joints[0].dynamics.armature = 3;
  CHECK(speed_after_a_step(heavy, 1, 0, 0) == Approx(h * 5 / (kAboutHinge + 3)).epsilon(1e-5));
  Scene damped = scene;
  damped.joints[0].dynamics.damping = 4;  // implicit
  CHECK(speed_after_a_step(damped, 0, 0, 2) ==
        Approx(2 * kAboutHinge / (kAboutHinge + 4 * h)).epsilon(1e-5));
  Scene sprung = scene;
  sprung.joints[0].dynamics.stiffness = 6, sprung.joints[0].dynamics.rest = 0.5;
  CHECK(speed_after_a_step(sprung, 0, 0.75, 0) ==
        Approx(-h * 6 * 0.25 / kAboutHinge).epsilon(1e-5));
  Scene servo = scene;  // to the control, with some damping
  servo.controls[0].actuator = {1, {8, 0, 0}, {0, -8, -0.5}};
  CHECK(speed_after_a_step(servo, 0.3, 0.1, 2) ==
        Approx(2 + h * (8 * (0.3 - 0.1) - 0.5 * 2) / kAboutHinge).epsilon(1e-5));
  servo.controls[0].actuator.high = 0.25;
  CHECK(speed_after_a_step(servo, 0.3, 0.1, 0) == Approx(h * 0.25 / kAboutHinge).epsilon(1e-5));
  // The coordinate of a hinge whose frames coincide.
  Scene shifted = sprung;
  shifted.joints[0].dynamics.reference = 0.75;
  Batch batch(compile(shifted), options_of(widest_tables().back()));
  CHECK(of(batch, Field::generalized_position)[0] == Approx(0.75));
  CHECK((position(batch, 0, BodyId(0)) - Vec3(kLength, 0, 0)).norm() < 1e-6);
}

TEST_CASE("forces, torques and gravity scales act on links", "[fast][newton]") {
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch swing(compile(newton_pendulum(0)), options_of(table));
    const double h = 0.01;
    swing.add_force(0, BodyId(0), Vec3(3, 5, -2));
    swing.add_torque(0, BodyId(0), Vec3(1, 0.5, 0));
    swing.step();
    const double turn = (2 * kLength + 0.5) / kAboutHinge;
    CHECK(of(swing, Field::generalized_velocity)[0] == Approx(h * turn).epsilon(1e-5));
    const double kept = of(swing, Field::generalized_velocity)[0];
    swing.step();  // they were for one call
    CHECK(of(swing, Field::generalized_velocity)[0] == Approx(kept).epsilon(1e-5));
    swing.add_force_at(0, BodyId(0), Vec3(0, 0, -2), Vec3(2 * kLength, 0, 0));
    swing.step();
    CHECK(of(swing, Field::generalized_velocity)[0] ==
          Approx(kept + h * 4 * kLength / kAboutHinge).epsilon(1e-3));

    Scene falling = newton_scene();
    for (const double scale : {1.0, 0.25, 0.0, -1.0}) {
      falling.add(lump(Space::spatial, 3, {1, 1, 1}, Vec3(5.0 * scale, 0, 0)));
      falling.bodies.back().gravity_scale = scale;
    }
    falling.variations = {vary(Parameter::gravity_scale, -2, 2)};
    Batch free(compile(falling), options_of(table, 2));
    const Numbers scales[] = {{1, 0.25, 0, -1}, {1, 1, 1, 0.5}};
    for (int w = 0; w < 2; ++w) free.write(Parameter::gravity_scale, w, scales[w]);
    free.step(10);
    for (int w = 0; w < 2; ++w) {
      for (int b = 0; b < 4; ++b) {
        const double scale = scales[w][static_cast<std::size_t>(b)];
        CHECK(velocity(free, w, BodyId(b)).z() == approx(-scale, 1e-5));
      }
    }
  }
}

// A body that falls through a medium ends at the speed at which drag carries its weight: of a box
// falling along an axis rho A v^2 / 2 = m g, and slowly 3 pi mu d v = m g with its mean size d.
TEST_CASE("bodies of the newton solver fall through a medium at their terminal speed",
          "[fast][newton]") {
  const Vec3 half(0.1, 0.2, 0.3);
  Scene scene = newton_scene(10);
  scene.options.dt = 0.005;
  Shape shape = shape_of(Box{half});
  shape.density = 700;
  scene.add(body_of(std::move(shape), Vec3::Zero()));
  const double mass = 700 * 8 * half.prod(), size = 2 * half.mean();
  const auto speed = [&](const Medium& medium, const Table& table) {
    Scene own = scene;
    own.options.medium = medium, own.options.wind = Vec3(0, 0, 0.5);
    Batch batch(compile(own), options_of(table));
    batch.step(4000);
    return 0.5 - velocity(batch, 0, BodyId(0)).z();
  };
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const double precision = pick(table, 1e-4, 1e-9);
    CHECK(speed({.density = 1000}, table) ==
          Approx(std::sqrt(2 * mass * 10 / (1000 * 4 * half.x() * half.y()))).epsilon(precision));
    CHECK(speed({.viscosity = 40}, table) ==
          Approx(mass * 10 / (3 * kPi * 40 * size)).epsilon(precision));
  }
}

// Down a slope a block slides alike whichever way the slope goes; pyramids are stiffer along their
// edges. Coulomb's g (sin - mu cos) is near: what slides is also lifted (Todorov 2014), and weighs
// more while it rises.
TEST_CASE("elliptic cones of the newton solver are round", "[fast][newton]") {
  const double mu = 0.3, slope = 0.6;
  const auto speed = [&](double heading, const Table& table) {
    Scene scene = newton_scene(0);
    scene.options.solver.cone = FrictionCone::elliptic;
    scene.options.gravity = 10 * Vec3(std::sin(slope) * std::cos(heading),
                                      std::sin(slope) * std::sin(heading), -std::cos(slope));
    Body floor = ground(Space::spatial);
    floor.shapes[0].material.friction = mu;
    scene.add(std::move(floor));
    Shape block = shape_of(Box{{0.5, 0.5, 0.1}});
    block.material.friction = mu;
    const Vec3 begin(0, 0, 0.1);
    scene.add(body_of(std::move(block), begin));
    JointId last;
    for (int axis = 0; axis < 3; ++axis) {  // it does not tip
      Joint slider;
      slider.type = SliderJoint{};
      slider.body_b = BodyId(1);
      slider.frame_b = {Vec3::Zero(), rotation_to(Vec3::UnitX(), Vec3::Unit(axis))};
      slider.frame_a = {last ? Vec3::Zero().eval() : begin, slider.frame_b.rotation};
      slider.after = last;
      last = scene.add(slider);
    }
    Batch batch(compile(scene), options_of(table));
    batch.step(100);
    const Vec3 before = velocity(batch, 0, BodyId(1));
    batch.step(100);
    return Vec3(velocity(batch, 0, BodyId(1)) - before);  // in 1 s
  };
  for (const Table& table : widest_tables()) {
    const double along_x = speed(0, table).x();
    CHECK(along_x == Approx(10 * (std::sin(slope) - mu * std::cos(slope))).epsilon(0.05));
    for (const double heading : {0.4, 0.785, 2.0}) {
      INFO(name(table) << ", heading " << heading);
      const Vec3 gained = speed(heading, table);
      CHECK(gained.head<2>().norm() == Approx(along_x).epsilon(pick(table, 0.01, 1e-8)));
      CHECK(std::atan2(gained.y(), gained.x()) == approx(heading, pick(table, 1e-5, 1e-12)));
    }
  }
}

// A servo whose damping is stiff against the step: explicitly it would ring apart.
TEST_CASE("forces of actuators that damp are implicit in implicit-fast", "[fast][newton]") {
  Scene scene = newton_pendulum(0);
  Control servo;
  servo.kind = ControlKind::joint_force, servo.joint = JointId(0);
  const double damping = 10 * kAboutHinge / scene.options.dt;
  servo.actuator.bias = {0, 0, -damping};
  scene.add(servo);
  scene.options.integrator = Integrator::implicit_fast;
  const double h = scene.options.dt;
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    put_angle(batch, 0, 2);
    batch.step();
    CHECK(of(batch, Field::generalized_velocity)[0] ==
          Approx(2 / (1 + h * damping / kAboutHinge)).epsilon(pick(table, 1e-5, 1e-12)));
  }
}

// Torque-free, about a middle axis: explicit steps gain energy, implicit ones may only lose it.
TEST_CASE("tumbling bodies gain no energy in implicit-fast", "[fast][newton]") {
  Scene scene = newton_scene(0);
  scene.options.integrator = Integrator::implicit_fast;
  scene.add(lump(Space::spatial, kMass, {0.1, 0.3, 0.35}, Vec3::Zero()));
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table));
    put(batch, Field::generalized_velocity, {0, 0, 0, 0.3, 8, 0.2});
    double before = batch.energy(0).kinetic;
    for (int i = 0; i < 300; ++i) {
      batch.step();
      const double now = batch.energy(0).kinetic;
      CHECK(now <= before * (1 + pick(table, 1e-5, 1e-12)));
      before = now;
    }
    CHECK(before > 1);
  }
}

}  // namespace manyworlds::test
