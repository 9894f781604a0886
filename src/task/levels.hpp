// Levels: the numbers of Task::levels, of all worlds, in this episode and in the next.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace manyworlds {

template <class Real>
class Levels {
 public:
  Levels(std::size_t worlds, std::size_t count)
      : count_(count), now_(worlds * count), next_(worlds * count) {}

  std::size_t count() const { return count_; }
  Real get(int world, std::size_t level) const { return now_[at(world, level)]; }
  // In this episode, and in the next until it is said what follows.
  void set(int world, std::size_t level, Real value) {
    now_[at(world, level)] = next_[at(world, level)] = value;
  }
  // What follows, where it is a number.
  void set_next(int world, std::size_t level, Real value) {
    if (!std::isnan(value)) next_[at(world, level)] = value;
  }
  void begin_episode(int world) {
    for (std::size_t i = 0; i < count_; ++i) now_[at(world, i)] = next_[at(world, i)];
  }

  // As 2 count() numbers.
  void save(int world, std::span<double> to) const {
    for (std::size_t i = 0; i < count_; ++i) {
      to[i] = static_cast<double>(now_[at(world, i)]);
      to[count_ + i] = static_cast<double>(next_[at(world, i)]);
    }
  }
  void restore(int world, std::span<const double> from) {
    for (std::size_t i = 0; i < count_; ++i) {
      now_[at(world, i)] = static_cast<Real>(from[i]);
      next_[at(world, i)] = static_cast<Real>(from[count_ + i]);
    }
  }

 private:
  std::size_t at(int world, std::size_t level) const {
    return static_cast<std::size_t>(world) * count_ + level;
  }

  std::size_t count_;
  std::vector<Real> now_, next_;  // [world][level]
};

}  // namespace manyworlds
