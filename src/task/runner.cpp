// Runs the programs of a task around the steps of a group. This is over 400 lines because what
// happens to a group before its steps, after them, where its worlds begin and between steps is one
// order.
#include "src/task/runner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/base/bits.hpp"
#include "src/task/fault_log.hpp"
#include "src/task/finite_check.hpp"
#include "src/task/host_numbers.hpp"
#include "src/task/levels.hpp"
#include "src/task/program_code.hpp"
#include "src/task/remembered.hpp"
#include "src/task/result_arrays.hpp"

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
        ends_of_steps_(p_->after, p_->results, std::array{p_->terminated, p_->results.back()},
                       lanes_),
        beginnings_(p_->after, p_->observations, {}, lanes_),
        faults_(p_->results.size()),
        results_(p_, lanes_),
        remembered_(p_->memory.row, p_->inputs.actions, worlds_, lanes_),
        levels_(at(worlds_), p_->level_nexts.size()),
        host_(p_->inputs, worlds_, lanes_, levels_) {
    const std::size_t groups = at((worlds_ + lanes_ - 1) / lanes_), lanes = at(lanes_);
    age_ = AlignedBuffer<Real>(groups * lanes);
    begin_now.resize(at(worlds_));
    begin_next.resize(at(worlds_));
    unsound.resize(at(worlds_));
    flagged_.resize(at(worlds_));
    for (int t = 0; t < batch.threads(); ++t) {
      Thread& thread = threads_.emplace_back();
      const std::size_t rows = std::max({opening_.rows(), before_.rows(), after_.rows()});
      thread.values = AlignedBuffer<Real>(rows * lanes);
      thread.inputs = AlignedBuffer<Real>(at(p_->inputs.count()) * lanes);
      thread.in.reserve(rows);
      thread.unknown.reserve(rows);
    }
  }

  GroupVisitor& visitor() override { return *this; }

  // [begins with the next step, age, the last actions, what the program remembers and what it did
  // a step before, levels, those of the next episode, key]
  std::size_t numbers() const override {
    return first_level() + levels_.numbers() + host_.numbers();
  }

  void save_world(int world, std::span<double> to) const override {
    to[0] = begin_next[at(world)];
    to[1] = static_cast<double>(age_[at(world)]);
    remembered_.save(world, to.subspan(2));
    levels_.save(world, to.subspan(first_level()));
    host_.save(world, to.last(host_.numbers()));
  }

  void restore_world(int world, std::span<const double> from) override {
    begin_next[at(world)] = from[0] != 0 && autoreset_ == Autoreset::next_step;
    age_[at(world)] = static_cast<Real>(from[1]);
    flagged_[at(world)] = 0;
    remembered_.restore(world, from.subspan(2));
    levels_.restore(world, from.subspan(first_level()));
    host_.restore(world, from.last(host_.numbers()));
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
      const int world = g.group * lanes_ + l;
      if (world < worlds_) unsound[at(world)] = flagged_[at(world)];
      put_action(g, thread, l);
      const Real age = age_[at(world)] + 1;
      thread.inputs[at(p_->inputs.age() * lanes_ + l)] = age;
      host_.put(g, thread.inputs.data(), l, age);
    }
    std::copy_n(thread.inputs.data(), at(p_->inputs.actions * lanes_), remembered_.acted(g.group));
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
      host_.put(g, thread.inputs.data(), l, age[l] + 1);
    }
    Real* in = thread.inputs.data();
    for (int l = 0; l < lanes_; ++l) {
      in[at(p_->inputs.age() * lanes_ + l)] = age[l] += 1;
      in[at(p_->inputs.lost() * lanes_ + l)] = is_lost(g, l);
    }
    run(g, after_, thread, false);
    const int first = g.group * lanes_, end = std::min(lanes_, worlds_ - first);
    for (int l = 0; l < end; ++l) results_.put_results(out, thread.values.data(), first + l, l);
    results_.put_rewards(out, thread.values.data(), first, end, begin_next);
    const std::uint32_t suspects = ends_of_steps_.suspects(thread.values.data());
    const std::uint32_t unknown = suspects == 0 ? 0 : flag(g, thread, suspects);
    end_episodes(g, thread, end, unknown);
    remembered_.next_step(g.group);
    remembered_.put_down(g.group, thread.values.data(), (1u << lanes_) - 1u);
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
      host_.begin_episode(world, seed, how.seeds.empty() ? next : 0);
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
    for_each_lane(lanes, [&](int l) {
      const int world = g.group * lanes_ + l;
      host_.begin_episode(world, g.worlds.seed(world), g.worlds.episode(world));
    });
    put_opening_numbers(g, thread, lanes);
    run(g, after_, thread, true);
    for (int l = 0; l < lanes_; ++l) {
      if (!get_bit(lanes, at(l))) continue;
      const int world = g.group * lanes_ + l;
      age_[at(world)] = 0;
      begin_next[at(world)] = 0;
      flagged_[at(world)] = 0;
      for (int i = 0; i < p_->inputs.actions; ++i)
        remembered_.acted(g.group)[at(i * lanes_ + l)] = 0;
      if (keeps_last) results_.keep_last(out, world);
      results_.put_results(out, thread.values.data(), world, l);
    }
    const std::uint32_t suspects = beginnings_.suspects(thread.values.data()) & lanes;
    for_each_lane(suspects, [&](int l) { name_faults(g, thread, l, p_->observations.size()); });
    remembered_.put_down(g.group, thread.values.data(), lanes);
  }

  void take_faults(std::vector<Fault>& to) override {
    faults_.take([&](int result, int world, double value) {
      to.push_back({result, world, static_cast<std::int64_t>(age_[at(world)]), value});
    });
  }

  void evaluate(BatchCore& core, const TaskPrograms& programs, std::span<double> out) override {
    const ProgramCode<Real> code(programs.after);
    Thread thread;
    const auto make = [this](std::size_t rows) { return AlignedBuffer<Real>(rows * at(lanes_)); };
    thread.values = make(code.rows()), thread.inputs = make(at(programs.inputs.count()));
    evaluation_ = {&programs, &code, &thread, out};
    core.visit(*this);
    evaluation_ = {};
  }

  void between_steps(const VisitedGroup<Real>& g) override {
    const auto& [programs, code, thread, to] = evaluation_;
    Real* in = thread->inputs.data();
    std::copy_n(remembered_.acted(g.group), at(p_->inputs.actions * lanes_), in);
    const Real* age = age_.data() + at(g.group * lanes_);
    for (int l = 0; l < lanes_; ++l) {
      in[at(p_->inputs.age() * lanes_ + l)] = age[l];
      in[at(p_->inputs.lost() * lanes_ + l)] = is_lost(g, l);
      host_.put(g, in, l, age[l], programs->inputs.numbers);
    }
    const int first = g.group * lanes_, end = std::min(lanes_, worlds_ - first);
    for (const bool beginning : {false, true}) {
      const auto is_so = [&](Real steps) { return (steps == 0) == beginning; };
      if (std::none_of(age, age + end, is_so)) continue;
      code->run(g, lanes_,
                {.input = in,
                 .memory = remembered_.before(g.group),
                 .value = thread->values.data(),
                 .beginning = beginning},
                thread->in);
      for (int l = 0; l < end; ++l) {
        if (!is_so(age[l])) continue;
        to[at(first + l)] = static_cast<double>(value(*thread, programs->evaluated, l));
      }
    }
  }

 private:
  struct Thread {
    AlignedBuffer<Real> values, inputs;
    std::vector<const Real*> in;        // of a call
    std::vector<std::uint8_t> unknown;  // of a lane, see FiniteCheck
  };

  // What evaluate() is about.
  struct Evaluation {
    const TaskPrograms* programs = nullptr;
    const ProgramCode<Real>* code = nullptr;
    Thread* thread = nullptr;
    std::span<double> out = {};
  };

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
    for_each_lane(lanes, [&](int l) { host_.put(g, thread.inputs.data(), l, 0); });
  }

  std::size_t first_level() const { return 2 + remembered_.numbers(); }  // in what is saved

  static bool has_status(const VisitedGroup<Real>& g, int lane, std::uint32_t bits) {
    return (g.view.status[lane] & bits) != 0;
  }
  static Real is_lost(const VisitedGroup<Real>& g, int lane) {
    return has_status(g, lane, kernels::kFrozen | kernels::kOutOfBounds) ? 1 : 0;
  }

  // Freezes the worlds of these lanes in which a result is not finite or an end is not known.
  // Returns the lanes in which it is not known whether the task ends the episode.
  std::uint32_t flag(const VisitedGroup<Real>& g, Thread& thread, std::uint32_t suspects) {
    std::uint32_t unknown = 0;
    for_each_lane(suspects, [&](int l) {
      const int world = g.group * lanes_ + l;
      // Worlds that begin now were not asked what they are.
      if (world >= worlds_ || begin_next[at(world)] != 0) return;
      ends_of_steps_.find_unknown(thread.values.data(), l, thread.unknown);
      if (thread.unknown[at(p_->terminated)] || !std::isfinite(value(thread, p_->terminated, l))) {
        unknown |= 1u << l;
      }
      name_faults(g, thread, l, p_->results.size());
    });
    return unknown;
  }

  // Of the first results of a lane. Not of worlds that are frozen already.
  void name_faults(const VisitedGroup<Real>& g, const Thread& thread, int lane,
                   std::size_t results) {
    const int world = g.group * lanes_ + lane;
    const bool was_frozen = has_status(g, lane, kernels::kFrozen);
    for (std::size_t i = 0; i < results; ++i) {
      const int row = p_->results[i];
      Real found = value(thread, row, lane);
      const bool is_end = i + 2 >= p_->results.size();
      if (is_end && thread.unknown[at(row)]) found = std::numeric_limits<Real>::quiet_NaN();
      if (std::isfinite(found)) continue;
      g.view.status[lane] |= kernels::kNonFinite;
      flagged_[at(world)] = 1;
      if (!was_frozen) faults_.add(i, world, static_cast<double>(found));
    }
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

  void run(const VisitedGroup<Real>& g, const ProgramCode<Real>& code, Thread& thread,
           bool beginning) const {
    code.run(g, lanes_,
             {.input = thread.inputs.data(),
              .memory = remembered_.now(g.group),
              .value = thread.values.data(),
              .beginning = beginning},
             thread.in);
  }

  Real value(const Thread& thread, int row, int lane) const {
    return thread.values[at(row * lanes_ + lane)];
  }

  // `unknown`: lanes in which it is not known whether the task ends the episode.
  void end_episodes(const VisitedGroup<Real>& g, const Thread& thread, int end,
                    std::uint32_t unknown) {
    const int first = g.group * lanes_;
    const Real* age = age_.data() + at(first);
    const Real* failed = thread.values.data() + at(p_->terminated * lanes_);
    const Real* broken_off = thread.values.data() + at(p_->truncated * lanes_);
    const Real most = p_->max_steps > 0 ? static_cast<Real>(p_->max_steps)
                                        : std::numeric_limits<Real>::infinity();
    bool some = false;
    for (int l = 0; l < end; ++l) {
      const std::size_t world = at(first + l);
      const bool begins = begin_next[world] != 0;
      const bool lost = !begins && is_lost(g, l) != 0;
      const bool terminated = !begins && failed[l] != 0 && !get_bit(unknown, at(l));
      const bool truncated = !begins && (broken_off[l] != 0 || age[l] >= most || lost);
      if (!out.lost.empty()) out.lost[world] = lost;
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

  std::shared_ptr<const TaskPrograms> p_;
  ProgramCode<Real> opening_, before_, after_;
  Autoreset autoreset_;
  int worlds_, lanes_;
  FiniteCheck<Real> ends_of_steps_, beginnings_;
  FaultLog faults_;
  ResultArrays<Real> results_;
  Remembered<Real> remembered_;
  Levels<Real> levels_;
  HostNumbers<Real> host_;
  AlignedBuffer<Real> age_;            // [group][lane]
  std::vector<std::uint8_t> flagged_;  // [world] whose results were not finite in this episode
  std::vector<Thread> threads_;
  Evaluation evaluation_;
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
