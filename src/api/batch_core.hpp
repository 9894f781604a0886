// BatchCore: what stands behind a Batch, whatever its number type: the worlds of each kind, and
// what spans kinds or threads, which are the step, the observers and the threads' scratch.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "src/api/observer_results.hpp"
#include "src/state/worlds_base.hpp"
#include "src/step/for_each_group.hpp"
#include "src/step/group_visitor.hpp"

namespace manyworlds {

class BatchCore {
 public:
  virtual ~BatchCore() = default;
  virtual WorldsBase& worlds(int kind) const = 0;

  // The visitor, of the batch's number type, may be null. `only`: the mask of the worlds that are
  // to step; empty: all. Forces act until end_steps().
  virtual void step(Executor& executor, int n, const Visit& visit = {},
                    std::span<const std::uint8_t> only = {}) = 0;
  virtual void end_steps(std::span<const std::uint8_t> only = {}) = 0;
  // Lets the visitor know that the worlds of this mask begin, before and after resetting them if it
  // is told to. Of batches of one kind, without sleep.
  virtual void begin(Executor& executor, std::span<const std::uint8_t> worlds,
                     const Beginning& beginning, GroupVisitor& visitor) = 0;

  // Shows all groups to the visitor as they are between steps, one by one, with what was last
  // observed of them. Of batches of one kind, without sleep.
  virtual void visit(GroupVisitor& visitor) = 0;

  virtual ObserverResults* observer_results() = 0;  // nullptr: nothing is observed
  virtual void look(Executor& executor) = 0;        // at the current state
  virtual void look_again() = 0;                    // at the next step also at what rests

  // Both run the collision stages once more on the current state.
  virtual std::vector<Contact> contacts(int kind, int world) const = 0;
  // Active share of the lanes of dense contact blocks, over all groups.
  virtual double occupancy(int kind, const GoOn& go_on) const = 0;

  virtual std::int64_t group_steps() const = 0;  // executed since construction
  virtual void profile(bool on) = 0;
  virtual std::vector<StageTime> take_stage_times() = 0;
  virtual std::size_t scratch_bytes() const = 0;  // per thread
  virtual int lanes() const = 0;
  virtual Isa isa() const = 0;
};

std::unique_ptr<BatchCore> make_core(const std::vector<Batch::Kind>& kinds,
                                     const BatchOptions& options, Isa isa, int threads);

}  // namespace manyworlds
