// Issues of Scene::variations.
#include <catch2/catch.hpp>

#include <limits>

#include "manyworlds/plan.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/scene_cases.hpp"

namespace manyworlds::test {
namespace {

Scene scene_with(Variation variation) {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  scene.add(body_of(shape_of(Box{{0.5, 0.5, 0.5}}), Vec3(0, 0, 1)));
  Body given = body_of(shape_of(Sphere{0.5}), Vec3(0, 0, 3));
  given.mass_properties = MassProperties{};
  scene.add(given);
  scene.variations = {variation};
  return scene;
}

Variation of(Variation v, int body, int shape = -1) {
  v.body = BodyId(body);
  if (shape != -1) v.shape = ShapeId(BodyId(body), shape);
  return v;
}

}  // namespace

TEST_CASE("what a variation is about must be there and able to vary", "[fast][scene][parameters]") {
  CHECK(validate(scene_with(vary(Parameter::friction, 0, 1))).empty());
  CHECK(validate(scene_with(vary(Parameter::mass, 1, 2))).empty());
  CHECK(only_issue(scene_with(of(vary(Parameter::mass, 1, 2), 3))) ==
        "variation 0: body is 3, must be -1 or the index of one of 3");
  CHECK(only_issue(scene_with(of(vary(Parameter::friction, 0, 1), 1, 1))) ==
        "variation 0: shape is 1, must be -1 or the index of one of 1");
  CHECK(only_issue(scene_with(of(vary(Parameter::friction, 0, 1), -1, 0))) ==
        "variation 0: shape is 0, must be -1 where body is -1");
  CHECK(only_issue(scene_with(of(vary(Parameter::mass, 1, 2), 1, 0))) ==
        "variation 0: shape is 0, must be -1: mass belongs to the body");
  CHECK(only_issue(scene_with(of(vary(Parameter::gravity, 0, 0), 1))) ==
        "variation 0: body is 1, must be -1: gravity belongs to the world");
  CHECK(only_issue(scene_with(of(vary(Parameter::mass, 1, 2), 0))) ==
        "variation 0: mass cannot vary here, must belong to a dynamic body");
  CHECK(only_issue(scene_with(of(vary(Parameter::density, 1, 2), 2, 0))) ==
        "variation 0: density cannot vary here, must belong to a dynamic body whose mass is not "
        "given");
  CHECK(only_issue(scene_with(of(vary(Parameter::size, 1, 2), 0, 0))) ==
        "variation 0: size cannot vary here, must belong to a shape of a moving body with a size");
  Scene empty = empty_scene(Space::spatial);
  empty.add(ground(Space::spatial));
  empty.variations = {vary(Parameter::mass, 1, 2)};
  CHECK(only_issue(empty) == "variation 0: mass matches nothing in this scene");
}

namespace {

// A hinge with a motor, a position servo and a velocity servo, and a body that is welded on.
Scene robot_with(std::vector<Variation> variations) {
  Scene scene = newton_pendulum();
  scene.add(lump(Space::spatial, kMass, {0.1, kAcross, 0.3}, {kLength, 0, 0}));
  scene.add(joint_at(scene, BodyId(0), BodyId(1), at({kLength, 0, 0}), FixedJoint{}));
  const std::pair<Vec3, Vec3> actuators[] = {
      {{1, 0, 0}, Vec3::Zero()}, {{20, 0, 0}, {0, -20, -1}}, {{3, 0, 0}, {0, 0, -3}}};
  for (const auto& [gain, bias] : actuators) {
    Control control;
    control.kind = ControlKind::joint_force, control.joint = JointId(0);
    control.actuator.gain = gain, control.actuator.bias = bias;
    scene.add(control);
  }
  scene.variations = std::move(variations);
  return scene;
}
Variation of_joint(Variation v, int joint) {
  v.joint = JointId(joint);
  return v;
}
Variation of_control(Variation v, int control) {
  v.control = ControlId(control);
  return v;
}
std::string issue_of(const Variation& v) { return only_issue(robot_with({v})); }

}  // namespace

TEST_CASE("numbers of joints and controls vary where there are such", "[fast][scene][parameters]") {
  for (const Parameter p : {Parameter::armature, Parameter::damping, Parameter::stiffness,
                            Parameter::rest, Parameter::kp, Parameter::kv}) {
    CHECK(validate(robot_with({vary(p, 0.1, 1)})).empty());
  }
  CHECK(issue_of(of_joint(vary(Parameter::armature, 0, 1), 2)) ==
        "variation 0: joint is 2, must be -1 or the index of one of 2");
  CHECK(issue_of(of_control(vary(Parameter::gain, 0, 1), 3)) ==
        "variation 0: control is 3, must be -1 or the index of one of 3");
  CHECK(issue_of(of_joint(vary(Parameter::gain, 0, 1), 0)) ==
        "variation 0: joint is 0, must be -1: gain belongs to the control");
  CHECK(issue_of(of_control(vary(Parameter::rest, 0, 1), 0)) ==
        "variation 0: control is 0, must be -1: rest belongs to the joint");
  CHECK(issue_of(of(vary(Parameter::damping, 0, 1), 0)) ==
        "variation 0: body is 0, must be -1: damping belongs to the joint");
  CHECK(issue_of(of_joint(vary(Parameter::armature, 0, 1), 1)) ==
        "variation 0: armature cannot vary here, must belong to a hinge, slider or ball joint");
  CHECK(issue_of(of_control(vary(Parameter::kp, 1, 2), 0)) ==
        "variation 0: kp cannot vary here, must belong to a position servo, of gain (kp, 0, 0) and "
        "bias (0, -kp, -kv), kp > 0");
  CHECK(issue_of(of_control(vary(Parameter::kv, 1, 2), 0)).find("or a velocity servo") !=
        std::string::npos);
  CHECK(issue_of(vary(Parameter::armature, -0.1, 1)) == "variation 0: low is -0.1, must be >= 0");
  CHECK(issue_of(vary(Parameter::kp, 0, 1)) == "variation 0: low is 0, must be > 0");
  CHECK(issue_of(of_control(vary(Parameter::kv, 0, 1), 2)) ==
        "variation 0: low is 0, must be > 0 for a velocity servo");
  CHECK(validate(robot_with({of_control(vary(Parameter::kv, 0, 1), 1)})).empty());
  CHECK(issue_of(vary(Parameter::damping, 0.5, 1, Draw::none)) ==
        "variation 0: draw is none, but the scene's damping of joint 0, 0, is not within low and "
        "high");
  CHECK(only_issue(
            robot_with({of_control(vary(Parameter::gain, 1, 2), 1), vary(Parameter::kp, 1, 2)})) ==
        "variation 1: kp varies already, by variation 0 (control 1)");
  CHECK(only_issue(scene_with(vary(Parameter::armature, 0, 1))) ==
        "variation 0: parameter is armature, which varies per world only with the newton solver, "
        "not tgs-soft");
}

TEST_CASE("ranges must be such as a scene may have", "[fast][scene][parameters]") {
  CHECK(only_issue(scene_with(vary(Parameter::friction, -0.1, 1))) ==
        "variation 0: low is -0.1, must be >= 0");
  CHECK(only_issue(scene_with(vary(Parameter::restitution, 0, 1.5))) ==
        "variation 0: high is 1.5, must be between 0 and 1");
  CHECK(only_issue(scene_with(vary(Parameter::friction, 0.8, 0.2))) ==
        "variation 0: low is 0.8, must be at most high, which is 0.2");
  CHECK(only_issue(scene_with(vary(Parameter::friction, 0, 0.2, Draw::log_uniform))) ==
        "variation 0: low is 0, must be > 0 for a logarithmic draw");
  CHECK(only_issue(scene_with(vary(Parameter::friction, 0, 0.2, Draw::none))) ==
        "variation 0: draw is none, but the scene's friction of body 0, shape 0, 0.6, is not "
        "within low and high");
  CHECK(only_issue(scene_with(of(vary(Parameter::mass, 1, 2, Draw::none), 1))) ==
        "variation 0: draw is none, but the scene's mass of body 1, 1000, is not within low and "
        "high");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(only_issue(scene_with(vary(Parameter::mass, nan, 2))) ==
        "variation 0: low is nan kg, must be > 0");
  Scene planar = empty_scene(Space::planar);
  planar.add(body_of(shape_of(Circle{}), Vec3::Zero()));
  Variation gravity = vary(Parameter::gravity, 0, 0);
  gravity.low.z() = -10;
  planar.variations = {gravity};
  CHECK(only_issue(planar) == "variation 0: high[2] must be 0 in a planar scene, as low[2]");

  // A body that has no mass: its shape is the issue.
  planar.bodies[0].shapes[0].geometry = Polygon{};
  for (const Parameter parameter : {Parameter::mass, Parameter::size}) {
    planar.variations = {vary(parameter, 1, 2, Draw::none)};
    planar.variations[0].low.setOnes(), planar.variations[0].high.setOnes();
    CHECK(only_issue(planar) == "body 0, shape 0: vertices are 0, must be 3 to 8");
  }
}

TEST_CASE("a number varies once, and at both ends the scene must be valid",
          "[fast][scene][parameters]") {
  Scene twice = scene_with(vary(Parameter::friction, 0, 1));
  twice.variations.push_back(of(vary(Parameter::friction, 0.2, 0.5), 1));
  CHECK(only_issue(twice) == "variation 1: friction varies already, by variation 0 (body 1)");

  Scene heavy = scene_with(of(vary(Parameter::density, 1, 1e30), 1));
  Variation size = of(vary(Parameter::size, 1, 1e4), 1);
  size.low.setConstant(1), size.high.setConstant(1e4);
  heavy.variations.push_back(size);
  const auto issues = validate(heavy);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].place == "variations at their highest:");
  CHECK(issues[0].message.find("body 1: shapes make a mass of") == 0);
  CHECK_THROWS_AS(compile(heavy), SceneError);
}

}  // namespace manyworlds::test
