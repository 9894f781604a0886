// FaultLog: the first world in which each result of a task was not finite in a call, noted by the
// threads that step. Which one it is does not depend on their order.
#pragma once

#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace manyworlds {

class FaultLog {
 public:
  explicit FaultLog(std::size_t results) : first_(results) { clear(); }

  void add(std::size_t result, int world, double value) {
    const std::uint64_t what = std::isnan(value) ? 0 : value > 0 ? 1 : 2;
    const std::uint64_t fault = static_cast<std::uint64_t>(world) * 4 + what;
    std::uint64_t before = first_[result].load(std::memory_order_relaxed);
    while (fault < before &&
           !first_[result].compare_exchange_weak(before, fault, std::memory_order_relaxed)) {
    }
    some_.store(true, std::memory_order_relaxed);
  }

  // Calls take(result, world, value) for each result that was added, and forgets them.
  template <class Take>
  void take(Take take) {
    if (!some_.load(std::memory_order_relaxed)) return;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kValues[] = {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity};
    for (std::size_t i = 0; i < first_.size(); ++i) {
      const std::uint64_t fault = first_[i].load(std::memory_order_relaxed);
      if (fault == kNone) continue;
      take(static_cast<int>(i), static_cast<int>(fault / 4), kValues[fault % 4]);
    }
    clear();
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  void clear() {
    for (auto& fault : first_) fault.store(kNone, std::memory_order_relaxed);
    some_.store(false, std::memory_order_relaxed);
  }

  std::vector<std::atomic<std::uint64_t>> first_;  // [result]
  std::atomic<bool> some_ = false;
};

}  // namespace manyworlds
