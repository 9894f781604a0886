// begin: the first stage of a contact step. Poses of shapes as rows, half a step ahead where bodies
// turn (work/half_turn.hpp), their bounds with the speculative margin, and inverse inertias in
// world axes.
#include "kernels/shape/shapes.hpp"
#include "kernels/sleep/sleep.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/constants.hpp"
#include "kernels/work/half_turn.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

MW_INLINE Vec3 vec3(const LaneNumber* v) { return {v[0], v[1], v[2]}; }
MW_INLINE Float length(Vec3 v) { return sqrt(dot(v, v)); }

// At most, by forces and controls: with those that pull against each other added up.
MW_INLINE Float acceleration_of_loads(const Constants& t, const Group& g, int body) {
  Float force(Real(0));
  if (g.force) {
    const Real* f = g.force + body * 6 * kLanes;
    const Float z =
        t.dimension == kernels::Dimension::spatial ? Float::load(f + 2 * kLanes) : Float(Real(0));
    force = length({Float::load(f), Float::load(f + kLanes), z});
  }
  const int thrusts = t.first_thrust ? t.first_thrust[body + 1] : 0;
  for (int i = t.first_thrust ? t.first_thrust[body] : 0; i < thrusts; ++i) {
    if (t.thrust[i].torque) continue;
    const auto& constants =
        reinterpret_cast<const kernels::ThrustConstants<LaneNumber>*>(g.constants.thrust)[i];
    const Float control = Float::load(g.control + t.thrust[i].control * kLanes);
    force = fma(abs(control), length(vec3(constants.direction)), force);
  }
  return force * constants_of_body(g, body).inv_mass;
}

// How much a shape's bounds grow: half of 4 slop, or as far as its body moves in the step by its
// speed and the loads on it, capped.
// Planes take what lies beyond the cap too: against a half space a far margin does no harm.
MW_INLINE Float margin_of(const Constants& t, const Group& g, Work& w, Float speed, int index) {
  Float travel = speed * Float(t.dt);
  if (g.force || t.first_thrust) {
    const Float pull = acceleration_of_loads(t, g, t.collider[index].body);
    travel = fma(pull, Float(t.dt * t.dt), travel);
  }
  if (w.travel) travel.store(w.travel + index * kLanes);
  const Float margin = clamp(travel, Float(t.half_margin), constants_of_shape(g, index).margin_cap);
  max(travel - margin, Float(Real(0))).store(w.beyond + index * kLanes);
  return margin;
}

// Contacts of trees are those of the moment: no margin for what may come.
MW_INLINE Float spatial_margin(const Constants& t, const Group& g, Work& w, int index,
                               bool rotated) {
  if (t.tree.links > 0) {
    Float(Real(0)).store(w.beyond + index * kLanes);
    return t.half_margin;
  }
  const auto at = kernels::state_offsets(t.dimension);
  const int body = t.collider[index].body;
  const Real* state = g.state + body * t.state_stride * kLanes;
  Float speed = length(load_vec3(state + at.linear * kLanes));
  if (rotated) {
    const Vec3 omega = load_vec3(state + at.angular * kLanes);
    speed = fma(length(omega), constants_of_body(g, body).radius, speed);
  }
  return margin_of(t, g, w, speed, index);
}

MW_INLINE void put_bounds(Work& w, int collider, const BoundsOf<Vec3>& bounds) {
  store(w.bounds + collider * 6 * kLanes, bounds.centre);
  store(w.bounds + collider * 6 * kLanes + 3 * kLanes, bounds.half);
}
MW_INLINE void put_bounds(Work& w, int collider, const BoundsOf<Vec2>& bounds) {
  store(w.bounds + collider * 4 * kLanes, bounds.centre);
  store(w.bounds + collider * 4 * kLanes + 2 * kLanes, bounds.half);
}

void spatial_collider(const Constants& t, const Group& g, Work& w, int index) {
  const auto& c = t.collider[index];
  const auto& constants = constants_of_shape(g, index);
  const auto at = kernels::state_offsets(t.dimension);
  const Real* state = g.state + c.body * t.state_stride * kLanes;
  Vec3 p = load_vec3(state + at.position * kLanes);
  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.pose_base[l] + c.row;
  Mat3 r;
  const bool rotated = t.has_orientation && !(t.collider_is_body && info(c.kind).ball);
  if (rotated) {
    const Vec3 omega = load_vec3(state + at.angular * kLanes);
    r = matrix(orientation_ahead(t, w, load_quat(state + at.orientation * kLanes), omega));
    if (!t.collider_is_body) {
      p = p + mul(r, vec3(constants.offset));
      const LaneNumber* axes = constants.rotation;
      r = {mul(r, vec3(axes)), mul(r, vec3(axes + 3)), mul(r, vec3(axes + 6))};
    }
  }
  const Float margin = spatial_margin(t, g, w, index, rotated);
  put_bounds(w, index,
             put_shape(SpatialPlacement{c, constants, nullptr, p, r, margin, w.pose_rows, o}));
}

void planar_collider(const Constants& t, const Group& g, Work& w, int index) {
  const auto& c = t.collider[index];
  const auto& constants = constants_of_shape(g, index);
  const auto at = kernels::state_offsets(t.dimension);
  const Real* state = g.state + c.body * t.state_stride * kLanes;
  Vec2 p = load_vec2(state + at.position * kLanes);
  const Vec2 v = load_vec2(state + at.linear * kLanes);
  Float speed = sqrt(dot(v, v));

  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.pose_base[l] + c.row;
  Rot2 q{Real(1), Real(0)};
  const bool rotated = t.has_orientation && !(t.collider_is_body && info(c.kind).ball);
  if (rotated) {
    const Float omega = Float::load(state + at.angular * kLanes);
    q = orientation_ahead(t, w, load_rot2(state + at.orientation * kLanes), omega);
    if (!t.collider_is_body) {
      p = p + rotate(q, {constants.offset[0], constants.offset[1]});
      q = {fms(q.c, Float(constants.rotation[0]), q.s * Float(constants.rotation[1])),
           fma(q.s, Float(constants.rotation[0]), q.c * Float(constants.rotation[1]))};
    }
    speed = fma(abs(omega), constants_of_body(g, c.body).radius, speed);
  }
  const Float margin = margin_of(t, g, w, speed, index);
  if (w.facing) {
    q.c.store(w.facing + index * 2 * kLanes);
    q.s.store(w.facing + (index * 2 + 1) * kLanes);
  }
  const auto* polygon = g.constants.polygon ? &constants_of_polygon(g, index) : nullptr;
  put_bounds(w, index,
             put_shape(PlanarPlacement{c, constants, polygon, p, q, margin, w.pose_rows, o}));
}

}  // namespace

void rotate_body_rows(const Constants& t, const Group& g, Work& w, bool ahead) {
  using kernels::InertiaKind;
  const bool scalar = t.inertia_kind != InertiaKind::tensor;
  if (scalar && t.collider_is_body && !t.bodies_vary) return;  // constant
  const auto at = kernels::state_offsets(t.dimension);
  for (int b = 0; b < t.bodies; ++b) {
    const auto& body = constants_of_body(g, b);
    const Real* state = g.state + b * t.state_stride * kLanes;
    alignas(64) std::int32_t o[kLanes];
    for (int l = 0; l < kLanes; ++l) o[l] = w.body_base[l] + b * body_row_size(t.inertia_kind);
    if (t.dimension == kernels::Dimension::planar) {
      const Vec2 p = load_vec2(state + at.position * kLanes);
      store_rows4(w.body_rows, o, body.inv_mass, body.inv_inertia[2], p.x, p.y);
      continue;
    }
    if (t.inertia_kind == kernels::InertiaKind::tensor) {
      Quat q = load_quat(state + at.orientation * kLanes);
      if (ahead) q = orientation_ahead(t, w, q, load_vec3(state + at.angular * kLanes));
      const Mat3 r = matrix(q);
      const Sym3 s = rotate_diagonal(r, vec3(body.inv_inertia));
      store_rows4(w.body_rows, o, s.xx, s.xy, s.xz, s.yy);
      store_rows4(w.body_rows + 4, o, s.yz, s.zz, body.inv_mass, Real(0));
    } else if (t.bodies_vary) {
      store_rows4(w.body_rows, o, body.inv_mass, body.inv_inertia[2], Real(0), Real(0));
    }
    if (!t.collider_is_body) {
      const Vec3 p = load_vec3(state + at.position * kLanes);
      const int part = t.inertia_kind == kernels::InertiaKind::tensor ? 8 : 4;
      store_rows4(w.body_rows + part, o, p.x, p.y, p.z, Real(0));
    }
  }
}

void begin(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  for (int i = 0; w.pose_rows && i < t.colliders; ++i) {
    if (t.dimension == kernels::Dimension::spatial) {
      spatial_collider(t, g, w, i);
    } else {
      planar_collider(t, g, w, i);
    }
  }
  if (t.tree.links == 0) rotate_body_rows(t, g, w, w.pose_rows != nullptr);
  for (int b = 0; b <= t.bodies; ++b) w.touched[b] = 0;
  for (int list = 0; list < kLists; ++list) {
    w.blocks[list].count = 0;
    for (int l = 0; l < kLanes; ++l) w.lane_count[list][l] = w.cursor[list][l] = 0;
    const std::int32_t* keys = g.cache[list].keys;
    for (int l = 0; keys && l < kLanes; ++l) {
      w.key_at_cursor[list][l] = keys[l];
    }
  }
  w.overflow = w.partly_asleep = 0;
  w.tree.contact_count = 0;
  w.untouched = w.frozen = frozen_lanes(g);
  if (t.has_sleep && t.has_joints && has_idle_bodies(g)) wake_joined(t, g, w);
  w.counters = {};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
