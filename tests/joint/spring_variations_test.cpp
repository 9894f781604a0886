// Springs, lengths and targets of joints on bodies, and where controls act, that differ from world
// to world.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

constexpr double kSpringGravity = 10, kMass = 2;

// A ball 1 m under the origin, which a joint holds to it.
Scene hanging_spring(Space space, const JointType& type) {
  Scene scene = empty_scene(space, kSpringGravity);
  const BodyId ball = add_ball(scene, -up_of(space), kMass);
  Joint joint = joint_at(scene, {}, ball, at(Vec3::Zero()), type);
  joint.frame_b.position.setZero();
  scene.add(joint);
  return scene;
}
// A ball that slides along x, along which gravity pulls.
Scene sliding(const SliderJoint& type) {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.options.gravity = {kSpringGravity, 0, 0};
  scene.add(joint_at(scene, {}, add_ball(scene, Vec3::Zero(), kMass), at(Vec3::Zero()), type));
  return scene;
}

constexpr Parameter kShares[] = {Parameter::drive_stiffness,
                                 Parameter::drive_damping,
                                 Parameter::drive_frequency,
                                 Parameter::drive_damping_ratio,
                                 Parameter::limit_stiffness,
                                 Parameter::limit_damping,
                                 Parameter::limit_frequency,
                                 Parameter::limit_damping_ratio,
                                 Parameter::spring_stiffness,
                                 Parameter::spring_damping,
                                 Parameter::spring_frequency,
                                 Parameter::spring_damping_ratio,
                                 Parameter::cone,
                                 Parameter::pulley_ratio};

// With a spring of either kind in all places that have one.
Scene varied_joints(Space space, bool trees) {
  Scene scene = trees ? joint_trees(space) : contraption(space);
  for (Joint& joint : scene.joints) {
    const double here = 0.7;  // about as long as it begins
    if (auto* distance = std::get_if<DistanceJoint>(&joint.type)) distance->length = here;
    if (auto* pulley = std::get_if<PulleyJoint>(&joint.type)) pulley->length = 3 + 1.5 * 3;
  }
  for (const Parameter p : kShares) vary_by_share(scene, p, 0.3);
  vary_around(scene, Parameter::length, 0.05);
  vary_around(scene, Parameter::motor_position, 0.2);
  return scene;
}

Scene thrusters(Space space) {
  Scene scene = empty_scene(space, 0);
  for (int i = 0; i < 2; ++i) {
    scene.add(body_of(shape_of(box_of(space, {0.3, 0.2, 0.1})), Vec3(2.0 * i, 0, 0)));
    for (const ControlKind kind : {ControlKind::thrust, ControlKind::torque}) {
      Control control;
      control.kind = kind, control.body = BodyId(i), control.initial = 1 + i;
      control.direction = kind == ControlKind::torque ? Vec3(0, 0, 1) : Vec3(2, 1, 0);
      control.low = -5, control.high = 5;
      if (kind == ControlKind::thrust) control.point = {0.1, 0.05, 0};
      scene.add(control);
    }
  }
  vary_around(scene, Parameter::control_point, 0.05);
  vary_around(scene, Parameter::control_direction, 0.4);
  return scene;
}

}  // namespace

TEST_CASE("ropes of worlds are as long as their numbers say", "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = hanging_spring(space, DistanceJoint{1.0, {}, {}});
    scene.variations = {vary(Parameter::length, 0.9, 1.1)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(300);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double length = numbers(batch, Parameter::length, w)[0];
        CHECK(position(batch, w, 0).norm() == approx(length, 1e-3));
      }
    }
  }
}

TEST_CASE("springs of worlds give way by their own stiffness or frequency",
          "[fast][joint][parameters]") {
  for (const Table& table : widest_tables()) {
    for (const Space space : kSpaces) {
      Scene scene = hanging_spring(space, DistanceJoint{1.0, {}, Spring{200, 30, 0, 0}});
      scene.variations = {vary(Parameter::spring_stiffness, 100, 400),
                          vary(Parameter::spring_damping, 20, 40)};
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(1200);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double sag =
            kMass * kSpringGravity / numbers(batch, Parameter::spring_stiffness, w)[0];
        CHECK(position(batch, w, 0).norm() - 1 == Approx(sag).epsilon(2e-3));
      }
    }
    Scene drive = sliding({std::nullopt, Drive{0.1, 0, Spring{0, 0, 2, 1}}});
    drive.variations = {vary(Parameter::drive_frequency, 1, 3),
                        vary(Parameter::drive_damping_ratio, 0.7, 1.5),
                        vary(Parameter::motor_position, -0.2, 0.2)};
    Batch driven(compile(drive), options_of(table, 17));
    driven.step(1200);
    for (int w = 0; w < driven.worlds(); ++w) {
      const double rate = 2 * kPi * numbers(driven, Parameter::drive_frequency, w)[0],
                   target = numbers(driven, Parameter::motor_position, w)[0];
      CHECK(position(driven, w, 0).x() - target ==
            Approx(kSpringGravity / (rate * rate)).epsilon(2e-3));
    }
    Scene limit = sliding({Limit{-1, 0.2, Spring{500, 40, 0, 0}}, std::nullopt});
    limit.variations = {vary(Parameter::limit_stiffness, 200, 900)};
    Batch limited(compile(limit), options_of(table, 17));
    limited.step(1200);
    for (int w = 0; w < limited.worlds(); ++w) {
      const double stiffness = numbers(limited, Parameter::limit_stiffness, w)[0];
      CHECK(position(limited, w, 0).x() - 0.2 ==
            Approx(kMass * kSpringGravity / stiffness).epsilon(2e-3));
    }
  }
}

TEST_CASE("pulleys of worlds have ratios and ropes of their own", "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    const Vec3 up = up_of(space);
    Scene scene = empty_scene(space, kSpringGravity);
    Joint rope;
    rope.body_a = add_ball(scene, Vec3(-1, 0, 0), 1),
    rope.body_b = add_ball(scene, Vec3(1, 0, 0), 1);
    rope.type = PulleyJoint{Vec3(-1, 0, 0) + 2 * up, Vec3(1, 0, 0) + 2 * up, 1.5, 5.0};
    scene.add(rope);
    scene.variations = {vary(Parameter::pulley_ratio, 1.4, 1.6), vary(Parameter::length, 4.9, 5.1)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(40);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double of_a = (position(batch, w, 0) - (Vec3(-1, 0, 0) + 2 * up)).norm(),
                     of_b = (position(batch, w, 1) - (Vec3(1, 0, 0) + 2 * up)).norm();
        CHECK(of_a + numbers(batch, Parameter::pulley_ratio, w)[0] * of_b ==
              approx(numbers(batch, Parameter::length, w)[0], 5e-3));
      }
    }
  }
}

TEST_CASE("thrusts of worlds act along their own direction, where their number says",
          "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.add(lump(space, 2, Vec3::Constant(0.5), Vec3::Zero()));
    Control thrust;
    thrust.kind = ControlKind::thrust, thrust.body = BodyId(0), thrust.initial = 3, thrust.high = 3;
    scene.add(thrust);
    scene.variations = {vary_three(Parameter::control_direction, {0.5, -1, 0}, {1, 1, 0}),
                        vary_three(Parameter::control_point, {-0.5, 0, 0}, {0.5, 0, 0})};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(1);
      for (int w = 0; w < batch.worlds(); ++w) {
        const auto n = numbers(batch, Parameter::control_direction, w),
                   p = numbers(batch, Parameter::control_point, w);
        const Vec3 force = 3 * Vec3(n[0], n[1], n[2]).normalized();
        const Vec3 v = force / 2 * scene.options.dt;
        CHECK((velocity(batch, w, 0) - v).norm() < 2e-3 * v.norm());
        const double turn = Vec3(p[0], p[1], p[2]).cross(force).z() / 0.5 * scene.options.dt;
        CHECK(spin(batch, w, 0).z() == Approx(turn).epsilon(2e-3).margin(1e-6));
      }
    }
  }
}

TEST_CASE(
    "a world with springs and lengths of its own is one of the scene that has them, bit for bit",
    "[fast][joint][parameters][bits][one_thread]") {
  for (const Space space : kSpaces) {
    for (const bool trees : {false, true}) {
      check_worlds_are_those_of_scenes(varied_joints(space, trees), trees ? "trees" : "", 5, 30);
    }
    check_worlds_are_those_of_scenes(thrusters(space), "thrusters", 9, 30);
    // A force to the integrator, with dampers in some worlds.
    Scene free = hanging_spring(space, DistanceJoint{1.0, {}, Spring{200, 0, 0, 0}});
    free.options.integrator = Integrator::runge_kutta4;
    free.variations = {vary(Parameter::spring_stiffness, 100, 400),
                       vary(Parameter::spring_damping, 0, 5), vary(Parameter::length, 0.8, 1.2)};
    check_worlds_are_those_of_scenes(free, "free motion", 9, 30);
  }
}

TEST_CASE("springs and lengths of worlds have the same bits whatever the batch and threads",
          "[fast][joint][parameters][bits]") {
  for (const bool trees : {false, true}) {
    check_bits_of_varied_worlds(varied_joints(Space::spatial, trees), Parameter::length);
  }
  check_bits_of_varied_worlds(thrusters(Space::spatial), Parameter::control_direction);
}

TEST_CASE("every number of every scene is read, whatever its joints have", "[fast][parameters]") {
  std::vector<Scene> scenes = {robots()};
  for (const Space space : kSpaces) {
    scenes.push_back(contraption(space)), scenes.push_back(joint_trees(space));
  }
  for (const Scene& scene : scenes) {
    const Batch batch(compile(scene), {.worlds = 2, .threads = 1});
    for (int p = 0; p < kParameterCount; ++p) {
      const auto all = numbers(batch, static_cast<Parameter>(p), 1);
      CHECK(std::none_of(all.begin(), all.end(), [](double x) { return std::isnan(x); }));
    }
  }
}

TEST_CASE("what is wrong with springs and lengths that vary is said", "[fast][scene][parameters]") {
  Scene scene = hanging_spring(Space::planar, DistanceJoint{1.0, {}, Spring{200, 30, 0, 0}});
  const auto issue = [&](std::vector<Variation> variations) {
    scene.variations = std::move(variations);
    return only_issue(scene);
  };
  CHECK(issue({vary(Parameter::length, 0, 1), vary(Parameter::spring_damping, 0, 3)}) ==
        "0 issues");
  CHECK(issue({vary(Parameter::length, -1, 1)}) == "variation 0: low is -1, must be >= 0");
  CHECK(issue({vary(Parameter::spring_frequency, 1, 2)}) ==
        "variation 0: spring_frequency matches nothing in this scene");
  CHECK(
      issue({vary(Parameter::spring_stiffness, 0, 1), vary(Parameter::spring_damping, 0, 1)}) ==
      "variations at their lowest: joint 0: spring is zero, must have a stiffness, a damping or a "
      "frequency");
  scene.joints[0].type = DistanceJoint{{}, {}, Spring{0, 0, 2, 1}};
  CHECK(issue({vary(Parameter::spring_frequency, 0, 2)}) == "variation 0: low is 0, must be > 0");
  Variation of_first = vary(Parameter::length, 1, 2);
  of_first.joint = JointId(0);
  CHECK(issue({of_first}) ==
        "variation 0: length cannot vary here, must belong to a distance joint or pulley with a "
        "length");
  Control torque;
  torque.kind = ControlKind::torque, torque.body = BodyId(0), torque.direction = Vec3::UnitZ();
  scene.add(torque);
  CHECK(issue({vary_three(Parameter::control_direction, Vec3::Zero(), Vec3::Zero())}) ==
        "variation 0: control_direction matches nothing in this scene");
  scene.controls[0].kind = ControlKind::thrust, scene.controls[0].direction = Vec3::UnitX();
  CHECK(issue({vary_three(Parameter::control_point, {0, 0, -1}, {0, 0, 1})}) ==
        "variation 0: high[2] must be 0 in a planar scene, as low[2]");
}

}  // namespace manyworlds::test
