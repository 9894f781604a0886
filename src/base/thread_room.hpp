// How many threads this process may still have.
#pragma once

#include <cstddef>
#include <limits>

namespace manyworlds {

// The number of threads with stacks of this many bytes that the limit of the address space
// (ulimit -v) and the task limits of the process's cgroups (pids.max) leave. The limit of a user's
// threads (ulimit -u) is not included: the system does not report how many threads a user has.
int thread_room(std::size_t stack);
inline constexpr int kAnyThreads = std::numeric_limits<int>::max();  // nothing limits them

// Whether so many bytes of address space can be had now.
bool has_room(std::size_t bytes);

}  // namespace manyworlds
