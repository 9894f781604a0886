// The program manyworlds, run as its users run it: exit codes, what goes to which stream, JSON.
// over 400 lines because it is the one list of what the program says.
#if MW_HAVE_CLI

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using test::contains, test::content, test::Outcome, test::ScratchFolder;

Outcome run(const std::string& arguments, const std::string& environment = "") {
  return test::run_program(test::kProgram, ScratchFolder(), arguments, environment);
}

std::set<std::string> keys(const Json& object) {
  std::set<std::string> names;
  for (const auto& item : object.items()) names.insert(item.key());
  return names;
}

const std::set<std::string>& report_keys() {
  static const std::set<std::string> names = {"scene",
                                              "worlds",
                                              "steps",
                                              "steps_per_call",
                                              "threads",
                                              "isa",
                                              "iterations",
                                              "precision",
                                              "solver",
                                              "dt",
                                              "substeps",
                                              "sleep",
                                              "awake_fraction",
                                              "world_steps_per_s",
                                              "body_steps_per_s",
                                              "contacts_per_world",
                                              "max_penetration_m",
                                              "max_joint_gap_m",
                                              "energy_j",
                                              "bytes_per_world",
                                              "lost_worlds",
                                              "diverged_worlds",
                                              "stage_split",
                                              "hash"};
  return names;
}

// The hash that the library itself computes for the job.
std::string library_hash(const char* scene, int worlds, int steps, std::uint64_t seed) {
  BatchOptions options;
  options.worlds = worlds;
  options.seed = seed;
  Batch batch(compile(scenes::find(scene)->make()), options);
  batch.step(steps);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(batch.hash()));
  return text;
}

TEST_CASE("the program explains itself and lists every scene", "[cli]") {
  const Outcome help = run("--help");
  CHECK(help.code == 0);
  CHECK(help.err.empty());
  for (const char* command :
       {"scenes", "run", "plan", "model", "bench", "verify", "soak", "replay", "info"}) {
    CHECK(contains(help.out, command));
    const Outcome detail = run(std::string(command) + " --help");
    CHECK(detail.code == 0);
    CHECK(contains(detail.out, "Example"));
  }

  const Outcome list = run("scenes");
  CHECK(list.code == 0);
  for (const scenes::Entry& entry : scenes::all()) {
    CHECK(contains("\n" + list.out, std::string("\n") + entry.name + " "));
  }
  CHECK(std::count(list.out.begin(), list.out.end(), '\n') ==
        static_cast<std::ptrdiff_t>(scenes::all().size()));
}

TEST_CASE("bad input ends with exit code 2, one line that names it, and no output", "[cli]") {
  struct Bad {
    const char* arguments;
    const char* message;  // part of the line
  };
  const Bad cases[] = {
      {"", "missing command; expected one of scenes, "},
      {"frobnicate", "unknown command 'frobnicate'"},
      {"run", "scene is required"},
      {"rum", "unknown command 'rum'; did you mean 'run'?"},
      {"report foo",
       "unknown report 'foo'; expected one of accuracy, stability, invariants, plan, "
       "throughput"},
      {"report", "missing report; expected one of accuracy, "},
      {"run ball3d --world 5", "unknown option '--world'; did you mean '--worlds'? (see"},
      {"run ball3d --world=5", "unknown option '--world'; did you mean '--worlds'? (see"},
      {"run ball3d --qwertyuiop", "unknown option '--qwertyuiop' (see 'manyworlds run --help')"},
      {"report plan --quik", "did you mean '--quick'? (see 'manyworlds report plan --help')"},
      {"run qwertyuiop", "unknown scene 'qwertyuiop' ('manyworlds scenes' lists all)"},
      {"run bin-boxen", "unknown scene 'bin-boxen'; did you mean 'bin-boxes'?"},
      {"plan stack1", "did you mean 'stack10'?"},
      {"soak bal3d", "did you mean 'ball3d'?"},
      {"bench --scenes ball3d,bin-shperes", "did you mean 'bin-spheres'?"},
      {"verify --scenes domina", "did you mean 'domino'?"},
      {"run ball3d --worlds 0", "--worlds: must be at least 1, is 0"},
      {"run ball3d --worlds -4", "--worlds: must be at least 1, is -4"},
      {"run ball3d --worlds 1e3", "--worlds: must be a whole number, is '1e3'"},
      {"run ball3d --worlds 99999999999", "--worlds: must be at most 2147483647"},
      {"run ball3d --steps 0", "--steps: must be at least 1, is 0"},
      {"run ball3d --seconds 0", "--seconds: must be a finite number above 0, is 0"},
      {"run ball3d --seconds inf", "--seconds: must be a finite number above 0, is inf"},
      {"run ball3d --seconds 1e300", "--seconds: 1e+300 s at dt"},
      {"run ball3d --seconds 1 --steps 4", "excludes"},
      {"run ball3d --dt nan", "--dt: must be a finite number above 0, is nan"},
      {"run ball3d --dt 0", "--dt: must be a finite number above 0, is 0"},
      {"run ball3d --dt -0.01", "--dt: must be a finite number above 0, is -0.01"},
      {"run ball3d --dt 0.01x", "--dt: must be a number, is '0.01x'"},
      {"run ball3d --substeps 0", "--substeps: must be at least 1, is 0"},
      {"run ball3d --substeps 65", "--substeps: must be at most 64, is 65"},
      {"run ball3d --threads -1", "--threads: must be at least 0, is -1"},
      {"run ball3d --threads 100000", "--threads: must be at most 1024, is 100000"},
      {"run ball3d --seed -1", "--seed: must be a whole number from 0 to 2^64 - 1, is '-1'"},
      {"run ball3d --precision f16", "--precision: must be f32 or f64, is 'f16'"},
      {"run ball3d --isa neon", "--isa: must be scalar, avx2 or avx512, is 'neon'"},
      {"run ball3d --layout columns", "--layout: must be auto, dense or rows, is 'columns'"},
      {"run ball3d --broad-phase tree",
       "must be auto, all-pairs, sort-and-sweep or sparse, is 'tree'"},
      {"run ball3d --keep contactz", "--keep: must be orientation, "},
      {"run ball3d --json --frobnicate", "--frobnicate"},
      {"bench --repeats 0", "--repeats: must be at least 1, is 0"},
      {"run no/such/file.xml", "no/such/file.xml: no such file"},
      {"run /", "/: is a directory; expected a file"},
  };
  for (const Bad& bad : cases) {
    INFO("manyworlds " << bad.arguments);
    const Outcome outcome = run(bad.arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, bad.message));
    CHECK(outcome.err.rfind("manyworlds: ", 0) == 0);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  }
}

TEST_CASE("more worlds than the machine can hold are refused", "[cli]") {
  const Outcome outcome = run("run bin-boxes --worlds 2147483647 --json");
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "--worlds: 2147483647 worlds of 'bin-boxes' need "));
  CHECK(contains(outcome.err, " GB of memory, the machine has "));
}

TEST_CASE("an unknown instruction set in the environment is bad input", "[cli]") {
  for (const char* command : {"run ball3d --worlds 1 --steps 1", "info"}) {
    const Outcome outcome = run(command, "MANYWORLDS_ISA=avx1024");
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, "avx1024"));
  }
}

TEST_CASE("a cut XML file is bad input", "[cli]") {
  const ScratchFolder folder;
  const fs::path file = folder / "cut.xml";
  std::ofstream(file) << "<mujoco><worldbody><body pos=\"0 0 1\"><freejoint/><geom type=\"sph";
  const Outcome info = run("info");
  const Outcome outcome = run("run '" + file.string() + "' --json");
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(contains(outcome.err, "cut.xml"));
  const bool reads_mjcf = std::regex_search(info.out, std::regex("mjcf +yes"));
  CHECK(contains(outcome.err, "built without MJCF") == !reads_mjcf);
}

TEST_CASE("run tells how far joints have come apart", "[cli]") {
  for (const char* scene : {"chain2d", "chain3d", "car2d"}) {
    const std::string job = std::string("run ") + scene + " --worlds 8 --steps 60 --threads 1";
    const Json json = Json::parse(run(job + " --json").out);
    CHECK(json["max_joint_gap_m"].get<double>() > 1e-6);
    CHECK(json["max_joint_gap_m"].get<double>() < 0.05);
    CHECK(run(job).out.find("joint gap") != std::string::npos);
  }
}

TEST_CASE("run --json prints exactly the documented keys", "[cli]") {
  const Outcome outcome = run("run ball3d --worlds 64 --steps 30 --seed 5 --threads 1 --json");
  REQUIRE(outcome.code == 0);
  CHECK(outcome.err.empty());
  const Json json = Json::parse(outcome.out);
  CHECK(keys(json) == report_keys());
  CHECK(json["scene"] == "ball3d");
  CHECK(json["worlds"] == 64);
  CHECK(json["steps"] == 30);
  CHECK(json["threads"] == 1);
  CHECK(json["precision"] == "f32");
  CHECK(json["solver"] == "tgs-soft");
  CHECK(json["sleep"] == false);
  CHECK(json["substeps"] == 4);
  CHECK(json["dt"].get<double>() == Approx(1.0 / 60));
  CHECK(json["lost_worlds"] == 0);
  CHECK(json["max_joint_gap_m"] == 0.0);
  CHECK(json["world_steps_per_s"].get<double>() > 0);
  CHECK(json["body_steps_per_s"].get<double>() ==
        Approx(json["world_steps_per_s"].get<double>()));  // one body
  CHECK(json["bytes_per_world"].get<double>() > 0);
  double shares = 0;
  for (const auto& share : json["stage_split"]) shares += share.get<double>();
  CHECK(shares == Approx(1.0));
  CHECK(json["hash"] == library_hash("ball3d", 64, 30, 5));
}

TEST_CASE("run and bench let worlds fall asleep on request", "[cli]") {
  const Json slept =
      Json::parse(run("run pyramid2d --worlds 16 --seconds 4 --sleep on --json").out);
  CHECK(slept["sleep"] == true);
  CHECK(slept["awake_fraction"] == 0.0);
  CHECK(contains(run("run pyramid2d --worlds 16 --seconds 4 --sleep on").out, "0.0 % of worlds"));
  const Json both =
      Json::parse(run("bench --scenes pyramid2d --worlds 16 --steps 240 --repeats 1 --threads 1 "
                      "--steps-per-call 1 --sleep both --json")
                      .out);
  REQUIRE(both.size() == 2);
  CHECK(both[0]["sleep"] == false);
  CHECK(both[0]["awake_fraction"] == 1.0);
  CHECK(both[1]["sleep"] == true);
  CHECK(both[1]["awake_fraction"] == 0.0);
  const Outcome bad = run("run pyramid2d --sleep maybe");
  CHECK(bad.code == 2);
  CHECK(contains(bad.err, "--sleep: must be off or on, is 'maybe'"));
}

TEST_CASE("how a job is cut into calls, threads and layouts does not change its hash", "[cli]") {
  const std::string job = "run bin-boxes --worlds 24 --json --seed 3 ";
  const Json one = Json::parse(run(job + "--steps 60 --steps-per-call 1 --threads 1").out);
  for (const char* way :
       {"--steps 60 --steps-per-call 7", "--seconds 1 --threads 2", "--steps 60 --layout dense",
        "--steps 60 --layout rows --isa scalar", "--steps 60 --broad-phase sort-and-sweep"}) {
    INFO(way);
    const Json other = Json::parse(run(job + way).out);
    CHECK(other["hash"] == one["hash"]);
    CHECK(other["steps"] == 60);
  }
  const Json double_precision = Json::parse(run(job + "--steps 60 --precision f64").out);
  CHECK(double_precision["precision"] == "f64");
  CHECK(double_precision["hash"] != one["hash"]);
}

TEST_CASE("run prints a summary for people", "[cli]") {
  const Outcome outcome = run("run bin-spheres --worlds 8 --seconds 0.5 --dt 0.01 --substeps 2");
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "bin-spheres: 8 worlds x 50 steps, 0.5 s simulated each"));
  CHECK(contains(outcome.out, "dt 0.01 s, 2 substeps"));
  for (const char* row : {"speed", "contacts", "penetration", "energy", "lost worlds", "hash"}) {
    CHECK(contains(outcome.out, std::string("\n  ") + row));
  }
}

TEST_CASE("plan tells what is in and what is out, and --keep brings it back", "[cli]") {
  const auto feature = [](const Json& plan, const std::string& name) {
    for (const auto& item : plan["features"]) {
      if (item["name"] == name) return item["in"].get<bool>();
    }
    FAIL("no feature " << name);
    return false;
  };
  const Json plain = Json::parse(run("plan free-flight --json").out);
  CHECK_FALSE(feature(plain, "contacts"));
  const Json kept = Json::parse(run("plan free-flight --json --keep contacts --keep drag").out);
  CHECK(feature(kept, "contacts"));
  CHECK(feature(kept, "drag"));

  const Outcome text = run("plan bin-boxes");
  CHECK(text.code == 0);
  for (const char* part :
       {"features", "stages", "pairs of shapes", "arrays", "capacity", "box-box"})
    CHECK(contains(text.out, part));
}

TEST_CASE("bench measures both kinds of call and ends all runs in the same hash", "[cli]") {
  const Outcome outcome =
      run("bench --scenes ball3d,ball2d --worlds 16 --steps 20 --warm-up 5 --repeats 2 --threads 2 "
          "--json");
  REQUIRE(outcome.code == 0);
  const Json list = Json::parse(outcome.out);
  REQUIRE(list.size() == 8);  // 2 scenes x 2 thread counts x 2 kinds of call
  for (const Json& report : list) {
    CHECK(keys(report) == report_keys());
    CHECK(report["steps"] == 20);
    CHECK(report["hash"] == library_hash(report["scene"].get<std::string>().c_str(), 16, 25, 0));
  }
  CHECK(list[0]["steps_per_call"] == 1);
  CHECK(list[1]["steps_per_call"] == 16);
  CHECK(list[0]["threads"] == 1);
  CHECK(list[2]["threads"] == 2);

  const Outcome table = run("bench --scenes ball3d --worlds 16 --steps 20 --repeats 1 --threads 1");
  CHECK(table.code == 0);
  CHECK(contains(table.out, "step(16)"));
  CHECK(contains(table.out, library_hash("ball3d", 16, 80, 0)));
}

TEST_CASE("verify finds equal bits and says what it compared", "[cli]") {
  const Outcome outcome = run("verify --quick --scenes ball3d,bin2d");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(contains(outcome.out, "comparisons equal"));
  for (const char* what :
       {"alone", "position", "size", "threads", "kernels", "masks", "saved", "frozen"}) {
    CHECK(contains(outcome.out, what));
  }
}

TEST_CASE("verify drives robots by random controls", "[cli]") {
  const Outcome outcome = run("verify --quick --scenes pendulum");
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "comparisons equal"));
  // Which broad phase and layout there is means nothing to them.
  CHECK(std::regex_search(outcome.out, std::regex("pendulum +f32( +[0-9]+){4} +-( +[0-9]+){5}")));
  // Without controls, all worlds would be the one that has no jitter.
  const auto hash_of_all = [](const std::string& out) { return out.substr(out.find("f32")); };
  const Outcome other = run("verify --quick --scenes pendulum --seed 2");
  CHECK(hash_of_all(other.out) != hash_of_all(outcome.out));
}

TEST_CASE("bench drives robots, and has one hash for all its calls", "[cli]") {
  const std::string job = "bench --scenes hopper --worlds 20 --steps 40 --repeats 1 --json";
  const Outcome outcome = run(job + " --threads 1");
  REQUIRE(outcome.code == 0);
  const Json list = Json::parse(outcome.out);
  REQUIRE(list.size() == 2);
  CHECK(list[0]["hash"] == list[1]["hash"]);
  CHECK(list[0]["hash"] != library_hash("hopper", 20, 100, 0));
  // 60 steps of warm-up, then those that are timed.
  const Outcome again = run("run hopper --worlds 20 --steps 100 --random-controls --json");
  CHECK(Json::parse(again.out)["hash"] == list[0]["hash"]);
}

TEST_CASE("random controls lose no lost world", "[cli]") {
  const std::string job = "soak ant --worlds 3 --seed 6 --steps 600 --random-controls";
  CHECK(run(job).code == 0);
  const Outcome outcome = run(job + " --dt 0.5");
  CHECK(outcome.code == 1);
  CHECK(std::regex_search(outcome.out, std::regex("lost worlds +3\n")));
  const std::regex command("world 1 lost \\([^)]*\\): manyworlds (run ant .*)\n");
  std::smatch match;
  REQUIRE(std::regex_search(outcome.err, match, command));
  CHECK(contains(match[1], "--random-controls"));
  CHECK(run(match[1]).code == 1);

  const Outcome none = run("run ball3d --random-controls");
  CHECK(none.code == 2);
  CHECK(contains(none.err, "'ball3d' has no controls"));
}

TEST_CASE("soak counts the lost and prints its seed", "[cli]") {
  const Outcome fixed = run("soak ball3d --worlds 1500 --steps 20 --seed 9");
  CHECK(fixed.code == 0);
  CHECK(contains(fixed.out, "1500 worlds x 20 steps, seed 9"));
  CHECK(std::regex_search(fixed.out, std::regex("lost worlds +0\n")));
  const std::regex seed("seed ([0-9]+)");
  std::smatch first;
  std::smatch second;
  const std::string one = run("soak ball3d --worlds 2 --steps 1").out;
  const std::string two = run("soak ball3d --worlds 2 --steps 1").out;
  REQUIRE(std::regex_search(one, first, seed));
  REQUIRE(std::regex_search(two, second, seed));
  CHECK(first[1] != second[1]);
}

TEST_CASE("worlds that gain energy from nothing end with exit code 1", "[cli]") {
  // A heavy ball on a light chain wants more than a sweep.
  const std::string job =
      "run ball-and-chain --solver sequential-impulse --worlds 8 --steps 200 --json ";
  const Outcome outcome = run(job + "--iterations 1 --audit-every 1");
  CHECK(outcome.code == 1);
  CHECK(Json::parse(outcome.out)["diverged_worlds"] > 0);
  CHECK(Json::parse(outcome.out)["lost_worlds"] == 0);
  CHECK(contains(outcome.err, "flagged (diverged): manyworlds run ball-and-chain"));
  CHECK(contains(outcome.err, "--audit-every 1"));
  const Outcome silent = run(job + "--iterations 1 --audit-every 0");
  CHECK(silent.code == 0);
  CHECK(Json::parse(silent.out)["hash"] == Json::parse(outcome.out)["hash"]);
}

TEST_CASE("a lost world ends with exit code 1 and the command that shows it again", "[cli]") {
  // Bodies that fly at about 1 m/s leave the range of 1e10 m in one such step.
  const std::string job = "run free-flight --steps 2 --dt 1e12 ";
  const Outcome outcome = run(job + "--worlds 12 --seed 40 --json");
  CHECK(outcome.code == 1);
  CHECK(Json::parse(outcome.out)["lost_worlds"] == 12);
  CHECK(contains(outcome.err, "world 0 lost ("));
  CHECK(contains(outcome.err, "world 9 lost ("));
  CHECK_FALSE(contains(outcome.err, "world 10 lost"));
  CHECK(contains(outcome.err, "and 2 more of them"));

  const std::regex command("world 7 lost \\([^)]*\\): manyworlds (run free-flight .*)\n");
  std::smatch match;
  REQUIRE(std::regex_search(outcome.err, match, command));
  CHECK(contains(match[1], "--worlds 1 --seed 47 --steps 2"));
  CHECK(run(match[1]).code == 1);

  CHECK(run("soak free-flight --worlds 3 --steps 2 --dt 1e12 --seed 1").code == 1);
}

TEST_CASE("help tells of sizes of scenes, MW_ISAS, and each report's examples", "[cli]") {
  const Outcome help = run("--help");
  CHECK(contains(help.out, "bin-boxes:1000"));
  CHECK(contains(help.out, "MW_ISAS"));
  CHECK(contains(run("run --help").out, "bin-boxes:1000"));
  for (const char* report : {"accuracy", "stability", "invariants", "plan", "throughput"}) {
    const std::string command = std::string("report ") + report;
    CHECK(contains(run(command + " --help").out, "manyworlds " + command + " --quick"));
  }
}

TEST_CASE("info --json tells machines what info tells people", "[cli]") {
  const Outcome outcome = run("info --json");
  REQUIRE(outcome.code == 0);
  const Json json = Json::parse(outcome.out);
  CHECK(keys(json) == std::set<std::string>{"manyworlds", "compiler", "cpu", "threads", "isas",
                                            "isa", "mjcf", "recordings"});
  CHECK(json["isa"] == to_string(default_isa()));
}

TEST_CASE("replay says in a line what it cannot read, and hangs on nothing", "[cli]") {
  if (!contains(run("info").out, "recordings   yes")) return;
  for (const char* file :
       {"/dev/null", "/", "none.h5", "/dev/null/x", "'../../../../../etc/passwd/x'"}) {
    const Outcome outcome = run(std::string("replay ") + file);
    INFO(file << ": " << outcome.err);
    CHECK(outcome.code == 2);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK_FALSE(contains(outcome.err, "filesystem error"));
  }
}

TEST_CASE("info names the machine and the build", "[cli]") {
  const Outcome outcome = run("info");
  CHECK(outcome.code == 0);
  for (const char* row :
       {"manyworlds", "compiler", "cpu", "threads", "isa", "precision", "mjcf", "recordings"}) {
    CHECK(contains("\n" + outcome.out, std::string("\n") + row));
  }
  CHECK(contains(outcome.out, to_string(default_isa())));
}

}  // namespace
}  // namespace manyworlds

#endif  // MW_HAVE_CLI
