// Threads. The only file that includes oneTBB; with MW_EXECUTOR_THREADS plain std::thread stands in
// for it, since Debian's TBB is not instrumented for ThreadSanitizer.
#include "src/step/for_each_group.hpp"

#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/base/thread_room.hpp"

#if defined(MW_EXECUTOR_THREADS)
#include <thread>
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

// Memory for what a started thread allocates in addition to its stack, and for the steps.
constexpr std::size_t kRoom = 16 << 20;  // bytes

// Holds started threads until it opens, so that all of them exist at the same time.
class Gate {
 public:
  ~Gate() { open(); }
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    opened_.notify_all();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    open_ = false;
  }
  void pass() {
    std::unique_lock lock(mutex_);
    opened_.wait(lock, [this] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool open_ = false;
};

#if defined(MW_EXECUTOR_THREADS)

constexpr std::size_t kStack = 8 << 20;

// Starts threads until `most` exist at the same time, including the calling one, or until one
// cannot be started. Returns their number. If the limits of the process allow fewer than `least`,
// it starts none and returns the number that they allow.
int start_threads(int most, int least) {
  most = std::min(most - 1, thread_room(kStack)) + 1;
  if (most < least) return most;
  Gate gate;
  std::vector<std::thread> threads;
  try {
    while (static_cast<int>(threads.size()) + 1 < most && has_room(kRoom)) {
      threads.emplace_back([&gate] { gate.pass(); });
    }
  } catch (const std::exception&) {
  }
  gate.open();
  for (auto& thread : threads) thread.join();
  return static_cast<int>(threads.size()) + 1;
}

class Workers final : public Executor {
 public:
  Workers(int most, int least) : threads_(start_threads(most, least)) {
    workers_.reserve(static_cast<std::size_t>(threads_));
  }
  int threads() const override { return threads_; }
  void run(int groups, Task task, void* context) override {
    for (int t = 0; t < threads_; ++t) {
      const int begin = groups * t / threads_, end = groups * (t + 1) / threads_;
      const auto work = [=] { run_range(begin, end, t, task, context); };
      try {
        workers_.emplace_back(work);
      } catch (const std::exception&) {
        work();  // the process has no thread for it now
      }
    }
    for (auto& worker : workers_) worker.join();
    workers_.clear();
  }

 private:
  int threads_;
  std::vector<std::thread> workers_;
};

#else

constexpr std::size_t kStack = 4 << 20;  // of TBB's threads

// Makes TBB start threads until `most` exist at the same time, including the calling one, or until
// one cannot be started. Returns their number. If the limits of the process allow fewer than
// `least`, it starts none and returns the number that they allow.
//
// TBB starts threads when it first has work for them. The calling thread starts two, where a
// failure is an exception. Those start the others, where a failure ends the program. This function
// makes the calling thread start each of them: every new arena requires one thread more.
int start_threads(int most, int least) {
  static std::mutex mutex;
  static int started = 1;  // threads that TBB has and keeps
  // Without any arena TBB ends its threads and starts others later.
  static tbb::task_arena& kept = *new tbb::task_arena(1);
  const std::lock_guard lock(mutex);
  if (most <= started) return most;
  most = started + std::min(most - started, thread_room(kStack));
  if (most < least) return most;
  // One for all calls, and never freed: TBB may run a task after this function has returned, or
  // never.
  static Gate& gate = *new Gate;
  gate.close();
  std::vector<std::unique_ptr<tbb::task_arena>> arenas;
  int threads = 1;
  try {
    kept.initialize();
    while (threads < most && has_room(kStack + kRoom)) {
      arenas.push_back(std::make_unique<tbb::task_arena>(2, 1));
      arenas.back()->enqueue([] { gate.pass(); });
      ++threads;
    }
  } catch (const std::exception&) {  // TBB's std::runtime_error, std::bad_alloc
  }
  gate.open();
  // Another limit of the process keeps TBB from having more, and lets it do with those.
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  started = std::max(started, std::min(threads, static_cast<int>(allowed)));
  return threads;
}

// Raises TBB's limit if a Batch requires more threads than cores. The limit belongs to the whole
// process, so other batches leave it alone.
class MoreThreads {
 public:
  explicit MoreThreads(int threads) {
    if (threads <= tbb::info::default_concurrency()) return;
    limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }

 private:
  std::optional<tbb::global_control> limit_;
};

class Workers final : public Executor {
 public:
  Workers(int most, int least)
      : limit_(most), threads_(start_threads(most, least)), arena_(threads_) {}
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
  MoreThreads limit_;  // before threads are started
  int threads_;
  tbb::task_arena arena_;
};

#endif

}  // namespace

std::shared_ptr<Executor> make_executor(int threads) {
  const int wanted = threads == 0 ? allowed_threads() : threads;
  if (wanted == 1) return std::make_shared<CallingThread>();
  auto workers = std::make_shared<Workers>(wanted, threads);
  const int present = workers->threads();
  if (present < wanted && threads != 0) {
    throw std::system_error(
        std::make_error_code(std::errc::resource_unavailable_try_again),
        "threads: " + std::to_string(wanted) + " cannot be started, this process may have " +
            std::to_string(present) + " (see ulimit -u, ulimit -v and the pids.max of its cgroup)");
  }
  if (present == 1) return std::make_shared<CallingThread>();
  return workers;
}

}  // namespace manyworlds
