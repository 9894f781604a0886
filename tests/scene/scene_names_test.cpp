// Names, field descriptions and the text of scene errors.
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "manyworlds/fields.hpp"
#include "manyworlds/plan.hpp"

namespace manyworlds {

TEST_CASE("features and broad phases have their names", "[fast][scene]") {
  CHECK(std::string(to_string(Feature::orientation)) == "orientation");
  CHECK(std::string(to_string(Feature::gravity)) == "gravity");
  std::set<std::string> names;
  for (int i = 0; i < kFeatureCount; ++i) names.insert(to_string(static_cast<Feature>(i)));
  CHECK(names.size() == kFeatureCount);
  CHECK(names.count("unknown") == 0);

  CHECK(std::string(to_string(BroadPhase::automatic)) == "automatic");
  CHECK(std::string(to_string(BroadPhase::all_pairs)) == "all-pairs");
  CHECK(std::string(to_string(BroadPhase::sort_and_sweep)) == "sort-and-sweep");
  CHECK(std::string(to_string(BroadPhase::sparse)) == "sparse");
}

TEST_CASE("field descriptions follow the list of fields", "[fast][scene]") {
  CHECK(std::string(info(Field::position).name) == "position");
  CHECK(std::string(info(Field::angular_velocity).name) == "angular_velocity");
  CHECK(std::string(info(Field::linear_velocity).unit) == "m/s");
  CHECK(components(Field::position, Space::planar) == 2);
  CHECK(components(Field::orientation, Space::planar) == 2);
  CHECK(components(Field::orientation, Space::spatial) == 4);
  CHECK(components(Field::angular_velocity, Space::planar) == 1);
  CHECK(components(Field::angular_velocity, Space::spatial) == 3);
  CHECK(std::string(info(Field::generalized_velocity).unit) == "m/s or rad/s");
  CHECK(std::string(to_string(info(Field::generalized_position).item)) == "coordinate");
  CHECK(std::string(to_string(info(Field::generalized_acceleration).item)) == "dof");
  for (const Field field : {Field::generalized_position, Field::generalized_velocity,
                            Field::generalized_acceleration}) {
    CHECK(components(field, Space::planar) == 1);
    CHECK(components(field, Space::spatial) == 1);
  }
}

TEST_CASE("a scene error carries and lists all issues", "[fast][scene]") {
  const SceneError error({{"body 3 'crate', shape 1: half_extents.y", "is -0.2 m, must be > 0"},
                          {"options.dt", "is nan s, must be > 0"}});
  CHECK(error.issues().size() == 2);
  CHECK(std::string(error.what()) ==
        "the scene has 2 issues:\n"
        "  body 3 'crate', shape 1: half_extents.y is -0.2 m, must be > 0\n"
        "  options.dt is nan s, must be > 0");
  const std::vector<Issue> one = {{"options.dt", "is 0 s, must be > 0"}};
  CHECK(std::string(SceneError(one).what()) ==
        "the scene has 1 issue:\n  options.dt is 0 s, must be > 0");
}

}  // namespace manyworlds
