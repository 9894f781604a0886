// Gymnasium's tasks of files: what a scene makes, a file makes, and errors name the file.
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include "manyworlds/environment.hpp"
#include "manyworlds/gymnasium_mjcf.hpp"
#include "src/plan/plan_data.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

namespace tasks = gymnasium;

std::filesystem::path model_path(const char* name) {
  return std::filesystem::path(kSourceFolder) / "scenes" / "mjcf" / (std::string(name) + ".xml");
}
// A model in the temporary folder, removed at the end.
struct ModelFile {
  std::filesystem::path path;
  ModelFile(const std::string& name, const std::string& inside)
      : path(std::filesystem::temp_directory_path() / name) {
    std::ofstream(path) << "<mujoco><worldbody>" << inside << "</worldbody></mujoco>";
  }
  ~ModelFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};
void check_same(const Task& a, const Task& b) {
  CHECK(validate(a).empty());
  CHECK(a.name == b.name);
  CHECK(a.frame_skip == b.frame_skip);
  CHECK(a.observations.size() == b.observations.size());
  CHECK(a.infos.size() == b.infos.size());
  CHECK(fingerprint(a.scene) == fingerprint(b.scene));
}

}  // namespace

TEST_CASE("a task of a file is the task of its scene", "[mjcf][task][gymnasium]") {
  const Scene ant = load_mjcf(model_path("robot_ant")).scene;
  check_same(tasks::ant(model_path("robot_ant")), tasks::ant(ant));
  const tasks::AntOptions other{.frame_skip = 3, .include_cfrc_ext_in_observation = false};
  check_same(tasks::ant(model_path("robot_ant"), other), tasks::ant(ant, other));
  check_same(tasks::task_of_file("Ant-v5", model_path("robot_ant"),
                                 {{"frame_skip", {3}}, {"include_cfrc_ext_in_observation", {0}}}),
             tasks::ant(ant, other));
  check_same(tasks::hopper(model_path("robot_hopper")),
             tasks::hopper(load_mjcf(model_path("robot_hopper")).scene));
  check_same(tasks::half_cheetah(model_path("robot_cheetah")),
             tasks::task_of_file("HalfCheetah-v5", model_path("robot_cheetah")));
  check_same(tasks::humanoid(model_path("robot_humanoid")),
             tasks::task_of_file("Humanoid-v5", model_path("robot_humanoid")));
  Environment environment(tasks::walker2d(model_path("robot_cheetah")),
                          {.worlds = 2, .threads = 1});
  CHECK(environment.batch().worlds() == 2);
}

TEST_CASE("errors of a task of a file name it and what is missing", "[mjcf][task][gymnasium]") {
  using Catch::Contains;
  using Catch::StartsWith;
  CHECK_THROWS_AS(tasks::ant("/nowhere/ant.xml"), MjcfError);
  CHECK_THROWS_WITH(tasks::ant("/nowhere/ant.xml"), Contains("/nowhere/ant.xml"));
  const std::string hopper = model_path("robot_hopper").string();
  CHECK_THROWS_AS(tasks::ant(hopper), std::invalid_argument);
  CHECK_THROWS_WITH(tasks::ant(hopper), StartsWith(hopper + ": the model ") &&
                                            Contains("has 6 coordinates, must have 7 or more"));
  CHECK_THROWS_WITH(tasks::inverted_pendulum(hopper),
                    StartsWith(hopper) && Contains("has 6 coordinates, must have 2"));
  CHECK_THROWS_WITH(tasks::task_of_file("Ant-v5", hopper), StartsWith(hopper));
  CHECK_THROWS_WITH(tasks::task_of_file("Ant-v4", hopper),
                    Contains("there is no task 'Ant-v4'; there are InvertedPendulum-v5, ") &&
                        Contains("HumanoidStandup-v5"));
  CHECK_THROWS_WITH(
      tasks::task_of_file("Reacher-v5", hopper, {{"weight", {2}}, {"frame_skip", {3}}}),
      "Reacher-v5 has no argument 'weight'; it has frame_skip, reward_dist_weight, "
      "reward_control_weight");
  // Bodies and sites that the task looks at.
  const auto chain = [](int joints) {
    std::string out;
    for (int i = 0; i < joints; ++i) {
      out += "<body pos='.3 0 0'><joint type='slide' axis='1 0 0'/><geom size='.1'/>";
    }
    for (int i = 0; i < joints; ++i) out += "</body>";
    return out;
  };
  const ModelFile arm("manyworlds_arm.xml", chain(4)), poles("manyworlds_poles.xml", chain(3));
  CHECK_THROWS_WITH(tasks::reacher(arm.path),
                    Contains("manyworlds_arm.xml: no body is named 'fingertip'"));
  CHECK_THROWS_WITH(
      tasks::inverted_double_pendulum(poles.path),
      Contains("manyworlds_poles.xml: the model ") && Contains("has no site, must have one"));
}

}  // namespace manyworlds::test
