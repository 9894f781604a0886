// A row of the newton solver that can only push: cost 1/2 D x^2 of its residual x = J a - reference
// where that is negative, force -D x.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Float negative_part(Float x) { return min(x, Real(0)); }

MW_INLINE Float force_of(const TreeRow& row) {
  return -(Float::load(row.weight) * negative_part(Float::load(row.residual)));
}
MW_INLINE Float stiffness_of(const TreeRow& row) {
  const Float zero(Real(0));
  return select(Float::load(row.residual) < zero, Float::load(row.weight), zero);
}
MW_INLINE void add_along(const TreeRow& row, Float step, Float& first, Float& second) {
  const Float zero(Real(0)), change = Float::load(row.change);
  const Float x = fma(step, change, Float::load(row.residual));
  const Float slope = Float::load(row.weight) * change;
  first = fma(slope, negative_part(x), first);
  second = second + select(x < zero, slope * change, zero);
}
MW_INLINE Mask advance_row(TreeRow& row, Float step) {
  const Float zero(Real(0)), before = Float::load(row.residual);
  const Float after = fma(step, Float::load(row.change), before);
  after.store(row.residual);
  const Mask pushed = before < zero, pushes = after < zero;
  return ((pushed & !pushes) | (pushes & !pushed)) & (zero < Float::load(row.weight));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
