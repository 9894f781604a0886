// What a plan chooses where Options leave it to it, and what it says of it.
#include <catch2/catch.hpp>

#include <algorithm>

#include "manyworlds/scenes.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

int substeps_of(const Scene& scene) { return *compile(scene).resolved().substeps; }
std::string why(const Scene& scene, const std::string& option = "substeps") {
  for (const auto& choice : compile(scene).report().choices) {
    if (choice.option == option) return choice.why;
  }
  return "";
}
bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Scene column(Space space, int count, double size, double gap = 0) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  for (int i = 0; i < count; ++i) {
    scene.add(
        body_of(shape_of(cube_of(space, size / 2)), (size * (0.5 + i) + gap * i) * up_of(space)));
  }
  return scene;
}

}  // namespace

TEST_CASE("the scenes of bench have four substeps", "[fast][plan]") {
  int all = 0;
  for (const auto& entry : scenes::all()) {
    if (!entry.standard && std::string(entry.name) != "free-flight") continue;
    INFO(entry.name);
    CHECK(substeps_of(entry.make()) == 4);
    ++all;
  }
  CHECK(all == 13);
}

TEST_CASE("columns get the substeps that they stand with", "[fast][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    CHECK(substeps_of(column(space, 10, 1)) == 4);
    CHECK(substeps_of(column(space, 20, 1)) > 4);
    CHECK(says(why(column(space, 20, 1)), "20 bodies up to body 20 stand on one another"));
    CHECK(substeps_of(column(space, 5, 1e-3)) > substeps_of(column(space, 5, 1e-2)));
    // What begins above something else with room between is no column.
    CHECK(substeps_of(column(space, 20, 1, 0.3)) == 4);
    // Side by side they are no higher.
    Scene wall = empty_scene(space);
    for (int row = 0; row < 12; ++row) {
      for (int i = 0; i < 12; ++i) {
        wall.add(body_of(shape_of(cube_of(space, 0.5)),
                         (i + 0.5 * (row % 2)) * Vec3::UnitX() + (0.5 + row) * up_of(space)));
      }
    }
    CHECK(substeps_of(wall) <= substeps_of(column(space, 12, 1)));
    Scene weightless = column(space, 20, 1);
    weightless.options.gravity.setZero();
    CHECK(substeps_of(weightless) == 4);
  }
}

TEST_CASE("ratios of mass and loads of joints ask for substeps", "[fast][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = column(space, 2, 1, 1);
    scene.bodies[2].shapes[0].density = 400 * scene.options.density;
    const Options chosen = compile(scene).resolved();
    CHECK(*chosen.substeps == 12);
    CHECK(*chosen.contact.frequency == 60);  // stiffer contacts would not help
    CHECK(says(why(scene), "has 400 times the mass of"));
    scene.bodies[2].shapes[0].filter.mask = 0;
    CHECK(substeps_of(scene) == 4);

    Scene chain = empty_scene(space);
    for (int i = 0; i < 10; ++i) {
      chain.add(body_of(shape_of(cube_of(space, 0.5)), i * Vec3::UnitX()));
      Joint hinge;
      hinge.body_a = BodyId(i - 1), hinge.body_b = BodyId(i);
      hinge.frame_a.position = {i == 0 ? -0.5 : 0.5, 0, 0};
      hinge.frame_b.position = {-0.5, 0, 0};
      chain.add(hinge);
    }
    CHECK(substeps_of(chain) == 4);
    chain.bodies[9].shapes[0].density = 1000 * chain.options.density;
    chain.bodies[9].shapes[0].filter.mask = 0;
    CHECK(substeps_of(chain) > 8);
    CHECK(says(why(chain), "carries"));
  }
}

TEST_CASE("what is given is not chosen", "[fast][plan]") {
  Scene scene = column(Space::spatial, 20, 0.1);
  scene.options.substeps = 3;
  scene.options.contact.frequency = 30;
  scene.options.contact.slop = 0.01;
  scene.options.length_unit = 2;
  const Plan plan = compile(scene);
  CHECK(*plan.resolved().substeps == 3);
  CHECK(*plan.resolved().contact.frequency == 30);
  CHECK(*plan.resolved().contact.slop == 0.01);
  CHECK(*plan.resolved().length_unit == 2);
  CHECK(why(scene).empty());
  CHECK(!plan.scene().options.contact.push_out_speed);  // the scene stays as it was described
  // As given or as chosen: the same worlds.
  Scene chosen = column(Space::spatial, 20, 0.1), given = chosen;
  given.options = compile(chosen).resolved();
  CHECK(compile(given).fingerprint() == compile(chosen).fingerprint());
}

TEST_CASE("a frequency that is given asks for substeps that carry it", "[fast][plan]") {
  Scene scene = column(Space::spatial, 1, 1);
  scene.options.contact.frequency = 240;
  CHECK(substeps_of(scene) == 16);
  CHECK(says(why(scene), "contacts of 240 Hz"));
}

TEST_CASE("the worst of all worlds decides", "[fast][plan]") {
  Scene scene = column(Space::spatial, 2, 1, 1);
  CHECK(substeps_of(scene) == 4);
  Variation density = vary(Parameter::density, 1000, 4e5);
  density.shape = ShapeId(BodyId(2), 0);
  scene.variations.push_back(density);
  CHECK(substeps_of(scene) == 12);
}

}  // namespace manyworlds::test
