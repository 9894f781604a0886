// ResultArrays: from the values of a program in lanes to the arrays of a caller, [world][result].
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "src/task/runner.hpp"

namespace manyworlds {

template <class Real>
class ResultArrays {
 public:
  ResultArrays(std::shared_ptr<const TaskPrograms> programs, int lanes)
      : p_(std::move(programs)), lanes_(lanes) {}

  // What is told of a world, where it is wanted.
  void put_results(const StepArrays& out, const Real* values, int world, int lane) const {
    put(out.observations, p_->observations, values, world, lane);
    put(out.observations_f64, p_->observations, values, world, lane);
    put(out.infos, p_->infos, values, world, lane);
  }
  template <class T>
  void put(std::span<T> to, const std::vector<int>& rows, const Real* values, int world,
           int lane) const {
    if (to.empty()) return;
    T* own = to.data() + at(world) * rows.size();
    for (const int row : rows) *own++ = static_cast<T>(values[at(row * lanes_ + lane)]);
  }

  void keep_last(const StepArrays& out, int world) const {
    const std::size_t n = p_->observations.size();
    keep(out.observations, out.final_observations, world, n);
    keep(out.observations_f64, out.final_observations_f64, world, n);
    keep(out.infos, out.final_infos, world, p_->infos.size());
  }
  template <class T>
  static void keep(std::span<T> from, std::span<T> to, int world, std::size_t n) {
    if (from.empty() || to.empty()) return;
    std::copy_n(from.data() + at(world) * n, n, to.data() + at(world) * n);
  }

  // Of the worlds `first` on, which are lanes 0 to `end`. In steps that begin an episode there is
  // no reward and no end.
  void put_rewards(const StepArrays& out, const Real* values, int first, int end,
                   const std::vector<std::uint8_t>& begin_next) const {
    std::array<double, kMaxLanes> sum{};
    const std::size_t rewards = p_->rewards.size();
    for (std::size_t i = 0; i < rewards; ++i) {
      const Real* row = values + at(p_->rewards[i] * lanes_);
      for (int l = 0; l < end; ++l) {
        const double reward = begin_next[at(first + l)] != 0 ? 0 : static_cast<double>(row[l]);
        sum[at(l)] += reward;
        if (!out.reward_terms.empty()) out.reward_terms[at(first + l) * rewards + i] = reward;
      }
    }
    if (!out.rewards.empty()) std::copy_n(sum.data(), end, out.rewards.data() + first);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::shared_ptr<const TaskPrograms> p_;
  int lanes_;
};

}  // namespace manyworlds
