// The executor that a Batch has unless its user brings one.
#pragma once

#include <memory>

#include "manyworlds/executor.hpp"

namespace manyworlds {

// threads = 0: as many as the process may run on and can start. Throws std::system_error if the
// given number cannot be started; the text says how many the process may have.
std::shared_ptr<Executor> make_executor(int threads);

}  // namespace manyworlds
