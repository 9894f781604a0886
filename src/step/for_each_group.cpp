// Threads. The only file that includes oneTBB; with MW_EXECUTOR_THREADS plain std::thread stands in
// for it, since Debian's TBB is not instrumented for ThreadSanitizer.
#include "src/step/for_each_group.hpp"

#include <sched.h>

#include <algorithm>

#include "src/base/denormals.hpp"

#if defined(MW_EXECUTOR_THREADS)
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>
#endif

namespace manyworlds {

namespace {

int allowed_threads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

void run_range(int begin, int end, int slot, Executor::Task task, void* context) {
  const FlushDenormals flush;
  for (int g = begin; g < end; ++g) task(context, g, slot);
}

}  // namespace

#if defined(MW_EXECUTOR_THREADS)

struct Executor::Pool {
  explicit Pool(int) {}
  static void run(int threads, int groups, Task task, void* context) {
    std::vector<std::thread> crew;
    for (int t = 0; t < threads; ++t) {
      crew.emplace_back(
          [=] { run_range(groups * t / threads, groups * (t + 1) / threads, t, task, context); });
    }
    for (auto& member : crew) member.join();
  }
};

#else

struct Executor::Pool {
  explicit Pool(int threads) : arena(threads) {
    // More threads than cores only when a Batch asked for them: the limit is the whole process's,
    // so it is not touched otherwise.
    if (threads > tbb::info::default_concurrency()) {
      workers.emplace(tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(threads));
    }
  }
  void run(int threads, int groups, Task task, void* context) {
    // A few chunks per thread even out groups of different cost.
    const int grain = std::max(1, groups / (threads * 8));
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, groups, static_cast<std::size_t>(grain)),
          [&](const tbb::blocked_range<int>& range) {
            run_range(range.begin(), range.end(), tbb::this_task_arena::current_thread_index(),
                      task, context);
          },
          tbb::simple_partitioner());
    });
  }
  std::optional<tbb::global_control> workers;
  tbb::task_arena arena;
};

#endif

Executor::Executor(int threads) : threads_(threads > 0 ? threads : allowed_threads()) {
  if (threads_ > 1) pool_ = std::make_unique<Pool>(threads_);
}
Executor::~Executor() = default;
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;

void Executor::run(int groups, Task task, void* context) {
  if (threads_ == 1 || groups <= 1) {
    run_range(0, groups, 0, task, context);
  } else {
    pool_->run(threads_, groups, task, context);
  }
}

}  // namespace manyworlds
