// begin: the first stage of a contact step. Poses of shapes as rows, their bounds with the
// speculative margin, and inverse inertias in world axes.
#include "kernels/sleep/sleep.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/constants.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// How much a shape's bounds grow: half of 4 slop, or as far as its body moves in the step, capped.
// Planes take what lies beyond the cap too: against a half space a far margin does no harm.
MW_INLINE Float margin_of(const Tables& t, const Group& g, Work& w, Float speed, int index) {
  const Float travel = speed * Float(t.dt);
  const Float margin = clamp(travel, Float(t.half_margin), constants_of_shape(g, index).margin_cap);
  max(travel - margin, Float(Real(0))).store(w.beyond + index * kLanes);
  return margin;
}

MW_INLINE Vec3 vec3(const LaneNumber* v) { return {v[0], v[1], v[2]}; }

MW_INLINE void put_bounds(Work& w, int collider, Vec3 centre, Vec3 half) {
  store(w.bounds + collider * 6 * kLanes, centre);
  store(w.bounds + collider * 6 * kLanes + 3 * kLanes, half);
}
MW_INLINE void put_bounds(Work& w, int collider, Vec2 centre, Vec2 half) {
  store(w.bounds + collider * 4 * kLanes, centre);
  store(w.bounds + collider * 4 * kLanes + 2 * kLanes, half);
}

void spatial_collider(const Tables& t, const Group& g, Work& w, int index) {
  const auto& c = t.collider[index];
  const auto& numbers = constants_of_shape(g, index);
  const auto at = kernels::state_offsets(t.dimension, t.has_orientation);
  const Real* state = g.state + c.body * t.state_stride * kLanes;
  Vec3 p = load_vec3(state + at.position * kLanes);
  const Vec3 v = load_vec3(state + at.linear * kLanes);
  Float speed = sqrt(dot(v, v));

  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.pose_base[l] + c.row;
  Mat3 r;
  const bool turned = t.has_orientation && !(t.collider_is_body && c.kind == ShapeKind::sphere);
  if (turned) {
    r = matrix(load_quat(state + at.orientation * kLanes));
    if (!t.collider_is_body) {
      p = p + mul(r, vec3(numbers.offset));
      const LaneNumber* axes = numbers.rotation;
      r = {mul(r, vec3(axes)), mul(r, vec3(axes + 3)), mul(r, vec3(axes + 6))};
    }
    const Vec3 omega = load_vec3(state + at.angular * kLanes);
    speed = fma(sqrt(dot(omega, omega)), constants_of_body(g, c.body).radius, speed);
  }
  const Float margin = margin_of(t, g, w, speed, index);
  if (c.kind == ShapeKind::sphere) {
    store_rows4(w.pose_rows, o, p.x, p.y, p.z, numbers.radius);
    const Float reach = margin + Float(numbers.radius);
    put_bounds(w, index, p, {reach, reach, reach});
    return;
  }
  if (c.kind == ShapeKind::capsule) {
    const Float half(numbers.half[0]), reach = margin + Float(numbers.radius);
    store_rows4(w.pose_rows, o, p.x, p.y, p.z, numbers.radius);
    store_rows4(w.pose_rows + 4, o, r.z.x, r.z.y, r.z.z, half);
    put_bounds(
        w, index, p,
        {fma(abs(r.z.x), half, reach), fma(abs(r.z.y), half, reach), fma(abs(r.z.z), half, reach)});
    return;
  }
  const Float hx(numbers.half[0]), hy(numbers.half[1]), hz(numbers.half[2]);
  store_rows4(w.pose_rows, o, r.x.x, r.x.y, r.x.z, p.x);
  store_rows4(w.pose_rows + 4, o, r.y.x, r.y.y, r.y.z, p.y);
  store_rows4(w.pose_rows + 8, o, r.z.x, r.z.y, r.z.z, p.z);
  store_rows4(w.pose_rows + 12, o, hx, hy, hz, margin);
  if (c.kind == ShapeKind::cylinder) {
    const auto half_of = [&](Float along) {
      const Float rim2 = max(fnma(along, along, Float(Real(1))), Real(0));
      return fma(sqrt(rim2), hx, fma(abs(along), hz, margin));
    };
    return put_bounds(w, index, p, {half_of(r.z.x), half_of(r.z.y), half_of(r.z.z)});
  }
  if (c.kind == ShapeKind::hull) {
    store_rows4(w.pose_rows + 16, o, static_cast<Real>(c.hull), static_cast<Real>(c.vertex_count),
                static_cast<Real>(c.face_count), Real(0));
  }
  put_bounds(w, index, p,
             {fma(abs(r.z.x), hz, fma(abs(r.y.x), hy, abs(r.x.x) * hx)) + margin,
              fma(abs(r.z.y), hz, fma(abs(r.y.y), hy, abs(r.x.y) * hx)) + margin,
              fma(abs(r.z.z), hz, fma(abs(r.y.z), hy, abs(r.x.z) * hx)) + margin});
}

void planar_collider(const Tables& t, const Group& g, Work& w, int index) {
  const auto& c = t.collider[index];
  const auto& numbers = constants_of_shape(g, index);
  const auto at = kernels::state_offsets(t.dimension, t.has_orientation);
  const Real* state = g.state + c.body * t.state_stride * kLanes;
  Vec2 p = load_vec2(state + at.position * kLanes);
  const Vec2 v = load_vec2(state + at.linear * kLanes);
  Float speed = sqrt(dot(v, v));

  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.pose_base[l] + c.row;
  Rot2 q{Real(1), Real(0)};
  const bool turned = t.has_orientation && !(t.collider_is_body && c.kind == ShapeKind::circle);
  if (turned) {
    q = load_rot2(state + at.orientation * kLanes);
    if (!t.collider_is_body) {
      p = p + rotate(q, {numbers.offset[0], numbers.offset[1]});
      q = {fms(q.c, Float(numbers.rotation[0]), q.s * Float(numbers.rotation[1])),
           fma(q.s, Float(numbers.rotation[0]), q.c * Float(numbers.rotation[1]))};
    }
    const Float omega = Float::load(state + at.angular * kLanes);
    speed = fma(abs(omega), constants_of_body(g, c.body).radius, speed);
  }
  const Float margin = margin_of(t, g, w, speed, index);
  if (c.kind == ShapeKind::circle) {
    store_rows4(w.pose_rows, o, p.x, p.y, numbers.radius, Real(0));
    const Float reach = margin + Float(numbers.radius);
    put_bounds(w, index, p, {reach, reach});
  } else if (c.kind == ShapeKind::capsule) {
    const Float half(numbers.half[0]), reach = margin + Float(numbers.radius);
    store_rows4(w.pose_rows, o, p.x, p.y, Real(0), numbers.radius);
    store_rows4(w.pose_rows + 4, o, -q.s, q.c, Real(0), half);
    put_bounds(w, index, p, {fma(abs(q.s), half, reach), fma(abs(q.c), half, reach)});
  } else if (c.kind == ShapeKind::rectangle) {
    const Float hx(numbers.half[0]), hy(numbers.half[1]);
    store_rows4(w.pose_rows, o, p.x, p.y, q.c, q.s);
    store_rows4(w.pose_rows + 4, o, hx, hy, Real(0), Real(0));
    put_bounds(
        w, index, p,
        {fma(abs(q.s), hy, abs(q.c) * hx) + margin, fma(abs(q.c), hy, abs(q.s) * hx) + margin});
  } else {
    store_rows4(w.pose_rows, o, p.x, p.y, static_cast<Real>(c.vertex_count), numbers.radius);
    const auto& polygon = constants_of_polygon(g, index);
    Vec2 low{Real(1e30), Real(1e30)}, high{Real(-1e30), Real(-1e30)};
    for (int i = 0; i < kernels::kMaxVertices; i += 2) {
      Vec2 a[2], n[2];
      for (int k = 0; k < 2; ++k) {
        const LaneNumber* vertex = polygon.vertices + 2 * (i + k);
        const LaneNumber* normal = polygon.normals + 2 * (i + k);
        a[k] = rotate(q, {vertex[0], vertex[1]});
        n[k] = rotate(q, {normal[0], normal[1]});
        low = {min(low.x, a[k].x), min(low.y, a[k].y)};
        high = {max(high.x, a[k].x), max(high.y, a[k].y)};
      }
      store_rows4(w.pose_rows + 4 + 2 * i, o, a[0].x, a[0].y, a[1].x, a[1].y);
      store_rows4(w.pose_rows + 4 + 2 * kernels::kMaxVertices + 2 * i, o, n[0].x, n[0].y, n[1].x,
                  n[1].y);
    }
    const Float half(Real(0.5));
    const Float reach = c.kind == ShapeKind::rounded ? margin + Float(numbers.radius) : margin;
    put_bounds(w, index, p + (low + high) * half,
               {fma(high.x - low.x, half, reach), fma(high.y - low.y, half, reach)});
  }
}

}  // namespace

void turn_body_rows(const Tables& t, const Group& g, Work& w) {
  using kernels::InertiaKind;
  const bool scalar = t.inertia_kind != InertiaKind::tensor;
  if (scalar && t.collider_is_body && !t.bodies_vary) return;  // constant
  const auto at = kernels::state_offsets(t.dimension, t.has_orientation);
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
      const Mat3 r = matrix(load_quat(state + at.orientation * kLanes));
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

void begin(const Tables& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  for (int i = 0; w.pose_rows && i < t.colliders; ++i) {
    if (t.dimension == kernels::Dimension::spatial) {
      spatial_collider(t, g, w, i);
    } else {
      planar_collider(t, g, w, i);
    }
  }
  turn_body_rows(t, g, w);
  for (int b = 0; b <= t.bodies; ++b) w.touched[b] = 0;
  for (int list = 0; list < kLists; ++list) {
    w.slots[list].count = 0;
    for (int l = 0; l < kLanes; ++l) w.lane_count[list][l] = w.cursor[list][l] = 0;
  }
  w.overflow = w.partly_asleep = 0;
  w.untouched = w.frozen = frozen_lanes(g);
  if (t.has_sleep && t.has_joints && has_idle_bodies(g)) wake_joined(t, g, w);
  w.counters = {};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
