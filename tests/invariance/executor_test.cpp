// Batches that step on threads of their user's own.
#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Threads take the next group from a counter, the last group first. Counts what ran.
class CountDown final : public Executor {
 public:
  explicit CountDown(int threads) : threads_(threads) {}
  int threads() const override { return threads_; }
  void run(int groups, Task task, void* context) override {
    std::atomic<int> next{groups};
    std::vector<std::thread> threads;
    for (int worker = 0; worker < threads_; ++worker) {
      threads.emplace_back([&, worker] {
        for (int g = --next; g >= 0; g = --next) {
          task(context, g, worker);
          ++tasks;
        }
      });
    }
    for (std::thread& member : threads) member.join();
    ++runs;
  }
  std::atomic<int> tasks{0};
  int runs = 0;

 private:
  int threads_;
};

}  // namespace

TEST_CASE("a batch steps on its user's executor with the same bits", "[fast][executor]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      const int worlds = 50;
      Batch own(plan, options_of(table, worlds));
      own.step(20);
      const auto executor = std::make_shared<CountDown>(3);
      BatchOptions options = options_of(table, worlds);
      options.threads = 0;
      options.executor = executor;
      Batch lent(plan, options);
      CHECK(lent.threads() == 3);
      for (int i = 0; i < 10; ++i) lent.step(2);
      for (int w = 0; w < worlds; ++w) CHECK(lent.hash(w) == own.hash(w));
      const int groups = (worlds + lent.lanes() - 1) / lent.lanes();
      CHECK(executor->runs == 10);
      CHECK(executor->tasks == 10 * groups);
    }
  }
}

TEST_CASE("two batches share an executor", "[fast][executor]") {
  const Plan plan = compile(crowd(Space::spatial));
  const auto executor = std::make_shared<CountDown>(2);
  Batch a(plan, {.worlds = 20, .executor = executor});
  Batch b(plan, {.worlds = 20, .executor = executor});
  a.step(5), b.step(5), a.step(5), b.step(5);
  CHECK(a.hash() == b.hash());
}

TEST_CASE("executors that make no sense are refused", "[fast][executor]") {
  const Plan plan = compile(crowd(Space::planar));
  const auto none = std::make_shared<CountDown>(0), two = std::make_shared<CountDown>(2);
  CHECK_THROWS_AS(Batch(plan, {.worlds = 1, .executor = none}), std::invalid_argument);
  CHECK_THROWS_AS(Batch(plan, {.worlds = 1, .threads = 2, .executor = two}), std::invalid_argument);
}

}  // namespace manyworlds::test
