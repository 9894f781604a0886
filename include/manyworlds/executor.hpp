// Executor: the threads on which a Batch steps its groups of worlds. By default a Batch creates its
// threads. Derive from this class to use others (a TBB arena, a job system, a thread pool).
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

class Executor {
 public:
  using Task = void (*)(void* context, int group, int worker);

  virtual ~Executor() = default;

  // Maximum number of concurrent tasks, at least 1. A Batch allocates scratch memory for each: the
  // number must not change while a Batch uses the executor.
  virtual int threads() const = 0;

  // Calls task(context, group, worker) once for every group from 0 to groups - 1, in any order and
  // on any threads. Returns when all calls have returned. 0 <= worker < threads(); concurrent calls
  // have different workers. Tasks neither throw nor wait for each other.
  virtual void run(int groups, Task task, void* context) = 0;

 protected:
  Executor() = default;
  Executor(const Executor&) = default;
  Executor& operator=(const Executor&) = default;
};

}  // namespace manyworlds
