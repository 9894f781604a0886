// What the narrow phase calls with a manifold. Geometry knows only plane and space; which inertia
// bodies have, and how velocities lie in memory, is behind these pointers, so that no pair of
// shapes is compiled twice for it.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// add_contact (prepare.hpp).
template <class G, int N>
using AddContact = void(const Constants& t, const Group& g, Work& w, ListId list,
                        const kernels::PairClass<Real>& pair_class, Manifold<G, N>& m, Mask active,
                        const std::int32_t* code, const std::int32_t* key, typename G::Vec pose_a,
                        typename G::Vec pose_b);

// Velocity of the origins of the shapes B in `code`, at pose_b (prepare.hpp).
template <class G>
using ShapeVelocity = Velocity<G>(const Constants& t, const Work& w, const std::int32_t* code,
                                  typename G::Vec pose_b);

// Of an inertia kind and a layout.
template <class G>
struct RowBuilder {
  AddContact<G, 1>* single[2];           // [A moves, too]
  AddContact<G, G::kMulti>* several[2];  // points
  ShapeVelocity<G>* velocity;            // nullptr: contacts are those of the step's start

  template <int N>
  MW_INLINE AddContact<G, N>* add(bool pair) const {
    if constexpr (N == 1) {
      return single[pair];
    } else {
      return several[pair];
    }
  }
};

RowBuilder<Planar> planar_dense(), planar_rows();
RowBuilder<Isotropic> isotropic_dense(), isotropic_rows(), tensor_dense(), tensor_rows();
RowBuilder<Isotropic> tree_contacts();

// Of the plan, in the layout of this step.
template <class G>
MW_INLINE RowBuilder<G> row_builder(const Constants& t, const Work& w) {
  if constexpr (G::kDim == 2) {
    return w.dense ? planar_dense() : planar_rows();
  } else if (t.tree.links > 0) {
    return tree_contacts();
  } else if (t.inertia_kind == kernels::InertiaKind::tensor) {
    return w.dense ? tensor_dense() : tensor_rows();
  } else {
    return w.dense ? isotropic_dense() : isotropic_rows();
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
