// What observers tell of joints: coordinates and speeds from geometry, forces and torques from
// statics and Newton.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/observed.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

const std::vector<Observer> kJoints = {Observer::joints, Observer::joint_loads};

// Of one joint, in space; torques of the plane are about z.
Vec3 force_on_second(const Batch& batch, std::size_t joint = 0) {
  const auto f = numbers(batch, Observed::joint_force);
  return batch.plan().scene().space == Space::planar
             ? Vec3(f[2 * joint], f[2 * joint + 1], 0)
             : Vec3(f[3 * joint], f[3 * joint + 1], f[3 * joint + 2]);
}
Vec3 torque_on_second(const Batch& batch, std::size_t joint = 0) {
  const auto l = numbers(batch, Observed::joint_torque);
  return batch.plan().scene().space == Space::planar
             ? Vec3(0, 0, l[joint])
             : Vec3(l[3 * joint], l[3 * joint + 1], l[3 * joint + 2]);
}
// The axis of a hinge with hinge_axes.
Vec3 axis_of(Space space) { return space == Space::planar ? Vec3::UnitZ() : Vec3::UnitY(); }

}  // namespace

TEST_CASE("a hinge tells its angle, its speed and what it carries", "[fast][observe][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(uniform_rod(space, 2, 1, {0.5, 0, 0}));
    HingeJoint hinge;
    hinge.drive = Drive{0.3, 0, Spring{0, 0, 8, 1}};
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), hinge));
    const Plan plan = compile(scene);
    CHECK(plan.coordinates() == 1);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, observing(table, kJoints));
      const Vec3 axis = axis_of(space);
      for (int i = 0; i < 5; ++i) {
        batch.step();
        const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
        const double angle = std::atan2(Vec3::UnitX().cross(along).dot(axis), along.x());
        CHECK(numbers(batch, Observed::joint_position)[0] ==
              approx(angle, pick(table, 1e-6, 1e-12)));
        CHECK(numbers(batch, Observed::joint_speed)[0] ==
              approx(spin(batch, 0, 0).dot(axis), pick(table, 1e-6, 1e-12)));
      }
      batch.step(600);  // at rest: the drive holds the rod's weight, the hinge carries it
      const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
      const Vec3 weight = -2 * 10 * up_of(space);
      CHECK((force_on_second(batch) + weight).norm() < 1e-3);
      CHECK((torque_on_second(batch) + (0.5 * along).cross(weight)).norm() < 1e-3);
      CHECK(std::abs(numbers(batch, Observed::joint_speed)[0]) < 1e-4);
    }
  }
}

TEST_CASE("a hinge that turns steadily pulls its body to its axis", "[fast][observe][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.options.dt = 1.0 / 240;
    scene.add(uniform_rod(space, 2, 1, {0.5, 0, 0}));
    HingeJoint hinge;
    hinge.drive = Drive{0, 3, std::nullopt, 1e3};
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), hinge));
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(plan, observing(table, kJoints));
      batch.step(480);  // 6 rad: within (-pi, pi] it is 6 - 2 pi
      CHECK(numbers(batch, Observed::joint_speed)[0] == Approx(3).epsilon(1e-3));
      CHECK(numbers(batch, Observed::joint_position)[0] == approx(6 - 2 * kPi, 0.02));
      const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
      CHECK((force_on_second(batch) + 2 * 9 * 0.5 * along).norm() < 0.1);
    }
  }
}

TEST_CASE("sliders, wheels, springs and ropes tell where they are", "[fast][observe][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    const Vec3 up = up_of(space);
    const Quat to_up = rotation_to(Vec3::UnitX(), up);
    const BodyId slider = add_ball(scene, Vec3::Zero());
    SliderJoint held;
    held.drive = Drive{0.5, 0, Spring{1000, 100, 0, 0}};
    scene.add(joint_at(scene, {}, slider, at(Vec3::Zero(), to_up), held));
    const BodyId wheel = add_ball(scene, {3, 0, 0}, 2);
    scene.add(joint_at(scene, {}, wheel, at({3, 0, 0}, to_up), WheelJoint{Spring{500, 100, 0, 0}}));
    const BodyId bob = add_ball(scene, Vec3(6, 0, 0) - 2 * up, 3);
    scene.add(joint_at(scene, {}, bob, at({6, 0, 0}), DistanceJoint{}));
    scene.joints.back().frame_b = {};
    std::get<DistanceJoint>(scene.joints.back().type).length = 2;
    const BodyId heavy = add_ball(scene, {9, 0, 0}, 2), light = add_ball(scene, {11, 0, 0}, 1);
    Joint rope;
    rope.type = PulleyJoint{Vec3(9, 0, 0) + 5 * up, Vec3(11, 0, 0) + 5 * up, 2, std::nullopt};
    rope.body_a = heavy, rope.body_b = light;
    scene.add(rope);
    const Plan plan = compile(scene);
    REQUIRE(plan.coordinates() == 5);
    CHECK(plan.first_coordinate(JointId(1)) == 1);
    CHECK(plan.first_coordinate(JointId(2)) == 3);
    CHECK(plan.first_coordinate(JointId(3)) == 4);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, observing(table, kJoints));
      batch.step(20);  // the rope's weights still fly
      const auto speed = numbers(batch, Observed::joint_speed);
      CHECK(speed[0] == approx(velocity(batch, 0, 0).dot(up), pick(table, 1e-6, 1e-12)));
      CHECK(speed[1] == approx(velocity(batch, 0, 1).dot(up), pick(table, 1e-6, 1e-12)));
      CHECK(speed[4] == Approx(0).margin(1e-3));
      CHECK(numbers(batch, Observed::joint_position)[4] == Approx(5 + 2 * 5).epsilon(1e-4));
      // x1 + 2 x2 is constant: T = 3 m1 m2 g / (4 m1 + m2), and B hangs on twice that.
      CHECK(force_on_second(batch, 3).dot(up) == Approx(2 * 3 * 2 * 1 * 10 / 9.0).epsilon(1e-3));
      batch.step(300);  // the others are at rest
      const auto place = numbers(batch, Observed::joint_position);
      CHECK(place[0] == Approx(0.5 - 10.0 / 1000).epsilon(1e-4));
      CHECK(place[1] == Approx(-20.0 / 500).epsilon(1e-4));
      CHECK(place[2] == Approx(0).margin(1e-5));
      CHECK(place[3] == Approx(2).epsilon(1e-4));
      CHECK(force_on_second(batch, 0).dot(up) == Approx(10).epsilon(1e-3));
      CHECK(force_on_second(batch, 1).dot(up) == Approx(20).epsilon(1e-3));
      CHECK(force_on_second(batch, 2).dot(up) == Approx(30).epsilon(1e-3));
      CHECK(torque_on_second(batch, 1).norm() < 1e-3);
    }
  }
}

TEST_CASE("a ball joint tells its cone and its twist", "[fast][observe][joint]") {
  Scene scene = empty_scene(Space::spatial, 0);
  const BodyId ball = add_ball(scene, {0, 0, -1});
  scene.add(joint_at(scene, {}, ball, at(Vec3::Zero()), BallJoint{}));
  scene.bodies[0].rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(0.6, 0.8, 0))) *
                             Quat(Eigen::AngleAxisd(-0.4, Vec3::UnitZ()));
  scene.bodies[0].position = scene.bodies[0].rotation * Vec3(0, 0, -1);
  for (const Table& table : all_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), observing(table, kJoints));
    batch.look();
    const auto angles = numbers(batch, Observed::joint_position);
    REQUIRE(angles.size() == 2);
    CHECK(angles[0] == approx(0.7, pick(table, 1e-5, 1e-10)));
    CHECK(angles[1] == approx(-0.4, pick(table, 1e-5, 1e-10)));
  }
}

TEST_CASE("cone and twist of a ball joint change by their speeds", "[fast][observe][joint]") {
  constexpr double kStep = 1e-5;
  Scene scene = empty_scene(Space::spatial, 0);
  scene.options.dt = kStep, scene.options.substeps = 1;
  const BodyId ball = add_ball(scene, Vec3::Zero());
  scene.add(joint_at(scene, {}, ball, at(Vec3::Zero()), BallJoint{}));
  scene.at(ball).angular_velocity = Vec3(1, -2, 0.7);
  for (const double cone : {0.3, 1.2, 2.6}) {
    scene.at(ball).rotation = Quat(Eigen::AngleAxisd(cone, Vec3(0.6, 0.8, 0))) *
                              Quat(Eigen::AngleAxisd(-0.4, Vec3::UnitZ()));
    if (!has_table(double_table())) return;
    Batch batch(compile(scene), observing(double_table(), kJoints));
    batch.look();
    const auto before = numbers(batch, Observed::joint_position),
               speed = numbers(batch, Observed::joint_speed);
    batch.step();
    const auto after = numbers(batch, Observed::joint_position);
    for (std::size_t i = 0; i < 2; ++i) {
      INFO("cone " << cone << (i == 0 ? ", of the cone" : ", of the twist"));
      CHECK((after[i] - before[i]) / kStep == Approx(speed[i]).epsilon(1e-3));
    }
  }
}

TEST_CASE("a fixed joint carries what hangs on it", "[fast][observe][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    scene.add(uniform_rod(space, 2, 1, {0.5, 0, 0}));
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), FixedJoint{}));
    const Plan plan = compile(scene);
    CHECK(plan.coordinates() == 0);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, observing(table, kJoints, 3));
      batch.step(300);
      const Vec3 weight = -2 * 10 * up_of(space);
      CHECK((force_on_second(batch) + weight).norm() < 1e-3);
      CHECK((torque_on_second(batch) + Vec3(0.5, 0, 0).cross(weight)).norm() < 2e-3);
      CHECK(numbers(batch, Observed::joint_position).empty());
      std::vector<float> all(batch.size(Observed::joint_force));
      batch.read(Observed::joint_force, all);
      CHECK(all.size() == 3 * (space == Space::planar ? 2u : 3u));
    }
  }
}

TEST_CASE("joints that nobody observes are not read", "[fast][observe][joint]") {
  Scene scene = empty_scene(Space::planar, 10);
  scene.add(uniform_rod(Space::planar, 2, 1, {0.5, 0, 0}));
  BatchOptions options = options_of(widest_tables().front());
  options.observe.what = {Observer::motion};
  Batch batch(compile(scene), options);
  std::vector<double> none;
  CHECK_THROWS_WITH(batch.read(Observed::joint_position, 0, none),
                    "joint_position is not observed: give Observer::joints in "
                    "BatchOptions::observe");
  options.observe.what = {Observer::joints};
  Batch seeing(compile(scene), options);
  seeing.step();
  CHECK_NOTHROW(seeing.read(Observed::joint_position, 0, none));
}

TEST_CASE("joints are seen at the state after a reset, without a step", "[fast][observe][joint]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::planar, 0);
    scene.add(uniform_rod(Space::planar, 1, 1, {0.5, 0, 0}));
    scene.bodies[0].angular_velocity.z() = 2;
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), HingeJoint{}));
    Batch batch(compile(scene), observing(table, kJoints, 2));
    batch.step(30);
    REQUIRE(numbers(batch, Observed::joint_position)[0] > 0.2);
    batch.reset(std::vector<std::uint8_t>{0, 1});
    batch.look();
    CHECK(numbers(batch, Observed::joint_position, 0)[0] > 0.2);
    CHECK(numbers(batch, Observed::joint_position, 1)[0] == Approx(0).margin(1e-6));
    CHECK(numbers(batch, Observed::joint_speed, 1)[0] == Approx(2));
  }
}

}  // namespace manyworlds::test
