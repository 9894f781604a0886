// What the program runs on.
#pragma once

#include <string>

namespace manyworlds::tools {

std::string cpu_model();
int usable_cpus();  // in the affinity mask: what --threads 0 comes to
// Version, CPU, instruction set and compiler, in one line of a report.
std::string machine_line();

}  // namespace manyworlds::tools
