// prepare: from a manifold in registers to the rows of a block, with the stored impulses of the
// previous step matched to its points. Contact rows for every space and point count are made here
// and only here.
#pragma once

#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/apart.hpp"
#include "kernels/rows/approach.hpp"
#include "kernels/rows/couple.hpp"
#include "kernels/rows/friction.hpp"
#include "kernels/rows/record.hpp"
#include "kernels/rows/resistance.hpp"
#include "kernels/rows/rest_speed.hpp"
#include "kernels/rows/touch.hpp"
#include "kernels/rows/touched.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Shapes that are off their body's centre of mass: anchors are from that centre.
template <class S, int N, class A>
MW_INLINE void anchor_at_centres(const Sides<S, A>& sides, typename S::Vec pose_a,
                                 typename S::Vec pose_b, Manifold<GeometryOf<S>, N>& m) {
  const auto shift_b = pose_b - sides.b.body.centre;
  for (int i = 0; i < N; ++i) m.point_b[i] = m.point_b[i] + shift_b;
  if constexpr (A::kMoves) {
    const auto shift_a = pose_a - sides.a.body.centre;
    for (int i = 0; i < N; ++i) m.point_a[i] = m.point_a[i] + shift_a;
  }
}

// Lanes outside of `mask` work on the dummy.
template <class S>
MW_INLINE void drop_lanes(const Constants& t, const Work& w, std::uint32_t mask, RowBodies& s) {
  const Ints dummy = Ints::load(w.velocity_base) + Ints(t.bodies * S::kRow);
  select(mask, Ints::load(s.offset_a), dummy).store(s.offset_a);
  select(mask, Ints::load(s.offset_b), dummy).store(s.offset_b);
  s.mask = mask;
}

// How many close points a block has in each lane, and the sums of their anchors.
template <class S>
struct PointSums {
  Float count;
  FrictionCentre<S> anchors;
};

// Lanes that dropped out keep harmless numbers: a zero normal and no effective mass.
template <class S, int N, class A>
MW_INLINE PointSums<S> put_normal_rows(const Constants& t, Work& w, const Sides<S, A>& sides,
                                       const Approach<S, N, A>& approach, Mask active,
                                       Manifold<GeometryOf<S>, N>& m, SidedBlock<S, N, A>& s) {
  using Vec = typename S::Vec;
  const Float zero(Real(0)), one(Real(1)), margin(t.margin), inv_mass = sides.inv_mass();
  store(s.normal[0], select(active, m.normal, zero_of<Vec>()));
  put_side(sides.b.body, s.b);
  if constexpr (A::kMoves) put_side(sides.a.body, s.a);
  PointSums<S> sums{zero, {zero_of<Vec>(), zero_of<Vec>()}};
  for (int i = 0; i < N; ++i) {
    m.valid[i] = m.valid[i] & active;
    store(s.b.arm[i][0], approach.b.arm[i]);
    if constexpr (A::kMoves) store(s.a.arm[i][0], approach.a.arm[i]);
    select(m.valid[i], one / approach.coupling(inv_mass, i, i), zero).store(s.mass[i]);
    m.separation[i].store(s.separation[i]);
    m.separation[i].store(s.gap[i]);
    s.close[i] = bits(approach.close[i] & active);
    const Float weight = select(mask_from_bits(s.close[i]), one, zero);
    sums.count = sums.count + weight;
    sums.anchors.b = fma(m.point_b[i], weight, sums.anchors.b);
    if constexpr (A::kMoves) sums.anchors.a = fma(m.point_a[i], weight, sums.anchors.a);
    w.counters.points +=
        static_cast<unsigned>(__builtin_popcount(bits(m.valid[i] & (m.separation[i] < margin))));
  }
  return sums;
}

// What an impulse at one point does to the speed of another.
template <class S, int N, class A>
MW_INLINE void put_couplings(const Sides<S, A>& sides, const Approach<S, N, A>& approach,
                             SidedBlock<S, N, A>& s) {
  const Float inv_mass = sides.inv_mass();
  int at = 0;
  for (int i = 0; i < N; ++i) {
    for (int j = i + 1; j < N; ++j) {
      approach.coupling(inv_mass, i, j).store(s.cross_k[at++]);
    }
  }
  if constexpr (N == 2) put_pair(s);
}

template <class S, int N, class A>
MW_INLINE void put_bounce(const Constants& t, const Group& g, const Sides<S, A>& sides,
                          const std::int32_t* code, const Manifold<GeometryOf<S>, N>& m,
                          const Approach<S, N, A>& approach, const StoredImpulses<N>& stored,
                          std::uint32_t mask, Bounce<S, N>& bounce) {
  const Float zero(Real(0)), dt(t.dt), threshold = rest_speed(t, g, sides);
  threshold.store(bounce.threshold);
  const MaterialPair e = load_materials<A>(t, g, code, mask, &Material::restitution);
  max(e.a, e.b).store(bounce.restitution);
  const Float pull = approach.pull.relative;
  for (int i = 0; i < N; ++i) {
    // v^2 = v0^2 - 2 a s: the speed when the gap s that is left has closed.
    const Float speed = approach.speed[i], gap = max(m.separation[i], zero);
    const Float v2 = fnma((pull + pull), gap, speed * speed);
    const Float at_touch = sqrt(max(v2, zero));
    const Mask hits = approach.close[i] & (min(speed, fma(dt, pull, speed)) < -threshold);
    select(hits, at_touch, zero).store(bounce.impact[i]);
    stored.normal[i].store(bounce.carried[i]);
    zero.store(bounce.total[i]);
  }
  for (int c = 0; c < S::kTangents; ++c) zero.store(bounce.total_tangent[c]);
  zero.store(bounce.total_twist);
}

// The lanes in which a point approaches as fast as in an impact. What is deeper than the margin has
// been inside for longer.
template <class S, int N, class A>
MW_INLINE std::uint32_t strikes_of(const Constants& t, const Work& w,
                                   const Approach<S, N, A>& approach,
                                   const Manifold<GeometryOf<S>, N>& m) {
  const Float speed = Float::load(w.strike_speed), deep(-t.margin);
  Mask strikes = mask_from_bits(0);
  for (int i = 0; i < N; ++i) {
    strikes =
        strikes | (approach.close[i] & (approach.speed[i] < -speed) & (deep < m.separation[i]));
  }
  return bits(strikes);
}

// Adds one block to `list`. `active` are the lanes that the narrow phase
// worked on; lanes without a point close enough drop out.
template <class S, int N, class A, bool kDense>
void add_contact(const Constants& t, const Group& g, Work& w, ListId list,
                 const kernels::PairClass<Real>& pair_class, Manifold<GeometryOf<S>, N>& m,
                 Mask active, const std::int32_t* code, const std::int32_t* key,
                 typename S::Vec pose_a, typename S::Vec pose_b) {
  BlockList& blocks = w.blocks[static_cast<int>(list)];
  auto& s = block_at<SidedBlock<S, N, A>>(blocks, blocks.count);
  const Sides<S, A> sides = find_sides<S, A, kDense>(t, w, code, s);
  // Queries of contacts return those of the current state.
  const bool asked = w.recorder && !w.recorder->places;
  if constexpr (N == 1) {
    if ((t.has_restitution || t.impact_sweeps > 0) && kernels::is_round(pair_class.kind) &&
        !asked) {
      turn_to_touch(t, g, w, code, sides, active, pose_a, pose_b, m);
    }
  }
  if (!t.collider_is_body) anchor_at_centres(sides, pose_a, pose_b, m);

  Approach<S, N, A> approach;
  measure_approach<kDense>(t, g, w, s, sides, pair_class.kind, active, m, approach);
  std::uint32_t mask = bits(approach.near);
  if (mask == 0) return;
  mask = claim_capacity(t, w, list, mask);
  if (mask == 0) return;
  active = mask_from_bits(mask);
  const std::uint32_t touching = bits(approach.touching & active);
  if constexpr (kDense) {
    mark_touched<S, A, kDense>(w, touching, s);
  } else {
    mark_met<A>(t, w, touching, sides);
  }
  s.unsure = mask & ~touching;
  s.strikes = t.impact_sweeps > 0 ? strikes_of(t, w, approach, m) & mask : 0, s.struck = 0;
  drop_lanes<S>(t, w, mask, s);
  Ints::load(key).store(s.key);
  s.apart = blocks.count > 0 &&
            are_apart<A, kDense>(s, block_at<SidedBlock<S, N, A>>(blocks, blocks.count - 1));
  ++blocks.count;
  w.counters.manifolds += static_cast<unsigned>(__builtin_popcount(mask));

  const PointSums<S> sums = put_normal_rows(t, w, sides, approach, active, m, s);
  if constexpr (N > 1) put_couplings(sides, approach, s);

  alignas(64) std::int32_t at[kLanes];
  find_stored(t, g, w, list, mask, key, at);
  StoredImpulses<N> stored;
  const Real* const rows = g.cache[static_cast<int>(list)].rows;
  carry_impulses(rows, at, m, s, stored);
  if (stored.struck != 0 && !asked) end_impact(stored);
  for (int i = 0; i < N; ++i) stored.normal[i].store(s.impulse[i]);
  s.strikes |= stored.struck & mask;
  if constexpr (N > 1 || !A::kMoves) {
    (max(-approach.pull.relative, Real(0)) * Float(t.h)).store(s.press);
  }
  if (t.has_friction) {
    put_friction(t, g, sides, code, m, active, sums.anchors, sums.count, stored, s);
  }
  if (t.has_resistance) {
    Float kept[4];
    load_rows4(rows + kMomentRow<S, N>, at, kept[0], kept[1], kept[2], kept[3]);
    put_resistance<S, A>(t, g, sides, code, mask, load_as<typename S::Vec>(s.normal[0]), m.tangent,
                         kept, kept[kPlanarMoment<N>], Float(Real(0)) < sum_of<N>(stored.normal),
                         resistance_at<S>(blocks, blocks.count - 1));
  }
  if (t.has_restitution) {
    auto& bounce = bounce_at<S, N>(blocks, blocks.count - 1);
    put_bounce(t, g, sides, code, m, approach, stored, mask, bounce);
  }
  if (w.recorder) {
    for (int i = 0; i < N; ++i) m.valid[i] = m.valid[i] & mask_from_bits(s.close[i]);
    record_points<S, N>(w, list, m, key, stored.normal,
                        t.collider_is_body ? pose_b : sides.b.body.centre);
  }
}

template <class S, bool kDense>
Velocity<GeometryOf<S>> shape_velocity(const Constants& t, const Work& w, const std::int32_t* code,
                                       typename S::Vec pose_b) {
  RowBodies bodies;
  const Sides<S, Fixed> sides = find_sides<S, Fixed, kDense>(t, w, code, bodies);
  return {velocity_at(t, sides.b, pose_b), sides.b.velocity.w};
}

template <class S, bool kDense>
RowBuilder<GeometryOf<S>> row_builder_of() {
  return {{add_contact<S, 1, Fixed, kDense>, add_contact<S, 1, Free, kDense>},
          {add_contact<S, S::kMulti, Fixed, kDense>, add_contact<S, S::kMulti, Free, kDense>},
          shape_velocity<S, kDense>};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
