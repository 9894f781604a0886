// manyworlds model: what it says of a robot, of a scene by name, and of a file that is refused.
#if MW_HAVE_CLI

#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

using test::contains, test::Outcome, test::ScratchFolder;

const char* const kRobot = R"(<mujoco>
<option timestep="0.004" solver="PGS"/>
<worldbody>
  <geom name="floor" type="plane" size="5 5 1"/>
  <body name="torso" pos="0 0 2"><freejoint/>
    <geom type="sphere" size="0.1" density="1000"/>
    <body name="arm" pos="0.3 0 0">
      <joint name="swing" type="ball" damping="2" range="0 90"/>
      <geom type="capsule" size="0.05 0.2"/>
      <body name="hand" pos="0.3 0 0">
        <joint name="wrist" axis="0 1 0" range="-60 60" armature="0.02"/>
        <joint name="reach" type="slide" axis="1 0 0" range="0 0.1"/>
        <geom type="box" size="0.1 0.1 0.1"/><site name="tip" pos="0.1 0 0"/>
      </body>
    </body>
  </body>
</worldbody>
<actuator><position name="servo" joint="wrist" kp="20" ctrlrange="-1 1" forcerange="-5 5"/></actuator>
<tendon><fixed name="cord" range="-1 1"><joint joint="wrist" coef="1"/>
  <joint joint="reach" coef="-2"/></fixed>
  <fixed name="seen"><joint joint="wrist" coef="3"/></fixed></tendon>
<sensor><jointpos joint="wrist"/></sensor>
<keyframe><key name="ready" qvel="0 0 0 0 0 0 0 0 0 0.5 0" ctrl="0.25"/></keyframe>
</mujoco>)";

Outcome model_of(const std::string& xml, const std::string& arguments = "") {
  const ScratchFolder folder;
  std::ofstream(folder / "robot.xml") << xml;
  return test::run_program(test::kProgram, folder, "model robot.xml " + arguments);
}

}  // namespace

TEST_CASE("model prints the tree of a robot and all that acts on it", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const Outcome text = model_of(kRobot);
  CHECK(text.code == 0);
  CHECK(text.err.empty());
  for (const char* line :
       {"13 coordinates (nq), 11 degrees of freedom (nv)", "\n  'torso'  4.189 kg, sphere\n",
        "\n      free  q 0-6  v 0-5\n",
        "\n        ball 'swing'  q 7-10  v 6-8  0 to 1.5708 rad  damping 2\n",
        "hinge 'wrist'  q 11  v 9  -1.0472 to 1.0472 rad  armature 0.02\n",
        "slider 'reach'  q 12  v 10  0 to 0.1 m\n", "  'world'  plane\n",
        "  'servo'  joint_force on 'wrist'  control -1 to 1  gear 1  gain (20, 0, 0)  "
        "bias (0, -20, 0)  force -5 to 5\n",
        "  'cord'  1 'wrist' + -2 'reach'  -1 to 1\n", "  'seen'  3 'wrist'\n",
        "\nsites\n  'tip'  on 'hand'  at (0.1, 0, 0) m\n", "\nkeyframes\n  'ready'\n",
        "plane-sphere", "0.004\n", "sensors are not computed\n", "solver PGS"}) {
    INFO(line << "\n" << text.out);
    CHECK(contains(text.out, line));
  }
}

TEST_CASE("model --json has the places of joints in the coordinates", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const auto json = nlohmann::json::parse(model_of(kRobot, "--json").out);
  CHECK(json["nq"] == 13);
  CHECK(json["nv"] == 11);
  REQUIRE(json["bodies"].size() == 3);
  const auto& hand = json["bodies"][2];
  CHECK(hand["parent"] == json["bodies"][1]["body"]);
  CHECK(json["bodies"][0]["parent"].is_null());
  REQUIRE(hand["joints"].size() == 2);
  CHECK(hand["joints"][0]["name"] == "wrist");
  CHECK(hand["joints"][1]["q"] == 12);
  CHECK(hand["joints"][1]["v"] == 10);
  CHECK(hand["joints"][1]["range"] == nlohmann::json::array({0, 0.1}));
  CHECK(json["controls"][0]["force_range"] == nlohmann::json::array({-5, 5}));
  CHECK(json["tendons"][0]["terms"][1]["coefficient"] == -2);
  CHECK_FALSE(json["tendons"][1].contains("range"));
  CHECK(json["sites"][0]["body"] == json["bodies"][2]["body"]);
  CHECK(json["sites"][0]["position"] == nlohmann::json::array({0.1, 0, 0}));
  REQUIRE(json["keyframes"].size() == 1);
  CHECK(json["keyframes"][0]["name"] == "ready");
  CHECK(json["keyframes"][0]["generalized_position"].size() == 13);
  CHECK(json["keyframes"][0]["generalized_velocity"][9] == 0.5);
  CHECK(json["keyframes"][0]["controls"] == nlohmann::json::array({0.25}));
  CHECK(json["left_out"].size() == 2);
}

TEST_CASE("run and soak begin, and reset, at a keyframe", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  const ScratchFolder folder;
  std::ofstream(folder / "robot.xml") << kRobot;
  const auto run = [&](const std::string& arguments) {
    return test::run_program(test::kProgram, folder, arguments);
  };
  const std::string job = "run robot.xml --worlds 3 --json --steps ";
  const auto hash = [&](const std::string& arguments) {
    const Outcome outcome = run(job + arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return nlohmann::json::parse(outcome.out)["hash"];
  };
  CHECK(hash("20 --keyframe ready") == hash("20 --keyframe ready"));
  CHECK(hash("20 --keyframe ready") != hash("20"));
  // Episodes of random controls begin anew within 500 steps.
  CHECK(hash("510 --random-controls --keyframe ready") != hash("510 --random-controls"));
  CHECK(run("soak robot.xml --worlds 3 --steps 5 --seed 1 --keyframe ready").code == 0);
  const Outcome unknown = run(job + "5 --keyframe redy");
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "--keyframe: no keyframe is named 'redy'; there is 'ready'"));
  CHECK(contains(run("run ball3d --steps 5 --keyframe ready").err,
                 "--keyframe: no keyframe is named 'ready'; there are no keyframes with names"));
}

TEST_CASE("model takes scenes that have a name, without coordinates", "[cli]") {
  const Outcome text = test::run_program(test::kProgram, ScratchFolder(), "model stack10");
  CHECK(text.code == 0);
  CHECK(contains(text.out, "10 bodies that move, 0 joints, tgs-soft"));
  CHECK_FALSE(contains(text.out, "(nq)"));
}

TEST_CASE("model refuses with all problems of a file, a line each", "[cli]") {
  if (!test::program_reads_mjcf()) return;
  std::string bad = kRobot;
  bad.replace(bad.find("damping=\"2\""), 11, "frictionloss=\"2\"");
  bad.replace(bad.find("armature=\"0.02\""), 15, "frictionloss=\"1\"");
  const Outcome refused = model_of(bad);
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
  CHECK(contains(refused.err, "manyworlds: robot.xml: joint 'swing'"));
  CHECK(contains(refused.err, "\nmanyworlds: robot.xml: joint 'wrist'"));
}

}  // namespace manyworlds

#endif
