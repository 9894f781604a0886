// Resistance of a contact: moments against rolling and against spinning about the normal. With the
// impulses lambda along the normal, and lengths of the materials,
//   |about the tangents| <= rolling * sum(lambda), a circle;  |about n| <= torsional * sum(lambda)
// In the plane there is rolling only. The rows are kept beside the blocks, only when the plan has
// resistance. They move with the passes of friction, and their moments are carried like friction.
#pragma once

#include "kernels/rows/sides.hpp"
#include "kernels/rows/solve_friction.hpp"
#include "kernels/rows/stored_impulses.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Of contacts in space.
template <class S>
struct SpinRows {
  Real tangent[3][kLanes];
  Real stop[3][kLanes];  // kg m^2, effective mass of both tangents
  Real brake[kLanes];    // of what rolls
  Real torsional[kLanes], torsion_mass[kLanes];
};
template <>
struct SpinRows<Planar> {
  Real stop[1][kLanes];
};

template <class S>
struct alignas(64) Resistance : SpinRows<S> {
  Real rolling[kLanes];
  Real impulse[S::kAng][kLanes];  // N m s, about the tangents and the normal; in the plane about z
  std::uint32_t lanes;            // in which the materials resist
};

template <class S>
MW_INLINE Resistance<S>& resistance_at(const BlockList& list, int i) {
  return reinterpret_cast<Resistance<S>*>(list.resistances)[i];
}

// Calls visit(block, index, list, resistance) for blocks that resist in some lane.
template <class S, class Visit>
MW_INLINE void for_each_resistance(Work& w, Visit visit) {
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    auto& r = resistance_at<S>(list, i);
    if (r.lanes != 0) visit(s, i, list, r);
  });
}

// ---- making them -------------------------------------------------------------------------------

// Effective masses; in the plane stop.xx alone.
struct TurningMasses {
  Sym2 stop;
  Float brake, torsion;
};
// turning(p, q): what a unit moment about p does to the relative spin about q.
template <class S, class Turning>
MW_INLINE TurningMasses turning_masses(const Resistance<S>& r, typename S::Vec normal,
                                       Turning turning) {
  if constexpr (S::kDim == 2) {
    const Float zero(Real(0)), one(Real(1));
    return {{inverse_or_zero(turning(one, one)), zero, zero}, zero, zero};
  } else {
    const Vec3 first = load_as<Vec3>(r.tangent[0]), second = cross(normal, first);
    const Sym2 k{turning(first, first), turning(first, second), turning(second, second)};
    return {inverse(k), Float(Real(2)) * inverse_or_zero(k.xx + k.yy),
            inverse_or_zero(turning(normal, normal))};
  }
}
// In the lanes of `in`.
template <class S>
MW_INLINE void put_masses(const TurningMasses& m, Mask in, Resistance<S>& r) {
  const auto put = [&](Float x, Real* to) { select(in, x, Float::load(to)).store(to); };
  put(m.stop.xx, r.stop[0]);
  if constexpr (S::kDim == 3) {
    put(m.stop.xy, r.stop[1]), put(m.stop.yy, r.stop[2]);
    put(m.brake, r.brake), put(m.torsion, r.torsion_mass);
  }
}
MW_INLINE Float turn(Float p, Float inertia, Float q) { return p * (inertia * q); }
template <class Inertia>
MW_INLINE Float turn(Vec3 p, const Inertia& inertia, Vec3 q) {
  return dot(p, apply(inertia, q));
}

// Where the moments of a manifold lie in its row of the cache (contact_cache.hpp): four numbers, in
// the plane one of them.
template <class S, int N>
inline constexpr int kMomentRow = S::kDim == 2 ? (N == 1 ? 0 : 4) : (N == 1 ? 4 : 16);
template <int N>
inline constexpr int kPlanarMoment = N == 1 ? 3 : 2;

// A moment is kept as a world vector, since its axes rotate with it.
template <class S>
MW_INLINE void carry_moment(const Float* x, Float planar, Mask carried, typename S::Vec normal,
                            Resistance<S>& r) {
  const auto put = [&](int i, Float amount) {
    select(carried, amount, Float(Real(0))).store(r.impulse[i]);
  };
  if constexpr (S::kDim == 2) {
    put(0, planar);
  } else {
    const Vec3 kept{x[0], x[1], x[2]}, first = load_as<Vec3>(r.tangent[0]);
    put(0, dot(kept, first)), put(1, dot(kept, cross(normal, first))), put(2, dot(kept, normal));
  }
}

// Not inlined, like what follows in the passes: few scenes have resistance, and kernels are many.
// `kept`: numbers of the cache, in the lanes of `carried`; `planar` the one of the plane.
template <class S, class A>
__attribute__((noinline)) void put_resistance(const Constants& t, const Group& g,
                                              const Sides<S, A>& sides, const std::int32_t* code,
                                              std::uint32_t mask, typename S::Vec normal,
                                              typename S::Vec tangent, const Float* kept,
                                              Float planar, Mask carried, Resistance<S>& r) {
  const Float zero(Real(0));
  const Mask active = mask_from_bits(mask);
  const auto larger = [&](LaneNumber Material::*number) {
    const MaterialPair of = load_materials<A>(t, g, code, mask, number);
    return select(active, max(of.a, of.b), zero);
  };
  const Float rolling = larger(&Material::rolling_resistance);
  rolling.store(r.rolling);
  Mask resists = zero < rolling;
  if constexpr (S::kDim == 3) {
    const Float torsional = larger(&Material::torsional_resistance);
    torsional.store(r.torsional);
    resists = resists | (zero < torsional);
    store(r.tangent[0], select(active, tangent, zero_of<Vec3>()));
  }
  r.lanes = bits(resists);
  const auto turning = [&](typename S::Ang p, typename S::Ang q) {
    Float k = turn(p, sides.b.body.inertia, q);
    if constexpr (A::kMoves) k = k + turn(p, sides.a.body.inertia, q);
    return k;
  };
  put_masses(turning_masses(r, normal, turning), mask_from_bits(kAllLanes), r);
  carry_moment(kept, planar, carried & resists, normal, r);
}

// ---- in the passes -----------------------------------------------------------------------------

// The sides of a block whose bodies may rotate; `a` is any where A does not move.
template <class S>
struct TurningSides {
  const SideRows<S, Free>&a, &b;
};
template <class S, int N, class A>
MW_INLINE TurningSides<S> turning_sides(const SidedBlock<S, N, A>& s) {
  if constexpr (A::kMoves) {
    return {s.a, s.b};
  } else {
    return {s.b, s.b};
  }
}
template <class S, class Velocities>
MW_INLINE void apply_turn(const TurningSides<S>& s, typename S::Ang moment, Velocities& v) {
  add_moment(s.b, moment, v.b);
  if constexpr (!std::is_same_v<decltype(v.a), Still>) take_moment(s.a, moment, v.a);
}
// The moment of amounts along the axes of the rows.
template <class S>
MW_INLINE typename S::Ang moment_of(typename S::Vec n, const Resistance<S>& r,
                                    const Float* amount) {
  if constexpr (S::kDim == 2) {
    return amount[0];
  } else {
    const Vec3 first = load_as<Vec3>(r.tangent[0]);
    return fma(n, amount[2], fma(cross(n, first), amount[1], first * amount[0]));
  }
}

// `before`: the impulses so far. Changes them and v, with `pressed` N s along the normal n.
template <class S, class Velocities>
__attribute__((noinline)) void resist(const TurningSides<S>& s, typename S::Vec n,
                                      const Resistance<S>& r, Float pressed, const Float* before,
                                      Velocities& v, Float* after) {
  const Float bound = Float::load(r.rolling) * pressed;
  const auto spin = relative_spin(v.a, v.b);
  if constexpr (S::kDim == 2) {
    after[0] = clamp(fnma(Float::load(r.stop[0]), spin, before[0]), -bound, bound);
    apply_turn(s, after[0] - before[0], v);
  } else {
    const Vec3 first = load_as<Vec3>(r.tangent[0]), second = cross(n, first);
    const Sym2 stop{Float::load(r.stop[0]), Float::load(r.stop[1]), Float::load(r.stop[2])};
    stop_in_circle<false>(stop, Float::load(r.brake), dot(first, spin), dot(second, spin), before,
                          bound, after);
    apply_turn(s, fma(second, after[1] - before[1], first * (after[0] - before[0])), v);
    const Float most = Float::load(r.torsional) * pressed;
    const Float left = dot(n, relative_spin(v.a, v.b));
    after[2] = clamp(fnma(Float::load(r.torsion_mass), left, before[2]), -most, most);
    apply_turn(s, n * (after[2] - before[2]), v);
  }
}
// Of rows one for both layouts.
template <class S, class A, bool kDense>
MW_INLINE SideVelocities<S, A>& sides_of(RowVelocities<S, A, kDense>& v) {
  return v;
}
template <class Velocities>
MW_INLINE Velocities& sides_of(Velocities& v) {
  return v;
}

// One visit of a pass to the rows of a block.
template <class S, int N, class A, class Velocities>
MW_INLINE void solve_resistance(const SidedBlock<S, N, A>& s, Resistance<S>& r, Velocities& v) {
  const Velocities found = v;
  Float normal[N], before[S::kAng], after[S::kAng];
  for (int i = 0; i < N; ++i) normal[i] = Float::load(s.impulse[i]);
  for (int i = 0; i < S::kAng; ++i) before[i] = Float::load(r.impulse[i]);
  resist(turning_sides(s), load_as<typename S::Vec>(s.normal[0]), r, sum_of<N>(normal), before,
         sides_of(v), after);
  const Mask resists = mask_from_bits(r.lanes);
  keep_other_lanes_of_sides(resists, found, v);
  for (int i = 0; i < S::kAng; ++i) select(resists, after[i], before[i]).store(r.impulse[i]);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
