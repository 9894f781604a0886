// The program among others: streams that are closed or full, locales, and what the environment
// lacks.
#if MW_HAVE_CLI

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/program_checks.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using test::check_one_line, test::contains, test::content, test::Outcome;

struct StreamsFolder : test::ProgramFolder {
  // With these redirections of a shell besides.
  Outcome redirected(const std::string& arguments, const std::string& how) const {
    return run(arguments, "sh -c '\"$0\" \"$@\" " + how + "'");
  }
};

const std::string kShortRun = "run ball3d --worlds 4 --steps 2 --threads 1";

}  // namespace

TEST_CASE("what is printed and does not arrive is an error", "[cli][streams]") {
  const StreamsFolder folder;
  const std::vector<std::string> commands = {
      "--help",
      "--version",
      "run --help",
      "scenes",
      "scenes --json",
      "info",
      "info --json",
      "plan ball3d",
      kShortRun,
      kShortRun + " --json",
      "soak ball3d --worlds 4 --steps 2",
      "bench --scenes ball3d --worlds 4 --steps 2 --warm-up 0 --repeats 1 --threads 1 --json",
      "verify --quick --scenes ball3d",
      "report accuracy --quick --cases A1"};
  for (const std::string& command : commands) {
    INFO(command);
    check_one_line(folder.redirected(command, ">/dev/full"), "cannot write to standard output");
  }
  check_one_line(folder.redirected("scenes", ">&-"),
                 "cannot write to standard output: Bad file descriptor");
  // An error stays the error that it is.
  check_one_line(folder.redirected("frobnicate", ">/dev/full"), "unknown command 'frobnicate'");
}

TEST_CASE("what is printed goes into no file that was opened in a closed stream's place",
          "[cli][streams]") {
  const StreamsFolder folder;
  if (!test::program_records()) return;
  for (const char* closed : {">&-", "2>&-", "<&-", "<&- >&- 2>&-"}) {
    INFO(closed);
    const bool unheard = contains(closed, " >&-") || closed[0] == '>';
    const Outcome run = folder.redirected(kShortRun + " --record run.h5", closed);
    CHECK(run.code == (unheard ? 2 : 0));
    const Outcome replay = folder.run("replay run.h5");
    CHECK(replay.code == 0);
    fs::remove(folder / "run.h5");
  }
}

TEST_CASE("errors that nobody hears end with their exit code", "[cli][streams]") {
  const StreamsFolder folder;
  for (const char* closed : {"2>&-", "2>/dev/full"}) {
    INFO(closed);
    CHECK(folder.redirected("frobnicate", closed).code == 2);
    const Outcome lost =
        folder.redirected("run free-flight --steps 2 --dt 1e12 --worlds 3 --json", closed);
    CHECK(lost.code == 1);
    CHECK(Json::parse(lost.out)["lost_worlds"] == 3);
  }
}

TEST_CASE("a reader that has seen enough ends the program quietly", "[cli][streams]") {
  const StreamsFolder folder;
  // By the signal, as other programs; where that is ignored, by an error. true reads nothing, and
  // the program waits until it has ended.
  const std::string wait = "; while [ ! -s code ]; do sleep 0.05; done";
  const auto piped = [&](const std::string& before) {
    return folder.run("scenes", "sh -c '" + before +
                                    "(sleep 0.2; \"$0\" \"$@\" 2>said; echo $? "
                                    ">code) | true" +
                                    wait + "'");
  };
  piped("");
  CHECK(content(folder / "code") == "141\n");
  CHECK(content(folder / "said").empty());
  fs::remove(folder / "code");
  piped("trap \"\" PIPE; ");
  CHECK(content(folder / "code") == "2\n");
  CHECK(content(folder / "said") == "manyworlds: cannot write to standard output: Broken pipe\n");
}

TEST_CASE("the environment changes neither numbers nor what is read", "[cli][streams]") {
  const StreamsFolder folder;
  const std::string job = kShortRun + " --dt 0.0125 --seed 7 --json";
  const Json plain = Json::parse(folder.run(job, "env -i").out);
  CHECK(plain["dt"] == 0.0125);
  // German writes 0,0125, Turkish has another capital of i; a locale that is not there is C.
  for (const char* environment :
       {"LC_ALL=de_DE.UTF-8", "LC_ALL=tr_TR.UTF-8", "LC_ALL=C.UTF-8", "TMPDIR=/no/such/folder",
        "HOME= TMPDIR=", "TMPDIR=/dev/full HOME=/no/such/home", "COLUMNS=1 TERM=dumb"}) {
    INFO(environment);
    const Outcome run = folder.run(job, std::string("env -i ") + environment);
    CHECK(run.code == 0);
    CHECK(run.err.empty());
    const Json json = Json::parse(run.out);
    CHECK(json["hash"] == plain["hash"]);
    CHECK(json["dt"] == plain["dt"]);
    CHECK(json["energy_j"] == plain["energy_j"]);
    check_one_line(folder.run("run ball3d --dt 0,0125", environment),
                   "--dt: must be a number, is '0,0125'");
  }
}

TEST_CASE("odd numbers are refused by the option's name, or mean what they say", "[cli][streams]") {
  const StreamsFolder folder;
  const char* const kWhole[] = {"--worlds",   "--steps",      "--steps-per-call",
                                "--substeps", "--iterations", "--threads"};
  const char* const kReal[] = {"--dt", "--seconds"};
  const char* const kOdd[] = {"1e999", "nan", "inf", "-inf", "0x10", "1_000", "''", "'  '", "'4 '",
                              "' 4'",  "+4",  "4.",  "٤",    "４",   "1e",    "--", "4,0",  "0b1"};
  for (const char* option : kWhole) {
    for (const char* number : kOdd) {
      INFO(option << ' ' << number);
      const Outcome outcome = folder.run(kShortRun + " " + option + "=" + number);
      CHECK(outcome.code == 2);
      check_one_line(outcome, std::string(option));
    }
    for (const char* number : {"99999999999999999999", "2147483648"}) {
      INFO(option << ' ' << number);
      check_one_line(folder.run(std::string("run ball3d ") + option + " " + number),
                     std::string(option) + ": must be at most ");
    }
    check_one_line(folder.run(std::string("run ball3d ") + option + "=-99999999999999999999"),
                   std::string(option) + ": must be at least ");
  }
  for (const char* option : kReal) {
    for (const char* number : {"1e999", "nan", "inf", "-inf", "0x10", "1_000", "' '", "'1 '",
                               "' 1'", "+1", "٤", "-0", "0", "1e-999", "1,5"}) {
      INFO(option << ' ' << number);
      check_one_line(folder.run(std::string("run ball3d ") + option + "=" + number),
                     std::string(option) + ": must be a ");
    }
  }
  for (const char* number : {"1e999", "-1", "18446744073709551616", "0x10", "' 1'"}) {
    INFO(number);
    check_one_line(folder.run(std::string("run ball3d --seed=") + number), "--seed: must be");
  }
  if (test::program_records()) {
    for (const char* number : {"1e999", "nan", "inf", "-1", "0x10", "' 1'", "1,5"}) {
      INFO(number);
      check_one_line(folder.run(kShortRun + " --record a.h5 --record-flush=" + number),
                     "--record-flush: must be a ");
    }
  }
  for (const char* option : {"--dt", "--seconds", "--seed", "--worlds"}) {
    check_one_line(folder.run(std::string("run ball3d ") + option + "=''"), option);
  }
  // Ten, not eight.
  const Json ten = Json::parse(folder.run("run ball3d --worlds 010 --steps 003 --json").out);
  CHECK(ten["worlds"] == 10);
  CHECK(ten["steps"] == 3);
}

}  // namespace manyworlds

#endif  // MW_HAVE_CLI
