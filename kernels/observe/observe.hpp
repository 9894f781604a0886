// What observers do beside the step, as one table.
#pragma once

#include "kernels/data/observation.hpp"
#include "kernels/data/program.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Observation = kernels::Observation<Real>;

const kernels::ObserverTable<Real>* observer_table();

void observe_rays(const Tables& t, const Group& g, kernels::Scratch* scratch, const Observation& o);
void run_program(const Group& g, const Observation* seen, const kernels::ProgramRun<Real>& run);
bool cast_one(kernels::Dimension dimension, kernels::ShapeKind kind, const Real* row,
              const Real* ray, Real* out);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
