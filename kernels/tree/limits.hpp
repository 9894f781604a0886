// Rows of joint limits: one of a side of a coordinate, +-1 in the column of its dof. A set of rows
// as the newton solver asks for it (newton.hpp).
#pragma once

#include "kernels/tree/compliance.hpp"
#include "kernels/tree/row_force.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class LimitRows {
 public:
  MW_INLINE LimitRows(const Constants& t, const Work& w) : t_(t), rows_(w.tree.limit_rows) {}

  // Returns lanes that have any.
  MW_INLINE Mask find(const Group& g) const {
    Mask found = mask_from_bits(0);
    for (int i = 0; i < t_.tree.limits; ++i) {
      const auto& limit = t_.tree.limit[i];
      const Float side(limit.side), margin(limit.margin);
      const Float distance =
          side * (Float::load(coordinate_of(t_, g, limit.coordinate)) - Float(limit.end));
      const Mask near = distance < margin;
      const Float speed = side * Float::load(velocity_of(t_, g, limit.dof));
      const SoftRow soft =
          soft_row(limit.compliance, Float(limit.inverse_weight), distance - margin, speed);
      Row& row = rows_[i];
      select(near, soft.weight, Real(0)).store(row.weight);
      select(near, soft.reference, Real(0)).store(row.reference);
      row.lanes = bits(near);
      found = found | near;
    }
    return found;
  }

  // J a - reference.
  MW_INLINE void start(const Real* a) const {
    for_each([&](Row& row, const Limit& limit) {
      fms(Float(limit.side), Float::load(a + limit.dof * kLanes), Float::load(row.reference))
          .store(row.residual);
    });
  }
  // Adds J' times the forces.
  MW_INLINE void add_forces(Real* load) const {
    for_each([&](const Row& row, const Limit& limit) {
      const Float f = force_of(row);
      Real* to = load + limit.dof * kLanes;
      fma(Float(limit.side), f, Float::load(to)).store(to);
    });
  }
  // Adds J' D J of the rows that push.
  MW_INLINE void add_stiffness(Real* matrix) const {
    for_each([&](const Row& row, const Limit& limit) {
      Real* diagonal = matrix + t_.tree.dof[limit.dof].entry * kLanes;
      (Float::load(diagonal) + stiffness_of(row)).store(diagonal);
    });
  }
  MW_INLINE void search(const Real* direction) const {
    for_each([&](Row& row, const Limit& limit) {
      (Float(limit.side) * Float::load(direction + limit.dof * kLanes)).store(row.change);
    });
  }
  // Adds the derivatives of the cost along the search.
  MW_INLINE void along(Float step, Float& first, Float& second) const {
    for_each([&](const Row& row, const Limit&) { add_along(row, step, first, second); });
  }
  // Goes the step; returns lanes in which a row has begun or ceased to push.
  MW_INLINE Mask advance(Float step) const {
    Mask changed = mask_from_bits(0);
    for_each([&](Row& row, const Limit&) { changed = changed | advance_row(row, step); });
    return changed;
  }

 private:
  using Row = TreeRow;
  using Limit = kernels::TreeLimit<Real>;
  template <class Visit>
  MW_INLINE void for_each(Visit visit) const {
    for (int i = 0; i < t_.tree.limits; ++i) {
      if (rows_[i].lanes != 0) visit(rows_[i], t_.tree.limit[i]);
    }
  }

  const Constants& t_;
  Row* rows_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
