// Frames of joints and what joints bear that differ from world to world.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

constexpr double kFrameGravity = 10;

Scene hanging_frame(Space space, double mass) {
  Scene scene = empty_scene(space, kFrameGravity);
  scene.add(lump(space, mass, {0.2, 0.2, 0.2}, -up_of(space)));
  Joint joint = joint_at(scene, {}, BodyId(0), at(Vec3::Zero(), hinge_axes(space)), HingeJoint{});
  joint.break_force = 100;
  scene.add(joint);
  return scene;
}

// What trees close within a step is not what they close in a while, which a plan knows: so far
// apart bring no world's joints.
void vary_joints(Scene& scene) {
  scene.variations = {vary(Parameter::break_force, 100, 1e4, Draw::log_uniform),
                      vary(Parameter::break_torque, 100, 1e4, Draw::log_uniform)};
  for (const Parameter anchor : {Parameter::anchor_a, Parameter::anchor_b}) {
    vary_around(scene, anchor, 5e-4);
  }
  for (const Parameter axes : {Parameter::axes_a, Parameter::axes_b}) {
    vary_around(scene, axes, 5e-3);
  }
  vary_around(scene, Parameter::initial_position, 5e-4);
  vary_around(scene, Parameter::initial_rotation, 1e-3);
}

}  // namespace

TEST_CASE("joints of worlds break under loads of their own", "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = hanging_frame(space, 2);
    scene.variations = {vary(Parameter::break_force, 10, 30)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 33));
      batch.step(120);
      int held = 0;
      for (int w = 0; w < batch.worlds(); ++w) {
        const double most = numbers(batch, Parameter::break_force, w)[0];
        if (std::abs(most - 2 * kFrameGravity) < 0.2) continue;
        CHECK(batch.joint_enabled(w, JointId(0)) == (most > 2 * kFrameGravity));
        held += batch.joint_enabled(w, JointId(0));
      }
      CHECK(held > 3);
      CHECK(held < 30);
      // Written, it counts from the next step.
      batch.reset();
      for (int w = 0; w < batch.worlds(); ++w) {
        const std::vector<double> most = {w % 2 == 0 ? 19.0 : 21.0};
        batch.write(Parameter::break_force, w, most);
      }
      batch.step(120);
      for (int w = 0; w < batch.worlds(); ++w) {
        CHECK(batch.joint_enabled(w, JointId(0)) == (w % 2 != 0));
      }
    }
  }
}

TEST_CASE("welds of worlds break under torques of their own", "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    // 3 kg whose centre is 0.5 m out: 15 N m, and a third more while it settles.
    Scene scene = empty_scene(space, kFrameGravity);
    scene.add(uniform_rod(space, 3, 1, {0.5, 0, 0}));
    Joint weld = joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), FixedJoint{});
    weld.break_torque = 30;
    scene.add(weld);
    scene.variations = {vary(Parameter::break_torque, 10, 30)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 33));
      batch.step(120);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double most = numbers(batch, Parameter::break_torque, w)[0];
        if (most > 14.7 && most < 22) continue;
        CHECK(batch.joint_enabled(w, JointId(0)) == (most > 15));
      }
    }
  }
}

TEST_CASE("a slider of axes of its own lets its body fall along them",
          "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.options.gravity = Vec3(kFrameGravity, 0, 0);
    scene.add(lump(space, 2, {0.2, 0.2, 0.2}, Vec3::Zero()));
    scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), SliderJoint{}));
    const Vec3 most = Vec3(0, 0, 1.5);
    scene.variations = {vary_three(Parameter::axes_a, -most, most, Draw::none),
                        vary_three(Parameter::axes_b, -most, most, Draw::none)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      const auto angle_of = [](int w) { return 0.15 * (w - 8); };
      for (int w = 0; w < batch.worlds(); ++w) {
        const std::vector<double> axes = {0, 0, angle_of(w)};
        batch.write(Parameter::axes_a, w, axes);
        batch.write(Parameter::axes_b, w, axes);
        CHECK(numbers(batch, Parameter::axes_a, w) == axes);
      }
      batch.step(60);
      const double time = 60 * scene.options.dt;
      for (int w = 0; w < batch.worlds(); ++w) {
        const double angle = angle_of(w), speed = kFrameGravity * std::cos(angle) * time;
        const Vec3 expected = speed * Vec3(std::cos(angle), std::sin(angle), 0);
        CHECK((velocity(batch, w, 0) - expected).norm() < 1e-3 * kFrameGravity);
      }
    }
  }
}

TEST_CASE("anchors of worlds are where bodies are drawn to", "[fast][joint][parameters]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 0);
    scene.add(lump(space, 2, {0.2, 0.2, 0.2}, Vec3::Zero()));
    Joint target = joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), TargetJoint{{0, 0, 2, 1}});
    scene.add(target);
    const Vec3 reach = space == Space::planar ? Vec3(1, 2, 0) : Vec3(1, 2, 0.5);
    scene.variations = {vary_three(Parameter::anchor_a, -reach, reach)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(300);
      for (int w = 0; w < batch.worlds(); ++w) {
        const auto own = numbers(batch, Parameter::anchor_a, w);
        CHECK((position(batch, w, 0) - Vec3(own[0], own[1], own[2])).norm() < 1e-3);
      }
      // A rope without a length is as long as the bodies begin apart, in every world.
      Scene rope = scene;
      rope.joints[0].type = DistanceJoint{};
      rope.options.gravity = -kFrameGravity * up_of(space);
      rope.variations[0].low = reach / 2;
      Batch ropes(compile(rope), options_of(table, 17));
      ropes.step(120);
      for (int w = 0; w < ropes.worlds(); ++w) {
        const auto own = numbers(ropes, Parameter::anchor_a, w);
        const Vec3 anchor(own[0], own[1], own[2]);
        CHECK((position(ropes, w, 0) - anchor).norm() == approx(anchor.norm(), 2e-3));
      }
    }
  }
}

TEST_CASE("a world with frames and loads of its own is one of the scene that has them, bit for bit",
          "[fast][joint][parameters][bits][one_thread]") {
  for (const Space space : kSpaces) {
    for (const bool trees : {false, true}) {
      Scene scene = trees ? joint_trees(space) : contraption(space);
      vary_joints(scene);
      check_worlds_are_those_of_scenes(scene, trees ? "trees" : "", 9, 30);
    }
  }
}

TEST_CASE("frames and loads of worlds have the same bits whatever the batch and threads",
          "[fast][joint][parameters][bits]") {
  for (const bool trees : {false, true}) {
    Scene scene = trees ? joint_trees(Space::spatial) : contraption(Space::spatial);
    vary_joints(scene);
    check_bits_of_varied_worlds(scene, Parameter::axes_a);
  }
}

TEST_CASE("what is wrong with frames and loads that vary is said", "[fast][scene][parameters]") {
  Scene scene = hanging_frame(Space::planar, 2);
  const auto issue = [&](std::vector<Variation> variations) {
    scene.variations = std::move(variations);
    return only_issue(scene);
  };
  CHECK(issue({vary(Parameter::break_force, 10, 20),
               vary_three(Parameter::axes_b, Vec3(0, 0, -0.1), Vec3(0, 0, 0.1)),
               vary_three(Parameter::anchor_a, Vec3(0, -0.1, 0), Vec3(0.1, 0, 0))}) == "0 issues");
  CHECK(issue({vary(Parameter::break_force, 0, 20)}) == "variation 0: low is 0, must be > 0");
  CHECK(issue({vary(Parameter::break_torque, 1, 20)}) ==
        "variation 0: break_torque matches nothing in this scene");
  Variation of_first = vary(Parameter::break_torque, 1, 20);
  of_first.joint = JointId(0);
  CHECK(issue({of_first}) ==
        "variation 0: break_torque cannot vary here, must belong to a joint with such a load, "
        "which is finite");
  CHECK(issue({vary_three(Parameter::anchor_b, Vec3(0, 1, -1), Vec3(0, 1, 1))}) ==
        "variation 0: high[2] must be 0 in a planar scene, as low[2]");
  CHECK(issue({vary_three(Parameter::axes_a, Vec3(0.1, 0, 0), Vec3(0.2, 0, 0))}) ==
        "variation 0: high[0] must be 0 in a planar scene, as low[0]");
  CHECK(issue({vary_three(Parameter::axes_a, Vec3(0, 0, 0.5), Vec3(0, 0, 0.2))}) ==
        "variation 0: low[2] is 0.5, must be at most high[2], which is 0.2");
  scene.joints[0].type = DistanceJoint{};
  CHECK(issue({vary_three(Parameter::axes_a, Vec3::Zero(), Vec3::Zero())}) ==
        "variation 0: axes_a matches nothing in this scene");
  scene.joints[0].type = HingeJoint{};
  scene.joints[0].break_force = std::numeric_limits<double>::infinity();
  scene.options.solver.method = Solver::newton;
  scene.variations = {vary_three(Parameter::anchor_a, Vec3::Zero(), Vec3::Zero())};
  const std::vector<Issue> issues = validate(scene);
  CHECK(std::any_of(issues.begin(), issues.end(), [](const Issue& i) {
    return to_string(i) ==
           "variation 0: parameter is anchor_a, which does not vary per world with the newton "
           "solver";
  }));
}

}  // namespace manyworlds::test
