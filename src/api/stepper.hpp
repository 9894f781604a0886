// Stepper: a BatchCore in one number type. Which groups are stepped, on which thread's scratch, and
// what visits and observes them.
#pragma once

#include <memory>
#include <vector>

#include "src/api/batch_core.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/state/worlds.hpp"
#include "src/step/pipeline.hpp"

namespace manyworlds {

template <class Real>
class Stepper final : public BatchCore {
 public:
  Stepper(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa, int threads);

  WorldsBase& worlds(int kind) const override { return at(kind); }
  void step(Executor& executor, int n, const Visit& visit,
            std::span<const std::uint8_t> only) override;
  void end_steps(std::span<const std::uint8_t> only) override;
  void begin(Executor& executor, std::span<const std::uint8_t> worlds, const Beginning& beginning,
             GroupVisitor& visitor) override;
  void visit(GroupVisitor& visitor) override;
  ObserverResults* observer_results() override { return results_.get(); }
  void look(Executor& executor) override;
  void look_again() override { all_groups_ = results_ != nullptr; }

  std::vector<Contact> contacts(int kind, int world) const override;  // stepper_contacts.cpp
  double occupancy(int kind, const GoOn& go_on) const override;

  std::int64_t group_steps() const override;
  void profile(bool on) override { profiling_ = on; }
  std::vector<StageTime> take_stage_times() override;
  std::size_t scratch_bytes() const override;
  int lanes() const override { return kernels_.lanes; }
  Isa isa() const override { return isa_; }

 private:
  struct ThreadScratch {
    std::vector<AlignedBuffer<unsigned char>> memory;  // one block per kind
    std::vector<kernels::Scratch*> views;
    std::vector<std::byte> saved_lanes;  // [lane], see make_saved_lanes()
  };

  struct alignas(64) ThreadCounters {  // no two threads on one cache line
    std::int64_t group_steps = 0;
    StageClock clock;
  };

  Worlds<Real>& at(int kind) const { return *worlds_[static_cast<std::size_t>(kind)]; }

  GroupStep<Real> group_step(std::size_t kind) const {
    return {kernels_, worlds_[kind]->tables(), stages_[kind], layout_};
  }

  void find_active();
  std::size_t kind_of(int active) const;
  bool is_in(std::span<const std::uint8_t> mask, std::size_t kind, int world) const {
    return mask[static_cast<std::size_t>(first_world_[kind] + world)] != 0;
  }
  // Lanes of an active group whose worlds are in a mask.
  std::uint32_t lanes_in(std::span<const std::uint8_t> mask, int active) const;
  // Room for the state of lanes that are not to step.
  void make_saved_lanes();

  // Calls (this->*work)(index, thread) for each active group, in parallel.
  template <void (Stepper::*work)(int, int)>
  void for_each_active(Executor& executor);
  // Calls work(plan of the step, group, scratch, counters, what a visitor sees) for a group that is
  // active, and brings home what it observed: `steps`, or only looks.
  template <class Work>
  void run_group(int index, int thread, bool steps, Work work);
  void run(int index, int thread);
  void begin_in(int index, int thread);
  void look_at(int index, int thread);

  const kernels::Kernels<Real>& kernels_;
  kernels::Layout layout_;
  Isa isa_ = Isa::scalar;
  int steps_ = 0;
  std::vector<std::unique_ptr<Worlds<Real>>> worlds_;
  std::vector<StageList<Real>> stages_;  // [kind]
  std::vector<int> first_world_, first_group_;
  std::vector<int> active_;  // groups in which something moves
  std::vector<ThreadScratch> scratch_;
  std::vector<ThreadCounters> counters_;
  bool profiling_ = false;
  bool packs_;  // worlds may sleep
  std::unique_ptr<ObserverResultsOf<Real>> results_;
  bool all_groups_ = false;                  // those that rest are to be looked at, too
  GroupVisitorOf<Real>* visitor_ = nullptr;  // of the call
  Visit part_;                               // of it, that these steps are
  std::span<const std::uint8_t> beginning_;  // [world]
  std::span<const std::uint8_t> only_;       // [world] of the call; empty: all
  Beginning how_;
};

}  // namespace manyworlds
