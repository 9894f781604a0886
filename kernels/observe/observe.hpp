// What observers do beside the step, as one table.
#pragma once

#include "kernels/observation.hpp"
#include "kernels/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Observation = kernels::Observation<Real>;

const kernels::ObserverTable<Real>* observer_table();

// Adds to rows of lanes.
MW_INLINE void add_to(Real* rows, int row, Float x) {
  (Float::load(rows + row * kLanes) + x).store(rows + row * kLanes);
}
MW_INLINE void add_to(Real* rows, int row, Vec2 x) {
  add_to(rows, row, x.x), add_to(rows, row + 1, x.y);
}
MW_INLINE void add_to(Real* rows, int row, Vec3 x) {
  add_to(rows, row, x.x), add_to(rows, row + 1, x.y), add_to(rows, row + 2, x.z);
}

void observe_rays(const Tables& t, const Group& g, kernels::Scratch* scratch, const Observation& o);
bool cast_one(kernels::Dimension dimension, kernels::ShapeKind kind, const Real* row,
              const Real* ray, Real* out);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
