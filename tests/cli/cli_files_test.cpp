// What the program writes is whole or not there, and what ends it early loses nothing.
#if MW_HAVE_CLI

#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/program_checks.hpp"
#include "tests/support/running.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using test::check_one_line, test::contains, test::content, test::Outcome, test::Running;

struct FilesFolder : test::ProgramFolder {
  std::vector<std::string> parts() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path())) {
      if (contains(entry.path().filename().string(), ".part-")) found.push_back(entry.path());
    }
    return found;
  }
};

}  // namespace

TEST_CASE("the program writes over nothing but files", "[cli][files]") {
  const FilesFolder folder;
  if (test::program_records()) {
    const std::string run = "run ball3d --worlds 4 --steps 2 --record ";
    check_one_line(folder.run(run + "/dev/null"), "'/dev/null': is a device, not a file");
    CHECK(fs::is_character_file("/dev/null"));
    REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
    check_one_line(folder.run(run + "fifo"), "'fifo': is a FIFO, not a file");
    CHECK(fs::is_fifo(folder / "fifo"));
    fs::create_symlink("target.h5", folder / "link.h5");
    CHECK(folder.run(run + "link.h5").code == 0);
    CHECK(fs::is_symlink(folder / "link.h5"));
    CHECK(folder.run("replay target.h5").code == 0);
  }
  fs::create_directories(folder / "report");
  REQUIRE(mkfifo((folder / "report" / "accuracy.json").c_str(), 0600) == 0);
  check_one_line(folder.run("report accuracy --quick --cases A1"),
                 "--out: cannot write 'report/accuracy.json': is a FIFO, not a file");
  CHECK_FALSE(fs::exists(folder / "report" / "accuracy.html"));
}

// A file of more blocks than `ulimit -f` brings SIGXFSZ.
TEST_CASE("where a file may not grow the program says so, and ends by no signal", "[cli][files]") {
  const FilesFolder folder;
  const std::string limit = "ulimit -f 4000;";  // 2 MB: reached after some samples
  const char* why = "the file would be larger than this process may write (ulimit -f)";
  if (test::program_records()) {
    const Outcome run =
        folder.run("run bin-boxes --worlds 64 --steps 60 --record run.h5 --json", limit);
    check_one_line(run, std::string("'run.h5': ") + why);
    CHECK(Json::parse(run.out)["steps"] == 60);  // the work itself is not lost
    CHECK_FALSE(fs::exists(folder / "run.h5"));
  }
  std::ofstream(folder / "old") << "old";
  fs::create_directories(folder / "report");
  std::ofstream(folder / "report" / "accuracy.json") << "old";
  check_one_line(folder.run("report accuracy --quick --cases A1 --out report", "ulimit -f 1;"),
                 why);
  CHECK(content(folder / "report" / "accuracy.json") == "old");
  CHECK_FALSE(fs::exists(folder / "report" / "accuracy.html"));
  CHECK(folder.parts().empty());
}

TEST_CASE("an interrupted run sums up, and its recording replays", "[cli][files]") {
  const FilesFolder folder;
  const bool recorded = test::program_records();
  std::vector<std::string> job = {"run",     "ball3d",     "--worlds", "64",
                                  "--steps", "2000000000", "--json"};
  if (recorded) job.insert(job.end(), {"--record", "run.h5", "--record-every", "1000"});
  for (const int number : {SIGINT, SIGTERM}) {
    Running running(folder, job);
    REQUIRE(running.is_ready());
    const Outcome outcome = running.end(number);
    INFO(outcome.err);
    CHECK(outcome.code == 128 + number);
    const Json json = Json::parse(outcome.out);
    CHECK(json["interrupted"] == (number == SIGINT ? "SIGINT" : "SIGTERM"));
    CHECK(contains(outcome.err, "after " + json["steps"].dump() + " of "));
    CHECK(folder.parts().empty());
    if (recorded) CHECK(folder.run("replay run.h5").code == 0);
  }
}

TEST_CASE("interrupted soaks, benches and reports tell what was done", "[cli][files]") {
  const FilesFolder folder;
  {
    Running soak(folder, {"soak", "ball3d", "--worlds", "8", "--steps", "2000000000"});
    REQUIRE(soak.is_ready());
    const Outcome outcome = soak.end(SIGINT);
    CHECK(outcome.code == 130);
    CHECK(contains(outcome.out, "lost worlds"));
    CHECK(contains(outcome.err, "interrupted by SIGINT after 0 of 8 worlds"));
  }
  {
    Running bench(folder, {"bench", "--scenes", "ball3d", "--worlds", "8", "--steps", "2000000000",
                           "--json"});
    REQUIRE(bench.is_ready());
    const Outcome outcome = bench.end(SIGTERM);
    CHECK(outcome.code == 143);
    CHECK(Json::parse(outcome.out).back()["interrupted"] == "SIGTERM");
  }
  {
    fs::create_directories(folder / "report");
    std::ofstream(folder / "report" / "accuracy.json") << "old";
    Running report(folder, {"report", "accuracy", "--json"});
    REQUIRE(report.is_ready());
    const Outcome outcome = report.end(SIGINT);
    CHECK(outcome.code == 130);
    CHECK(Json::parse(outcome.out)["interrupted"] == "SIGINT");
    CHECK(contains(outcome.err, "report/accuracy.json "));
    CHECK(contains(outcome.err, " not written"));
    CHECK(content(folder / "report" / "accuracy.json") == "old");
    CHECK_FALSE(fs::exists(folder / "report" / "accuracy.html"));
  }
}

TEST_CASE("what a killed run had recorded is found by the next, and replays", "[cli][files]") {
  const FilesFolder folder;
  if (!test::program_records()) return;
  {
    Running running(folder, {"run", "ball3d", "--worlds", "64", "--steps", "2000000000", "--record",
                             "run.h5", "--record-every", "64", "--record-flush", "0"});
    REQUIRE(Running::wait_until([&] {
      const auto parts = folder.parts();
      return !parts.empty() && contains(content(parts[0]).substr(0, 8), "MWPART");
    }));
    CHECK(running.end(SIGKILL).code == 1000 + SIGKILL);
  }
  CHECK_FALSE(fs::exists(folder / "run.h5"));
  REQUIRE(folder.parts().size() == 1);
  const std::string part = fs::path(folder.parts()[0]).filename();
  CHECK(folder.run("replay " + part).code == 0);
  const Outcome next = folder.run("run ball3d --worlds 4 --steps 2 --record run.h5");
  CHECK(next.code == 0);
  CHECK(next.err ==
        "manyworlds: note: an interrupted run left a recording: manyworlds replay " + part + "\n");
  CHECK(folder.parts().size() == 1);
  // Dumps of lost worlds look, too.
  fs::create_directories(folder / "lost");
  const std::string left = "lost/world_3.h5.part-0123456789abcdef";
  std::ofstream(folder / left) << "";
  CHECK(contains(folder.run("soak ball3d --worlds 2 --steps 2 --dump-lost lost").err, left));
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
