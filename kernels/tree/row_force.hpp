// A one-sided row of the newton solver: cost 1/2 D x^2 of its residual x = J a - reference
// where that is negative, force -D x.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Float negative_part(Float x) { return min(x, Real(0)); }

// Numbers of a row, [lane] each.
struct RowView {
  const Real* weight;  // D
  Real* residual;
  const Real* change;  // of the residual, along the search

  MW_INLINE Float force() const {
    return -(Float::load(weight) * negative_part(Float::load(residual)));
  }
  MW_INLINE Float stiffness() const {
    const Float zero(Real(0));
    return select(Float::load(residual) < zero, Float::load(weight), zero);
  }
  // Adds the derivatives of the cost where the step leads.
  MW_INLINE void add_along(Float step, Float& first, Float& second) const {
    const Float zero(Real(0)), rate = Float::load(change);
    const Float x = fma(step, rate, Float::load(residual));
    const Float slope = Float::load(weight) * rate;
    first = fma(slope, negative_part(x), first);
    second = second + select(x < zero, slope * rate, zero);
  }
  // Goes the step but in lanes that are done; returns those in which the row has become
  // active or inactive.
  MW_INLINE Mask advance(Float step, Mask done) const {
    const Float zero(Real(0)), before = Float::load(residual);
    const Float after = select(done, before, fma(step, Float::load(change), before));
    after.store(residual);
    const Mask was_active = before < zero, is_active = after < zero;
    return ((was_active & !is_active) | (is_active & !was_active)) & (zero < Float::load(weight));
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
