// What the program writes is whole or not there, and what ends it early loses nothing.
#if MW_HAVE_CLI

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using test::contains, test::content, test::Outcome;

struct Folder : test::ProgramFolder {
  std::vector<std::string> parts() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path())) {
      if (contains(entry.path().filename().string(), ".part-")) found.push_back(entry.path());
    }
    return found;
  }
};

bool records(const Folder& folder) { return contains(folder.run("info").out, "recordings   yes"); }

void check_one_line(const Outcome& outcome, const std::string& message) {
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, message));
  CHECK(outcome.err.rfind("manyworlds: ", 0) == 0);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

// The program in the background, with the signals that a shell in the foreground gives it.
class Running {
 public:
  Running(const Folder& folder, const std::vector<std::string>& arguments) : folder_(folder) {
    process_ = fork();
    if (process_ != 0) return;
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_DFL);
    const auto open_as = [&](const char* name, int number) {
      dup2(open((folder.path() / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), number);
    };
    open_as("out", 1), open_as("err", 2);
    std::vector<const char*> words = {test::kProgram};
    for (const std::string& word : arguments) words.push_back(word.c_str());
    words.push_back(nullptr);
    if (chdir(folder.path().c_str()) == 0) {
      execv(test::kProgram, const_cast<char* const*>(words.data()));
    }
    std::_Exit(127);
  }
  ~Running() {
    if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Waits until it notes signals, so that one that is sent does not end it.
  bool is_ready() const {
    return wait_until([&] {
      // Before it is started it is this program, which notes signals, too.
      std::error_code gone;
      const fs::path runs = fs::read_symlink("/proc/" + std::to_string(process_) + "/exe", gone);
      if (gone || runs != fs::canonical(test::kProgram)) return false;
      std::istringstream status(content("/proc/" + std::to_string(process_) + "/status"));
      for (std::string line; std::getline(status, line);) {
        if (line.rfind("SigCgt:", 0) != 0) continue;
        return (std::stoull(line.substr(7), nullptr, 16) >> (SIGTERM - 1) & 1) != 0;
      }
      return false;
    });
  }
  static bool wait_until(const std::function<bool()>& so) {
    for (int i = 0; i < 6000; ++i) {
      if (so()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  // Its exit code; 128 and the signal where one ended it.
  Outcome end(int number) {
    kill(process_, number);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    return {code, content(folder_ / "out"), content(folder_ / "err")};
  }

 private:
  const Folder& folder_;
  pid_t process_ = -1;
};

}  // namespace

TEST_CASE("the program writes over nothing but files", "[cli][files]") {
  const Folder folder;
  if (records(folder)) {
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
  const Folder folder;
  const std::string limit = "ulimit -f 4000;";  // 2 MB: reached after some samples
  const char* why = "the file would be larger than this process may write (ulimit -f)";
  if (records(folder)) {
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
  const Folder folder;
  const bool recorded = records(folder);
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
  const Folder folder;
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
  const Folder folder;
  if (!records(folder)) return;
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
        "manyworlds: note: left by a run that was cut off: manyworlds replay " + part + "\n");
  CHECK(folder.parts().size() == 1);
  // Dumps of lost worlds look, too.
  fs::create_directories(folder / "lost");
  const std::string left = "lost/world_3.h5.part-0123456789abcdef";
  std::ofstream(folder / left) << "";
  CHECK(contains(folder.run("soak ball3d --worlds 2 --steps 2 --dump-lost lost").err, left));
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
