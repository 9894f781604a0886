// Which scenes the plan has sweeps after impacts for (src/plan/impact_sweeps.cpp).
#include <catch2/catch.hpp>

#include <string>

#include "manyworlds/scenes.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

Scene balls(int count) {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  for (int i = 0; i < count; ++i) {
    scene.add(body_of(shape_of(Sphere{0.5}), Vec3(2.0 * i, 0, 1)));
  }
  return scene;
}

int sweeps_of(const Scene& scene) { return *compile(scene).resolved().contact.impact_sweeps; }

std::string reason_of(const Scene& scene) {
  for (const auto& choice : compile(scene).report().choices) {
    if (choice.option == "contact.impact_sweeps") return choice.why;
  }
  return {};
}

}  // namespace

TEST_CASE("impacts among few bodies are swept", "[fast][plan]") {
  CHECK(sweeps_of(balls(1)) == 64);
  CHECK(sweeps_of(balls(12)) == 64);
  CHECK(reason_of(balls(12)) == "no more than 12 bodies move");
  CHECK(sweeps_of(balls(13)) == 0);
  CHECK(reason_of(balls(13)) == "13 bodies move, more than 12");
  // What cannot be hit does not count.
  Scene ghosts = balls(13);
  ghosts.bodies.back().shapes[0].filter.mask = 0;
  CHECK(sweeps_of(ghosts) == 64);
  ghosts = balls(13);
  ghosts.bodies.back().motion = Motion::kinematic;
  CHECK(sweeps_of(ghosts) == 64);
  Scene penalty = balls(2);
  penalty.options.solver.method = Solver::penalty;
  CHECK(sweeps_of(penalty) == 0);
}

TEST_CASE("a number of sweeps that is set is kept", "[fast][plan]") {
  Scene crowd = balls(40);
  crowd.options.contact.impact_sweeps = 20;
  CHECK(sweeps_of(crowd) == 20);
  CHECK(reason_of(crowd).empty());
}

TEST_CASE("scenes with joints have no sweeps after impacts", "[fast][plan]") {
  Scene scene = scenes::find("chain3d")->make();
  CHECK(sweeps_of(scene) == 0);
  scene.options.contact.impact_sweeps = 0;
  CHECK(validate(scene).empty());
  scene.options.contact.impact_sweeps = 8;
  const auto issues = validate(scene);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].place == "options.contact.impact_sweeps");
  CHECK(issues[0].message ==
        "is 8, must be 0 in scenes with joints, which do not take part in impacts yet");
}

}  // namespace manyworlds::test
