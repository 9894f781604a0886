// Controls: what they do, by closed forms, and what they leave alone.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/support/hashes.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Control thrust(int body, const Vec3& point, const Vec3& direction) {
  Control out;
  out.kind = ControlKind::thrust;
  out.body = BodyId(body), out.point = point, out.direction = direction;
  out.low = -100, out.high = 100;
  return out;
}
Control torque(int body, const Vec3& direction) {
  Control out = thrust(body, Vec3::Zero(), direction);
  out.kind = ControlKind::torque;
  return out;
}
Control target(ControlKind kind, int joint) {
  Control out;
  out.kind = kind, out.joint = JointId(joint);
  out.low = -10, out.high = 10;
  return out;
}

// A free body of 2 kg and 0.5 kg m^2 about each axis, without gravity.
Scene free_body(Space space) {
  Scene scene = empty_scene(space, 0);
  scene.add(lump(space, 2, {0.5, 0.5, 0.5}, {1, 2, 0}));
  return scene;
}
// An arm on a hinge with a drive, and nothing else.
Scene arm(Space space, const Drive& drive) {
  Scene scene = empty_scene(space, 0);
  scene.add(uniform_rod(space, 1, 1, {0.5, 0, 0}));
  scene.add(
      joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), HingeJoint{{}, drive}));
  return scene;
}
// About the axis of hinge_axes, rad.
double angle_of_arm(const Batch& batch, int world) {
  const Vec3 x = rotation(batch, world, 0) * Vec3::UnitX();
  return batch.plan().scene().space == Space::planar ? std::atan2(x.y(), x.x())
                                                     : std::atan2(-x.z(), x.x());
}

std::vector<double> controls_of(const Batch& batch) {
  std::vector<double> out;
  for (int w = 0; w < batch.worlds(); ++w)
    out.resize(out.size() + static_cast<std::size_t>(batch.controls(w)));
  batch.read_controls(out);
  return out;
}

}  // namespace

TEST_CASE("thrust and torque are what Newton and Euler say", "[fast][control]") {
  for (Space space : kSpaces) {
    Scene scene = free_body(space);
    scene.controls = {thrust(0, Vec3::Zero(), {0, 3, 0}), torque(0, {0, 0, 2})};
    scene.controls[0].initial = 4;
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table, 3));
      batch.set_controls(1, std::vector<double>{-10, 0});
      batch.set_controls(2, std::vector<double>{0, 0.5});
      batch.step(30);  // 0.5 s
      const double few = pick(table, 1e-5, 1e-12);
      CHECK((velocity(batch, 0, 0) - Vec3(0, 4.0 / 2 / 2, 0)).norm() < few);
      CHECK((velocity(batch, 1, 0) - Vec3(0, -10.0 / 2 / 2, 0)).norm() < few);
      CHECK(velocity(batch, 2, 0).norm() < few);
      CHECK((spin(batch, 2, 0) - Vec3(0, 0, 0.5 / 0.5 / 2)).norm() < few);
      CHECK(spin(batch, 1, 0).norm() < few);
    }
  }
}

TEST_CASE("thrust turns with its body and turns it", "[fast][control]") {
  // A constant force across a spinning body goes round in a circle: after a whole turn nothing is
  // left of it. One beside the centre of mass turns the body with its arm.
  for (Space space : kSpaces) {
    Scene scene = free_body(space);
    scene.options.dt = 1.0 / 240;
    scene.bodies[0].angular_velocity = Vec3(0, 0, 2 * 3.14159265358979);
    scene.controls = {thrust(0, Vec3::Zero(), {1, 0, 0}), thrust(0, {0, 0.25, 0}, {1, 0, 0})};
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table, 2));
      batch.set_controls(0, std::vector<double>{10, 0});
      batch.set_controls(1, std::vector<double>{0, 4});
      batch.step(120);  // half a turn: the integral of (cos, sin)(w t) F / m dt is (0, 2) F / (m w)
      CHECK((velocity(batch, 0, 0) - Vec3(0, 2 * 10 / (2 * 2 * 3.14159265), 0)).norm() < 0.03);
      batch.step(120);
      CHECK(velocity(batch, 0, 0).norm() < 1e-3);
      const double faster = spin(batch, 1, 0).z() - 2 * 3.14159265358979;
      CHECK(faster == Approx(-0.25 * 4 / 0.5).epsilon(1e-4));
    }
  }
}

TEST_CASE("every world has its own targets", "[fast][control][joint]") {
  for (Space space : kSpaces) {
    Scene motor = arm(space, {0, 1, std::nullopt, 50});
    motor.controls = {target(ControlKind::target_speed, 0)};
    motor.controls[0].initial = 2;
    Scene servo = arm(space, {0, 0, Spring{0, 0, 5, 1}, 1e3});
    servo.controls = {target(ControlKind::target_position, 0)};
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch turning(compile(motor), options_of(table, 3));
      turning.set_controls(1, std::vector<double>{-3});
      turning.step(60);
      const double expected[] = {2, -3, 2};
      for (int w = 0; w < 3; ++w) {
        const Vec3 w_arm = spin(turning, w, 0);
        const double about = space == Space::planar ? w_arm.z() : w_arm.y();
        CHECK(about == Approx(expected[w]).epsilon(1e-3));
      }
      Batch held(compile(servo), options_of(table, 3));
      held.set_controls(std::vector<float>{0.5f, -1.0f, 1.25f});
      held.step(240);
      CHECK(angle_of_arm(held, 0) == Approx(0.5).epsilon(1e-3));
      CHECK(angle_of_arm(held, 1) == Approx(-1).epsilon(1e-3));
      CHECK(angle_of_arm(held, 2) == Approx(1.25).epsilon(1e-3));
    }
  }
}

TEST_CASE("controls stay in their range, and reset gives them back", "[fast][control]") {
  Scene scene = free_body(Space::planar);
  scene.controls = {thrust(0, Vec3::Zero(), {0, 1, 0}), torque(0, {0, 0, 1})};
  scene.controls[0].low = -1, scene.controls[0].high = 3, scene.controls[0].initial = 0.5;
  Batch batch(compile(scene), options_of(widest_tables().front(), 2));
  CHECK(controls_of(batch) == std::vector<double>{0.5, 0, 0.5, 0});
  batch.set_controls(std::vector<double>{-7, 1e300, 9, -1e300});
  CHECK(controls_of(batch) == std::vector<double>{-1, 100, 3, -100});
  batch.reset(std::vector<std::uint8_t>{0, 1});
  CHECK(controls_of(batch) == std::vector<double>{-1, 100, 0.5, 0});
  batch.copy_world(0, 1);
  CHECK(controls_of(batch) == std::vector<double>{-1, 100, -1, 100});
  const Snapshot saved = batch.save();
  batch.reset();
  batch.restore(saved);
  CHECK(controls_of(batch) == std::vector<double>{-1, 100, -1, 100});
  CHECK_THROWS_AS(batch.set_controls(std::vector<double>(3)), std::invalid_argument);
  CHECK_THROWS_AS(batch.set_controls(0, std::vector<double>(3)), std::invalid_argument);
  CHECK_THROWS(batch.set_controls(2, std::vector<double>(2)));
}

TEST_CASE("a control that is no number freezes its world alone", "[fast][control]") {
  Scene scene = free_body(Space::spatial);
  scene.controls = {thrust(0, Vec3::Zero(), {0, 1, 0})};
  const Plan plan = compile(scene);
  for (const Table& table : widest_tables()) {
    Batch batch(plan, options_of(table, 3)), whole(plan, options_of(table, 3));
    batch.set_controls(std::vector<double>{1, kNan, 1});
    whole.set_controls(std::vector<double>{1, 1, 1});
    batch.step(5), whole.step(5);
    CHECK(batch.status(1) == Status::non_finite);
    CHECK(velocity(batch, 1, 0) == Vec3::Zero());
    for (int w : {0, 2}) {
      CHECK(batch.status(w) == Status::ok);
      CHECK(batch.hash(w) == whole.hash(w));
    }
  }
}

TEST_CASE("controlled worlds have their bits wherever they are computed", "[fast][control][bits]") {
  for (Space space : kSpaces) {
    Scene scene = arm(space, {0, 0, Spring{0, 0, 5, 0.5}, 100});
    scene.options.gravity = -9.81 * up_of(space);
    scene.add(ground(space));
    scene.controls = {target(ControlKind::target_position, 0), target(ControlKind::target_speed, 0),
                      thrust(0, {0.5, 0, 0}, {1, 2, 0}), torque(0, {0, 0, 1})};
    const Plan plan = compile(scene);
    const auto drive = [](Batch& batch, int steps) {
      for (int step = 0; step < steps; ++step) {
        for (int w = 0; w < batch.worlds(); ++w) {
          const double x = std::sin(0.1 * step + w);
          batch.set_controls(w, std::vector<double>{2 * x, x * x, 30 * x, -5 * x});
        }
        batch.step();
      }
    };
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (const int threads : {1, 3}) {
          INFO(name(table) << " threads " << threads);
          Batch batch(plan, options_of(table, 19, threads));
          drive(batch, 20);
          const Snapshot saved = batch.save();
          batch.step(20);
          const auto worlds = hashes(batch);
          if (reference.empty()) reference = worlds;
          CHECK(worlds == reference);
          CHECK(worlds[0] != worlds[1]);
          batch.restore(saved);
          batch.step(20);
          CHECK(batch.hash(5) == reference[5]);
        }
      }
    }
  }
}

TEST_CASE("what a control holds does not sleep, and a new control wakes",
          "[fast][control][sleep]") {
  Scene scene = free_body(Space::spatial);
  scene.options.gravity = {0, 0, -10};
  scene.add(ground(Space::spatial));
  scene.bodies[0].position = {0, 0, 0.5};
  scene.bodies[0].shapes[0].filter.mask = ~0u;
  scene.controls = {thrust(0, Vec3::Zero(), {0, 0, 1})};
  BatchOptions options = options_of(widest_tables().front(), 2);
  options.sleep = true;
  Batch batch(compile(scene), options);
  batch.set_controls(1, std::vector<double>{20});  // its weight
  batch.step(300);
  CHECK(batch.asleep(0));
  CHECK_FALSE(batch.asleep(1));
  batch.set_controls(0, std::vector<double>{30});
  CHECK_FALSE(batch.asleep(0));
  const double speed = velocity(batch, 0, 0).z();
  batch.step(30);
  CHECK(velocity(batch, 0, 0).z() - speed == Approx((30 - 20) / 2.0 * 0.5).epsilon(1e-3));
}

TEST_CASE("a scene tells what is wrong with its controls", "[fast][control][scene]") {
  Scene scene = arm(Space::planar, {0, 1, std::nullopt, 50});
  scene.add(ground(Space::planar));
  const auto issue = [&](const Control& control) {
    scene.controls = {control};
    const std::vector<Issue> issues = validate(scene);
    return issues.size() == 1 ? to_string(issues[0]) : std::to_string(issues.size()) + " issues";
  };
  CHECK(issue(target(ControlKind::target_speed, 0)) == "0 issues");
  CHECK(issue(target(ControlKind::target_speed, 1)) ==
        "control 0: joint is 1, must be a joint, 0 to 0");
  CHECK(issue(target(ControlKind::target_position, 0)) ==
        "control 0: joint is 0, must be a joint whose drive has a spring: a motor does not hold a "
        "position");
  CHECK(issue(thrust(1, Vec3::Zero(), {0, 1, 0})) ==
        "control 0: body is 1, must be a dynamic body");
  CHECK(issue(thrust(2, Vec3::Zero(), {0, 1, 0})) ==
        "control 0: body is 2, must be a body, 0 to 1");
  CHECK(issue(thrust(0, Vec3::Zero(), {0, 0, 0})) ==
        "control 0: direction is zero, must have a length");
  CHECK(issue(torque(0, {0, 1, 0})).find("control 0: direction") == 0);
  Control odd = torque(0, {0, 0, 1});
  odd.low = 1, odd.high = -1;
  CHECK(issue(odd) == "control 0: low is 1, must not be above high, which is -1");
  odd.high = kNan;
  CHECK(issue(odd) == "control 0: high is nan, must be finite");
  odd.high = 3;
  CHECK(issue(odd) == "control 0: initial is 0, must be between 1 and 3");
  odd.name = "jet";
  CHECK(issue(odd) == "control 0 'jet': initial is 0, must be between 1 and 3");
  scene.controls = {target(ControlKind::target_speed, 0), target(ControlKind::target_speed, 0)};
  REQUIRE(validate(scene).size() == 1);
  CHECK(to_string(validate(scene)[0]) ==
        "control 1: joint is 0, must be a joint whose target is not already control 0's");
  std::get<HingeJoint>(scene.joints[0].type).drive.reset();
  scene.controls.pop_back();
  REQUIRE(validate(scene).size() == 1);
  CHECK(to_string(validate(scene)[0]) == "control 0: joint is 0, must be a joint with a drive");
}

}  // namespace manyworlds::test
