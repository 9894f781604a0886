// M = L' D L of the joint-space inertia, without fill: a row has entries for the dofs on the way to
// the root alone (Featherstone 2005, "Efficient factorization of the joint-space inertia matrix").
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Makes the matrix L, unit diagonals left out, and 1 / D where those are.
inline void factorise(const Constants& t, Real* matrix) {
  const Dof* dofs = t.tree.dof;
  for (int k = t.tree.dofs - 1; k >= 0; --k) {
    Real* row = matrix + dofs[k].entry * kLanes;
    const Float inverse = Float(Real(1)) / Float::load(row);
    inverse.store(row);
    int i = dofs[k].parent;
    for (int a = 1; a <= dofs[k].depth; ++a, i = dofs[i].parent) {
      const Float entry = Float::load(row + a * kLanes), factor = entry * inverse;
      Real* other = matrix + dofs[i].entry * kLanes;
      for (int b = a; b <= dofs[k].depth; ++b, other += kLanes) {
        fnma(factor, Float::load(row + b * kLanes), Float::load(other)).store(other);
      }
      factor.store(row + a * kLanes);
    }
  }
}

// x <- M^-1 x, [dof][lane].
inline void solve_factored(const Constants& t, const Real* matrix, Real* x) {
  const Dof* dofs = t.tree.dof;
  for (int k = t.tree.dofs - 1; k >= 0; --k) {
    const Real* row = matrix + dofs[k].entry * kLanes;
    const Float value = Float::load(x + k * kLanes);
    for (int j = dofs[k].parent; j >= 0; j = dofs[j].parent) {
      row += kLanes;
      fnma(Float::load(row), value, Float::load(x + j * kLanes)).store(x + j * kLanes);
    }
  }
  for (int k = 0; k < t.tree.dofs; ++k) {
    const Real* row = matrix + dofs[k].entry * kLanes;
    Float value = Float::load(x + k * kLanes) * Float::load(row);
    for (int j = dofs[k].parent; j >= 0; j = dofs[j].parent) {
      row += kLanes;
      value = fnma(Float::load(row), Float::load(x + j * kLanes), value);
    }
    value.store(x + k * kLanes);
  }
}

// out = M x of the matrix itself.
inline void multiply(const Constants& t, const Real* matrix, const Real* x, Real* out) {
  const Dof* dofs = t.tree.dof;
  for (int k = 0; k < t.tree.dofs; ++k) {
    const Real* row = matrix + dofs[k].entry * kLanes;
    const Float own = Float::load(x + k * kLanes);
    Float sum = Float::load(row) * own;
    for (int j = dofs[k].parent; j >= 0; j = dofs[j].parent) {
      row += kLanes;
      const Float entry = Float::load(row);
      sum = fma(entry, Float::load(x + j * kLanes), sum);
      Real* other = out + j * kLanes;
      fma(entry, own, Float::load(other)).store(other);
    }
    sum.store(out + k * kLanes);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
