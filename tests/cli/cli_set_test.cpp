// --set: every option of a scene by its path.
#if MW_HAVE_CLI

#include <cmath>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "manyworlds/options.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

using Json = nlohmann::json;
using test::contains, test::Outcome;

Outcome run_set(const std::string& arguments) {
  return test::run_program(test::kProgram, test::ScratchFolder(), arguments);
}

TEST_CASE("what cannot be set is told in a line", "[cli]") {
  struct Bad {
    const char* set;
    const char* message;  // part of the line
  };
  const Bad cases[] = {
      {"contact.slop", "--set: must be PATH=VALUE, is 'contact.slop'"},
      {"contact.slup=1",
       "--set: unknown option of a scene 'contact.slup'; did you mean "
       "'contact.slop'? ('manyworlds info --options' lists all)"},
      {"qwertyuiop=1", "unknown option of a scene 'qwertyuiop' ('manyworlds info"},
      {"contact=1", "unknown option of a scene 'contact'"},
      {"contact.damping_ratio=", "--set: contact.damping_ratio must be a number, is ''"},
      {"contact.damping_ratio=1e999", "--set: contact.damping_ratio must be a number, is '1e999'"},
      {"substeps=2.5", "--set: substeps must be a whole number, or default, is '2.5'"},
      {"solver.method=sot",
       "--set: solver.method must be tgs-soft, sequential-impulse, sor, nncg, "
       "penalty or newton, is 'sot'"},
      {"solver.split_impulse=1", "solver.split_impulse must be true or false, is '1'"},
      {"solver.iterations=many", "must be a whole number, or default, is 'many'"},
      {"gravity=1,2", "--set: gravity must be 3 numbers, as in 0,0,-9.81, is '1,2'"},
      {"gravity=1,2,3,4", "--set: gravity must be 3 numbers"},
      {"bounds=1,2,3", "bounds must be 6 numbers, the lowest corner and the highest, or default"},
      // Ranges are for the checks of the scene.
      {"contact.slop=-1", "options.contact.slop is -1 m, must be > 0"},
      {"substeps=65", "options.substeps is 65, must be between 1 and 64"}};
  for (const Bad& bad : cases) {
    INFO(bad.set);
    const Outcome outcome =
        run_set(std::string("run ball3d --worlds 1 --steps 1 --set ") + bad.set);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, bad.message));
  }
}

TEST_CASE("setting an option with --set does what its flag does", "[cli]") {
  const auto json = [](const std::string& arguments) {
    const Outcome outcome =
        run_set("run stack10 --worlds 2 --steps 20 --threads 1 --json " + arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out);
  };
  const Json flags = json("--dt 0.01 --substeps 3 --solver sor --iterations 5");
  const Json set =
      json("--set dt=0.01 --set substeps=3 --set solver.method=sor --set=solver.iterations=5");
  CHECK(set["hash"] == flags["hash"]);
  CHECK(set["solver"] == "sor");
  CHECK(json("--dt 0.01 --set dt=0.02")["dt"] == 0.02);  // the last word
  const auto chain = [](const std::string& joints) {
    return Json::parse(run_set("run chain3d --worlds 2 --steps 20 --json " + joints).out)["hash"];
  };
  CHECK(chain("--joints tree") == chain("--set joint.method=tree"));
  CHECK(chain("--joints tree") != chain("--joints sweep"));
  CHECK(json("--set gravity=0,0,-1.6")["hash"] != json("")["hash"]);
  CHECK(json("--set solver.iterations=default --set bounds=-90,-90,-90,90,90,90")["hash"] ==
        json("")["hash"]);
}

TEST_CASE("a lost world's command has what was set", "[cli]") {
  const Outcome outcome = run_set("run free-flight --worlds 1 --steps 2 --set dt=1e12 --seed 4");
  CHECK(outcome.code == 1);
  CHECK(contains(outcome.err, " --set 'dt=1e12'"));
}

TEST_CASE("info --options lists what --set takes, with the defaults", "[cli]") {
  CHECK(contains(run_set("info --options").out, "contact.slop "));
  std::string all;
  for (const Json& option : Json::parse(run_set("info --options --json").out)) {
    const std::string path = option["path"];
    CHECK_FALSE(option["takes"].get<std::string>().empty());
    if (path == "contact.damping_ratio") CHECK(option["default"] == "10");
    if (path == "joint.pull_speed") CHECK(option["default"] == "inf");
    all += " --set " + path + "=" + option["default"].get<std::string>();
  }
  // Ball and defaults: what they are anyway, but for the scene's own gravity and bounds.
  const Outcome outcome = run_set("run ball3d --worlds 1 --steps 1" + all);
  INFO(outcome.err);
  CHECK(outcome.code == 0);
}

}  // namespace
}  // namespace manyworlds

#endif
