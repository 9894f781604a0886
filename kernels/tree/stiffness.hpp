// The symmetric matrix M + J' D J of the newton solver and its factors L' D L. Below the diagonal a
// row has room for all dofs before it, its own first; those that are not 0 are known as bits: those
// on the way to the root, those that contacts of this step couple the dof with, and what the
// factors fill. Zeros of other lanes' contacts are +0, and change nothing wherever they are added.
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using DofBits = std::uint64_t;

class Stiffness {
 public:
  MW_INLINE Stiffness(const Constants& t, const Work& w)
      : t_(t), numbers_(w.tree.stiffness), columns_(w.tree.columns) {}

  MW_INLINE Real* row(int dof) const { return numbers_ + dof * (dof + 1) / 2 * kLanes; }
  MW_INLINE Real* entry(int dof, int before) const { return row(dof) + (dof - before) * kLanes; }

  // Which entries there are. Between these two calls: couple, for sets of dofs with J' D J.
  void begin_pattern() const {
    for (int k = 0; k < t_.tree.dofs; ++k) columns_[k] = t_.tree.ancestors[k];
  }
  MW_INLINE void couple(DofBits set) const {
    for (DofBits rows = set; rows != 0; rows &= rows - 1) {
      const int k = __builtin_ctzll(rows);
      columns_[k] |= set & ((DofBits(1) << k) - 1);
    }
  }
  void fill_pattern() const {
    for (int k = t_.tree.dofs - 1; k > 0; --k) couple(columns_[k]);
  }

  // M itself.
  void start(const Real* matrix) const {
    const Float zero(Real(0));
    for (int k = 0; k < t_.tree.dofs; ++k) {
      for (DofBits b = columns_[k] & ~t_.tree.ancestors[k]; b != 0; b &= b - 1) {
        zero.store(entry(k, __builtin_ctzll(b)));
      }
      const Real* from = matrix + t_.tree.dof[k].entry * kLanes;
      for (int j = k; j >= 0; j = t_.tree.dof[j].parent, from += kLanes) {
        (Float::load(from) + zero).store(entry(k, j));
      }
    }
  }

  // Makes it L, unit diagonals left out, and 1 / D where those are.
  void factorise() const {
    for (int k = t_.tree.dofs - 1; k >= 0; --k) {
      Real* own = row(k);
      const Float inverse = Float(Real(1)) / Float::load(own);
      inverse.store(own);
      int before[64];  // columns, the last first, as places in the row
      const int count = list(columns_[k], k, before);
      for (int a = 0; a < count; ++a) {
        Real* at = own + before[a];
        const Float value = Float::load(at), factor = value * inverse;
        Real* other = row(k - before[a] / kLanes) - before[a];
        for (int b = a; b < count; ++b) {
          Real* to = other + before[b];
          fnma(factor, Float::load(own + before[b]), Float::load(to)).store(to);
        }
        factor.store(at);
      }
    }
  }
  // x <- its inverse times x, [dof][lane].
  void solve(Real* x) const {
    int before[64];
    for (int k = t_.tree.dofs - 1; k >= 0; --k) {
      const Real* own = row(k);
      Real* at = x + k * kLanes;
      const Float value = Float::load(at);
      const int count = list(columns_[k], k, before);
      for (int a = 0; a < count; ++a) {
        Real* to = at - before[a];
        fnma(Float::load(own + before[a]), value, Float::load(to)).store(to);
      }
    }
    for (int k = 0; k < t_.tree.dofs; ++k) {
      const Real* own = row(k);
      Real* at = x + k * kLanes;
      Float value = Float::load(at) * Float::load(own);
      const int count = list(columns_[k], k, before);
      for (int a = 0; a < count; ++a) {
        value = fnma(Float::load(own + before[a]), Float::load(at - before[a]), value);
      }
      value.store(at);
    }
  }

 private:
  static MW_INLINE int list(DofBits columns, int k, int* before) {
    int count = 0;
    for (; columns != 0; ++count) {
      const int j = 63 - __builtin_clzll(columns);
      columns &= ~(DofBits(1) << j);
      before[count] = (k - j) * kLanes;
    }
    return count;
  }

  const Constants& t_;
  Real* numbers_;
  DofBits* columns_;  // [dof] of its row, itself left out
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
