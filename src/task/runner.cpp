#include "src/task/runner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/base/bits.hpp"
#include "src/base/random.hpp"
#include "src/task/levels.hpp"
#include "src/task/program_code.hpp"

namespace manyworlds {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class Real>
class RunnerOf final : public TaskRunner, public GroupVisitorOf<Real> {
 public:
  RunnerOf(std::shared_ptr<const TaskPrograms> programs, const Batch& batch, Autoreset autoreset)
      : p_(std::move(programs)),
        opening_(p_->opening),
        before_(p_->before),
        after_(p_->after),
        autoreset_(autoreset),
        worlds_(batch.worlds()),
        lanes_(batch.lanes()),
        levels_(at(worlds_), p_->level_nexts.size()) {
    const std::size_t groups = at((worlds_ + lanes_ - 1) / lanes_), lanes = at(lanes_);
    memory_ = AlignedBuffer<Real>(groups * p_->memory.row.size() * lanes);
    age_ = AlignedBuffer<Real>(groups * lanes);
    begin_now.resize(at(worlds_));
    begin_next.resize(at(worlds_));
    const auto& numbers = p_->inputs.numbers;
    draws_ = std::any_of(numbers.begin(), numbers.end(), [](const HostNumber& n) {
      return n.kind == HostNumber::of_episode || n.kind == HostNumber::of_step;
    });
    if (draws_) key_.resize(at(worlds_));
    unsound.resize(at(worlds_));
    for (int t = 0; t < batch.threads(); ++t) {
      Thread& thread = threads_.emplace_back();
      const std::size_t rows = std::max({opening_.rows(), before_.rows(), after_.rows()});
      thread.values = AlignedBuffer<Real>(rows * lanes);
      thread.inputs = AlignedBuffer<Real>(at(p_->inputs.count()) * lanes);
      thread.in.reserve(rows);
    }
  }

  GroupVisitor& visitor() override { return *this; }

  // [begins with the next step, age, what the program remembers, levels, those of the next
  // episode, key]
  std::size_t numbers() const override {
    return 2 + p_->memory.row.size() + levels_.numbers() + (draws_ ? 2 : 0);
  }

  void save_world(int world, std::span<double> to) const override {
    to[0] = begin_next[at(world)];
    to[1] = static_cast<double>(age_[at(world)]);
    for (std::size_t i = 0; i < p_->memory.row.size(); ++i) {
      to[2 + i] = static_cast<double>(memory_[remembered(world, i)]);
    }
    levels_.save(world, to.subspan(2 + p_->memory.row.size()));
    if (!draws_) return;  // in halves, which doubles hold exactly
    to[to.size() - 2] = static_cast<double>(key_[at(world)] >> 32);
    to[to.size() - 1] = static_cast<double>(key_[at(world)] & 0xffffffffu);
  }

  void restore_world(int world, std::span<const double> from) override {
    begin_next[at(world)] = from[0] != 0 && autoreset_ == Autoreset::next_step;
    age_[at(world)] = static_cast<Real>(from[1]);
    for (std::size_t i = 0; i < p_->memory.row.size(); ++i) {
      memory_[remembered(world, i)] = static_cast<Real>(from[2 + i]);
    }
    levels_.restore(world, from.subspan(2 + p_->memory.row.size()));
    if (!draws_) return;
    key_[at(world)] = half_of_key(from[from.size() - 2]) << 32 | half_of_key(from[from.size() - 1]);
  }

  double level(int world, std::size_t level) const override {
    return static_cast<double>(levels_.get(world, level));
  }
  void set_level(int world, std::size_t level, double value) override {
    levels_.write(world, level, static_cast<Real>(value));
  }

  void before_steps(const VisitedGroup<Real>& g) override {
    Thread& thread = threads_[at(g.thread)];
    for (int l = 0; l < lanes_; ++l) {
      if (g.group * lanes_ + l < worlds_) unsound[at(g.group * lanes_ + l)] = 0;
      put_action(g, thread, l);
      put_numbers(g, thread, l, age_[at(g.group * lanes_ + l)] + 1);
    }
    run(g, before_, thread, false);
    for (std::size_t i = 0; i < p_->controls.size(); ++i) {
      auto [low, high] = p_->control_range[i];
      const Real* from = thread.values.data() + at(p_->controls[i]) * at(lanes_);
      for (int l = 0; l < lanes_; ++l) {
        if (p_->ranges_vary) {
          const int world = std::min(g.group * lanes_ + l, worlds_ - 1);
          low = g.worlds.number(Parameter::control_low, world, i);
          high = g.worlds.number(Parameter::control_high, world, i);
        }
        if (std::isnan(from[l])) {
          freeze(g, l);
        } else {
          g.control[i * at(lanes_) + at(l)] =
              std::clamp(from[l], static_cast<Real>(low), static_cast<Real>(high));
        }
      }
    }
  }

  void after_steps(const VisitedGroup<Real>& g) override {
    Thread& thread = threads_[at(g.thread)];
    Real* age = age_.data() + at(g.group * lanes_);
    for (int l = 0; !g.whole && l < lanes_; ++l) {
      put_action(g, thread, l);
      put_numbers(g, thread, l, age[l] + 1);
    }
    Real* in = thread.inputs.data();
    for (int l = 0; l < lanes_; ++l) {
      in[at(p_->inputs.age() * lanes_ + l)] = age[l] += 1;
      in[at(p_->inputs.lost() * lanes_ + l)] =
          has_status(g, l, kernels::kFrozen | kernels::kOutOfBounds) ? 1 : 0;
    }
    run(g, after_, thread, false);
    const int first = g.group * lanes_, end = std::min(lanes_, worlds_ - first);
    for (int l = 0; l < end; ++l) put_results(thread, first + l, l);
    put_rewards(thread, first, end);
    end_episodes(thread, first, end, age);
    put_down(g.group, thread, (1u << lanes_) - 1u);
  }

  void before_beginning(const VisitedGroup<Real>& g, WorldsBase& worlds, std::uint32_t lanes,
                        const Beginning& how) override {
    if (opening_.rows() == 0) return;
    Thread& thread = threads_[at(g.thread)];
    for_each_lane(lanes, [&](int l) {
      const int world = g.group * lanes_ + l;
      const std::uint64_t seed = how.seeds.empty() ? worlds.seed(world) : how.seeds[at(world)];
      const std::uint64_t next =
          how.resets ? std::uint64_t{worlds.episode(world)} + 1 : worlds.episode(world);
      if (draws_) key_[at(world)] = Draws(seed, how.seeds.empty() ? next : 0).key();
      levels_.begin_episode(world);
    });
    if (how.first && levels_.count() > 0) {
      put_opening_numbers(g, thread, lanes);
      run(g, opening_, thread, true);
      for_each_lane(lanes, [&](int l) {
        for (std::size_t i = 0; i < levels_.count(); ++i) {
          const Real begins = value(thread, p_->level_begins[i], l);
          levels_.begin(g.group * lanes_ + l, i, std::isnan(begins) ? Real(0) : begins);
        }
      });
    }
    if (!how.resets || p_->initial_parameters.empty()) return;
    put_opening_numbers(g, thread, lanes);
    run(g, opening_, thread, true);
    for_each_lane(lanes, [&](int l) {
      for (std::size_t i = 0; i < p_->initial_parameters.size(); ++i) {
        const HostNumber& of = p_->initial_parameters[i];
        worlds.set_next(of.of, g.group * lanes_ + l, of.item,
                        static_cast<double>(value(thread, p_->initial_values[i], l)));
      }
    });
  }

  void after_beginning(const VisitedGroup<Real>& g, std::uint32_t lanes) override {
    Thread& thread = threads_[at(g.thread)];
    if (draws_) {
      for_each_lane(lanes, [&](int l) {
        const int world = g.group * lanes_ + l;
        key_[at(world)] = Draws(g.worlds.seed(world), g.worlds.episode(world)).key();
      });
    }
    put_opening_numbers(g, thread, lanes);
    run(g, after_, thread, true);
    for (int l = 0; l < lanes_; ++l) {
      if (!get_bit(lanes, at(l))) continue;
      const int world = g.group * lanes_ + l;
      age_[at(world)] = 0;
      begin_next[at(world)] = 0;
      if (keeps_last) keep_last(world);
      put_results(thread, world, l);
    }
    put_down(g.group, thread, lanes);
  }

 private:
  struct Thread {
    AlignedBuffer<Real> values, inputs;
    std::vector<const Real*> in;  // of a call
  };

  // Of a snapshot, which may have been made up.
  static std::uint64_t half_of_key(double number) {
    return number >= 0 && number < 0x1p32 ? static_cast<std::uint64_t>(number) : 0;
  }

  template <class Call>
  void for_each_lane(std::uint32_t lanes, Call call) const {
    for (int l = 0; l < lanes_; ++l) {
      if (get_bit(lanes, at(l))) call(l);
    }
  }

  // Inputs of worlds that begin an episode: no action, and no step behind them.
  void put_opening_numbers(const VisitedGroup<Real>& g, Thread& thread, std::uint32_t lanes) const {
    std::fill_n(thread.inputs.data(), thread.inputs.size(), Real(0));
    if (p_->inputs.numbers.empty()) return;
    for_each_lane(lanes, [&](int l) { put_numbers(g, thread, l, 0); });
  }

  // Where in memory_ a number of a world is.
  std::size_t remembered(int world, std::size_t number) const {
    const std::size_t row = at(world / lanes_) * p_->memory.row.size() + number;
    return row * at(lanes_) + at(world % lanes_);
  }

  static bool has_status(const VisitedGroup<Real>& g, int lane, std::uint32_t bits) {
    return (g.view.status[lane] & bits) != 0;
  }

  void freeze(const VisitedGroup<Real>& g, int lane) {
    g.view.status[lane] |= kernels::kNonFinite;
    if (g.group * lanes_ + lane < worlds_) unsound[at(g.group * lanes_ + lane)] = 1;
  }

  void put_action(const VisitedGroup<Real>& g, Thread& thread, int lane) {
    const std::size_t world = at(std::min(g.group * lanes_ + lane, worlds_ - 1));
    Real* in = thread.inputs.data() + lane;
    if (choices) {
      *in = static_cast<Real>(choices[world]);
      return;
    }
    for (std::size_t i = 0; i < p_->action_range.size(); ++i) {
      const float value = actions[world * p_->action_range.size() + i];
      const auto [low, high] = p_->action_range[i];
      const Real counts =
          std::clamp(static_cast<Real>(value), static_cast<Real>(low), static_cast<Real>(high));
      const bool sound = std::isfinite(counts);
      if (!sound) freeze(g, lane);
      in[i * at(lanes_)] = sound ? counts : Real(0);
    }
  }

  // What the host knows of the world in a lane, `age` steps after its episode began.
  void put_numbers(const VisitedGroup<Real>& g, Thread& thread, int lane, Real age) const {
    const int world = std::min(g.group * lanes_ + lane, worlds_ - 1);
    Real* in = thread.inputs.data() + at(p_->inputs.first_number() * lanes_ + lane);
    for (const HostNumber& n : p_->inputs.numbers) {
      if (n.kind == HostNumber::parameter) {
        *in = static_cast<Real>(g.worlds.number(n.of, world, n.item));
      } else if (n.kind == HostNumber::level) {
        *in = levels_.get(world, n.item);
      } else {  // an even count is of the episode, odd ones are of steps
        const bool each = n.kind == HostNumber::of_step;
        const std::uint64_t step = each ? 2 * static_cast<std::uint64_t>(age) + 1 : 0;
        *in = uniform_of<Real>(bits_of_stream(key_[at(world)], n.stream, (n.count << 32) + step));
      }
      in += lanes_;
    }
  }

  void run(const VisitedGroup<Real>& g, const ProgramCode<Real>& code, Thread& thread,
           bool beginning) const {
    const std::size_t first = at(g.group) * p_->memory.row.size() * at(lanes_);
    code.run(g, lanes_,
             {.input = thread.inputs.data(),
              .memory = memory_.data() + first,
              .value = thread.values.data(),
              .beginning = beginning},
             thread.in);
  }

  Real value(const Thread& thread, int row, int lane) const {
    return thread.values[at(row * lanes_ + lane)];
  }

  // What is told of a world, where it is wanted.
  void put_results(const Thread& thread, int world, int lane) const {
    put(out.observations, p_->observations, thread, world, lane);
    put(out.observations_f64, p_->observations, thread, world, lane);
    put(out.infos, p_->infos, thread, world, lane);
  }
  template <class T>
  void put(std::span<T> to, const std::vector<int>& rows, const Thread& thread, int world,
           int lane) const {
    if (to.empty()) return;
    T* own = to.data() + at(world) * rows.size();
    for (const int row : rows) *own++ = static_cast<T>(value(thread, row, lane));
  }

  void keep_last(int world) const {
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
  void put_rewards(const Thread& thread, int first, int end) const {
    std::array<double, kMaxLanes> sum{};
    const std::size_t rewards = p_->rewards.size();
    for (std::size_t i = 0; i < rewards; ++i) {
      const Real* row = thread.values.data() + at(p_->rewards[i] * lanes_);
      for (int l = 0; l < end; ++l) {
        const double reward = begin_next[at(first + l)] != 0 ? 0 : static_cast<double>(row[l]);
        sum[at(l)] += reward;
        if (!out.reward_terms.empty()) out.reward_terms[at(first + l) * rewards + i] = reward;
      }
    }
    if (!out.rewards.empty()) std::copy_n(sum.data(), end, out.rewards.data() + first);
  }

  void end_episodes(const Thread& thread, int first, int end, const Real* age) {
    const Real* failed = thread.values.data() + at(p_->terminated * lanes_);
    const Real* broken_off = thread.values.data() + at(p_->truncated * lanes_);
    const Real most = p_->max_steps > 0 ? static_cast<Real>(p_->max_steps)
                                        : std::numeric_limits<Real>::infinity();
    bool some = false;
    for (int l = 0; l < end; ++l) {
      const std::size_t world = at(first + l);
      const bool begins = begin_next[world] != 0;
      const bool terminated = !begins && failed[l] != 0;
      const bool truncated = !begins && (broken_off[l] != 0 || age[l] >= most);
      if (!out.terminated.empty()) out.terminated[world] = terminated;
      if (!out.truncated.empty()) out.truncated[world] = truncated;
      const bool ended = terminated || truncated;
      if (ended) {
        levels_.end_episode(first + l,
                            [&](std::size_t i) { return value(thread, p_->level_nexts[i], l); });
      }
      begin_now[world] = begins || (ended && autoreset_ == Autoreset::same_step);
      begin_next[world] = ended && autoreset_ == Autoreset::next_step;
      some = some || begin_now[world] != 0;
    }
    if (some) some_begin.store(true, std::memory_order_relaxed);
  }

  // What the next step has to remember of these lanes.
  void put_down(int group, const Thread& thread, std::uint32_t lanes) {
    const std::size_t rows = p_->memory.row.size();
    Real* to = memory_.data() + at(group) * rows * at(lanes_);
    for (const int row : p_->memory.row) {
      for (int l = 0; l < lanes_; ++l) {
        if (get_bit(lanes, at(l))) to[l] = value(thread, row, l);
      }
      to += lanes_;
    }
  }

  std::shared_ptr<const TaskPrograms> p_;
  ProgramCode<Real> opening_, before_, after_;
  Autoreset autoreset_;
  int worlds_, lanes_;
  Levels<Real> levels_;
  AlignedBuffer<Real> memory_;  // [group][number][lane]
  AlignedBuffer<Real> age_;     // [group][lane]
  bool draws_;
  std::vector<std::uint64_t> key_;  // [world] of its draws, from where its episode began
  std::vector<Thread> threads_;
};

}  // namespace

std::unique_ptr<TaskRunner> make_runner(std::shared_ptr<const TaskPrograms> programs,
                                        const Batch& batch, Autoreset autoreset) {
  if (batch.precision() == Precision::f32) {
    return std::make_unique<RunnerOf<float>>(std::move(programs), batch, autoreset);
  }
  return std::make_unique<RunnerOf<double>>(std::move(programs), batch, autoreset);
}

}  // namespace manyworlds
