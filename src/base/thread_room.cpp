#include "src/base/thread_room.hpp"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace manyworlds {

namespace {

int whole(double threads) {
  return static_cast<int>(std::clamp(threads, 0.0, static_cast<double>(kAnyThreads)));
}

// Every thread takes its stack and a guard page, and some of what it allocates.
int in_address_space(std::size_t stack) {
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return kAnyThreads;
  double pages = 0;
  if (!(std::ifstream("/proc/self/statm") >> pages)) return kAnyThreads;
  const double used = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  constexpr double kBeside = 64 << 10;
  return whole((static_cast<double>(space.rlim_cur) - used) /
               (static_cast<double>(stack) + kBeside));
}

// "max" is no number: there is no limit.
int in_group(const std::filesystem::path& group) {
  double most = 0, present = 0;
  if (!(std::ifstream(group / "pids.max") >> most)) return kAnyThreads;
  if (!(std::ifstream(group / "pids.current") >> present)) return kAnyThreads;
  return whole(most - present);
}

// Lines are "0::/user.slice" of version 2 and "4:pids:/user.slice" of version 1. What a group may
// have, those above it must have, too.
int in_groups() {
  int least = kAnyThreads;
  std::ifstream lines("/proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && controllers != "pids") continue;
    const std::filesystem::path root =
        controllers.empty() ? "/sys/fs/cgroup" : "/sys/fs/cgroup/pids";
    std::filesystem::path group =
        root / std::filesystem::path(line.substr(second + 1)).relative_path();
    for (; group.native().size() >= root.native().size(); group = group.parent_path()) {
      least = std::min(least, in_group(group));
    }
  }
  return least;
}

}  // namespace

int thread_room(std::size_t stack) { return std::min(in_address_space(stack), in_groups()); }

bool has_room(std::size_t bytes) {
  // Writable, as what is allocated is, since some limits (ulimit -d) are of that alone.
  void* const there =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (there == MAP_FAILED) return false;
  munmap(there, bytes);
  return true;
}

}  // namespace manyworlds
