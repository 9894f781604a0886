// Threads. The only file that includes oneTBB; with MW_EXECUTOR_THREADS plain std::thread stands in
// for it, since Debian's TBB is not instrumented for ThreadSanitizer.
#include "src/step/for_each_group.hpp"

#include <sched.h>

#include <algorithm>

#include "src/base/float_mode.hpp"

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

void run_range(int begin, int end, int worker, Executor::Task task, void* context) {
  // Groups ask for it, whoever runs them; to find it set costs less than to set it for each.
  const FloatMode mode(FloatMode::flush);
  for (int g = begin; g < end; ++g) task(context, g, worker);
}

class CallingThread final : public Executor {
 public:
  int threads() const override { return 1; }
  void run(int groups, Task task, void* context) override {
    run_range(0, groups, 0, task, context);
  }
};

#if defined(MW_EXECUTOR_THREADS)

class Workers final : public Executor {
 public:
  explicit Workers(int threads) : threads_(threads) {}
  int threads() const override { return threads_; }
  void run(int groups, Task task, void* context) override {
    std::vector<std::thread> threads;
    for (int t = 0; t < threads_; ++t) {
      const int begin = groups * t / threads_, end = groups * (t + 1) / threads_;
      threads.emplace_back([=] { run_range(begin, end, t, task, context); });
    }
    for (auto& member : threads) member.join();
  }

 private:
  int threads_;
};

#else

class Workers final : public Executor {
 public:
  explicit Workers(int threads) : threads_(threads), arena_(threads) {
    // More threads than cores only when a Batch asked for them: the limit is the whole process's,
    // so it is not touched otherwise.
    if (threads > tbb::info::default_concurrency()) {
      workers_.emplace(tbb::global_control::max_allowed_parallelism,
                       static_cast<std::size_t>(threads));
    }
  }
  int threads() const override { return threads_; }
  void run(int groups, Task task, void* context) override {
    if (groups <= 1) return run_range(0, groups, 0, task, context);
    // A few chunks per thread even out groups of different cost.
    const int grain = std::max(1, groups / (threads_ * 8));
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<int>(0, groups, static_cast<std::size_t>(grain)),
          [&](const tbb::blocked_range<int>& range) {
            run_range(range.begin(), range.end(), tbb::this_task_arena::current_thread_index(),
                      task, context);
          },
          tbb::simple_partitioner());
    });
  }

 private:
  int threads_;
  std::optional<tbb::global_control> workers_;
  tbb::task_arena arena_;
};

#endif

}  // namespace

std::shared_ptr<Executor> make_executor(int threads) {
  if (threads == 0) threads = allowed_threads();
  if (threads == 1) return std::make_shared<CallingThread>();
  return std::make_shared<Workers>(threads);
}

}  // namespace manyworlds
