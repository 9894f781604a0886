// Threads that cannot be started: an error that says how many may be had, and no crash.
#if MW_HAVE_CLI

#include <string>

#include <catch2/catch.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/sanitized.hpp"

#ifndef MW_SANITIZED  // sanitizers reserve terabytes of address space and start threads

namespace manyworlds {
namespace {

using test::contains, test::Outcome, test::ProgramFolder;

const std::string kRun = "run bin-boxes --worlds 64 --steps 4";

// It ends well, or by an error of one line.
void check_ends(const Outcome& outcome) {
  INFO(outcome.err);
  CHECK((outcome.code == 0 || outcome.code == 2));
  if (outcome.code == 0) return;
  CHECK(outcome.err.rfind("manyworlds: ", 0) == 0);
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
}

}  // namespace

TEST_CASE("more threads than the address space has room for are an error", "[cli][threads]") {
  const ProgramFolder folder;
  const Outcome refused = folder.run(kRun + " --threads 600", "ulimit -v 2000000;");
  CHECK(refused.code == 2);
  CHECK(contains(refused.err,
                 "manyworlds: --threads: 600 cannot be started, this process may "
                 "have "));
  CHECK(contains(refused.err, "ulimit -v"));
  for (const char* limit : {"100000", "200000", "400000", "800000", "1600000", "3200000"}) {
    for (const char* threads : {"0", "2", "16", "100", "600", "1024"}) {
      INFO(limit << " kB, " << threads << " threads");
      check_ends(
          folder.run(kRun + " --threads " + threads, std::string("ulimit -v ") + limit + ";"));
    }
  }
}

TEST_CASE("the n-th thread that cannot be started is an error, for every n", "[cli][threads]") {
  const ProgramFolder folder;
  for (int n = 1; n <= 9; ++n) {
    INFO("thread " << n);
    const std::string failing = std::string("LD_PRELOAD='") + test::kFailingThreads +
                                "' FAILING_THREAD=" + std::to_string(n);
    const Outcome outcome = folder.run(kRun + " --threads 8", failing);
    INFO(outcome.err);
    CHECK(outcome.code == (n <= 7 ? 2 : 0));
    if (n > 7) continue;
    CHECK(contains(outcome.err, "--threads: 8 cannot be started, this process may have " +
                                    std::to_string(n) + " "));
    // Without --threads it takes those that there are.
    CHECK(folder.run(kRun, failing).code == 0);
    check_ends(
        folder.run("bench --scenes ball2d --worlds 64 --steps 2 --warm-up 0 --repeats 1 "
                   "--threads 8",
                   failing));
  }
}

}  // namespace manyworlds

#endif  // MW_SANITIZED
#endif  // MW_HAVE_CLI
