// Executor: runs a task for every group on a fixed number of threads.
#pragma once

#include <memory>

namespace manyworlds {

class Executor {
 public:
  // threads = 0: as many as the process may run on.
  explicit Executor(int threads);
  ~Executor();
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;

  int threads() const { return threads_; }

  // Calls task(context, group, slot) for every group; slot < threads() tells concurrent calls
  // apart. Denormals are flushed around every call.
  using Task = void (*)(void* context, int group, int slot);
  void run(int groups, Task task, void* context);

 private:
  struct Pool;
  int threads_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace manyworlds
