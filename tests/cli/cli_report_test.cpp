// `manyworlds report`, run as its users run it: complete JSON with sane numbers, and a page.
#if MW_HAVE_CLI

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/cli/report_page.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

using Json = nlohmann::json;
using test::approx, test::contains, test::content, test::Outcome, test::report_in,
    test::run_with_page, test::ScratchFolder;

// Least error of each case over its points, and what is wrong with them.
std::map<std::string, double> least_errors(const Json& report) {
  std::map<std::string, double> least;
  for (const Json& c : report["results"]) {
    const std::string id = c["id"];
    INFO("case " << id);
    for (const char* key : {"title", "metric", "unit", "level", "simulated_s", "published"}) {
      CHECK(c.contains(key));
    }
    REQUIRE_FALSE(c["points"].empty());
    std::set<std::string> precisions;
    for (const Json& p : c["points"]) {
      CHECK(p["step_s"].get<double>() > 0);
      CHECK(p["us_per_world"].get<double>() > 0);
      CHECK(p["steps_per_s"].get<double>() > 0);
      CHECK_FALSE(p["method"].get<std::string>().empty());
      precisions.insert(p["precision"]);
      if (p["error"].is_null()) continue;  // the world was lost
      const double error = p["error"];
      CHECK(error >= 0);
      if (least.count(id) == 0 || error < least[id]) least[id] = error;
    }
    CHECK(precisions.count("f32") == 1);
    for (const Json& p : c["cheapest_at_level"]) {
      CHECK(p["error"].get<double>() <= c["level"].get<double>());
    }
  }
  return least;
}

// A program that stands in for another engine's, in the folder `peers`.
void write_peer(const ScratchFolder& folder, const std::string& name, const std::string& body) {
  const std::filesystem::path path = folder.path() / "peers" / name;
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << "#!/bin/sh\n" << body;
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("report accuracy writes complete tables and a page", "[cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome = run_with_page(folder, "report accuracy --quick --out here");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(contains(outcome.out, "A16 49 balls that bounce"));
  const Json report = Json::parse(content(folder.path() / "here" / "accuracy.json"));
  CHECK(report["report"] == "accuracy");
  CHECK(report["quick"] == true);
  const auto least = least_errors(report);
  // A few times the least error that the short form finds. A17e, elastic, is chaotic.
  const std::map<std::string, double> expected = {
      {"A1", 1e-5},     {"A2", 3e-10},  {"A3", 2e-8},   {"A4", 2e-6},   {"A5", 3e-7},
      {"A6", 3e-3},     {"A7", 3e-3},   {"A8", 3e-3},   {"A10", 3e-3},  {"A11-2", 0.3},
      {"A11-40", 1e-3}, {"A15x", 1e-9}, {"A15y", 1e-9}, {"A16", 1e-20}, {"A17", 2e-5},
      {"A17e", 1e7},    {"A19", 1e-14}, {"A20", 2e-3},  {"A21", 2e-2},  {"A22", 1e-15},
      {"A23", 2e-9},    {"A24", 1e-7},  {"A25e", 1e-8}, {"A25p", 2e-8}, {"A26e", 1e-10},
      {"A26p", 1e-10},  {"A27", 4e-8}};
  CHECK(least.size() == expected.size());
  for (const auto& [id, most] : expected) {
    INFO(id);
    REQUIRE(least.count(id) == 1);
    CHECK(least.at(id) < most);
  }
  const std::string page = content(folder.path() / "here" / "accuracy.html");
  CHECK(report_in(page) == report);
  CHECK(contains(page, "RaiSim"));
  CHECK_FALSE(contains(page, "nan"));
}

TEST_CASE("report stability judges every case in every setting", "[cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome = run_with_page(folder, "report stability --quick --json");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  // What the default settings are known not to hold, by docs/stability.md.
  const std::set<std::string> known = {"B9", "B21 1e8 velocity-verlet", "B21 1e8 runge-kutta4",
                                       "C5 overlap", "C5 rest"};
  std::map<std::string, int> rows;
  const Json report = Json::parse(outcome.out);
  for (const Json& v : report["results"]) {
    const std::string id = v["id"];
    INFO(v.dump());
    ++rows[id];
    CHECK_FALSE(v["criterion"].get<std::string>().empty());
    CHECK_FALSE(v["group"].get<std::string>().empty());
    if (v["passed"] == true) {
      CHECK(v["lost_worlds"] == 0);
      CHECK(v["value"].get<double>() <= v["limit"].get<double>());
    } else if (v["setting"] == "default, f32") {
      CHECK(known.count(id) == 1);
    }
  }
  CHECK(rows.size() == 114);
  for (const auto& [id, settings] : rows) CHECK(settings == 3);
  CHECK(contains(content(folder.path() / "report" / "stability.html"), "pyramid spawned"));
}

TEST_CASE("report plan finds equal bits whatever was switched on", "[cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome =
      run_with_page(folder, "report plan --quick --scenes ball3d,stack10,chain2d,pyramid2d --json");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  std::map<std::string, int> variants;
  const Json report = Json::parse(outcome.out);
  for (const Json& row : report["results"]) {
    INFO(row.dump());
    ++variants[row["scene"]];
    CHECK(row["time_ratio"].get<double>() > 0);
    CHECK(row["world_steps_per_s"].get<double>() > 0);
    CHECK(row["bodies"].get<int>() > 0);
    if (row["must_be_same"]) CHECK(row["same_bits"] == true);
  }
  CHECK(variants.size() == 4);
  CHECK(contains(outcome.out, "the same in space"));
  CHECK(contains(outcome.out, "with a joint"));
  CHECK(variants["ball3d"] > 4);
  CHECK(contains(content(folder.path() / "report" / "plan.html"), "with friction"));
}

TEST_CASE("report throughput measures every sweep", "[cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome = run_with_page(folder, "report throughput --quick --scenes ball2d --json");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const Json results = Json::parse(outcome.out)["results"];
  CHECK(results["gigabytes_per_s"].get<double>() > 0);
  std::map<std::string, std::set<std::string>> hashes;
  for (const Json& row : results["rows"]) {
    INFO(row.dump());
    CHECK(row["world_steps_per_s"].get<double>() > 0);
    CHECK(row["bytes_per_world"].get<int>() > 0);
    hashes[row["sweep"]].insert(row["hash"]);
  }
  CHECK(hashes.size() == 4);
  CHECK(hashes["threads"].size() == 1);
  CHECK(hashes["instruction set and precision"].size() <= 2);  // one for each precision
  CHECK(report_in(content(folder.path() / "report" / "throughput.html"))["results"] == results);
}

TEST_CASE("report throughput compares with other engines and says which of them fail",
          "[cli][report]") {
  const ScratchFolder folder;
  // Says what it was asked for where settings go, and something of its own before the result. Its
  // balls are 4 mm in the ground in the first world and 1 m above it in the others.
  write_peer(folder, "peer_good", R"(
if [ "$1" = --list ]; then echo ball2d; exit; fi
echo 'hello from an engine'
poses=0,0.496,0.1
for world in $(seq 127); do poses="$poses,0.5,1.5,-2"; done
cat <<END
{"engine": "Good", "version": "1.2", "scene": "ball2d", "world_steps_per_s": 1000, \
"settings": "$*", "poses": [$poses]}
END
)");
  write_peer(folder, "peer_slow", R"(
if [ "$1" = --list ]; then echo ball2d; exit; fi
poses=0,1,0
for world in $(seq 127); do poses="$poses,0,1,0"; done
echo '{"engine": "Slow", "version": "3", "scene": "ball2d", "world_steps_per_s": 300, "poses": ['$poses]}
)");
  write_peer(folder, "peer_lost", R"(
if [ "$1" = --list ]; then echo ball2d; exit; fi
echo '{"engine": "Lost", "version": "1", "scene": "ball2d", "world_steps_per_s": 9, "poses": [1, 2]}'
)");
  write_peer(folder, "peer_bad", R"(
if [ "$1" = --list ]; then echo ball2d; exit; fi
printf 'it fell over\377\n' >&2
exit 3
)");
  write_peer(folder, "peer_dumb", "echo ball2d\n");
  write_peer(folder, "peer_gone", "kill -9 $$\n");
  write_peer(folder, "other", "exit 1\n");
  const Outcome outcome =
      run_with_page(folder, "report throughput --quick --scenes ball2d --peers peers --peers-only");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  const Json results =
      Json::parse(content(folder.path() / "report" / "throughput.json"))["results"];
  CHECK(results["rows"].empty());
  REQUIRE(results["peers"].size() == 1);
  const Json& scene = results["peers"][0];
  CHECK(scene["scene"] == "ball2d");
  CHECK(scene["worst_gap_m"].is_null());
  CHECK(scene["long_visit"].get<double>() > 0);
  REQUIRE(scene["engines"].size() == 2);
  const Json &good = scene["engines"][0], &slow = scene["engines"][1];
  CHECK(good["engine"] == "Good");
  CHECK(good["world_steps_per_s"] == 1000.0);
  CHECK(good["worst_overlap_m"].get<double>() == approx(0.004, 1e-6));
  CHECK(good["settings"] ==
        "--scenes ball2d --worlds 128 --warm-up 60 --steps 60 --visit 16 --poses");
  CHECK(good["ratio"].get<double>() > 1);
  CHECK(good["long_visit"]["world_steps_per_s"] == 1000.0);
  CHECK(slow["engine"] == "Slow");
  CHECK(slow["worst_overlap_m"] == 0.0);
  CHECK(slow["long_visit"].is_null());
  CHECK(results["peer_means"]["ratio"].get<double>() == Approx(good["ratio"].get<double>()));
  CHECK(results["peer_means"]["long_visit"].get<double>() ==
        Approx(good["long_visit"]["ratio"].get<double>()));
  const Json& failures = results["peer_failures"];
  REQUIRE(failures.size() == 4);
  CHECK(contains(failures[0], "peer_gone failed: --list: "));
  CHECK(failures[1] == "peer_bad failed: ball2d: exit status 3: it fell over?");
  CHECK(failures[2] == "peer_dumb failed: ball2d: it printed no result");
  CHECK(failures[3] ==
        "peer_lost failed: ball2d: its poses are 2 numbers, expected 384 (128 worlds of 1 bodies)");
  CHECK(contains(outcome.out, "Good 1.2"));
  CHECK(contains(outcome.out, "fastest engine of each scene, geometric mean: "));
  CHECK(contains(outcome.out, "peer_bad failed: "));
  CHECK(report_in(content(folder.path() / "report" / "throughput.html"))["results"] == results);
}

TEST_CASE("report throughput measures joint gaps where the engine's bodies are", "[cli][report]") {
  const ScratchFolder folder;
  // Chains as they start but for the last link, which is turned about its centre by half a turn:
  // its end is 1 m from where it is joined.
  write_peer(folder, "peer_turned", R"(
if [ "$1" = --list ]; then echo chain2d; echo chain3d; exit; fi
world=
for i in 0 1 2 3 4 5 6 7 8; do
  if [ $2 = chain2d ]; then world="$world$i.5,0,0,"; else world="$world$i.5,0,0,1,0,0,0,"; fi
done
if [ $2 = chain2d ]; then world="${world}9.5,0,3.14159265"; else world="${world}9.5,0,0,0,0,0,1"; fi
poses=$world
for i in $(seq 127); do poses="$poses,$world"; done
echo '{"engine": "Turned", "version": "1", "scene": "'$2'", "world_steps_per_s": 1, "poses": ['$poses]}
)");
  const Outcome outcome = run_with_page(
      folder, "report throughput --quick --scenes chain2d,chain3d --peers peers --peers-only");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  const Json results =
      Json::parse(content(folder.path() / "report" / "throughput.json"))["results"];
  CHECK(results["peer_failures"].empty());
  REQUIRE(results["peers"].size() == 2);
  for (const Json& scene : results["peers"]) {
    INFO(scene);
    REQUIRE(scene["engines"].size() == 1);
    CHECK(scene["engines"][0]["worst_overlap_m"].is_null());
    CHECK(scene["engines"][0]["worst_gap_m"].get<double>() == approx(1, 1e-5));
  }
}

TEST_CASE("a report without a page is its JSON, and says how the page is made", "[cli][report]") {
  const ScratchFolder folder;
  // Where no page was built beside it.
  const std::filesystem::path alone = folder / "bin" / "manyworlds";
  std::filesystem::create_directories(alone.parent_path());
  std::filesystem::copy_file(test::kProgram, alone);
  const std::string command = "report accuracy --quick --cases A1";
  const Outcome first = test::run_program(alone.string(), folder, command);
  INFO(first.err);
  CHECK(first.code == 0);
  CHECK(std::count(first.err.begin(), first.err.end(), '\n') == 1);
  CHECK(contains(first.err, "tools/viewer in the repository builds it"));
  CHECK(contains(first.err, "'manyworlds report page report/accuracy.json' then makes the page"));
  CHECK_FALSE(contains(first.out, "accuracy.html"));
  CHECK_FALSE(contains(first.err, "earlier"));
  const std::filesystem::path page = folder / "report" / "accuracy.html";
  CHECK_FALSE(std::filesystem::exists(page));
  const Json report = Json::parse(content(folder / "report" / "accuracy.json"));
  CHECK(report["results"][0]["id"] == "A1");

  // Makes it of what was measured then.
  const Outcome made = run_with_page(folder, "report page report/accuracy.json");
  INFO(made.err);
  CHECK(made.code == 0);
  CHECK(made.out == "report/accuracy.html\n");
  CHECK(report_in(content(page)) == report);
  CHECK(run_with_page(folder, "report page report/accuracy.json --out a/b").code == 0);
  CHECK(content(folder / "a" / "b" / "accuracy.html") == content(page));

  const Outcome again = test::run_program(alone.string(), folder, command);
  CHECK(contains(again.err, "report/accuracy.html is from an earlier report"));
  const Outcome none =
      test::run_program(alone.string(), folder, "report page report/accuracy.json");
  CHECK(none.code == 2);
  CHECK(contains(none.err, "report page: the page was not built with this program: tools/viewer"));
}

TEST_CASE("report page says what is no report and what is no page", "[fast][cli][report]") {
  const ScratchFolder folder;
  std::ofstream(folder / "list.json") << "[1, 2]";
  std::ofstream(folder / "other.json") << R"({"report": "weather", "results": []})";
  std::ofstream(folder / "half.json") << R"({"report": "plan", "res)";
  std::ofstream(folder / "plan.json") << R"({"report": "plan", "results": []})";
  std::ofstream(folder / "plan.html") << R"({"report": "plan", "results": []})";
  for (const auto& [arguments, message] : std::map<std::string, std::string>{
           {"none.json", "'none.json': no such file"},
           {".", "'.': is not a file"},
           {"list.json", "'list.json': is not a report; expected the JSON of report accuracy, "},
           {"plan.json other.json", "'other.json': is not a report"},
           {"half.json", "'half.json': is not a report"},
           {"plan.html", "'plan.html': its page would overwrite it"},
           {"plan.json --out list.json", "report page: cannot write 'list.json': is a file"}}) {
    INFO(arguments);
    const Outcome outcome = run_with_page(folder, "report page " + arguments);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, message));
  }
  for (const std::string command : {"report page plan.json", "report accuracy --quick"}) {
    CHECK(contains(test::run_program(test::kProgram, folder, command, "MANYWORLDS_REPORT=no").err,
                   "MANYWORLDS_REPORT is 'no', which is not a file"));
    CHECK(contains(
        test::run_program(test::kProgram, folder, command, "MANYWORLDS_REPORT=list.json").err,
        "'list.json': is not a page of this version; expected report.html as viewer/ builds it"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "report"));
}

TEST_CASE("report throughput says when a folder has no peers", "[fast][cli][report]") {
  const ScratchFolder folder;
  for (const char* name : {".", "nowhere"}) {
    const Outcome outcome = test::run_program(
        test::kProgram, folder, std::string("report throughput --quick --peers ") + name);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, std::string("--peers: ")));
    CHECK(contains(outcome.err, name));
  }
}

TEST_CASE("report says which cases there are", "[fast][cli][report]") {
  const ScratchFolder folder;
  const Outcome outcome =
      test::run_program(test::kProgram, folder, "report accuracy --cases A1,B7 --out here", "");
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "unknown case 'B7'; expected A1, A2"));
}

}  // namespace manyworlds

#endif
