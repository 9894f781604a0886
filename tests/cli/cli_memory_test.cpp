// The address space ends (ulimit -v), wherever the program is by then: an error, no crash. HDF5
// does not survive an allocation that fails, so that its calls must not come to one.
#if MW_HAVE_CLI

#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/sanitized.hpp"

#ifndef MW_SANITIZED  // those need an address space of terabytes

namespace manyworlds {
namespace {

using test::contains, test::Outcome, test::ProgramFolder;

Outcome limited(const ProgramFolder& folder, const std::string& arguments, int kilobytes) {
  return folder.run(arguments, "ulimit -v " + std::to_string(kilobytes) + ";");
}

// The least that the program starts with: less, and the loader gives up.
int least_to_start(const ProgramFolder& folder) {
  int low = 0, high = 1 << 21;
  while (high - low > 64) {
    const int middle = (low + high) / 2;
    (limited(folder, "--version", middle).code == 0 ? high : low) = middle;
  }
  return high;
}

}  // namespace

TEST_CASE("recordings are written and read, or refused, wherever the address space ends",
          "[cli][memory]") {
  const ProgramFolder folder;
  if (!contains(folder.run("info").out, "recordings   yes")) return;
  REQUIRE(folder.run("run ball3d --worlds 2 --steps 3 --threads 1 --record good.h5").code == 0);
  const int least = least_to_start(folder);
  for (const std::string command :
       {"replay good.h5 --threads 1",
        "run ball3d --worlds 2 --steps 3 --threads 1 --record run.h5 --record-flush 0"}) {
    int refused = 0, done = 0;
    for (int more = 256; more < (20 << 10); more += 256) {
      const Outcome outcome = limited(folder, command, least + more);
      INFO(command << " with " << least << " + " << more << " kB: " << outcome.err);
      CHECK((outcome.code == 0 || outcome.code == 2));
      refused += outcome.code == 2 ? 1 : 0;
      done += outcome.code == 0 ? 1 : 0;
      if (outcome.code != 2) continue;
      CHECK(outcome.err.rfind("manyworlds: ", 0) == 0);
      CHECK(contains(outcome.err, "memory"));
      CHECK_FALSE(std::filesystem::exists(folder / "run.h5"));
    }
    INFO(command);
    CHECK(refused > 0);
    CHECK(done > 0);
    std::filesystem::remove(folder / "run.h5");
  }
}

}  // namespace manyworlds

#endif  // MW_SANITIZED
#endif  // MW_HAVE_CLI
