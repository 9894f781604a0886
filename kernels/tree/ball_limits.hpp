// Rows of limits of ball joints: one for the angle of the joint's rotation, along its axis. The
// angle grows with the angular velocity about that axis. A set of rows as the newton solver asks
// for it (newton.hpp).
#pragma once

#include "kernels/tree/axis_angle.hpp"
#include "kernels/tree/compliance.hpp"
#include "kernels/tree/couplings.hpp"
#include "kernels/tree/row_force.hpp"
#include "kernels/tree/stiffness.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class BallLimitRows {
 public:
  MW_INLINE BallLimitRows(const Constants& t, const Work& w) : t_(t), rows_(w.tree.ball_rows) {}

  // Returns lanes that have any.
  MW_INLINE Mask find(const Group& g) const {
    Mask found = mask_from_bits(0);
    for (int i = 0; i < t_.tree.ball_limits; ++i) {
      const Limit& limit = t_.tree.ball_limit[i];
      const auto& own = constants_of_limit(g, t_.tree.limits + i);
      const AxisAngle at = axis_angle(normalize(load_quat(coordinate_of(t_, g, limit.coordinate))));
      const Float margin(limit.margin), distance = Float(own.end) - at.angle;
      const Mask near = distance < margin;
      const Vec3 spin{Float::load(velocity_of(t_, g, limit.dof)),
                      Float::load(velocity_of(t_, g, limit.dof + 1)),
                      Float::load(velocity_of(t_, g, limit.dof + 2))};
      const SoftRow soft = soft_row(own.compliance, limit.power, Float(limit.inverse_weight),
                                    distance - margin, -dot(at.axis, spin));
      Row& row = rows_[i];
      store(row.axis[0], at.axis);
      select(near, soft.weight, Real(0)).store(row.row.weight);
      select(near, soft.reference, Real(0)).store(row.row.reference);
      row.row.lanes = bits(near);
      found = found | near;
    }
    return found;
  }

  void look_at(std::uint32_t lanes) { lanes_ = lanes; }
  // J a - reference.
  MW_INLINE void start(const Real* a) const {
    for_each([&](Row& row, const Limit& limit) {
      (along(row, limit, a) - Float::load(row.row.reference)).store(row.row.residual);
    });
  }
  // Adds J' times the forces.
  MW_INLINE void add_forces(Real* load) const {
    for_each([&](Row& row, const Limit& limit) {
      Real* to = load + limit.dof * kLanes;
      store(to, fma(load_vec3(row.axis[0]), -view(row).force(), load_vec3(to)));
    });
  }
  // Adds J' D J of the rows that push. The dofs of a joint are coupled with each other anyway.
  MW_INLINE void add_stiffness(const Stiffness& stiffness) const {
    for_each([&](Row& row, const Limit& limit) {
      const Float own = view(row).stiffness();
      if ((bits(Float(Real(0)) < own) & lanes_) == 0) return;
      for (int i = 0; i < 3; ++i) {
        const Float of_dof = own * Float::load(row.axis[i]);
        for (int j = 0; j <= i; ++j) {
          Real* to = stiffness.entry(limit.dof + i, limit.dof + j);
          fma(of_dof, Float::load(row.axis[j]), Float::load(to)).store(to);
        }
      }
    });
  }
  // By links: its three dofs as one row.
  MW_INLINE void add_rows(Couplings& couplings) const {
    for_each([&](Row& row, const Limit& limit) {
      const Float weight = view(row).stiffness(), zero(Real(0));
      const Mask acts = zero < weight;
      if ((bits(acts) & lanes_) == 0) return;
      for (int i = 0; i < 3; ++i) {
        couplings.add_force(limit.dof + i, select(acts, Float::load(row.axis[i]), zero));
      }
      couplings.finish(weight);
    });
  }
  MW_INLINE void search(const Real* direction) const {
    for_each(
        [&](Row& row, const Limit& limit) { along(row, limit, direction).store(row.row.change); });
  }
  // Adds the derivatives of the cost along the search.
  MW_INLINE void along(Float step, Float& first, Float& second) const {
    for_each([&](Row& row, const Limit&) { view(row).add_along(step, first, second); });
  }
  // Goes the step but in lanes that are done; returns those in which a row has begun or ceased to
  // push.
  MW_INLINE Mask advance(Float step, Mask done) const {
    Mask changed = mask_from_bits(0);
    for_each([&](Row& row, const Limit&) { changed = changed | view(row).advance(step, done); });
    return changed;
  }

 private:
  using Row = TreeBallRow;
  using Limit = kernels::TreeBallLimit<Real>;
  // J x.
  static MW_INLINE Float along(const Row& row, const Limit& limit, const Real* x) {
    return -dot(load_vec3(row.axis[0]), load_vec3(x + limit.dof * kLanes));
  }
  static MW_INLINE RowView view(Row& row) {
    return {row.row.weight, row.row.residual, row.row.change};
  }
  template <class Visit>
  MW_INLINE void for_each(Visit visit) const {
    for (int i = 0; i < t_.tree.ball_limits; ++i) {
      if ((rows_[i].row.lanes & lanes_) != 0) visit(rows_[i], t_.tree.ball_limit[i]);
    }
  }

  const Constants& t_;
  std::uint32_t lanes_ = kAllLanes;
  Row* rows_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
