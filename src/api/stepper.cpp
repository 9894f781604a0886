#include "src/api/stepper.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "src/base/bits.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

kernels::Layout layout_of(ContactLayout layout) {
  switch (layout) {
    case ContactLayout::dense: return kernels::Layout::dense;
    case ContactLayout::rows: return kernels::Layout::rows;
    case ContactLayout::automatic: break;
  }
  return kernels::Layout::automatic;
}

}  // namespace

template <class Real>
Stepper<Real>::Stepper(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa,
                       int threads)
    : kernels_(kernels_for<Real>(isa)), layout_(layout_of(options.layout)), packs_(options.sleep) {
  for (const Isa i : {Isa::scalar, Isa::avx2, Isa::avx512}) {
    if (std::string(kernels_.isa) == to_string(i)) isa_ = i;
  }
  int first = 0, groups = 0;
  for (const auto& kind : kinds) {
    worlds_.push_back(
        std::make_unique<Worlds<Real>>(kind.plan, kind.worlds, first, options, kernels_.lanes));
    stages_.emplace_back(worlds_.back()->data(), worlds_.back()->tables(), kernels_);
    first_world_.push_back(first);
    first += kind.worlds;
    first_group_.push_back(groups);
    groups += worlds_.back()->storage().groups();
  }
  first_group_.push_back(groups);
  active_.reserve(static_cast<std::size_t>(groups));
  for (int thread = 0; thread < threads; ++thread) {
    auto& scratch = scratch_.emplace_back();
    for (const auto& w : worlds_) {
      scratch.memory.emplace_back(kernels_.scratch_bytes(w->tables()));
      scratch.views.push_back(kernels_.make_scratch(w->tables(), scratch.memory.back().data()));
    }
  }
  counters_.resize(static_cast<std::size_t>(threads));
  if (!observes(options.observe)) return;
  results_ = std::make_unique<ObserverResultsOf<Real>>(worlds_, options.observe, kernels_);
  for (const auto& scratch : scratch_) results_->add_thread(scratch.views);
  look_again();
}

template <class Real>
template <void (Stepper<Real>::*work)(int, int)>
void Stepper<Real>::for_each_active(Executor& executor) {
  executor.run(
      static_cast<int>(active_.size()),
      [](void* self, int index, int thread) {
        (static_cast<Stepper*>(self)->*work)(index, thread);
      },
      this);
}

template <class Real>
void Stepper<Real>::step(Executor& executor, int n, const Visit& visit,
                         std::span<const std::uint8_t> only) {
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
    make_saved_lanes();
    std::erase_if(active_, [this](int group) { return lanes_in(only_, group) == 0; });
  }
  // A kind without contacts keeps its group in the cache for all n steps; so does one with
  // contacts, since groups do not know of each other.
  if (!active_.empty()) for_each_active<&Stepper::run>(executor);
  only_ = {};
}

template <class Real>
void Stepper<Real>::end_steps(std::span<const std::uint8_t> only) {
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

template <class Real>
void Stepper<Real>::begin(Executor& executor, std::span<const std::uint8_t> worlds,
                          const Beginning& beginning, GroupVisitor& visitor) {
  visitor_ = static_cast<GroupVisitorOf<Real>*>(&visitor);
  beginning_ = worlds;
  how_ = beginning;
  active_.clear();
  for (int g = 0; g < worlds_.front()->storage().groups(); ++g) {
    if (lanes_in(beginning_, g) != 0) active_.push_back(g);
  }
  for_each_active<&Stepper::begin_in>(executor);
  beginning_ = {}, how_ = {};
}

template <class Real>
void Stepper<Real>::visit(GroupVisitor& visitor) {
  const FloatMode mode(FloatMode::flush);
  auto& to = static_cast<GroupVisitorOf<Real>&>(visitor);
  auto& w = *worlds_.front();
  for (int g = 0; g < w.storage().groups(); ++g) {
    const kernels::GroupView<Real> view = w.storage().group(g);
    const auto* seen = results_ ? &results_->recall(g) : nullptr;
    to.between_steps({g, 0, kernels_, w.tables(), view, w.storage().controls(g * kernels_.lanes),
                      seen, w, false});
  }
}

template <class Real>
void Stepper<Real>::look(Executor& executor) {
  steps_ = 0;
  all_groups_ = true;
  find_active();
  for_each_active<&Stepper::look_at>(executor);
}

template <class Real>
void Stepper<Real>::find_active() {
  active_.clear();
  for (std::size_t k = 0; k < worlds_.size(); ++k) {
    const Storage<Real>& storage = worlds_[k]->storage();
    for (int g = 0; g < storage.groups(); ++g) {
      if (all_groups_ || storage.moving_lanes(g) != 0) active_.push_back(first_group_[k] + g);
    }
  }
}

template <class Real>
std::size_t Stepper<Real>::kind_of(int active) const {
  std::size_t kind = 0;
  while (active >= first_group_[kind + 1]) ++kind;
  return kind;
}

template <class Real>
std::uint32_t Stepper<Real>::lanes_in(std::span<const std::uint8_t> mask, int active) const {
  const std::size_t kind = kind_of(active);
  const int lane_index = (active - first_group_[kind]) * kernels_.lanes;
  std::uint32_t lanes = 0;
  for (int l = 0; l < kernels_.lanes; ++l) {
    const int world = worlds_[kind]->world_in(lane_index + l);
    if (world >= 0 && is_in(mask, kind, world)) lanes |= 1u << l;
  }
  return lanes;
}

template <class Real>
void Stepper<Real>::make_saved_lanes() {
  std::size_t bytes = 0;
  for (const auto& w : worlds_) bytes = std::max(bytes, w->storage().world_bytes());
  for (auto& scratch : scratch_) {
    scratch.saved_lanes.resize(bytes * static_cast<std::size_t>(kernels_.lanes));
  }
}

template <class Real>
template <class Work>
void Stepper<Real>::run_group(int index, int thread, bool steps, Work work) {
  const FloatMode mode(FloatMode::flush);  // whatever thread this is
  const int active = active_[static_cast<std::size_t>(index)];
  const std::size_t kind = kind_of(active);
  auto& w = *worlds_[kind];
  const auto t = static_cast<std::size_t>(thread);
  const int group = active - first_group_[kind], first_lane = group * kernels_.lanes;
  GroupStep<Real> plan = group_step(kind);
  if (results_) {
    plan.wanted = &results_->ask(t, kind, group);
    plan.poses = results_->poses(t, kind);
  }
  const kernels::GroupView<Real> view = w.storage().group(group);
  const std::uint32_t lanes = only_.empty() ? ~std::uint32_t{0} : lanes_in(only_, active);
  const auto for_each_other = [&](auto&& call) {
    if (only_.empty()) return;
    std::vector<std::byte>& saved = scratch_[t].saved_lanes;
    const auto all = static_cast<std::size_t>(kernels_.lanes), bytes = saved.size() / all;
    for (std::size_t l = 0; l < all; ++l) {
      if (!get_bit(lanes, l)) call(first_lane + static_cast<int>(l), saved.data() + l * bytes);
    }
  };
  for_each_other([&w](int lane_index, std::byte* to) { w.save_lane(lane_index, to); });
  work(plan, view, scratch_[t].views[kind], counters_[t],
       VisitedGroup<Real>{group, thread, kernels_, w.tables(), view,
                          w.storage().controls(first_lane), plan.wanted, w,
                          part_.begins && part_.ends});
  for_each_other([&w](int lane_index, const std::byte* from) { w.restore_lane(lane_index, from); });
  // The others have not been stepped: what was last seen of their steps stays.
  const std::uint32_t seen = beginning_.empty() ? lanes : lanes_in(beginning_, active);
  if (results_) results_->take(t, kind, group, seen, steps);
}

template <class Real>
void Stepper<Real>::run(int index, int thread) {
  run_group(index, thread, true,
            [this](const auto& plan, const auto& group, auto* scratch, auto& counters,
                   const auto& visited) {
              if (visitor_ && part_.begins) visitor_->before_steps(visited);
              counters.group_steps += step_group<Real>(plan, group, scratch, steps_,
                                                       profiling_ ? &counters.clock : nullptr);
              if (visitor_ && part_.ends) visitor_->after_steps(visited);
            });
}

template <class Real>
void Stepper<Real>::begin_in(int index, int thread) {
  run_group(index, thread, false,
            [this](const auto& plan, const auto& group, auto* scratch, auto&, const auto& visited) {
              const std::uint32_t lanes = lanes_in(beginning_, visited.group);
              auto& own = *worlds_.front();
              visitor_->before_beginning(visited, own, lanes, how_);
              for (int l = 0; how_.resets && l < kernels_.lanes; ++l) {
                if (!get_bit(lanes, static_cast<std::size_t>(l))) continue;
                const int world = visited.group * kernels_.lanes + l;
                if (how_.seeds.empty()) {
                  own.reset(world);
                } else {
                  own.reset(world, how_.seeds[static_cast<std::size_t>(world)]);
                }
              }
              if (plan.wanted) look_at_group<Real>(plan, group, scratch);
              visitor_->after_beginning(visited, lanes);
            });
}

template <class Real>
void Stepper<Real>::look_at(int index, int thread) {
  run_group(index, thread, false,
            [](const auto& plan, const auto& group, auto* scratch, auto&, const auto&) {
              look_at_group<Real>(plan, group, scratch);
            });
}

template <class Real>
std::int64_t Stepper<Real>::group_steps() const {
  std::int64_t sum = 0;
  for (const auto& c : counters_) sum += c.group_steps;
  return sum;
}

template <class Real>
std::vector<StageTime> Stepper<Real>::take_stage_times() {
  std::vector<StageTime> out;
  for (std::size_t s = 0; s < kStepStages; ++s) {
    double sum = 0;
    for (auto& c : counters_) sum += std::exchange(c.clock.seconds()[s], 0.0);
    if (sum > 0) out.push_back({kStepStageNames[s], sum});
  }
  return out;
}

template <class Real>
std::size_t Stepper<Real>::scratch_bytes() const {
  std::size_t total = 0;
  for (const auto& m : scratch_.front().memory) total += m.size();
  return total;
}

std::unique_ptr<BatchCore> make_core(const std::vector<Batch::Kind>& kinds,
                                     const BatchOptions& options, Isa isa, int threads) {
  if (options.precision == Precision::f32) {
    return std::make_unique<Stepper<float>>(kinds, options, isa, threads);
  }
  return std::make_unique<Stepper<double>>(kinds, options, isa, threads);
}

}  // namespace manyworlds
