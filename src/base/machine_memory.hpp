// How much memory the machine has, to refuse before allocating more.
#pragma once

#include <string>

namespace manyworlds {

// Bytes that a process may have: of the machine, of its container (cgroup v2), of its address space
// (RLIMIT_AS), whichever is least; infinity where none says.
double machine_memory();
std::string gigabytes(double bytes);  // "12.3 GB"

}  // namespace manyworlds
