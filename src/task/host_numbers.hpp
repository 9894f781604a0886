// HostNumbers: what the host knows of a world beside its state, put into lanes of a program's
// inputs: random numbers, numbers of the scene that vary, levels.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "src/base/random.hpp"
#include "src/step/group_visitor.hpp"
#include "src/task/levels.hpp"
#include "src/task/program.hpp"

namespace manyworlds {

template <class Real>
class HostNumbers {
 public:
  HostNumbers(const InputRows& rows, int worlds, int lanes, const Levels<Real>& levels)
      : rows_(rows), worlds_(worlds), lanes_(lanes), levels_(levels) {
    const bool draws = std::any_of(rows.numbers.begin(), rows.numbers.end(), [](const auto& n) {
      return n.kind == HostNumber::of_episode || n.kind == HostNumber::of_step;
    });
    if (draws) key_.resize(at(worlds));
  }

  // The draws of a world's episode; nothing to tasks without random numbers.
  void begin_episode(int world, std::uint64_t seed, std::uint64_t episode) {
    if (!key_.empty()) key_[at(world)] = Draws(seed, episode).key();
  }

  // Of the world in a lane, `age` steps after its episode began. `numbers`: those of the rows, and
  // any after them.
  void put(const VisitedGroup<Real>& g, Real* inputs, int lane, Real age,
           const std::vector<HostNumber>& numbers) const {
    const int world = std::min(g.group * lanes_ + lane, worlds_ - 1);
    Real* in = inputs + at(rows_.first_number() * lanes_ + lane);
    for (const HostNumber& n : numbers) {
      if (n.kind == HostNumber::parameter) {
        *in = static_cast<Real>(g.worlds.number(n.of, world, n.item));
      } else if (n.kind == HostNumber::level) {
        *in = levels_.get(world, n.item);
      } else {  // an even count is of the episode, odd ones are of steps
        const bool each = n.kind == HostNumber::of_step;
        const std::uint64_t step = each ? 2 * static_cast<std::uint64_t>(age) + 1 : 0;
        *in = uniform_of<Real>(
            bits_of_stream(key_of(g.worlds, world), n.stream, (n.count << 32) + step));
      }
      in += lanes_;
    }
  }
  void put(const VisitedGroup<Real>& g, Real* inputs, int lane, Real age) const {
    put(g, inputs, lane, age, rows_.numbers);
  }

  std::size_t numbers() const { return key_.empty() ? 0 : 2; }  // of a world
  void save(int world, std::span<double> to) const {
    if (key_.empty()) return;  // in halves, which doubles hold exactly
    to[0] = static_cast<double>(key_[at(world)] >> 32);
    to[1] = static_cast<double>(key_[at(world)] & 0xffffffffu);
  }
  void restore(int world, std::span<const double> from) {
    if (!key_.empty()) key_[at(world)] = half_of_key(from[0]) << 32 | half_of_key(from[1]);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  // Of a snapshot, which may have been made up.
  static std::uint64_t half_of_key(double number) {
    return number >= 0 && number < 0x1p32 ? static_cast<std::uint64_t>(number) : 0;
  }
  // A task that draws nothing may be asked what it would draw.
  std::uint64_t key_of(const WorldsBase& worlds, int world) const {
    return key_.empty() ? Draws(worlds.seed(world), worlds.episode(world)).key() : key_[at(world)];
  }

  const InputRows& rows_;
  int worlds_, lanes_;
  const Levels<Real>& levels_;
  std::vector<std::uint64_t> key_;  // [world] of its draws, from where its episode began
};

}  // namespace manyworlds
