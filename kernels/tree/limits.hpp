// Rows of limits of joints and tendons: one of a side of a length, with a coefficient in the column
// of each of its dofs. A set of rows as the newton solver asks for it (newton.hpp).
#pragma once

#include "kernels/tree/compliance.hpp"
#include "kernels/tree/couplings.hpp"
#include "kernels/tree/row_force.hpp"
#include "kernels/tree/stiffness.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class LimitRows {
 public:
  MW_INLINE LimitRows(const Constants& t, const Work& w)
      : t_(t), rows_(w.tree.limit_rows), stale_(w.tree.stale) {}

  // Returns lanes that have any.
  MW_INLINE Mask find(const Group& g) const {
    Mask found = mask_from_bits(0);
    for (int i = 0; i < t_.tree.limits; ++i) {
      const auto& limit = t_.tree.limit[i];
      const auto& own = constants_of_limit(g, i);
      const Float side(limit.side), margin(limit.margin);
      const Float length =
          sum(limit, [&](const Term& term) { return coordinate_of(t_, g, term.coordinate); });
      const Float distance = side * (length - Float(own.end));
      const Mask near = distance < margin;
      Row& row = rows_[i];
      row.lanes = bits(near);
      if (row.lanes == 0) continue;
      const Float speed =
          side * sum(limit, [&](const Term& term) { return velocity_of(t_, g, term.dof); });
      const SoftRow soft = soft_row(own.compliance, limit.power, Float(limit.inverse_weight),
                                    distance - margin, speed);
      select(near, soft.weight, Real(0)).store(row.weight);
      select(near, soft.reference, Real(0)).store(row.reference);
      found = found | near;
    }
    return found;
  }

  void look_at(std::uint32_t lanes) { lanes_ = lanes; }
  // J a - reference.
  MW_INLINE void start(const Real* a) const {
    for_each([&](Row& row, const Limit& limit) {
      fms(Float(limit.side), along(limit, a), Float::load(row.reference)).store(row.residual);
    });
  }
  // Adds J' times the forces.
  MW_INLINE void add_forces(Real* load) const {
    for_each([&](Row& row, const Limit& limit) {
      const Float f = view(row).force();
      const Float own = Float(limit.side) * f;
      for (int i = 0; i < limit.terms; ++i) {
        const Term& term = t_.tree.term[limit.first_term + i];
        Real* to = load + term.dof * kLanes;
        fma(Float(term.coefficient), own, Float::load(to)).store(to);
      }
    });
  }
  // Adds J' D J of the active rows.
  MW_INLINE void couple(const Stiffness& stiffness) const {
    for_each([&](Row& row, const Limit& limit) {
      if (limit.terms > 1 && is_active(row)) stiffness.couple(limit.coupled);
    });
  }
  MW_INLINE void add_stiffness(const Stiffness& stiffness) const {
    for_each([&](Row& row, const Limit& limit) {
      if (!is_active(row)) return;
      const Float own = view(row).stiffness();
      const Term* terms = t_.tree.term + limit.first_term;
      for (int i = 0; i < limit.terms; ++i) {
        for (int j = i; j < limit.terms; ++j) {
          Real* to = stiffness.entry(terms[i].dof, terms[j].dof);
          const Float share(terms[i].coefficient * terms[j].coefficient);
          fma(share, own, Float::load(to)).store(to);
        }
      }
    });
  }
  // The same of rows of single dofs, on a diagonal [dof][lane], and of the others.
  MW_INLINE void add_stiffness(Real* diagonal) const {
    for_each([&](Row& row, const Limit& limit) {
      if (limit.terms > 1 || !is_active(row)) return;
      const Term& term = t_.tree.term[limit.first_term];
      Real* to = diagonal + term.dof * kLanes;
      const Float share(term.coefficient * term.coefficient);
      fma(share, view(row).stiffness(), Float::load(to)).store(to);
    });
  }
  MW_INLINE void add_rows(Couplings& couplings) const {
    for_each([&](Row& row, const Limit& limit) {
      if (limit.terms == 1 || !is_active(row)) return;
      const Float weight = view(row).stiffness(), zero(Real(0));
      for (int i = 0; i < limit.terms; ++i) {
        const Term& term = t_.tree.term[limit.first_term + i];
        couplings.add_force(term.dof, select(zero < weight, Float(term.coefficient), zero));
      }
      couplings.finish(weight);
    });
  }
  MW_INLINE void search(const Real* direction) const {
    for_each([&](Row& row, const Limit& limit) {
      (Float(limit.side) * along(limit, direction)).store(row.change);
    });
  }
  // Adds the derivatives of the cost along the search.
  MW_INLINE void along(Float step, Float& first, Float& second) const {
    for_each([&](Row& row, const Limit&) { view(row).add_along(step, first, second); });
  }
  // Goes the step but in lanes that are done; returns those in which a row has become
  // active or inactive.
  MW_INLINE Mask advance(Float step, Mask done) const {
    Mask changed = mask_from_bits(0);
    for_each([&](Row& row, const Limit& limit) {
      const Mask own = view(row).advance(step, done);
      if (limit.terms == 1 && any(own))
        stale_[t_.tree.dof[t_.tree.term[limit.first_term].dof].link] = true;
      changed = changed | own;
    });
    return changed;
  }

 private:
  using Row = TreeRow;
  using Limit = kernels::TreeLimit<Real>;
  using Term = kernels::TreeTerm<Real>;
  // Of what row(term) points to, each times its coefficient.
  template <class RowOf>
  MW_INLINE Float sum(const Limit& limit, RowOf row) const {
    const Term* terms = t_.tree.term + limit.first_term;
    Float out = Float(terms[0].coefficient) * Float::load(row(terms[0]));
    for (int i = 1; i < limit.terms; ++i) {
      out = fma(Float(terms[i].coefficient), Float::load(row(terms[i])), out);
    }
    return out;
  }
  MW_INLINE Float along(const Limit& limit, const Real* x) const {
    return sum(limit, [&](const Term& term) { return x + term.dof * kLanes; });
  }
  static MW_INLINE RowView view(Row& row) { return {row.weight, row.residual, row.change}; }
  template <class Visit>
  MW_INLINE void for_each(Visit visit) const {
    for (int i = 0; i < t_.tree.limits; ++i) {
      if ((rows_[i].lanes & lanes_) != 0) visit(rows_[i], t_.tree.limit[i]);
    }
  }

  MW_INLINE bool is_active(Row& row) const {
    return (bits(Float(Real(0)) < view(row).stiffness()) & lanes_) != 0;
  }

  const Constants& t_;
  std::uint32_t lanes_ = kAllLanes;
  Row* rows_;
  bool* stale_;  // [link]
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
