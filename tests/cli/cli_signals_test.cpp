// Ctrl-C and SIGTERM: every command that takes long ends soon, sums up what was done, says that it
// was interrupted, in --json too, and has the exit code that --help promises.
#if MW_HAVE_CLI

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/running.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::contains, test::content, test::Outcome, test::ProgramFolder, test::Running;
using Words = std::vector<std::string>;

Outcome interrupted(const ProgramFolder& folder, const Words& arguments, int number) {
  Running running(folder, arguments, {"MANYWORLDS_VIEWER=viewer.html"});
  REQUIRE(running.is_ready());
  Outcome outcome = running.end(number);
  INFO(outcome.err);
  CHECK(outcome.code == 128 + number);
  return outcome;
}

}  // namespace

TEST_CASE("a page that was cut says so", "[cli][signals]") {
  const ProgramFolder folder;
  if (!test::program_has("recordings   yes")) return;
  test::write_empty_page(folder);
  Words view = {"view", "ball3d", "stack10", "--worlds", "8", "--seconds", "1000000"};
  view.insert(view.end(), {"--out", "page.html"});
  for (const bool json : {false, true}) {
    fs::remove(folder / "page.html");
    if (json) view.emplace_back("--json");
    const Outcome outcome = interrupted(folder, view, json ? SIGTERM : SIGINT);
    const std::string cut = " steps of ball3d";
    CHECK(contains(outcome.err, json ? "interrupted by SIGTERM after " : "interrupted by SIGINT"));
    CHECK(contains(outcome.err, " of 60000000" + cut + "; page.html shows the steps until then"));
    CHECK(contains(content(folder / "page.html"), ", interrupted after "));
    if (!json) {
      CHECK(contains(outcome.out, "page.html: 8 worlds"));
      continue;
    }
    const Json said = Json::parse(outcome.out);
    CHECK(said["interrupted"] == "SIGTERM");
    CHECK(said["cut"]["scene"] == "ball3d");
    CHECK(said["cut"]["of"] == 60000000);
    CHECK(said["cut"]["steps"] < 60000000);
    CHECK(said["page"] == "page.html");
  }
}

TEST_CASE("an interrupted verify counts what it has compared", "[cli][signals]") {
  const ProgramFolder folder;
  const Outcome outcome = interrupted(folder, {"verify", "--scenes", "bin-boxes,bin2d"}, SIGINT);
  CHECK(contains(outcome.out, " comparisons equal so far"));
  CHECK(contains(outcome.err, "interrupted by SIGINT after "));
  CHECK(contains(outcome.err, " of 4 rows"));
  CHECK_FALSE(contains(outcome.out, "BAD"));
  CHECK_FALSE(contains(outcome.out, "differ"));
}

TEST_CASE("an interrupted replay says how far it came", "[cli][signals]") {
  const ProgramFolder folder;
  if (!test::program_has("recordings   yes")) return;
  REQUIRE(folder.run("run bin2d --worlds 64 --steps 4000 --record run.h5 --record-every 40").code ==
          0);
  for (const bool json : {false, true}) {
    Words replay = {"replay", "run.h5", "--threads", "1"};
    if (json) replay.emplace_back("--json");
    const Outcome outcome = interrupted(folder, replay, SIGINT);
    CHECK(contains(outcome.err, "interrupted by SIGINT after "));
    CHECK(contains(outcome.err, " of 101 samples"));
    if (!json) {
      CHECK(contains(outcome.out, "different    none"));
      continue;
    }
    const Json said = Json::parse(outcome.out);
    CHECK(said["interrupted"] == "SIGINT");
    CHECK(said["samples"] < 101);
    CHECK(said["different"] == 0);
  }
}

TEST_CASE("an interrupted comparison with MuJoCo prints what it has found", "[cli][signals]") {
  const ProgramFolder folder;
  if (!test::program_has("mjcf         yes")) return;
  const std::string model = std::string(test::kSourceFolder) + "/scenes/mjcf/robot_hopper.xml";
  for (const bool json : {false, true}) {
    Words compare = {"compare", model, "--worlds", "8", "--steps", "100000000", "--no-speed"};
    if (json) compare.emplace_back("--json");
    const Outcome outcome = interrupted(folder, compare, SIGTERM);
    CHECK(contains(outcome.err, "interrupted by SIGTERM after "));
    CHECK(contains(outcome.err, " of 5 comparisons"));
    if (json) {
      CHECK(Json::parse(outcome.out)["interrupted"] == "SIGTERM");
    } else {
      CHECK(contains(outcome.out, "all gates hold so far"));
    }
  }
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
