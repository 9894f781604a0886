#include "src/base/machine_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

namespace manyworlds {

double machine_memory() {
  double least = std::numeric_limits<double>::infinity();
  const auto limit = [&least](double bytes) {
    if (bytes > 0) least = std::min(least, bytes);
  };
  limit(static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)));
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    limit(static_cast<double>(space.rlim_cur));
  }
  // Of the container; "max": there is none.
  double bytes = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> bytes) limit(bytes);
  return least;
}

std::string gigabytes(double bytes) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f GB", bytes / 1e9);
  return text;
}

}  // namespace manyworlds
