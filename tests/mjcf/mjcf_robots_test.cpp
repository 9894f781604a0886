// The robots among the named scenes are the models of scenes/mjcf, written as C++ so that they need
// no MuJoCo. After a change of a model or of the reader,
//   MANYWORLDS_WRITE_ROBOTS=1 manyworlds_mjcf_tests 'robots by name*'
// writes scenes/robots/ again; clang-format does the rest.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/mjcf/scene_source.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(kSourceFolder) / "scenes";

// check_floors.py wants to be told.
constexpr const char* kLong =
    "// This file has over 400 lines because a program wrote it, a line per number.\n";

Scene robot_of_model(const std::string& name) {
  Scene scene = load_mjcf(kScenes / "mjcf" / ("robot_" + name + ".xml")).scene;
  scene.name = name;
  return scene;
}

void write_source(const Scene& scene) {
  std::string body = SceneSource(15).function(scene);
  std::string head;
  if (body.find("numeric_limits") != std::string::npos) head += "#include <limits>\n\n";
  std::ofstream(kScenes / "robots" / (scene.name + ".cpp"))
      << "// Made from scenes/mjcf/robot_" << scene.name
      << ".xml by tests/mjcf/mjcf_robots_test.cpp; change it there.\n"
      << (scene.bodies.size() > 12 ? kLong : "") << head
      << "#include \"scenes/makers.hpp\"\n\nnamespace manyworlds::scenes {\n\n"
      << body << "\n}  // namespace manyworlds::scenes\n";
}

}  // namespace

TEST_CASE("robots by name are the models of scenes/mjcf", "[mjcf][robots]") {
  int robots = 0;
  for (const auto& file : std::filesystem::directory_iterator(kScenes / "mjcf")) {
    const std::string stem = file.path().stem();
    if (!stem.starts_with("robot_")) continue;
    ++robots;
    const Scene model = robot_of_model(stem.substr(6));
    if (std::getenv("MANYWORLDS_WRITE_ROBOTS")) write_source(model);
    INFO(stem);
    const scenes::Entry* entry = scenes::find(model.name);
    REQUIRE(entry);
    // The sines of two C libraries may differ in the last bit.
    CHECK(SceneSource(10).function(entry->make()) == SceneSource(10).function(model));
  }
  CHECK(robots == 5);
}

}  // namespace manyworlds::test
