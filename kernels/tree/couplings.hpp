// Rows of the newton solver that couple branches of trees: contacts between two links, limits of
// several dofs. Where A is what articulated bodies solve (articulated.hpp), J the rows that act and
// W their weights,
//   (A + J' W J) x = load   is   A x = load - J' f,   (1 / W + J A^-1 J') f = J A^-1 load.
// With A^-1 = E D^-1 E' a row is reduced along the ways of its links to the root, E' J', and the
// matrix of f is 1 / W + (E' J')' D^-1 (E' J'), a sum of squares.
#pragma once

#include "kernels/tree/articulated.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class Couplings {
 public:
  MW_INLINE Couplings(const Constants& t, const Group& g, const Work& w)
      : t_(t), w_(w), x_(w.tree), bodies_(t, g, w) {}

  void clear() { count_ = 0, begin(); }
  bool any() const { return count_ > 0; }

  // A row is given by these, then finish. It has to be 0 where its weight is.
  void add_wrench(int link, Wrench f) {
    const int dof = t_.tree.link[link].last_dof;
    if (dof < 0) return;
    for (int at = link; at != t_.tree.dof[dof].link; at = t_.tree.link[at].parent) {
      f = to_parent(w_, at, f);
    }
    const DofBits own = DofBits(1) << dof;
    Real* to = pending(dof);
    store(to, (waiting_ & own) ? load_wrench(to) + f : f);
    waiting_ |= own, reached_ |= own | t_.tree.ancestors[dof];
  }
  void add_force(int dof, Float f) {
    f.store(spread(count_, dof));
    const DofBits own = DofBits(1) << dof;
    direct_ |= own, reached_ |= own | t_.tree.ancestors[dof];
  }
  void finish(Float weight) {
    reduce();
    factorise(weight);
    x_.reached[count_++] = reached_;
    begin();
  }

  // From reduced loads to those less what the rows take, also reduced.
  void correct(Real* loads) const {
    Real* f = x_.multiplier;
    for (int r = 0; r < count_; ++r) {
      Float sum = along(r, loads);
      for (int s = 0; s < r; ++s) sum = fnma(entry(r, s), Float::load(f + s * kLanes), sum);
      sum.store(f + r * kLanes);
    }
    for (int r = count_ - 1; r >= 0; --r) {
      Float own = Float::load(f + r * kLanes) * entry(r, r);
      for (int s = r + 1; s < count_; ++s)
        own = fnma(entry(s, r), Float::load(f + s * kLanes), own);
      own.store(f + r * kLanes);
    }
    for (int r = 0; r < count_; ++r) {
      const Float own = Float::load(f + r * kLanes);
      for_each_dof_in(x_.reached[r], [&](int k) {
        Real* to = loads + k * kLanes;
        fnma(own, Float::load(spread(r, k)), Float::load(to)).store(to);
      });
    }
  }

 private:
  template <class Visit>
  static MW_INLINE void for_each_dof_in(DofBits set, Visit visit) {  // the last one first
    while (set != 0) {
      const int k = 63 - __builtin_clzll(set);
      set &= ~(DofBits(1) << k);
      visit(k);
    }
  }
  MW_INLINE Real* pending(int dof) const { return x_.pending + dof * kTwistRows * kLanes; }
  MW_INLINE Real* spread(int row, int dof) const {
    return x_.spread + (row * t_.tree.dofs + dof) * kLanes;
  }
  MW_INLINE Real* scaled(int dof) const { return x_.scaled + dof * kLanes; }
  MW_INLINE Real* schur(int row, int before) const {
    return x_.schur + (row * (row + 1) / 2 + before) * kLanes;
  }
  MW_INLINE Float entry(int row, int before) const { return Float::load(schur(row, before)); }
  void begin() { waiting_ = direct_ = reached_ = 0; }

  // The row as the dofs have it when those beyond have given way. The wrench on its way to the root
  // stays in registers; where another branch is to come first, in `pending`.
  void reduce() {
    Wrench f{zero_of<Vec3>(), zero_of<Vec3>()};
    int carried = -1;  // the dof that it has come to
    DofBits done = 0;
    for_each_dof_in(reached_, [&](int k) {
      if ((done >> k) & 1) return;
      const bool waits = (waiting_ >> k) & 1, here = carried == k;
      Wrench own{zero_of<Vec3>(), zero_of<Vec3>()};
      if (here) own = f;
      if (waits) own = here ? f + load_wrench(pending(k)) : load_wrench(pending(k));
      const int link = t_.tree.dof[k].link;
      if (FreeRoot::is(t_, t_.tree.link[link])) {
        const int first = t_.tree.link[link].first_dof;
        bodies_.root(link).reduce(own, spread(count_, first));
        for (int d = first; d < first + FreeRoot::kSize; ++d) {
          const Float part = Float::load(spread(count_, d));
          (part * Float::load(x_.inverse + d * kLanes)).store(scaled(d));
          done |= DofBits(1) << d;
        }
        if (here) carried = -1;
        return;
      }
      Real* to = spread(count_, k);
      Float force = dot(load_twist(axis_of(w_, k)), own);
      if ((direct_ >> k) & 1) force = force + Float::load(to);
      force.store(to);
      const Float gives = force * Float::load(x_.inverse + k * kLanes);
      gives.store(scaled(k));
      const int parent = t_.tree.dof[k].parent;
      if (here) carried = -1;
      if (parent < 0) return;
      own = fnma(load_wrench(x_.response + k * kTwistRows * kLanes), gives, own);
      for (int at = link; at != t_.tree.dof[parent].link; at = t_.tree.link[at].parent) {
        own = to_parent(w_, at, own);
      }
      if (carried < 0) {
        f = own, carried = parent;
      } else if (carried == parent) {
        f = f + own;
      } else {
        Real* rows = pending(parent);
        const DofBits bit = DofBits(1) << parent;
        store(rows, (waiting_ & bit) ? load_wrench(rows) + own : own);
        waiting_ |= bit;
      }
    });
  }
  // Its row of L D L'; on the diagonal 1 / D.
  void factorise(Float weight) const {
    const Float one(Real(1)), zero(Real(0));
    for (int s = 0; s <= count_; ++s) {
      Float sum = zero;
      const DofBits common = s < count_ ? reached_ & x_.reached[s] : reached_;
      for_each_dof_in(common, [&](int k) {
        sum = fma(Float::load(spread(s, k)), Float::load(scaled(k)), sum);
      });
      for (int q = 0; q < s; ++q) {
        // Up to here row `count_` holds L D.
        sum =
            fnma(entry(count_, q), s < count_ ? entry(s, q) : entry(count_, q) * entry(q, q), sum);
      }
      sum.store(schur(count_, s));
    }
    for (int s = 0; s < count_; ++s) (entry(count_, s) * entry(s, s)).store(schur(count_, s));
    const Mask acts = zero < weight;
    const Float own = entry(count_, count_) + one / select(acts, weight, one);
    (one / select(acts, own, one)).store(schur(count_, count_));
  }
  // J A^-1 load, from reduced loads.
  MW_INLINE Float along(int row, const Real* loads) const {
    Float sum(Real(0));
    for_each_dof_in(x_.reached[row], [&](int k) {
      const Float own = Float::load(loads + k * kLanes) * Float::load(x_.inverse + k * kLanes);
      sum = fma(Float::load(spread(row, k)), own, sum);
    });
    return sum;
  }

  const Constants& t_;
  const Work& w_;
  const TreeWork& x_;
  const ArticulatedBodies bodies_;
  int count_ = 0;
  DofBits waiting_ = 0, direct_ = 0, reached_ = 0;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
