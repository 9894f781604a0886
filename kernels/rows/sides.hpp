// The two sides that a contact is between, as its rows need them.
#pragma once

#include "kernels/lane/ints.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A side while its rows are made.
template <class S, class Side>
struct SideState {};
template <class S>
struct SideState<S, Free> {
  BodyRow<S> body;
  Velocity<S> velocity;  // at the start of the step
};

template <class S, class A>
struct Sides {
  Ints body_a, body_b;  // the dummy in lanes without a candidate; A is the dummy if it is fixed
  SideState<S, A> a;
  SideState<S, Free> b;

  MW_INLINE Float inv_mass() const {
    if constexpr (A::kMoves) {
      return a.body.inv_mass + b.body.inv_mass;
    } else {
      return b.body.inv_mass;
    }
  }
};

// The bodies of the shapes in `code`, which `s` learns, too.
template <class S, class A, bool kDense>
MW_INLINE Sides<S, A> find_sides(const Constants& t, const Work& w, const std::int32_t* code,
                                 RowBodies& s) {
  const Ints shapes = Ints::load(code), velocities = Ints::load(w.velocity_base);
  Sides<S, A> out;
  const auto body_of = [&](Ints shape) {
    return t.collider_is_body ? shape : gather(t.collider_body, shape);
  };
  out.body_b = body_of(high_half(shapes));
  out.body_a = A::kMoves ? body_of(low_half(shapes)) : Ints(t.bodies);
  (velocities + out.body_b * Ints(S::kRow)).store(s.offset_b);
  (velocities + out.body_a * Ints(S::kRow)).store(s.offset_a);
  if constexpr (kDense) {  // every lane of a dense block is about the same two bodies
    s.body_b = t.collider_body[(code[0] >> 16) & 0xffff];
    s.body_a = A::kMoves ? t.collider_body[code[0] & 0xffff] : t.bodies;
  }
  const Ints rows = Ints::load(w.body_base), size(body_row_size(S::kKind));
  alignas(64) std::int32_t at[kLanes];
  (rows + out.body_b * size).store(at);
  load_body_row(t, w, at, out.b.body);
  out.b.velocity = load_velocity<S, kDense>(w.velocity, s.offset_b, kDense ? s.body_b : 0);
  if constexpr (A::kMoves) {
    (rows + out.body_a * size).store(at);
    load_body_row(t, w, at, out.a.body);
    out.a.velocity = load_velocity<S, kDense>(w.velocity, s.offset_a, kDense ? s.body_a : 0);
  }
  return out;
}

// One number of the materials of both shapes of every lane; 0 and 0 stand for lanes that are idle.
struct MaterialPair {
  Float a, b;
};
template <class A>
MW_INLINE MaterialPair load_materials(const Constants& t, const Group& g, const std::int32_t* code,
                                      std::uint32_t mask, LaneNumber Material::*number) {
  const Ints shapes = Ints::load(code), none(0);
  const Ints a = low_half(shapes) + Ints(A::kMoves ? 0 : t.colliders);
  const LaneNumber& first = materials(g)->*number;
  return {gather_numbers<Material>(first, select(mask, a, none)),
          gather_numbers<Material>(first, select(mask, high_half(shapes), none))};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
