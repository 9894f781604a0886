// The speed of approach below which a contact does not bounce.
//
// What rests comes with what gravity gives it in a step, and is to be told from what falls. Each
// contact looks at its own bodies: worlds may have gravities of their own, and attractors pull on
// each body otherwise.
#pragma once

#include "kernels/rows/sides.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Square of the acceleration of the bodies of the lanes by gravity and attractors, m^2/s^4.
template <class S>
MW_INLINE Float pull2_of(const Constants& t, const Group& g, Ints bodies) {
  using Vec = typename S::Vec;
  Vec pull = gravity_of<S>(t, g, bodies);
  if (t.attractors > 0) {
    // Lanes may have different bodies; few scenes have attractors.
    alignas(64) Real out[S::kDim][kLanes], of_body[S::kDim][kLanes];
    alignas(64) std::int32_t body[kLanes];
    store(out[0], pull);
    bodies.store(body);
    for (int l = 0; l < kLanes; ++l) {
      if (body[l] >= t.bodies || t.body[body[l]].kinematic) continue;
      store(of_body[0], attraction_of_body<S>(t, g, body[l]));
      for (int c = 0; c < S::kDim; ++c) out[c][l] += of_body[c][l];
    }
    pull = load_as<Vec>(out[0]);
  }
  return dot(pull, pull);
}

template <class S, class A>
MW_INLINE Float rest_speed(const Constants& t, const Group& g, const Sides<S, A>& sides) {
  const Float given(t.restitution_threshold);
  if (t.restitution_time == 0 || (!t.has_gravity && t.attractors == 0)) return given;
  Float pull2 = pull2_of<S>(t, g, sides.body_b);
  if (A::kMoves && !(t.uniform_gravity && t.attractors == 0)) {
    pull2 = max(pull2_of<S>(t, g, sides.body_a), pull2);
  }
  return fma(sqrt(pull2), Float(t.restitution_time), given);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
