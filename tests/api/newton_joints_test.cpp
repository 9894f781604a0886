// What observers tell of joints of Solver::newton: coordinates and speeds, and what the joints
// carry, from statics and Newton.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include "tests/support/approx.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/observed.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

const std::vector<Observer> kLoads = {Observer::joints, Observer::joint_loads, Observer::contacts};

Vec3 of_joint(const Batch& batch, Observed what, JointId joint) {
  const Numbers v = numbers(batch, what);
  const auto i = static_cast<std::size_t>(3 * joint.index());
  return {v[i], v[i + 1], v[i + 2]};
}
Vec3 force_on_b(const Batch& batch, JointId joint = JointId(0)) {
  return of_joint(batch, Observed::joint_force, joint);
}
Vec3 torque_on_b(const Batch& batch, JointId joint = JointId(0)) {
  return of_joint(batch, Observed::joint_torque, joint);
}

}  // namespace

TEST_CASE("a pendulum in joint coordinates tells what its hinge carries", "[fast][newton][joint]") {
  const double weight = kMass * 10;
  for (const Integrator integrator :
       {Integrator::symplectic_euler, Integrator::implicit_fast, Integrator::runge_kutta4}) {
    Scene scene = newton_pendulum();
    scene.options.integrator = integrator, scene.options.substeps = 2;
    scene.options.dt = 1e-4;
    for (const Table& table : all_tables()) {
      INFO(name(table) << ", " << to_string(integrator));
      const double slack = pick(table, 1e-3, 1e-5) * weight;
      Batch batch(compile(scene), observing(table, kLoads));
      put_angle(batch, kPi / 2);  // hanging at rest
      batch.step(3);
      CHECK((force_on_b(batch) - Vec3(0, 0, weight)).norm() < slack);
      CHECK(torque_on_b(batch).norm() < slack);
      // Level, it begins to fall with m g l / I about the hinge.
      put_angle(batch, 0);
      batch.step();
      const double turn = weight * kLength / kAboutHinge;
      CHECK((force_on_b(batch) - Vec3(0, 0, weight - kMass * kLength * turn)).norm() < slack);
      CHECK(torque_on_b(batch).norm() < slack);
      // It turns at the bottom: the hinge pulls it to its axis.
      put_angle(batch, kPi / 2, 3);
      batch.step();
      const double pull = weight + kMass * kLength * 9;
      CHECK(force_on_b(batch).norm() == approx(pull, 2 * slack));
      CHECK(std::abs(force_on_b(batch).x()) < 4e-4 * pull);  // it has gone on by so much
      // What pushes from outside is not the hinge's.
      put_angle(batch, kPi / 2);
      batch.add_force(0, BodyId(0), Vec3(0, 7, -5));
      batch.step();
      CHECK((force_on_b(batch) - Vec3(0, -7, weight + 5)).norm() < slack);
      CHECK((torque_on_b(batch) - Vec3(-7 * kLength, 0, 0)).norm() < slack);
      batch.look();  // without a step
      CHECK(force_on_b(batch).norm() == 0);
    }
  }
}

TEST_CASE("joints in series and fixed ones carry what hangs on them", "[fast][newton][joint]") {
  // A body on two hinges in series, 0.5 m apart, and one fixed to it, all level and held by motors.
  Scene scene = newton_scene();
  const BodyId arm = scene.add(lump(Space::spatial, 2, {0.1, 0.2, 0.3}, {1, 0, 0})),
               tip = scene.add(lump(Space::spatial, 1, {0.1, 0.2, 0.3}, {2, 0, 0}));
  const Quat about_y = z_to_y();
  const JointId first =
      scene.add(joint_at(scene, {}, arm, at(Vec3::Zero(), about_y), HingeJoint{}));
  Joint second = joint_at(scene, {}, arm, at({0.5, 0, 0}, about_y), HingeJoint{});
  second.after = first;
  second.frame_a = second.frame_b;  // of what the first one moves
  const JointId elbow = scene.add(second);
  const JointId weld = scene.add(joint_at(scene, arm, tip, at({1.5, 0, 0}), FixedJoint{}));
  // Torques that hold it: weights times their levers.
  for (const JointId joint : {first, elbow}) {
    Control motor;
    motor.kind = ControlKind::joint_force, motor.joint = joint;
    motor.initial = joint == first ? -(20.0 * 1 + 10.0 * 2) : -(20.0 * 0.5 + 10.0 * 1.5);
    motor.low = -100, motor.high = 100;
    scene.add(motor);
  }
  for (const Table& table : all_tables()) {
    INFO(name(table));
    const double slack = pick(table, 1e-3, 1e-9);
    Batch batch(compile(scene), observing(table, kLoads));
    batch.step();
    for (const double speed : of(batch, Field::generalized_velocity)) {
      CHECK(speed == Approx(0).margin(pick(table, 1e-5, 1e-12)));
    }
    CHECK((force_on_b(batch, first) - Vec3(0, 0, 30)).norm() < slack);
    CHECK((force_on_b(batch, elbow) - Vec3(0, 0, 30)).norm() < slack);
    CHECK((force_on_b(batch, weld) - Vec3(0, 0, 10)).norm() < slack);
    CHECK((torque_on_b(batch, first) - Vec3(0, -40, 0)).norm() < slack);
    CHECK((torque_on_b(batch, elbow) - Vec3(0, -25, 0)).norm() < slack);
    CHECK((torque_on_b(batch, weld) - Vec3(0, -5, 0)).norm() < slack);
  }
}

TEST_CASE("springs, dampers, limits and motors act within their joint, rotors in front of it",
          "[fast][newton][joint]") {
  const auto torque = [](const Scene& scene, const Table& table, double q, double v) {
    Batch batch(compile(scene), observing(table, kLoads));
    put_angle(batch, q, v);
    batch.step();
    // Of the step itself, dampers as it took them.
    const double turn = (of(batch, Field::generalized_velocity)[0] - v) / scene.options.dt;
    return std::pair(torque_on_b(batch).y(), turn);
  };
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    const double slack = pick(table, 2e-2, 1e-9);
    Scene scene = newton_pendulum(0);
    Joint& joint = scene.joints[0];
    joint.dynamics.stiffness = 30, joint.dynamics.damping = 4;
    auto [sprung, turned] = torque(scene, table, 0.4, 2);
    CHECK(sprung == approx(kAboutHinge * turned, slack));
    CHECK(sprung == approx(-30 * 0.4 - 4 * (2 + turned * scene.options.dt), slack));
    joint.dynamics = {};
    std::get<HingeJoint>(joint.type).limit = Limit{-0.1, 0.1};
    std::tie(sprung, turned) = torque(scene, table, 0.15, 1);
    CHECK(turned < -1);
    CHECK(sprung == approx(kAboutHinge * turned, slack));
    std::get<HingeJoint>(joint.type).limit.reset();
    joint.dynamics.armature = 3;
    Control motor;
    motor.kind = ControlKind::joint_force, motor.joint = JointId(0), motor.initial = 1;
    motor.actuator.gear = 5;
    scene.add(motor);
    std::tie(sprung, turned) = torque(scene, table, 0, 0);
    CHECK(turned == Approx(5 / (kAboutHinge + 3)).epsilon(1e-4));
    CHECK(sprung == approx(5 - 3 * turned, slack));
  }
}

TEST_CASE("what contacts carry, joints do not", "[fast][newton][joint]") {
  // A rod on a hinge that lies on a ground with its far end.
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::runge_kutta4}) {
    Scene scene = newton_scene();
    scene.options.integrator = integrator;
    scene.options.dt = 0.005;
    scene.add(ground(Space::spatial, 0.5));
    Body rod = body_of(shape_of(Sphere{0.1}, 0.5), Vec3(0.5, 0, 0.1));
    rod.shapes[0].position = {0.5, 0, 0};
    rod.mass_properties = MassProperties{2, Vec3::Zero(), Vec3(0.01, 0.2, 0.2).asDiagonal()};
    scene.add(rod);
    const BodyId body(1);
    scene.add(joint_at(scene, {}, body, at({0, 0, 0.1}, z_to_y()), HingeJoint{}));
    scene.joints[0].dynamics.damping = 0.5;
    for (const Table& table : widest_tables()) {
      INFO(name(table) << ", " << to_string(integrator));
      Batch batch(compile(scene), observing(table, kLoads));
      batch.step(1000);
      const auto contacts = batch.step_contacts(0);
      REQUIRE(contacts.size() == 1);
      const double push = contacts[0].normal_impulse / scene.options.dt;
      CHECK(push == Approx(10).epsilon(0.02));  // half of its weight
      CHECK((force_on_b(batch) + push * Vec3::UnitZ() - 20 * Vec3::UnitZ()).norm() < 0.02);
      CHECK(std::abs(torque_on_b(batch).y()) < 0.02);
    }
  }
}

TEST_CASE("joints in joint coordinates tell where they are, in their order",
          "[fast][newton][joint]") {
  Scene scene = newton_robot();
  scene.bodies[1].jitter = {};
  scene.joints[0].dynamics.reference = 0.5;
  const Plan plan = compile(scene);
  CHECK(plan.coordinates() == 3);  // a hinge, and cone and twist of a ball
  CHECK(plan.first_observed(JointId(0)) == 0);
  CHECK(plan.first_observed(JointId(1)) == 1);
  CHECK(plan.first_coordinate(JointId(0)) == 7);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    const double slack = pick(table, 1e-5, 1e-12);
    Batch batch(plan, observing(table, kLoads));
    batch.look();
    CHECK(numbers(batch, Observed::joint_position)[0] == approx(0.5, slack));
    Numbers q = of(batch, Field::generalized_position), v = of(batch, Field::generalized_velocity);
    const Quat lean(Eigen::AngleAxisd(0.7, Vec3(0.6, 0.8, 0)));
    const Quat hand = lean * Eigen::AngleAxisd(-0.4, Vec3::UnitZ());
    q[7] = 9, v[6] = -2;  // more than a turn
    q[8] = hand.w(), q[9] = hand.x(), q[10] = hand.y(), q[11] = hand.z();
    // About the hand's axes: a turn about its z twists, one about the axis that it leans about
    // leans.
    const Vec3 spin = hand.conjugate() * Vec3(0.6, 0.8, 0) * 1.5;
    for (int c = 0; c < 3; ++c) v[static_cast<std::size_t>(7 + c)] = spin[c];
    put(batch, Field::generalized_position, q), put(batch, Field::generalized_velocity, v);
    batch.look();
    const Numbers place = numbers(batch, Observed::joint_position),
                  speed = numbers(batch, Observed::joint_speed);
    CHECK(place[0] == approx(9, slack));
    CHECK(place[1] == approx(0.7, slack));
    CHECK(place[2] == approx(-0.4, slack));
    CHECK(speed[0] == approx(-2, slack));
    CHECK(speed[1] == approx(1.5, slack));
    CHECK(speed[2] == Approx(0).margin(slack));
  }
}

TEST_CASE("cone and twist of a ball change by their speeds", "[fast][newton][joint]") {
  Scene scene = newton_scene(0);
  scene.options.dt = 1e-5;
  scene.add(lump(Space::spatial, 1, Vec3::Constant(0.1), {0, 0, 1}));
  const Quat frame(Eigen::AngleAxisd(0.4, Vec3(1, 2, -1).normalized()));
  scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), frame), BallJoint{}));
  const Quat turned(Eigen::AngleAxisd(0.9, Vec3(1, -0.5, 0.3).normalized()));
  for (const Table& table : widest_tables()) {
    if (table.precision != Precision::f64) continue;
    Batch batch(compile(scene), observing(table, kLoads));
    put(batch, Field::generalized_position, {turned.w(), turned.x(), turned.y(), turned.z()});
    put(batch, Field::generalized_velocity, {1, -2, 0.7});
    batch.look();
    const Numbers before = numbers(batch, Observed::joint_position),
                  speed = numbers(batch, Observed::joint_speed);
    batch.step();
    const Numbers after = numbers(batch, Observed::joint_position);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK((after[i] - before[i]) / 1e-5 == Approx(speed[i]).epsilon(1e-3));
    }
  }
}

TEST_CASE("what is observed of joints has the bits of its world, and changes none of it",
          "[fast][newton][bits]") {
  constexpr int kWorlds = 21;
  Scene scene = newton_robot();
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::runge_kutta4}) {
    scene.options.integrator = integrator;
    const Plan plan = compile(scene);
    Numbers first[2];  // by precision
    for (const Table& table : all_tables()) {
      INFO(name(table) << ", " << to_string(integrator));
      Batch plain(plan, options_of(table, kWorlds)), seen(plan, observing(table, kLoads, kWorlds));
      plain.step(60);
      seen.step(40);
      for (int i = 0; i < 20; ++i) seen.step();
      for (int w = 0; w < kWorlds; ++w) CHECK(plain.hash(w) == seen.hash(w));
      Numbers all(seen.size(Observed::joint_force) + seen.size(Observed::joint_torque));
      seen.read(Observed::joint_force, std::span(all).first(seen.size(Observed::joint_force)));
      seen.read(Observed::joint_torque, std::span(all).subspan(seen.size(Observed::joint_force)));
      Numbers& other = first[table.precision == Precision::f32 ? 0 : 1];
      if (other.empty()) other = all;
      CHECK(std::memcmp(all.data(), other.data(), all.size() * sizeof(double)) == 0);
      CHECK(force_on_b(seen).norm() > 0);
      // In another lane, with others beside it.
      const Snapshot saved = seen.save();
      Batch one(plan, observing(table, kLoads));
      seen.step(3);
      for (const int world : {0, 7, kWorlds - 1}) {
        one.restore(saved, world, 0);
        one.step(3);
        for (const Observed what : {Observed::joint_position, Observed::joint_speed,
                                    Observed::joint_force, Observed::joint_torque}) {
          CHECK(numbers(one, what) == numbers(seen, what, world));
        }
      }
    }
  }
}

}  // namespace manyworlds::test
