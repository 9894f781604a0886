#include "src/api/memory.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kernels/data/observer.hpp"
#include "src/api/observer_results.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/base/machine_memory.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/state/worlds.hpp"

namespace manyworlds {

namespace {

// What observers take for `worlds` of a kind, with the scratch of one thread.
template <class Real>
double observers_in(const Batch::Kind& kind, const BatchOptions& options,
                    const kernels::Kernels<Real>& kernels, int threads) {
  // The room for contacts that is asked for may exceed memory.
  Observers few = options.observe;
  few.contacts_per_world = std::min(few.contacts_per_world, 1);
  typename ObserverResultsOf<Real>::AllWorlds one;
  one.push_back(std::make_unique<Worlds<Real>>(kind.plan, 1, 0, options, kernels.lanes));
  const auto& tables = one.front()->tables();
  AlignedBuffer<unsigned char> memory(kernels.scratch_bytes(tables));
  kernels::Scratch* const scratch = kernels.make_scratch(tables, memory.data());
  ObserverResultsOf<Real> seen(one, few, kernels);
  seen.add_thread({&scratch, 1});
  double total = static_cast<double>(kind.worlds) * static_cast<double>(seen.world_bytes(0)) +
                 threads * static_cast<double>(seen.thread_bytes());
  if (observes(few, Observer::contacts)) {
    const double more = static_cast<double>(options.observe.contacts_per_world) -
                        static_cast<double>(few.contacts_per_world);
    total += (kind.worlds + static_cast<double>(threads) * kernels.lanes) * more *
             static_cast<double>(sizeof(kernels::ContactImpulse<Real>));
  }
  return total;
}

// One world is made, and what it takes counted.
template <class Real>
double memory_in(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa,
                 int threads) {
  const kernels::Kernels<Real>& kernels = kernels_for<Real>(isa);
  double total = 0;
  for (const Batch::Kind& kind : kinds) {
    const Worlds<Real> one(kind.plan, 1, 0, options, kernels.lanes);
    const double lanes = kernels.lanes;
    const double groups = std::ceil(kind.worlds / lanes);
    total += groups * static_cast<double>(one.storage().bytes());
    total += groups * lanes * static_cast<double>(one.own_bytes());
    total += threads * static_cast<double>(kernels.scratch_bytes(one.tables()));
    if (observes(options.observe)) total += observers_in<Real>(kind, options, kernels, threads);
  }
  return total;
}

}  // namespace

double memory_of(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa,
                 int threads) {
  return options.precision == Precision::f32 ? memory_in<float>(kinds, options, isa, threads)
                                             : memory_in<double>(kinds, options, isa, threads);
}

bool may_be_large(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, int threads) {
  constexpr int kManyWorlds = 256, kManyThreads = 32, kManyContacts = 1 << 16;
  int worlds = 0;
  for (const Batch::Kind& kind : kinds) worlds = std::max(worlds, kind.worlds);
  return worlds > kManyWorlds || threads > kManyThreads ||
         options.observe.contacts_per_world > kManyContacts;
}

std::string memory_text(const std::vector<Batch::Kind>& kinds, double bytes) {
  std::string text = "worlds: ";
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    text += (k > 0 ? " and " : "") + std::to_string(kinds[k].worlds) + " worlds of '" +
            kinds[k].plan.scene().name + "'";
  }
  return text + " need " + gigabytes(bytes) + " of memory";
}

}  // namespace manyworlds
