// Limits, how soft limits and contacts are, gears and ranges of forces of Solver::newton that
// differ from world to world.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "src/plan/plan_data.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/scene_cases.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

constexpr double kGravity = 8, kImpedance = 0.5;

// Of a constant impedance, by its stiffness, 1/s^2: a mass that rests on it sinks in by
// (1 - d) g / stiffness.
Compliance direct(double stiffness) {
  return {.time_constant = -stiffness,
          .damping_ratio = -4 * std::sqrt(stiffness),
          .min_impedance = kImpedance,
          .max_impedance = kImpedance};
}
double depth(double stiffness) { return (1 - kImpedance) * kGravity / stiffness; }

// A box that slides along z against a limit on either side, under gravity or by a motor.
Scene slider(double gravity) {
  Scene scene = robot_scene(gravity);
  RobotBuilder build(scene);
  const BodyId box = build.body(Box{{0.1, 0.1, 0.1}}, {0, 0, 0});
  const JointId rail = build.slider({}, box, {0, 0, 0}, Vec3::UnitZ());
  scene.at(rail).type = SliderJoint{Limit{-1, 1, {}, direct(2000)}};
  scene.at(rail).dynamics = {};
  return scene;
}

Variation solref(Parameter parameter, double softest, double stiffest) {
  const double least = 4 * std::sqrt(softest), most = 4 * std::sqrt(stiffest);
  return vary_three(parameter, {-stiffest, -most, 0}, {-softest, -least, 0});
}

Scene varied_robot(Scene scene) {
  for (const Parameter end : {Parameter::limit_low, Parameter::limit_high}) {
    vary_around(scene, end, 0.3);
  }
  for (const Parameter p : {Parameter::limit_solref, Parameter::contact_solref, Parameter::gear}) {
    vary_by_share(scene, p, 0.4);
  }
  for (const Parameter p : {Parameter::limit_solimp, Parameter::contact_solimp}) {
    vary_by_share(scene, p, 0.04);
  }
  scene.variations.push_back(vary(Parameter::force_low, -3, -0.5));
  scene.variations.push_back(vary(Parameter::force_high, 0.5, 3));
  return scene;
}

// Three balls on arms: one whose limit acts in some worlds alone, one that always has one, one
// without.
Scene balls() {
  Scene scene = robot_scene(9.81);
  RobotBuilder build(scene);
  for (int i = 0; i < 3; ++i) {
    const BodyId arm = build.body(Capsule{0.04, 0.15}, {0.25, 1.0 * i, 1});
    scene.at(arm).shapes[0].filter.mask = 0;
    const JointId ball = build.ball({}, arm, {0, 1.0 * i, 1});
    if (i < 2) scene.at(ball).type = BallJoint{.limit = Limit{0, i == 0 ? 4 : 0.7}};
  }
  Variation seldom = vary(Parameter::limit_high, 0.4, 4),
            often = vary(Parameter::limit_high, 0.3, 1);
  seldom.joint = JointId(0), often.joint = JointId(1);
  scene.variations = {seldom, often, vary(Parameter::limit_solref, 0.02, 0.1)};
  scene.variations[2].low[1] = 0.5, scene.variations[2].high[1] = 1.5;
  return scene;
}

// Where something rests is as exact as Newton's last step: by default 1e-8 m.
constexpr double kExact = 1e-26;
double still(const Table& table) { return pick(table, 2e-6, 1e-9); }  // m

}  // namespace

TEST_CASE("robots of worlds rest on limits of their own, as deep as these are soft",
          "[fast][robots][parameters]") {
  for (const double gravity : {kGravity, -kGravity}) {
    Scene scene = slider(gravity);
    scene.options.solver.tolerance = kExact;
    scene.variations = {vary(Parameter::limit_low, -0.3, -0.1),
                        vary(Parameter::limit_high, 0.1, 0.3),
                        solref(Parameter::limit_solref, 500, 4000)};
    const bool down = gravity > 0;
    const Parameter end = down ? Parameter::limit_low : Parameter::limit_high;
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(compile(scene), options_of(table, 17));
      batch.step(1200);
      for (int w = 0; w < batch.worlds(); ++w) {
        const double stiffness = -numbers(batch, Parameter::limit_solref, w)[0],
                     at = numbers(batch, end, w)[0];
        const double expected = down ? at - depth(stiffness) : at + depth(stiffness);
        CHECK(position(batch, w, 0).z() == approx(expected, still(table)));
      }
      // Written, it moves what rests on it.
      const std::vector<double> moved = {down ? -0.2 : 0.2};
      batch.write(end, 5, moved);
      batch.step(1200);
      const double sunk = depth(-numbers(batch, Parameter::limit_solref, 5)[0]);
      CHECK(std::abs(position(batch, 5, 0).z()) == approx(0.2 + sunk, still(table)));
    }
  }
}

TEST_CASE("shapes of worlds rest as deep as their contacts are soft",
          "[fast][robots][parameters]") {
  Scene scene = robot_scene(kGravity);
  scene.add(ground(Space::spatial));
  SoftContact soft;
  soft.dimensions = 1, soft.priority = 1, soft.compliance = direct(2000);
  RobotBuilder(scene).body(Sphere{0.2}, {0, 0, 0.2}, soft);
  Variation own = solref(Parameter::contact_solref, 500, 4000);
  own.shape = ShapeId(BodyId(1), 0);
  scene.options.solver.tolerance = kExact;
  scene.variations = {own};
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(compile(scene), options_of(table, 17));
    batch.step(1200);
    for (int w = 0; w < batch.worlds(); ++w) {
      const double stiffness = -numbers(batch, Parameter::contact_solref, w)[2];
      CHECK(position(batch, w, 0).z() == approx(0.2 - depth(stiffness), still(table)));
    }
  }
}

TEST_CASE("motors of worlds have gears and ranges of their own", "[fast][robots][parameters]") {
  Scene scene = slider(0);
  scene.joints[0].type = SliderJoint{};
  RobotBuilder(scene).motor(JointId(0), 2);
  scene.controls[0].low = -10, scene.controls[0].high = 10;
  scene.variations = {vary(Parameter::gear, 1, 3), vary(Parameter::force_low, -5, -1),
                      vary(Parameter::force_high, 1, 5)};
  const double mass = mass_properties(scene, scene.bodies[0]).mass;
  for (const double control : {-10.0, 10.0}) {
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table, 17));
      for (int w = 0; w < batch.worlds(); ++w) batch.set_controls(w, std::vector<double>{control});
      batch.step(60);
      const Parameter end = control < 0 ? Parameter::force_low : Parameter::force_high;
      for (int w = 0; w < batch.worlds(); ++w) {
        const double force = numbers(batch, Parameter::gear, w)[0] * numbers(batch, end, w)[0];
        CHECK(velocity(batch, w, 0).z() ==
              Approx(force / mass * 60 * scene.options.dt).epsilon(pick(table, 1e-5, 1e-9)));
      }
    }
  }
}

TEST_CASE("a robot with softness of its own is one of the scene that has it, bit for bit",
          "[fast][robots][parameters][bits][one_thread]") {
  Scene round = lone_walker();
  round.options.solver.cone = FrictionCone::elliptic;
  round.options.integrator = Integrator::implicit_fast;
  check_worlds_are_those_of_scenes(varied_robot(lone_walker()), "pyramids", 9, 50);
  check_worlds_are_those_of_scenes(varied_robot(round), "round cones", 9, 50);
  check_worlds_are_those_of_scenes(varied_robot(robots()), "several robots", 5, 40);
  check_worlds_are_those_of_scenes(balls(), "balls", 9, 60);
}

TEST_CASE("softness of robots has the same bits whatever the batch and threads",
          "[fast][robots][parameters][bits]") {
  check_bits_of_varied_worlds(varied_robot(lone_walker()), Parameter::contact_solimp);
  check_bits_of_varied_worlds(balls(), Parameter::limit_solref);
}

TEST_CASE("softness that varies goes through snapshots and resets", "[fast][robots][parameters]") {
  const Plan plan = compile(varied_robot(lone_walker()));
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 5));
    const auto first = numbers(batch, Parameter::limit_solimp, 2);
    batch.step(40);
    const Snapshot saved = batch.save();
    batch.step(20);
    const auto then = hashes(batch);
    batch.reset(std::vector<std::uint8_t>(5, 1));  // the next episode
    CHECK(numbers(batch, Parameter::limit_solimp, 2) != first);
    batch.restore(saved);
    CHECK(numbers(batch, Parameter::limit_solimp, 2) == first);
    batch.step(20);
    CHECK(hashes(batch) == then);
  }
}

TEST_CASE("a plan has softness per world only of what varies", "[fast][robots][parameters]") {
  Scene scene = robots();
  const auto bytes = [&](const std::vector<Variation>& variations) {
    scene.variations = variations;
    return Batch(compile(scene), options_of(widest_tables().front(), 64)).bytes_per_world();
  };
  const std::size_t none = bytes({});
  const auto trees_with = [&](const std::vector<Variation>& variations) {
    scene.variations = variations;
    return compile(scene).data().trees;
  };
  const auto limits = trees_with({vary(Parameter::limit_high, 0.5, 1)}).limit_numbers.size();
  const std::size_t own = bytes({vary(Parameter::limit_high, 0.5, 1)}) - none;
  CHECK(own >= limits * 9 * sizeof(float));
  CHECK(own < limits * (9 * sizeof(float) + sizeof(double)) + 32);
  // Where nothing varies most pairs have one softness; else each two materials have.
  const PlanTrees alike = trees_with({});
  CHECK(alike.compliances.size() < 6);
  CHECK(alike.mixed.empty());
  const PlanTrees various = trees_with({solref(Parameter::contact_solref, 500, 4000)});
  CHECK(various.compliances.size() == various.mixed.size());
  CHECK(various.mixed.size() > 20);
}

TEST_CASE("what is wrong with softness and gears that vary is said", "[fast][scene][parameters]") {
  Scene scene = slider(kGravity);
  RobotBuilder(scene).motor(JointId(0), 2);
  const auto issue = [&](std::vector<Variation> variations) {
    scene.variations = std::move(variations);
    return only_issue(scene);
  };
  CHECK(issue({solref(Parameter::limit_solref, 500, 1000), vary(Parameter::gear, -1, 1)}) ==
        "0 issues");
  CHECK(issue({vary_three(Parameter::limit_solref, {-100, -10, 0}, {0.02, -5, 0})}) ==
        "variation 0: low[0] is -100 and high[0] 0.02, both must be > 0 (time constant, damping "
        "ratio) or neither (-stiffness, -damping)");
  CHECK(issue({vary_three(Parameter::contact_solimp, {0.5, 0.9, 0}, {0.9, 1.5, 0})}) ==
        "variation 0: high[1] is 1.5, must be between 0 and 1");
  CHECK(issue({vary_three(Parameter::limit_solimp, {0.5, 0.9, -1}, {0.9, 0.9, 0})}) ==
        "variation 0: low[2] is -1, must be >= 0");
  CHECK(issue({vary(Parameter::force_low, -3, 2), vary(Parameter::force_high, 1, 5)}) ==
        "variations at their lowest, force_low at its highest: control 0: actuator.low is 2, must "
        "not be above high, which is 1");
  CHECK(issue({vary(Parameter::limit_high, -2, 1)}) ==
        "variations at their lowest: joint 0: limit is from -1 to -2, low must not be above high");
  scene.joints[0].type = SliderJoint{};
  CHECK(issue({solref(Parameter::limit_solref, 500, 1000)}) ==
        "variation 0: limit_solref matches nothing in this scene");
  Variation of_first = vary(Parameter::limit_solimp, 0, 0);
  of_first.joint = JointId(0);
  CHECK(issue({of_first}) ==
        "variation 0: limit_solimp cannot vary here, must belong to a hinge, slider or ball joint "
        "with a finite limit");
  scene.options.solver.method = Solver::tgs_soft;
  scene.joints.clear(), scene.controls.clear();
  CHECK(issue({vary_three(Parameter::contact_solref, {0.01, 1, 0}, {0.02, 1, 0})}) ==
        "variation 0: parameter is contact_solref, which varies per world only with the newton "
        "solver, not tgs-soft");
}

}  // namespace manyworlds::test
