// Threads that a process may not have.
#include <catch2/catch.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "src/base/thread_room.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/sanitized.hpp"

namespace manyworlds::test {
namespace {

// So many bytes more than there are now, in this process.
[[maybe_unused]] bool limit_address_space(std::size_t more) {
  double pages = 0;
  if (!(std::ifstream("/proc/self/statm") >> pages)) return false;
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more;
  return setrlimit(RLIMIT_AS, &limit) == 0;
}

}  // namespace

#ifndef MW_SANITIZED  // sanitizers reserve terabytes of address space

TEST_CASE("threads that cannot be started are a std::system_error", "[fast][misuse]") {
  const Plan plan = compile(crowd(Space::planar));
  const pid_t child = fork();
  if (child == 0) {
    if (!limit_address_space(std::size_t{1} << 30)) std::_Exit(3);
    if (thread_room(std::size_t{4} << 20) > 256) std::_Exit(4);
    try {
      Batch(plan, {.worlds = 64, .threads = 600});
    } catch (const std::system_error& error) {
      const std::string_view text = error.what();
      if (!text.starts_with("threads: 600 cannot be started, this process may have ")) {
        std::_Exit(2);
      }
      Batch alone(plan, {.worlds = 64, .threads = 1});  // what fits is still to be had
      alone.step();
      std::_Exit(alone.steps() == 1 ? 0 : 5);
    }
    std::_Exit(1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
}

#endif

TEST_CASE("what has no limit has room", "[fast][misuse]") {
  CHECK(thread_room(1 << 20) > 0);
  CHECK(has_room(1 << 20));
  CHECK_FALSE(has_room(std::size_t{1} << 60));
}

}  // namespace manyworlds::test
