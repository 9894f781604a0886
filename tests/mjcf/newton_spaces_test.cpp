// Both spaces of the newton solver against MuJoCo: articulated bodies where links of one robot
// touch each other, the joint-space inertia where many robots do.
#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "tests/mjcf/newton_comparison.hpp"

namespace manyworlds::test {
namespace {

std::string model_in_space(const std::string& option, const std::string& bodies,
                           const std::string& rest) {
  return R"(<mujoco><compiler angle="radian" autolimits="true"/><option timestep="0.004" )" +
         option +
         R"(/><default><geom type="capsule" size="0.05 0.12" friction="0.7"/><joint damping="0.1"/></default>
    <worldbody><geom type="plane" size="5 5 1" condim="3"/>)" +
         bodies + "</worldbody>" + rest + "</mujoco>";
}

// A trunk with two arms that fold onto it and onto each other, and a tendon through both elbows.
std::string folding_robot(const std::string& option, int dimensions) {
  const auto arm = [](const std::string& name, double y) {
    const std::string side = std::to_string(y);
    return "<body name='" + name + "' pos='0 " + side + R"( 0.1'>
        <joint type="ball" pos="0 0 -0.15" range="0 1.4"/><geom/>
        <body pos="0 0 0.3"><joint name=")" +
           name + R"(" axis="1 0.2 0" pos="0 0 -0.15" range="-2.8 2.8" armature="0.002"/><geom/>
        </body></body>)";
  };
  return model_in_space(
      option,
      R"(<body pos="0 0 0.6"><freejoint/><geom type="capsule" size="0.07 0.2" condim=")" +
          std::to_string(dimensions) + R"("/>)" + arm("left", 0.25) + arm("right", -0.25) +
          "</body>",
      R"(<tendon><fixed limited="true" range="-1 1"><joint joint="left" coef="1"/>
      <joint joint="right" coef="-0.7"/></fixed></tendon>
    <actuator><motor joint="left" gear="3" ctrlrange="-1 1"/>
      <motor joint="right" gear="3" ctrlrange="-1 1"/></actuator>)");
}

// Five of two links each, in a heap.
std::string heap(const std::string& option) {
  std::string bodies;
  for (int i = 0; i < 5; ++i) {
    bodies += "<body pos='" + std::to_string(0.13 * (i % 3)) + " " +
              std::to_string(0.11 * (i / 3)) + " " + std::to_string(0.2 + 0.12 * i) +
              R"(' euler='1.2 0.3 )" + std::to_string(i) +
              R"('><freejoint/><geom/>
        <body pos="0 0 0.3"><joint axis="0 1 0" pos="0 0 -0.15" range="-1.2 1.2"/><geom/></body>
      </body>)";
  }
  return model_in_space(option, bodies, "");
}

std::string stage_of(const std::string& xml) {
  for (const auto& stage : compile(load_mjcf_string(xml).scene).report().stages) {
    if (stage.name == "tree") return stage.why;
  }
  return "";
}

void check_space(const std::string& xml, const std::string& space) {
  CHECK_THAT(stage_of(xml), Catch::Contains(space));
  for (const Table& table : all_tables()) {
    const compare::Pair pair = pair_of(xml);
    const auto samples = compare::draw_samples(pair, table.precision, 150, 20, 250);
    const compare::StateComparison c = compare::compare_states(pair, samples, kernels_of(table));
    INFO(name(table) << ": " << to_string(c));
    CHECK(c.contacts > 100);
    CHECK(c.other_contacts == 0);
    CHECK(acceleration(c).most() < pick(table, 1e-2, 1e-7));
    CHECK(acceleration(c).median() < pick(table, 1e-4, 1e-11));
  }
}

}  // namespace

TEST_CASE("links of a robot that touch each other are solved by articulated bodies",
          "[mjcf][robots]") {
  for (const char* option : {"cone='pyramidal'", "cone='elliptic' impratio='2'"}) {
    for (const int dimensions : {1, 3}) {
      INFO(option << ", condim " << dimensions);
      check_space(folding_robot(option, dimensions), "by articulated bodies");
    }
  }
}

TEST_CASE("robots in a heap are solved in joint space", "[mjcf][robots]") {
  for (const char* option : {"cone='pyramidal'", "cone='elliptic'"}) {
    INFO(option);
    check_space(heap(option), "by the joint-space inertia");
  }
}

}  // namespace manyworlds::test
