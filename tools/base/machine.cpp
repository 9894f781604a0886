#include "tools/base/machine.hpp"

#include <sched.h>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "manyworlds/batch.hpp"

#include "tools/base/version.hpp"

namespace manyworlds::tools {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t value = line.find_first_not_of(" \t", line.find(':') + 1);
    if (value != std::string::npos) return line.substr(value);
  }
  return "unknown";
}

int usable_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(CPU_COUNT(&set), 1);
}

std::string machine_line() {
  return fmt::format("manyworlds {}, {}, {}, {}", kVersion, cpu_model(), to_string(default_isa()),
                     kCompiler);
}

}  // namespace manyworlds::tools
