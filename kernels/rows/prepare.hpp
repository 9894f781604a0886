// prepare: from a manifold in registers to the rows of a slot, with the stored impulses of the
// previous step matched to its points. Contact rows for every space and point count are made here
// and only here.
#pragma once

#include "kernels/rows/body_rows.hpp"
#include "kernels/rows/stored_impulses.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Which bodies the lanes of a slot are about.
struct LaneBodies {
  alignas(64) std::int32_t a[kLanes], b[kLanes];  // bodies; the dummy in inactive lanes
  alignas(64) std::int32_t offset_a[kLanes], offset_b[kLanes];  // into body_rows
};

// Places of the points of a slot in all lanes, half way between the surfaces, and the code of its
// features: [point][component][lane], [lane].
template <class S, int N>
void record_places(const Manifold<S, N>& m, typename S::Vec origin, Real* out) {
  for (int i = 0; i < N; ++i) {
    const Float to_middle = max(m.separation[i], Real(0)) * Float(Real(-0.5));
    store(out + i * S::kDim * kLanes, fma(m.normal, to_middle, origin + m.point_b[i]));
  }
  m.code.store(out + N * S::kDim * kLanes);
}

// Writes the points of the recorder's lane.
template <class S, int N>
void record_points(Work& w, ListId list, const Manifold<S, N>& m, const std::int32_t* key,
                   const Float* impulse, typename S::Vec origin) {
  Recorder& r = *w.recorder;
  if (r.places) {
    const int id = static_cast<int>(list), slot = w.slots[id].count - 1;
    return record_places<S, N>(m, origin, r.places[id] + slot * (N * S::kDim + 1) * kLanes);
  }
  const auto lane_of = [&](Float x) {
    alignas(64) Real all[kLanes];
    x.store(all);
    return all[r.lane];
  };
  // Points of a manifold are told apart by their quarter about its middle: stable when they move.
  Real middle_x = 0, middle_y = 0, points = 0;
  for (int i = 0; i < N; ++i) {
    if (!((bits(m.valid[i]) >> r.lane) & 1u)) continue;
    middle_x += lane_of(m.feature_x[i]);
    middle_y += lane_of(m.feature_y[i]);
    points += 1;
  }
  for (int i = 0; i < N && r.count < r.max; ++i) {
    if (!((bits(m.valid[i]) >> r.lane) & 1u)) continue;
    auto& out = r.out[r.count++];
    const Float to_middle = max(m.separation[i], Real(0)) * Float(Real(-0.5));
    const typename S::Vec p = fma(m.normal, to_middle, origin + m.point_b[i]);
    out.list = static_cast<std::int32_t>(list);
    out.key = key[r.lane];
    out.normal[0] = lane_of(m.normal.x), out.normal[1] = lane_of(m.normal.y);
    out.point[0] = lane_of(p.x), out.point[1] = lane_of(p.y);
    out.normal[2] = out.point[2] = Real(0);
    if constexpr (S::kDim == 3) out.normal[2] = lane_of(m.normal.z), out.point[2] = lane_of(p.z);
    out.separation = lane_of(m.separation[i]);
    out.impulse = lane_of(impulse[i]);
    const bool right = lane_of(m.feature_x[i]) * points > middle_x;
    const bool far = lane_of(m.feature_y[i]) * points > middle_y;
    out.feature = static_cast<std::int32_t>(lane_of(m.code)) * 4 + (right ? 1 : 0) + (far ? 2 : 0);
  }
}

// One number of the materials of both shapes of every lane.
struct MaterialPair {
  alignas(64) LaneNumber a, b;
};
template <bool kPair>
MW_INLINE MaterialPair load_materials(const Tables& t, const Group& g, const std::int32_t* code,
                                      std::uint32_t mask, LaneNumber Material::*number) {
  MaterialPair out;
  const auto* table = materials(g);
  for (int l = 0; l < kLanes; ++l) {
    const bool active = ((mask >> l) & 1u) != 0;
    const int a = active ? (code[l] & 0xffff) + (kPair ? 0 : t.colliders) : 0;
    const int b = active ? (code[l] >> 16) & 0xffff : 0;
    out.a.lane[l] = (table[a].*number).lane[l];
    out.b.lane[l] = (table[b].*number).lane[l];
  }
  return out;
}

// Adds one slot to `list`. kPair: A moves too. `active` are the lanes that the narrow phase
// worked on; lanes without a point close enough drop out.
// Not inlined: every shape pair shares these few instantiations.
template <class S, int N, bool kPair, bool kDense>
__attribute__((noinline)) void add_slot(const Tables& t, const Group& g, Work& w, ListId list,
                                        const kernels::PairClass<Real>& pair_class,
                                        Manifold<S, N>& m, Mask active, const std::int32_t* code,
                                        const std::int32_t* key, typename S::Vec pose_a,
                                        typename S::Vec pose_b) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Float zero(Real(0)), one(Real(1));
  SlotList& slots = w.slots[static_cast<int>(list)];
  auto& s = slot_at<S, N>(slots, slots.count);

  LaneBodies who;
  for (int l = 0; l < kLanes; ++l) {
    who.b[l] = t.collider_body[(code[l] >> 16) & 0xffff];
    who.a[l] = kPair ? t.collider_body[code[l] & 0xffff] : t.bodies;
    who.offset_b[l] = w.body_base[l] + who.b[l] * body_row_size(S::kKind);
    who.offset_a[l] = w.body_base[l] + who.a[l] * body_row_size(S::kKind);
    s.offset_b[l] = w.velocity_base[l] + who.b[l] * S::kRow;
    s.offset_a[l] = w.velocity_base[l] + who.a[l] * S::kRow;
    s.key[l] = key[l];
  }
  if constexpr (kDense) {  // every lane of a dense slot is about the same two bodies
    s.body_a = who.a[0];
    s.body_b = who.b[0];
  }

  BodyRow<S> body_a, body_b;
  load_body_row(t, w, who.offset_b, body_b);
  if constexpr (kPair) load_body_row(t, w, who.offset_a, body_a);
  if (!t.collider_is_body) {
    // Shapes that are off their body's centre of mass: anchors are from that centre.
    const Vec shift_b = pose_b - body_b.centre;
    for (int i = 0; i < N; ++i) m.point_b[i] = m.point_b[i] + shift_b;
    if constexpr (kPair) {
      const Vec shift_a = pose_a - body_a.centre;
      for (int i = 0; i < N; ++i) m.point_a[i] = m.point_a[i] + shift_a;
    }
  }

  // Approach at the start of the step: it widens the margin, tells whether the points will touch
  // in this step, and gives the speed at impact.
  const Velocity<S> velocity_b = load_velocity<S, kDense>(w, s.offset_b, kDense ? s.body_b : 0);
  Velocity<S> velocity_a;
  if constexpr (kPair) {
    velocity_a = load_velocity<S, kDense>(w, s.offset_a, kDense ? s.body_a : 0);
  }
  Float normal_speed = dot(m.normal, velocity_b.v);
  if constexpr (kPair) normal_speed = dot(m.normal, velocity_b.v - velocity_a.v);
  // Of gravity along n: relative, and the most that closes the gap when something holds A or B.
  Float pull = zero, closing_pull = zero;
  if (t.has_gravity || t.attractors > 0) {
    const Float pull_b = gravity_along<S>(t, g, who.b, m.normal);
    pull = closing_pull = pull_b;
    if constexpr (kPair) {
      const bool uniform = t.uniform_gravity && t.attractors == 0;
      const Float pull_a = uniform ? pull_b : gravity_along<S>(t, g, who.a, m.normal);
      pull = pull_b - pull_a;
      closing_pull = min(pull, min(pull_b, -pull_a));
    }
  }

  const Float dt(t.dt), margin(t.margin);
  // A body fast enough for a cast needs no speculation against a fixed shape, which could stop one
  // that only passes by. Half spaces cannot be passed by, and height fields are not cast against.
  Float speculation(Real(1));
  if (!kPair && t.cast && !is_plane(pair_class.kind) && !is_tile(pair_class.kind)) {
    alignas(64) LaneNumber core;
    for (int l = 0; l < kLanes; ++l) {
      core.lane[l] = who.b[l] < t.bodies ? constants_of_body(g, who.b[l]).core_radius.lane[l] : 0;
    }
    const Float travel2 = dot(velocity_b.v, velocity_b.v) * (dt * dt);
    const Mask cast = (zero < core) & (square(core) < travel2);
    speculation = select(cast, zero, one);
  }
  const Float inv_mass = kPair ? body_a.inv_mass + body_b.inv_mass : body_b.inv_mass;
  Ang arm_a[N], arm_b[N], turned_a[N], turned_b[N];
  Float speed[N];
  Mask touches = zero < zero, any_valid = touches;
  for (int i = 0; i < N; ++i) {
    arm_b[i] = cross(m.point_b[i], m.normal);
    turned_b[i] = apply(body_b.inertia, arm_b[i]);
    Float v = normal_speed + dot(arm_b[i], velocity_b.w);
    if constexpr (kPair) {
      arm_a[i] = cross(m.point_a[i], m.normal);
      turned_a[i] = apply(body_a.inertia, arm_a[i]);
      v = v - dot(arm_a[i], velocity_a.w);
    }
    speed[i] = v;
    const Float end_speed = fma(dt, pull, v);
    const Float travel = dt * min(min(v, end_speed), zero) * speculation;
    m.valid[i] = m.valid[i] & active & (m.separation[i] + travel < margin);
    any_valid = any_valid | m.valid[i];
    const Float fall = dt * min(min(v, fma(dt, closing_pull, v)), zero) * speculation;
    touches = touches | (m.valid[i] & (m.separation[i] + fall < zero));
  }
  std::uint32_t mask = bits(any_valid);
  if (mask == 0) return;
  mask = claim_capacity(t, w, list, mask);
  if (mask == 0) return;
  active = mask_from_bits(mask);
  const std::uint32_t touching = bits(touches & active);
  for (int l = 0; l < kLanes; ++l) {
    if ((touching >> l) & 1u) {
      w.touched[who.b[l]] |= 1u << l;
      if constexpr (kPair) w.touched[who.a[l]] |= 1u << l;
    }
    if (!((mask >> l) & 1u)) {
      s.offset_b[l] = s.offset_a[l] = w.velocity_base[l] + t.bodies * S::kRow;
    }
  }
  ++slots.count;
  s.mask = mask;
  w.counters.manifolds += static_cast<unsigned>(__builtin_popcount(mask));

  // Lanes that dropped out keep harmless numbers: a zero normal and no effective mass.
  const Vec normal = select(active, m.normal, zero_of<Vec>());
  store(s.normal[0], normal);
  store(s.inertia_b[0], body_b.inertia);
  body_b.inv_mass.store(s.inv_mass_b);
  if constexpr (kPair) {
    store(s.inertia_a[0], body_a.inertia);
    body_a.inv_mass.store(s.inv_mass_a);
  }
  Float count = zero;
  Vec centre_a = zero_of<Vec>(), centre_b = zero_of<Vec>();
  for (int i = 0; i < N; ++i) {
    m.valid[i] = m.valid[i] & active;
    store(s.arm_b[i][0], arm_b[i]);
    Float k = inv_mass + dot(arm_b[i], turned_b[i]);
    if constexpr (kPair) {
      store(s.arm_a[i][0], arm_a[i]);
      k = k + dot(arm_a[i], turned_a[i]);
    }
    select(m.valid[i], one / k, zero).store(s.mass[i]);
    m.separation[i].store(s.separation[i]);
    m.separation[i].store(s.gap[i]);
    const Float weight = select(m.valid[i], one, zero);
    count = count + weight;
    centre_b = fma(m.point_b[i], weight, centre_b);
    if constexpr (kPair) centre_a = fma(m.point_a[i], weight, centre_a);
    w.counters.points +=
        static_cast<unsigned>(__builtin_popcount(bits(m.valid[i] & (m.separation[i] < margin))));
  }
  if constexpr (N > 1) {
    int at = 0;
    for (int i = 0; i < N; ++i) {
      for (int j = i + 1; j < N; ++j) {
        Float k = inv_mass + dot(arm_b[i], turned_b[j]);
        if constexpr (kPair) k = k + dot(arm_a[i], turned_a[j]);
        k.store(s.cross_k[at++]);
      }
    }
  }

  // Stored impulses.
  alignas(64) std::int32_t stored[kLanes];
  find_stored(t, g, w, list, mask, key, stored);
  const Real* rows = g.cache[static_cast<int>(list)].rows;
  Float impulse[N], tangent_impulse[2] = {zero, zero}, twist = zero;
  if constexpr (N == 1) {
    // The friction impulse is kept as a world vector, since the tangents of a point turn with it.
    Vec kept = zero_of<Vec>();
    Float unused;
    if constexpr (S::kDim == 3) {
      load_rows4(rows, stored, impulse[0], kept.x, kept.y, kept.z);
    } else {
      load_rows4(rows, stored, impulse[0], kept.x, kept.y, unused);
    }
    impulse[0] = select(m.valid[0], impulse[0], zero);
    if constexpr (S::kDim == 3) {
      tangent_impulse[0] = dot(kept, m.tangent);
      tangent_impulse[1] = dot(kept, cross(m.normal, m.tangent));
    } else {
      tangent_impulse[0] = cross(m.normal, kept);
    }
  } else {
    Float old_x[4], old_y[4] = {zero, zero, zero, zero}, old[4], code_before, unused;
    if constexpr (S::kDim == 3) {
      load_rows4(rows, stored, old_x[0], old_x[1], old_x[2], old_x[3]);
      load_rows4(rows + 4, stored, old_y[0], old_y[1], old_y[2], old_y[3]);
      load_rows4(rows + 8, stored, old[0], old[1], old[2], old[3]);
      load_rows4(rows + 12, stored, code_before, tangent_impulse[0], tangent_impulse[1], twist);
    } else {
      load_rows4(rows, stored, old_x[0], old_x[1], old[0], old[1]);
      load_rows4(rows + 4, stored, code_before, tangent_impulse[0], unused, unused);
    }
    const Mask same = code_before == m.code;
    Float sum = zero;
    for (int i = 0; i < N; ++i) {
      // From the nearest; the first of several in one place, since points that a manifold does not
      // have repeat its first with no impulse.
      Float x = zero, nearest = m.match_distance2;
      for (int j = 0; j < N; ++j) {
        const Float dx = old_x[j] - m.feature_x[i], dy = old_y[j] - m.feature_y[i];
        const Float distance2 = fma(dx, dx, dy * dy);
        x = select(distance2 < nearest, old[j], x);
        nearest = min(distance2, nearest);
      }
      impulse[i] = select(same & m.valid[i], x, zero);
      sum = sum + impulse[i];
      m.feature_x[i].store(s.feature_x[i]);
      m.feature_y[i].store(s.feature_y[i]);
    }
    const Mask carried = zero < sum;
    tangent_impulse[0] = select(carried, tangent_impulse[0], zero);
    tangent_impulse[1] = select(carried, tangent_impulse[1], zero);
    twist = select(carried, twist, zero);
    m.code.store(s.code);
  }
  for (int i = 0; i < N; ++i) impulse[i].store(s.impulse[i]);

  // Friction rows.
  if (t.has_friction) {
    const MaterialPair mu = load_materials<kPair>(t, g, code, mask, &Material::friction);
    sqrt(mu.a * mu.b).store(s.friction);
    const Float share = one / max(count, one);
    centre_b = centre_b * share;
    store(s.centre_b[0], centre_b);
    if constexpr (kPair) {
      centre_a = centre_a * share;
      store(s.centre_a[0], centre_a);
    }
    if constexpr (S::kDim == 2) {
      const Vec tangent{-normal.y, normal.x};
      store(s.tangent[0], tangent);
      const Float b = cross(centre_b, tangent);
      Float k = inv_mass + b * apply(body_b.inertia, b);
      if constexpr (kPair) {
        const Float a = cross(centre_a, tangent);
        k = k + a * apply(body_a.inertia, a);
      }
      select(active, one / k, zero).store(s.tangent_mass[0]);
    } else {
      const Vec tangent = select(active, m.tangent, zero_of<Vec>());
      const Vec second = cross(normal, tangent);
      store(s.tangent[0], tangent);
      const Vec b1 = cross(centre_b, tangent), b2 = cross(centre_b, second);
      const Vec i1 = apply(body_b.inertia, b1), i2 = apply(body_b.inertia, b2);
      Float k11 = inv_mass + dot(b1, i1), k12 = dot(b1, i2), k22 = inv_mass + dot(b2, i2);
      if constexpr (kPair) {
        const Vec a1 = cross(centre_a, tangent), a2 = cross(centre_a, second);
        const Vec j1 = apply(body_a.inertia, a1), j2 = apply(body_a.inertia, a2);
        k11 = k11 + dot(a1, j1);
        k12 = k12 + dot(a1, j2);
        k22 = k22 + dot(a2, j2);
      }
      const Float scale = select(active, one / fms(k11, k22, k12 * k12), zero);
      (k22 * scale).store(s.tangent_mass[0]);
      (-(k12 * scale)).store(s.tangent_mass[1]);
      (k11 * scale).store(s.tangent_mass[2]);
      select(active, tangent_impulse[1], zero).store(s.tangent_impulse[1]);
      if constexpr (N > 1) {
        Float k = dot(normal, apply(body_b.inertia, normal));
        if constexpr (kPair) k = k + dot(normal, apply(body_a.inertia, normal));
        select(active, one / k, zero).store(s.twist_mass);
        select(active, twist, zero).store(s.twist_impulse);
        for (int i = 0; i < N; ++i) {
          const Vec d = m.point_b[i] - centre_b;
          select(m.valid[i], sqrt(dot(d, d)), zero).store(s.twist_arm[i]);
        }
      }
    }
    select(active, tangent_impulse[0], zero).store(s.tangent_impulse[0]);
  }

  if (t.has_restitution) {
    auto& bounce = bounce_at<S, N>(slots, slots.count - 1);
    const MaterialPair e = load_materials<kPair>(t, g, code, mask, &Material::restitution);
    max(e.a, e.b).store(bounce.restitution);
    const Float threshold(t.restitution_threshold);
    for (int i = 0; i < N; ++i) {
      // v^2 = v0^2 - 2 a s: the speed when the gap s that is left has closed.
      const Float gap = max(m.separation[i], zero);
      const Float v2 = fnma((pull + pull), gap, speed[i] * speed[i]);
      const Float at_touch = sqrt(max(v2, zero));
      const Mask hits = m.valid[i] & (min(speed[i], fma(dt, pull, speed[i])) < -threshold);
      select(hits, at_touch, zero).store(bounce.impact[i]);
      impulse[i].store(bounce.carried[i]);
      zero.store(bounce.total[i]);
    }
    for (int c = 0; c < S::kTangents; ++c) zero.store(bounce.total_tangent[c]);
    zero.store(bounce.total_twist);
  }
  if (w.recorder) {
    record_points<S, N>(w, list, m, key, impulse, t.collider_is_body ? pose_b : body_b.centre);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
