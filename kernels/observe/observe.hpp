// What observers do beside the step, as one table.
#pragma once

#include "kernels/data/observer.hpp"
#include "kernels/data/program.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using ObserverView = kernels::ObserverView<Real>;
using kernels::row_of;
using kernels::rows_of;

// Where an observer puts what it sees; nullptr: it was not asked for.
MW_INLINE Real* rows_for(const ObserverView& o, Observer observer) {
  return o.rows[static_cast<int>(observer)];
}
MW_INLINE int items_of(const ObserverView& o, Observer observer) {
  return o.items[static_cast<int>(observer)];
}

const kernels::ObserverTable<Real>* observer_table();

void observe_rays(const Constants& t, const Group& g, kernels::Scratch* scratch,
                  const ObserverView& o);
void run_program(const Group& g, const ObserverView* seen, const kernels::ProgramRun<Real>& run);
bool cast_one(kernels::Dimension dimension, kernels::ShapeKind kind, const Real* row,
              const Real* ray, Real* out);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
