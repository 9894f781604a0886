// Remembered: what a task remembers of its worlds from step to step, in lanes: its memory, that of
// one step before, by which an expression can be evaluated between steps, and the last actions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/base/aligned_buffer.hpp"
#include "src/base/bits.hpp"

namespace manyworlds {

template <class Real>
class Remembered {
 public:
  // `rows`: of the program that runs after steps, which are put down.
  Remembered(const std::vector<int>& rows, int actions, int worlds, int lanes)
      : rows_(rows), actions_(at(actions)), lanes_(at(lanes)) {
    const std::size_t groups = (at(worlds) + lanes_ - 1) / lanes_;
    for (auto& side : memory_) side = AlignedBuffer<Real>(groups * rows_.size() * lanes_);
    acted_ = AlignedBuffer<Real>(groups * actions_ * lanes_);
    side_.resize(groups);
  }

  // [number][lane] of a group, and those of the step before.
  const Real* now(int group) const { return memory(group, side_[at(group)]); }
  const Real* before(int group) const { return memory(group, side_[at(group)] ^ 1u); }
  Real* acted(int group) {
    return acted_.data() + at(group) * actions_ * lanes_;
  }  // [action][lane]

  // What is remembered becomes what was before, and all lanes are to be put down.
  void next_step(int group) { side_[at(group)] ^= 1; }
  void put_down(int group, const Real* values, std::uint32_t lanes) {
    Real* to = memory_[side_[at(group)]].data() + at(group) * rows_.size() * lanes_;
    for (const int row : rows_) {
      for (std::size_t l = 0; l < lanes_; ++l) {
        if (get_bit(lanes, l)) to[l] = values[at(row) * lanes_ + l];
      }
      to += lanes_;
    }
  }

  std::size_t numbers() const { return actions_ + 2 * rows_.size(); }  // of a world
  void save(int world, std::span<double> to) const {
    auto next = to.begin();
    for_each(*this, world, [&](Real number) { *next++ = static_cast<double>(number); });
  }
  void restore(int world, std::span<const double> from) {
    auto next = from.begin();
    for_each(*this, world, [&](Real& number) { number = static_cast<Real>(*next++); });
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  const Real* memory(int group, std::size_t side) const {
    return memory_[side].data() + at(group) * rows_.size() * lanes_;
  }
  template <class Self, class Call>
  static void for_each(Self& self, int world, Call call) {
    const std::size_t group = at(world) / self.lanes_, lane = at(world) % self.lanes_;
    const auto visit = [&](auto& buffer, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        call(buffer.data()[(group * count + i) * self.lanes_ + lane]);
      }
    };
    visit(self.acted_, self.actions_);
    const std::size_t side = self.side_[group];
    visit(self.memory_[side], self.rows_.size());
    visit(self.memory_[side ^ 1], self.rows_.size());
  }

  const std::vector<int>& rows_;
  std::size_t actions_, lanes_;
  std::array<AlignedBuffer<Real>, 2> memory_;  // [group][number][lane]
  std::vector<std::uint8_t> side_;             // [group] of memory_ that is now
  AlignedBuffer<Real> acted_;                  // [group][action][lane]
};

}  // namespace manyworlds
