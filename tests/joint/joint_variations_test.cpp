// Limits and drives of joints that differ from world to world.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

// A ball of 2 kg on a slider along x, which gravity pulls along.
Scene slider(double gravity, const SliderJoint& type) {
  Scene scene = empty_scene(Space::spatial, 0);
  scene.options.gravity = Vec3(gravity, 0, 0);
  scene.add(joint_at(scene, BodyId{}, add_ball(scene, Vec3::Zero(), 2), at(Vec3::Zero()), type));
  return scene;
}

std::vector<Variation> of_all_joints(bool springs) {
  std::vector<Variation> out = {vary(Parameter::limit_low, -0.3, -0.05),
                                vary(Parameter::limit_high, 0.05, 0.3),
                                vary(Parameter::motor_speed, -2, 2),
                                vary(Parameter::motor_force, 10, 200, Draw::log_uniform)};
  if (!springs) return out;
  out.push_back(vary(Parameter::drive_stiffness, 100, 1000));
  out.push_back(vary(Parameter::drive_damping, 1, 30));
  return out;
}

}  // namespace

TEST_CASE("motors of worlds differ in force and speed", "[fast][joint][parameters]") {
  Scene scene = slider(0, {std::nullopt, Drive{0, 1, std::nullopt, 1}});
  scene.variations = {vary(Parameter::motor_speed, 0.5, 4), vary(Parameter::motor_force, 1, 8)};
  scene.options.dt = 0.01;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 33));
    batch.step(100);
    int held = 0;
    for (int w = 0; w < batch.worlds(); ++w) {
      const double speed = numbers(batch, Parameter::motor_speed, w)[0],
                   force = numbers(batch, Parameter::motor_force, w)[0];
      held += speed < force / 2;
      CHECK(velocity(batch, w, 0).x() == Approx(std::min(speed, force / 2)).epsilon(1e-4));
    }
    CHECK(held > 3);
    CHECK(held < 30);
  }
}

TEST_CASE("limits of worlds hold where they are", "[fast][joint][parameters]") {
  for (const double gravity : {-10.0, 10.0}) {
    Scene scene = slider(gravity, {Limit{-1, 1}, std::nullopt});
    scene.variations = {vary(Parameter::limit_low, -0.5, -0.1),
                        vary(Parameter::limit_high, 0.1, 0.5)};
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 33));
      batch.step(240);
      const auto end = gravity < 0 ? Parameter::limit_low : Parameter::limit_high;
      for (int w = 0; w < batch.worlds(); ++w) {
        CHECK(position(batch, w, 0).x() == approx(numbers(batch, end, w)[0], 2e-3));
      }
      // Written, they move what lies on them.
      std::vector<double> moved = {gravity < 0 ? -0.4 : 0.4};
      batch.write(end, 7, moved);
      batch.step(240);
      CHECK(position(batch, 7, 0).x() == approx(moved[0], 2e-3));
      moved[0] = gravity < 0 ? -0.6 : 0.6;
      CHECK_THROWS_AS(batch.write(end, 7, moved), std::invalid_argument);
    }
  }
}

TEST_CASE("springs of worlds give way by their own stiffness", "[fast][joint][parameters]") {
  const Spring spring{100, 40, 0, 0};
  Scene scene = slider(10, {std::nullopt, Drive{0, 0, spring}});
  scene.variations = {vary(Parameter::drive_stiffness, 50, 500, Draw::log_uniform),
                      vary(Parameter::drive_damping, 30, 60)};
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), options_of(table, 33));
    batch.step(1200);
    for (int w = 0; w < batch.worlds(); ++w) {
      const double stiffness = numbers(batch, Parameter::drive_stiffness, w)[0];
      CHECK(position(batch, w, 0).x() == Approx(2 * 10 / stiffness).epsilon(1e-3));
    }
  }
}

TEST_CASE("a world with joints of its own is one of the scene that has them, bit for bit",
          "[fast][joint][parameters][bits][one_thread]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    for (const bool trees : {false, true}) {
      Scene scene = trees ? joint_trees(space) : contraption(space);
      scene.variations = of_all_joints(trees);
      check_worlds_are_those_of_scenes(scene, trees ? "trees" : "", 9, 30);
    }
  }
}

TEST_CASE("joints of worlds have the same bits whatever the batch, threads and instruction set",
          "[fast][joint][parameters][bits]") {
  for (const bool trees : {false, true}) {
    Scene scene = trees ? joint_trees(Space::spatial) : contraption(Space::spatial);
    scene.variations = of_all_joints(trees);
    check_bits_of_varied_worlds(scene, Parameter::limit_low);
  }
}

TEST_CASE("what is wrong with limits and drives that vary is said", "[fast][scene][parameters]") {
  Scene scene = slider(0, {Limit{-1, 1}, Drive{0, 1, std::nullopt, 1}});
  const auto issue = [&](std::vector<Variation> variations) {
    scene.variations = std::move(variations);
    return only_issue(scene);
  };
  CHECK(issue({vary(Parameter::limit_low, -1, 0)}) == "0 issues");
  CHECK(issue({vary(Parameter::drive_stiffness, 1, 2)}) ==
        "variation 0: drive_stiffness matches nothing in this scene");
  Variation of_first = vary(Parameter::drive_damping, 1, 2);
  of_first.joint = JointId(0);
  CHECK(
      issue({of_first}) ==
      "variation 0: drive_damping cannot vary here, must belong to a hinge, slider or wheel whose "
      "drive has a spring of stiffness and damping");
  CHECK(issue({vary(Parameter::motor_force, -1, 2)}) == "variation 0: low is -1, must be >= 0");
  CHECK(issue({vary(Parameter::limit_low, -1, 0.5), vary(Parameter::limit_high, 0.25, 1)}) ==
        "variations at their lowest, limit_low at its highest: joint 0: limit is from 0.5 to 0.25, "
        "low must not be above high");
  std::get<SliderJoint>(scene.joints[0].type).limit->low = -std::numeric_limits<double>::infinity();
  CHECK(issue({vary(Parameter::limit_low, -1, 0)}) ==
        "variation 0: limit_low matches nothing in this scene");
  CHECK(issue({vary(Parameter::armature, 0, 1)}) ==
        "variation 0: parameter is armature, which varies per world only with the newton solver, "
        "not tgs-soft");
  scene.joints[0].type = SliderJoint{Limit{-1, 1}, std::nullopt};
  scene.options.solver.method = Solver::newton;
  CHECK(issue({vary(Parameter::limit_low, -1, 0)}) == "0 issues");
  CHECK(issue({vary(Parameter::motor_speed, -1, 0)}) ==
        "variation 0: parameter is motor_speed, which does not vary per world with the newton "
        "solver");
}

}  // namespace manyworlds::test
