// Issues of Scene::variations.
#include <catch2/catch.hpp>

#include <limits>

#include "manyworlds/plan.hpp"
#include "tests/support/scenes.hpp"

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

std::string only_issue(const Scene& scene) {
  const std::vector<Issue> issues = validate(scene);
  if (issues.size() != 1) return std::to_string(issues.size()) + " issues";
  return to_string(issues[0]);
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
        "variation 0: shape is 0, must be -1: mass is of the body");
  CHECK(only_issue(scene_with(of(vary(Parameter::gravity, 0, 0), 1))) ==
        "variation 0: body is 1, must be -1: gravity is of the world");
  CHECK(only_issue(scene_with(of(vary(Parameter::mass, 1, 2), 0))) ==
        "variation 0: mass cannot vary here, must be of a dynamic body");
  CHECK(only_issue(scene_with(of(vary(Parameter::density, 1, 2), 2, 0))) ==
        "variation 0: density cannot vary here, must be of a dynamic body whose mass is not given");
  CHECK(only_issue(scene_with(of(vary(Parameter::size, 1, 2), 0, 0))) ==
        "variation 0: size cannot vary here, must be of a shape of a moving body with a size");
  Scene empty = empty_scene(Space::spatial);
  empty.add(ground(Space::spatial));
  empty.variations = {vary(Parameter::mass, 1, 2)};
  CHECK(only_issue(empty) == "variation 0: mass is of nothing in this scene");
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
