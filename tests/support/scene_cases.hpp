// Small valid scenes, and a table-driven check that each way of spoiling one gives one issue.
#pragma once

#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInf = std::numeric_limits<double>::infinity();

struct BadInput {
  std::string field;    // end of Issue::place
  std::string message;  // must be part of Issue::message
  std::function<void(Scene&)> spoil;
};

inline std::vector<std::string> places(const Scene& scene) {
  std::vector<std::string> result;
  for (const Issue& issue : validate(scene)) result.push_back(issue.place);
  return result;
}

// The text of its one issue, or how many it has.
inline std::string only_issue(const Scene& scene) {
  const std::vector<Issue> issues = validate(scene);
  return issues.size() == 1 ? to_string(issues[0]) : std::to_string(issues.size()) + " issues";
}

// A valid scene, spoilt in each way in turn, has exactly the one issue at `part` + field.
inline void check_each(const Scene& valid, const std::string& part,
                       const std::vector<BadInput>& cases) {
  REQUIRE(validate(valid).empty());
  for (const BadInput& bad : cases) {
    Scene scene = valid;
    bad.spoil(scene);
    const std::vector<Issue> issues = validate(scene);
    CAPTURE(part, bad.field, bad.message);
    CHECK(places(scene) == std::vector<std::string>{part + bad.field});
    if (!issues.empty()) CHECK_THAT(issues.front().message, Catch::Contains(bad.message));
  }
}

// Body 0 'ground', fixed; body 1 'crate', dynamic, with shape 0 'hull'.
inline Scene scene_with(Space space, Geometry ground, Geometry hull) {
  Scene scene;
  scene.space = space;
  if (space == Space::planar) scene.options.gravity = {0, -10, 0};
  Body fixed;
  fixed.name = "ground";
  fixed.motion = Motion::fixed;
  fixed.shapes.emplace_back();
  fixed.shapes.back().geometry = std::move(ground);
  scene.add(fixed);
  Body crate;
  crate.name = "crate";
  crate.shapes.emplace_back();
  crate.shapes.back().name = "hull";
  crate.shapes.back().geometry = std::move(hull);
  scene.add(crate);
  return scene;
}
inline Scene spatial_scene_with(Geometry hull) {
  return scene_with(Space::spatial, Plane{}, std::move(hull));
}
inline Scene planar_scene_with(Geometry hull) {
  return scene_with(Space::planar, HalfPlane{}, std::move(hull));
}

inline Scene sphere_scene() { return spatial_scene_with(Sphere{0.5}); }
inline Scene circle_scene() { return planar_scene_with(Circle{0.5}); }

}  // namespace manyworlds::test
