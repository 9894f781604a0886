// Levels: the numbers of Task::levels, of all worlds, in this episode and in the next.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace manyworlds {

template <class Real>
class Levels {
 public:
  Levels(std::size_t worlds, std::size_t count)
      : count_(count),
        now_(worlds * count),
        next_(worlds * count),
        ended_(count > 0 ? worlds : 0) {}

  std::size_t count() const { return count_; }
  Real get(int world, std::size_t level) const { return now_[at(world, level)]; }

  void begin(int world, std::size_t level, Real value) {
    now_[at(world, level)] = next_[at(world, level)] = value;
  }
  // What is written as it is changes nothing: it may be about to be another one.
  void write(int world, std::size_t level, Real value) {
    if (value != get(world, level)) begin(world, level, value);
  }
  // next(level): what follows, where it is a number. Once: a world may step on beyond its end.
  template <class Next>
  void end_episode(int world, Next next) {
    if (count_ == 0 || std::exchange(ended_[at(world)], std::uint8_t{1}) != 0) return;
    for (std::size_t i = 0; i < count_; ++i) {
      if (const Real value = next(i); !std::isnan(value)) next_[at(world, i)] = value;
    }
  }
  void begin_episode(int world) {
    if (count_ == 0) return;
    ended_[at(world)] = 0;
    for (std::size_t i = 0; i < count_; ++i) now_[at(world, i)] = next_[at(world, i)];
  }

  std::size_t numbers() const { return count_ == 0 ? 0 : 2 * count_ + 1; }  // of a world
  void save(int world, std::span<double> to) const {
    if (count_ == 0) return;
    for (std::size_t i = 0; i < count_; ++i) {
      to[i] = static_cast<double>(now_[at(world, i)]);
      to[count_ + i] = static_cast<double>(next_[at(world, i)]);
    }
    to[2 * count_] = ended_[at(world)];
  }
  void restore(int world, std::span<const double> from) {
    if (count_ == 0) return;
    for (std::size_t i = 0; i < count_; ++i) {
      now_[at(world, i)] = static_cast<Real>(from[i]);
      next_[at(world, i)] = static_cast<Real>(from[count_ + i]);
    }
    ended_[at(world)] = from[2 * count_] != 0;
  }

 private:
  static std::size_t at(int world) { return static_cast<std::size_t>(world); }
  std::size_t at(int world, std::size_t level) const {
    return static_cast<std::size_t>(world) * count_ + level;
  }

  std::size_t count_;
  std::vector<Real> now_, next_;     // [world][level]
  std::vector<std::uint8_t> ended_;  // [world] whose episode has ended
};

}  // namespace manyworlds
