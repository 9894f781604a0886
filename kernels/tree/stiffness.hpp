// The symmetric matrix M + J' D J of the newton solver and its factors L' D L. Below the diagonal a
// row has room for all dofs before it, its own first; those that are not 0 are known as bits: those
// on the way to the root, those that contacts of this step couple the dof with, and what the
// factors fill. They are listed anew where the couplings are others than in the factorisation
// before. Zeros of other lanes' contacts are +0, and change nothing wherever they are added.
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class Stiffness {
 public:
  MW_INLINE Stiffness(const Constants& t, const Work& w)
      : t_(t), x_(w.tree), numbers_(w.tree.stiffness) {}

  // Before the first pattern of these tables: no dof couples with itself.
  void forget_pattern() const { x_.listed[0] = 1; }

  MW_INLINE Real* row(int dof) const { return numbers_ + dof * (dof + 1) / 2 * kLanes; }
  MW_INLINE Real* entry(int dof, int before) const { return row(dof) + (dof - before) * kLanes; }

  // Which entries there are. Between these two calls: couple, for sets of dofs with J' D J.
  void begin_pattern() const {
    for (int k = 0; k < t_.tree.dofs; ++k) x_.coupled[k] = t_.tree.ancestors[k];
  }
  MW_INLINE void couple(DofBits set) const { couple(x_.coupled, set); }
  void fill_pattern() const {
    bool same = true;
    for (int k = 0; k < t_.tree.dofs; ++k) {
      same = same && x_.listed[k] == x_.coupled[k];
      x_.listed[k] = x_.coupled[k];
    }
    if (same) return;
    for (int k = t_.tree.dofs - 1; k > 0; --k) couple(x_.coupled, x_.coupled[k]);
    for (int k = 0; k < t_.tree.dofs; ++k) list(k, x_.coupled[k]);
  }

  // M itself.
  void start(const Real* matrix) const {
    const Float zero(Real(0));
    for (int k = 0; k < t_.tree.dofs; ++k) {
      Real* own = row(k);
      const TreeEntry* entry = entries(k);
      for (int a = 0; a < x_.counts[k]; ++a) zero.store(own + entry[a].at);
      const Real* from = matrix + t_.tree.dof[k].entry * kLanes;
      for (int j = k; j >= 0; j = t_.tree.dof[j].parent, from += kLanes) {
        (Float::load(from) + zero).store(own + (k - j) * kLanes);
      }
    }
  }

  // Makes it L, unit diagonals left out, and 1 / D where those are.
  void factorise() const {
    for (int k = t_.tree.dofs - 1; k >= 0; --k) {
      Real* own = row(k);
      const Float inverse = Float(Real(1)) / Float::load(own);
      inverse.store(own);
      const TreeEntry* entry = entries(k);
      const int count = x_.counts[k];
      for (int a = 0; a < count; ++a) {
        Real* at = own + entry[a].at;
        const Float value = Float::load(at), factor = value * inverse;
        // The entries of that row, as places in this one.
        Real* other = numbers_ + entry[a].row - entry[a].at;
        for (int b = a; b < count; ++b) {
          Real* to = other + entry[b].at;
          fnma(factor, Float::load(own + entry[b].at), Float::load(to)).store(to);
        }
        factor.store(at);
      }
    }
  }
  // x <- its inverse times x, [dof][lane].
  void solve(Real* x) const {
    for (int k = t_.tree.dofs - 1; k >= 0; --k) {
      const Real* own = row(k);
      Real* at = x + k * kLanes;
      const Float value = Float::load(at);
      const TreeEntry* entry = entries(k);
      for (int a = 0; a < x_.counts[k]; ++a) {
        Real* to = at - entry[a].at;
        fnma(Float::load(own + entry[a].at), value, Float::load(to)).store(to);
      }
    }
    for (int k = 0; k < t_.tree.dofs; ++k) {
      const Real* own = row(k);
      Real* at = x + k * kLanes;
      Float value = Float::load(at) * Float::load(own);
      const TreeEntry* entry = entries(k);
      for (int a = 0; a < x_.counts[k]; ++a) {
        value = fnma(Float::load(own + entry[a].at), Float::load(at - entry[a].at), value);
      }
      value.store(at);
    }
  }

 private:
  static MW_INLINE void couple(DofBits* rows_of, DofBits set) {
    for (DofBits rows = set; rows != 0; rows &= rows - 1) {
      const int k = __builtin_ctzll(rows);
      rows_of[k] |= set & ((DofBits(1) << k) - 1);
    }
  }
  MW_INLINE TreeEntry* entries(int k) const { return x_.entries + k * (k - 1) / 2; }
  MW_INLINE void list(int k, DofBits columns) const {
    TreeEntry* to = entries(k);
    for (; columns != 0; ++to) {
      const int j = 63 - __builtin_clzll(columns);
      columns &= ~(DofBits(1) << j);
      *to = {(k - j) * kLanes, j * (j + 1) / 2 * kLanes};
    }
    x_.counts[k] = static_cast<std::int32_t>(to - entries(k));
  }

  const Constants& t_;
  const TreeWork& x_;
  Real* numbers_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
