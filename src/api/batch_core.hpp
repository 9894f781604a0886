// CoreOf: a BatchCore in one number type. Which groups are stepped, on which scratch, and who looks
// at them before and after.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/api/batch_impl.hpp"
#include "src/base/bits.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

inline kernels::Layout layout_of(ContactLayout layout) {
  switch (layout) {
    case ContactLayout::dense: return kernels::Layout::dense;
    case ContactLayout::rows: return kernels::Layout::rows;
    case ContactLayout::automatic: break;
  }
  return kernels::Layout::automatic;
}

template <class Real>
class CoreOf final : public BatchCore {
 public:
  CoreOf(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa, int threads)
      : kernels_(kernels_for<Real>(isa)),
        layout_(layout_of(options.layout)),
        packs_(options.sleep) {
    for (const Isa i : {Isa::scalar, Isa::avx2, Isa::avx512}) {
      if (std::string(kernels_.isa) == to_string(i)) isa_ = i;
    }
    int first = 0, groups = 0;
    for (const auto& kind : kinds) {
      worlds_.push_back(
          std::make_unique<Worlds<Real>>(kind.plan, kind.worlds, first, options, kernels_.lanes));
      first_world_.push_back(first);
      first += kind.worlds;
      first_group_.push_back(groups);
      groups += worlds_.back()->storage().groups();
    }
    first_group_.push_back(groups);
    active_.reserve(static_cast<std::size_t>(groups));
    for (int slot = 0; slot < threads; ++slot) {
      auto& scratch = scratch_.emplace_back();
      for (const auto& w : worlds_) {
        scratch.memory.emplace_back(kernels_.scratch_bytes(w->tables()));
        scratch.views.push_back(kernels_.make_scratch(w->tables(), scratch.memory.back().data()));
      }
    }
    counters_.resize(static_cast<std::size_t>(threads));
    if (options.observe.what.empty() && options.observe.rays.empty()) return;
    observations_ = std::make_unique<ObservationsOf<Real>>(worlds_, options.observe, kernels_);
    for (const auto& scratch : scratch_) observations_->add_thread(scratch.views);
    look_again();
  }

  void step(Executor& executor, int n, const Visit& visit,
            std::span<const std::uint8_t> only) override {
    steps_ = n;
    visitor_ = static_cast<GroupVisitorOf<Real>*>(visit.visitor);
    part_ = visit;
    only_ = only;
    find_active();
    if (!active_.empty() && packs_) {
      for (auto& w : worlds_) w->pack();
      find_active();
    }
    if (!only_.empty()) {
      make_aside();
      std::erase_if(active_, [this](int group) { return lanes_in(only_, group) == 0; });
    }
    // A kind without contacts keeps its group in the cache for all n steps; so does one with
    // contacts, since groups do not know of each other.
    if (!active_.empty()) {
      executor.run(
          static_cast<int>(active_.size()),
          [](void* self, int index, int slot) { static_cast<CoreOf*>(self)->run(index, slot); },
          this);
    }
    only_ = {};
  }
  void end_steps(std::span<const std::uint8_t> only) override {
    if (only.empty()) {
      for (auto& w : worlds_) w->clear_forces();
      all_groups_ = false;
      return;
    }
    for (std::size_t k = 0; k < worlds_.size(); ++k) {
      for (int w = 0; w < worlds_[k]->count(); ++w) {
        if (is_in(only, k, w)) worlds_[k]->clear_forces(w);
      }
      worlds_[k]->find_forces();
    }
  }
  void look(Executor& executor) override {
    steps_ = 0;
    all_groups_ = true;
    find_active();
    executor.run(
        static_cast<int>(active_.size()),
        [](void* self, int index, int slot) { static_cast<CoreOf*>(self)->look_at(index, slot); },
        this);
  }
  void begin(Executor& executor, std::span<const std::uint8_t> worlds, bool reset,
             GroupVisitor& visitor) override {
    visitor_ = static_cast<GroupVisitorOf<Real>*>(&visitor);
    beginning_ = worlds;
    resets_ = reset;
    active_.clear();
    for (int g = 0; g < worlds_.front()->storage().groups(); ++g) {
      if (lanes_in(beginning_, g) != 0) active_.push_back(g);
    }
    executor.run(
        static_cast<int>(active_.size()),
        [](void* self, int index, int slot) { static_cast<CoreOf*>(self)->begin_in(index, slot); },
        this);
  }
  Observations* observations() override { return observations_.get(); }
  void look_again() override { all_groups_ = observations_ != nullptr; }

  void restart() override {
    for (auto& w : worlds_) w->restart();
  }
  void reset(int kind, int world) override { at(kind).reset(world); }
  void reset(int kind, int world, std::uint64_t seed) override { at(kind).reset(world, seed); }
  void read(Field field, int kind, int world, float* out) const override {
    at(kind).read(field, world, out);
  }
  void read(Field field, int kind, int world, double* out) const override {
    at(kind).read(field, world, out);
  }
  void write(Field field, int kind, int world, const float* in) override {
    at(kind).write(field, world, in);
  }
  void write(Field field, int kind, int world, const double* in) override {
    at(kind).write(field, world, in);
  }
  LaneBlocks lane_blocks(Field field, int kind) const override {
    return at(kind).lane_blocks(field);
  }
  int slot(int kind, int world) const override { return at(kind).slot_of(world); }
  void set_initial(Field field, int kind, int world, const double* in) override {
    at(kind).set_initial(field, world, in);
  }
  std::size_t parameter_size(Parameter parameter, int kind) const override {
    return at(kind).parameter_size(parameter);
  }
  void read(Parameter parameter, int kind, int world, double* out) const override {
    at(kind).read(parameter, world, out);
  }
  std::string check(Parameter parameter, int kind, int world, const double* in) const override {
    return at(kind).check(parameter, world, in);
  }
  void write(Parameter parameter, int kind, int world, const double* in) override {
    at(kind).write(parameter, world, in);
  }
  void set_controls(int kind, int first, int count, const float* in) override {
    at(kind).set_controls(first, count, in);
  }
  void set_controls(int kind, int first, int count, const double* in) override {
    at(kind).set_controls(first, count, in);
  }
  void read_controls(int kind, int first, int count, float* out) const override {
    at(kind).read_controls(first, count, out);
  }
  void read_controls(int kind, int first, int count, double* out) const override {
    at(kind).read_controls(first, count, out);
  }
  void add_force(int kind, int world, int body, const Vec3& f, const Vec3& torque) override {
    at(kind).add_force(world, body, f, torque);
  }
  void add_impulse(int kind, int world, int body, const Vec3& p, const Vec3& l) override {
    at(kind).add_impulse(world, body, p, l);
  }
  bool forced() const override {
    return std::any_of(worlds_.begin(), worlds_.end(),
                       [](const auto& w) { return w->storage().forced(); });
  }
  Vec3 center_of_mass(int kind, int world, int body) const override {
    return at(kind).center_of_mass(world, body);
  }
  void set_enabled(int kind, int world, int body, bool enabled) override {
    at(kind).set_enabled(world, body, enabled);
  }
  bool enabled(int kind, int world, int body) const override {
    return at(kind).enabled(world, body);
  }
  void set_joint_enabled(int kind, int world, int joint, bool enabled) override {
    at(kind).set_joint_enabled(world, joint, enabled);
  }
  bool joint_enabled(int kind, int world, int joint) const override {
    return at(kind).joint_enabled(world, joint);
  }
  void spawn(int kind, int world, int body, const BodyState& state) override {
    at(kind).spawn(world, body, state);
  }
  bool asleep(int kind, int world, int body) const override { return at(kind).asleep(world, body); }
  bool resting(int kind, int world) const override { return at(kind).resting(world); }
  void wake(int kind, int world) override { at(kind).wake(world); }
  std::int64_t group_steps() const override {
    std::int64_t sum = 0;
    for (const auto& c : counters_) sum += c.group_steps;
    return sum;
  }
  std::size_t world_bytes(int kind) const override { return at(kind).world_bytes(); }
  std::uint32_t episode(int kind, int world) const override { return at(kind).episode(world); }
  void set_episode(int kind, int world, std::uint32_t episode) override {
    at(kind).set_episode(world, episode);
  }
  std::uint64_t seed(int kind, int world) const override { return at(kind).seed(world); }
  void set_seed(int kind, int world, std::uint64_t seed) override {
    at(kind).set_seed(world, seed);
  }
  void write_world(int kind, int world, std::byte* to) const override {
    at(kind).write_world(world, to);
  }
  std::string check_world(int kind, const std::byte* from) const override {
    return at(kind).check_world(from);
  }
  void read_world(int kind, int world, const std::byte* from) override {
    look_again();
    at(kind).read_world(world, from);
  }
  void copy_world(int kind, int from, int to) override {
    look_again();
    at(kind).copy_world(from, to);
  }
  Status status(int kind, int world) const override { return at(kind).status(world); }
  std::uint64_t hash(int kind, int world) const override { return at(kind).hash(world); }
  Energy energy(int kind, int world) const override { return at(kind).energy(world); }

  std::vector<Contact> contacts(int kind, int world) const override;
  double occupancy(int kind, const GoOn& go_on) const override;

  std::size_t bytes() const override {
    std::size_t total = 0;
    for (const auto& w : worlds_) total += w->storage().bytes();
    return total;
  }
  std::size_t scratch_bytes() const override {
    std::size_t total = 0;
    for (const auto& m : scratch_.front().memory) total += m.size();
    return total;
  }
  int lanes() const override { return kernels_.lanes; }
  Isa isa() const override { return isa_; }

  void profile(bool on) override { profiling_ = on; }
  std::vector<StageTime> take_stage_times() override {
    std::vector<StageTime> out;
    for (std::size_t s = 0; s < StageClock::kStages; ++s) {
      double sum = 0;
      for (auto& c : counters_) sum += std::exchange(c.clock.seconds()[s], 0.0);
      if (sum > 0) out.push_back({StageClock::kNames[s], sum});
    }
    return out;
  }

 private:
  struct ThreadScratch {
    std::vector<AlignedBuffer<unsigned char>> memory;  // one block per kind
    std::vector<kernels::Scratch*> views;
    std::vector<std::byte> aside;  // [lane], see make_aside()
  };

  struct alignas(64) ThreadCounters {  // no two threads on one cache line
    std::int64_t group_steps = 0;
    StageClock clock;
  };

  Worlds<Real>& at(int kind) const { return *worlds_[static_cast<std::size_t>(kind)]; }

  void find_active() {
    active_.clear();
    for (std::size_t k = 0; k < worlds_.size(); ++k) {
      const Storage<Real>& storage = worlds_[k]->storage();
      for (int g = 0; g < storage.groups(); ++g) {
        if (all_groups_ || storage.moving_lanes(g) != 0) active_.push_back(first_group_[k] + g);
      }
    }
  }

  std::size_t kind_of(int active) const {
    std::size_t kind = 0;
    while (active >= first_group_[kind + 1]) ++kind;
    return kind;
  }
  bool is_in(std::span<const std::uint8_t> mask, std::size_t kind, int world) const {
    return mask[static_cast<std::size_t>(first_world_[kind] + world)] != 0;
  }
  // Lanes of an active group whose worlds are in a mask.
  std::uint32_t lanes_in(std::span<const std::uint8_t> mask, int active) const {
    const std::size_t kind = kind_of(active);
    const int slot = (active - first_group_[kind]) * kernels_.lanes;
    std::uint32_t lanes = 0;
    for (int l = 0; l < kernels_.lanes; ++l) {
      const int world = worlds_[kind]->world_in(slot + l);
      if (world >= 0 && is_in(mask, kind, world)) lanes |= 1u << l;
    }
    return lanes;
  }
  // Room for what lanes hold that are not to step.
  void make_aside() {
    std::size_t most = 0;
    for (const auto& w : worlds_) most = std::max(most, w->storage().world_bytes());
    for (auto& scratch : scratch_) {
      scratch.aside.resize(most * static_cast<std::size_t>(kernels_.lanes));
    }
  }

  // Calls work(plan of the step, group, scratch, counters, what a visitor sees) for a group that is
  // active, and brings home what it observed: `steps`, or only looks.
  template <class Work>
  void run_group(int index, int slot, bool steps, Work work) {
    const FloatMode mode(FloatMode::flush);  // whatever thread this is
    const int active = active_[static_cast<std::size_t>(index)];
    const std::size_t kind = kind_of(active);
    auto& w = *worlds_[kind];
    const auto s = static_cast<std::size_t>(slot);
    const int group = active - first_group_[kind];
    GroupStep<Real> plan{kernels_, w.tables(), layout_};
    if (observations_) {
      plan.wanted = &observations_->ask(s, kind, group);
      plan.poses = observations_->poses(s, kind);
    }
    const kernels::GroupView<Real> view = w.storage().group(group);
    const std::uint32_t lanes = only_.empty() ? ~std::uint32_t{0} : lanes_in(only_, active);
    const auto for_each_other = [&](auto&& call) {
      if (only_.empty()) return;
      std::vector<std::byte>& aside = scratch_[s].aside;
      const auto all = static_cast<std::size_t>(kernels_.lanes), bytes = aside.size() / all;
      for (std::size_t l = 0; l < all; ++l) {
        if (!get_bit(lanes, l))
          call(group * kernels_.lanes + static_cast<int>(l), aside.data() + l * bytes);
      }
    };
    for_each_other([&w](int slot_aside, std::byte* to) { w.put_aside(slot_aside, to); });
    work(plan, view, scratch_[s].views[kind], counters_[s],
         VisitedGroup<Real>{group, slot, kernels_, w.tables(), view,
                            w.storage().controls(group * kernels_.lanes), plan.wanted,
                            part_.begins && part_.ends});
    for_each_other([&w](int slot_aside, const std::byte* from) { w.put_back(slot_aside, from); });
    if (observations_) observations_->take(s, kind, group, lanes, steps);
  }
  void run(int index, int slot) {
    run_group(index, slot, true,
              [this](const auto& plan, const auto& group, auto* scratch, auto& counters,
                     const auto& visited) {
                if (visitor_ && part_.begins) visitor_->before_steps(visited);
                counters.group_steps += step_group<Real>(plan, group, scratch, steps_,
                                                         profiling_ ? &counters.clock : nullptr);
                if (visitor_ && part_.ends) visitor_->after_steps(visited);
              });
  }
  void begin_in(int index, int slot) {
    run_group(
        index, slot, false,
        [this](const auto& plan, const auto& group, auto* scratch, auto&, const auto& visited) {
          const std::uint32_t lanes = lanes_in(beginning_, visited.group);
          for (int l = 0; resets_ && l < kernels_.lanes; ++l) {
            if (get_bit(lanes, static_cast<std::size_t>(l))) {
              worlds_.front()->reset(visited.group * kernels_.lanes + l);
            }
          }
          if (plan.wanted) look_at_group<Real>(plan, group, scratch);
          visitor_->after_beginning(visited, lanes);
        });
  }
  void look_at(int index, int slot) {
    run_group(index, slot, false,
              [](const auto& plan, const auto& group, auto* scratch, auto&, const auto&) {
                look_at_group<Real>(plan, group, scratch);
              });
  }

  const kernels::KernelTable<Real>& kernels_;
  kernels::Layout layout_;
  Isa isa_ = Isa::scalar;
  int steps_ = 0;
  std::vector<std::unique_ptr<Worlds<Real>>> worlds_;
  std::vector<int> first_world_, first_group_;
  std::vector<int> active_;  // groups in which something moves
  std::vector<ThreadScratch> scratch_;
  std::vector<ThreadCounters> counters_;
  bool profiling_ = false;
  bool packs_;  // worlds may sleep
  std::unique_ptr<ObservationsOf<Real>> observations_;
  bool all_groups_ = false;                  // those that rest are to be looked at, too
  GroupVisitorOf<Real>* visitor_ = nullptr;  // of the call
  Visit part_;                               // of it, that these steps are
  std::span<const std::uint8_t> beginning_;  // [world]
  std::span<const std::uint8_t> only_;       // [world] of the call; empty: all
  bool resets_ = false;
};

}  // namespace manyworlds
