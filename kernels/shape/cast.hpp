// cast: a body that moves more than half its extent in a step is swept against the fixed shapes
// that are not planes, and on request against moving shapes, and stops where its core first touches
// one. Planes need no cast: contacts with a speculative margin hold at any speed against a half
// space.
//
// The core is a sphere inside the body about its centre of mass, smaller than the body, so that
// passing an edge closely is not an impact. The time of touch is found by conservative
// advancement: the core may always move by its distance to the shape. The rest of the step's
// motion is dropped; the velocity stays, and the next step's contact deals with it.
//
// A moving shape is taken to shift without turning while the step lasts: what it turns matters
// little to a body that crosses its own size meanwhile.
#pragma once

#include "kernels/lane/space.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/constants.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kCastRounds = 32;

MW_INLINE Mask within_bounds(const Tables& t, Vec2 x) {
  return (Float(t.bounds_low[0]) <= x.x) & (x.x <= Float(t.bounds_high[0])) &
         (Float(t.bounds_low[1]) <= x.y) & (x.y <= Float(t.bounds_high[1]));
}
MW_INLINE Mask within_bounds(const Tables& t, Vec3 x) {
  return within_bounds(t, Vec2{x.x, x.y}) & (Float(t.bounds_low[2]) <= x.z) &
         (x.z <= Float(t.bounds_high[2]));
}

// Does any shape of the body collide with this one, by their filters?
MW_INLINE bool may_collide(const Tables& t, int body, const kernels::ColliderTable& other) {
  for (int i = t.first_collider[body]; i < t.first_collider[body + 1]; ++i) {
    const auto& own = t.collider[i];
    if ((own.category & other.mask) != 0 && (other.category & own.mask) != 0) return true;
  }
  return false;
}

// From a capsule, given the point from its origin.
template <class Vec>
MW_INLINE Float distance_to_capsule(Vec d, Vec axis, Float radius, Float half) {
  const Vec out = fnma(axis, clamp(dot(axis, d), -half, half), d);
  return sqrt(dot(out, out)) - radius;
}

// As for polygons below: the largest distance to a face's plane. All lanes see the same hull, one
// number after another: row(20) is the first of its corners.
template <class Row>
__attribute__((noinline)) Float distance_to_hull(Row row, Vec3 local) {
  const auto count = [&](int number) {
    alignas(64) Real all[kLanes];
    Float(row(number)).store(all);
    return static_cast<int>(all[0]);
  };
  const int faces = 20 + 4 * count(17), end = faces + 8 * count(18);
  const Float one(Real(1));
  const Vec3 inverse{one / row(12), one / row(13), one / row(14)};
  Float far = Real(-1e30);
  for (int i = faces; i < end; i += 8) {
    const Vec3 m{row(i) * inverse.x, row(i + 1) * inverse.y, row(i + 2) * inverse.z};
    far = max(far, (dot(m, local) - row(i + 3)) / sqrt(dot(m, m)));
  }
  return far;
}

// Distance from a point to a shape; 0 or less inside. `row(i)` is number i of its pose row.
template <class Row>
MW_INLINE Float distance_to_shape(kernels::ShapeKind kind, Row row, Vec3 p) {
  const Float zero(Real(0));
  if (kind == kernels::ShapeKind::sphere) {
    const Vec3 d = p - Vec3{row(0), row(1), row(2)};
    return sqrt(dot(d, d)) - row(3);
  }
  if (kind == kernels::ShapeKind::capsule) {
    const Vec3 from = p - Vec3{row(0), row(1), row(2)};
    return distance_to_capsule(from, Vec3{row(4), row(5), row(6)}, row(3), row(7));
  }
  const Vec3 d = p - Vec3{row(3), row(7), row(11)};
  const Vec3 local{dot(d, Vec3{row(0), row(1), row(2)}), dot(d, Vec3{row(4), row(5), row(6)}),
                   dot(d, Vec3{row(8), row(9), row(10)})};
  if (kind == kernels::ShapeKind::hull) return distance_to_hull(row, local);
  const Vec3 out{max(abs(local.x) - row(12), zero), max(abs(local.y) - row(13), zero),
                 max(abs(local.z) - row(14), zero)};
  if (kind == kernels::ShapeKind::cylinder) {
    const Float rim = max(sqrt(fma(local.x, local.x, local.y * local.y)) - row(12), zero);
    return sqrt(fma(rim, rim, out.z * out.z));
  }
  return sqrt(dot(out, out));
}
template <class Row>
MW_INLINE Float distance_to_shape(kernels::ShapeKind kind, Row row, Vec2 p) {
  const Float zero(Real(0));
  const Vec2 d = p - Vec2{row(0), row(1)};
  if (kind == kernels::ShapeKind::circle) {
    return sqrt(dot(d, d)) - row(2);
  }
  if (kind == kernels::ShapeKind::capsule) {
    return distance_to_capsule(d, Vec2{row(4), row(5)}, row(3), row(7));
  }
  if (kind == kernels::ShapeKind::link) {  // nothing for what comes from behind
    const Vec2 axis{row(2), row(3)};
    const Float distance = distance_to_capsule(d, axis, zero, row(4));
    return select(cross(axis, d) < zero, zero, distance);
  }
  if (kind == kernels::ShapeKind::rectangle) {
    const Vec2 local = rotate_inverse({row(2), row(3)}, d);
    const Vec2 out{max(abs(local.x) - row(4), zero), max(abs(local.y) - row(5), zero)};
    return sqrt(dot(out, out));
  }
  // Convex polygon: the largest distance to an edge line is a lower bound, which is all that
  // conservative advancement needs; it is exact where it matters, in front of a face.
  Float far = Real(-1e30);
  for (int i = 0; i < kernels::kMaxVertices; ++i) {
    const Vec2 vertex{row(4 + 2 * i), row(5 + 2 * i)};
    const Vec2 normal{row(20 + 2 * i), row(21 + 2 * i)};
    far = max(far, dot(normal, d - vertex));
  }
  if (kind == kernels::ShapeKind::rounded) far = far - row(3);
  return far;
}

// The share of `step` that the core may go from `start` before it touches the shape; 1 when it
// does not, and where it begins inside: that is the contact's business.
template <class Vec, class Row>
MW_INLINE Float free_share(kernels::ShapeKind kind, Row row, Vec start, Vec step, Float core,
                           Mask fast) {
  const Float zero(Real(0)), one(Real(1));
  const Float inv_length = one / max(sqrt(dot(step, step)), Real(1e-20));
  Float share = zero;
  // As near as a cast may end, so that one who stopped there can go away again.
  const Float touching = core * Float(Real(1.01));
  Mask moving = fast & (touching < distance_to_shape(kind, row, start));
  const Mask outside = moving;
  for (int round = 0; round < kCastRounds && any(moving); ++round) {
    const Float distance = distance_to_shape(kind, row, fma(step, share, start));
    const Mask close = distance < touching;
    const Float next = fma(distance - core, inv_length, share);
    moving = moving & !close;
    share = select(moving, min(next, one), share);
    moving = moving & (share < one);
  }
  return select(outside, share, one);
}

template <class Vec>
MW_INLINE Vec cast_against_fixed(const Tables& t, const Group& g, int body, Vec start, Vec step) {
  const Float radius = constants_of_body(g, body).core_radius;
  const Mask fast = (Float(Real(0)) < radius) & (radius < sqrt(dot(step, step)));
  if (!any(fast)) return step;
  // The core is half the inner sphere, so a body sunk into a face still counts as outside of it.
  const Float core = radius * Float(Real(0.5));
  Float least = Real(1);
  for (int f = 0; f < t.fixed_shapes; ++f) {
    const kernels::ShapeKind kind = t.fixed[f].kind;
    // Who got below a surface that is solid below comes up again.
    if (kind == kernels::ShapeKind::plane || kind == kernels::ShapeKind::tile) continue;
    const Real* r = t.fixed_rows + t.fixed[f].row;
    const auto row = [r](int i) { return Float(r[i]); };
    least = min(least, free_share(kind, row, start, step, core, fast));
  }
  return select(least < Float(Real(1)), step * least, step);
}

// Takes down the shapes of bodies that go so far in this step that others may have to be cast
// against them, whatever those do.
template <class Moved>
void find_swift(const Tables& t, const Group& g, Work& w, Moved moved) {
  Float core = Real(1e18);  // the smallest
  for (int b = 0; b < t.bodies; ++b) {
    const Float radius = constants_of_body(g, b).core_radius;
    core = select(Float(Real(0)) < radius, min(radius, core), core);
  }
  const Float far = core * Float(Real(0.49));  // a little less than half of it
  w.swift_count = 0;
  for (int i = 0; i < t.colliders; ++i) {
    const auto way = moved(t.collider_body[i]);
    if (all(dot(way, way) < square(far))) continue;
    w.swift[w.swift_count++] = i;
  }
}

// `moved(other)` is how far another body goes in this step. Who goes less than half its core meets
// only the swift ones at speed. Not inlined: scenes seldom want it.
template <class Vec, class Moved>
__attribute__((noinline)) Vec cast_against_moving(const Tables& t, const Group& g, const Work& w,
                                                  int body, Vec start, Vec step, Moved moved) {
  const Float radius = constants_of_body(g, body).core_radius;
  const Mask has_core = Float(Real(0)) < radius;
  if (!any(has_core)) return step;
  const Float core = radius * Float(Real(0.5));
  Float least = Real(1);
  const bool slow = all(dot(step, step) < square(core));
  const int others = slow ? w.swift_count : t.colliders;
  for (int k = 0; k < others; ++k) {
    const int i = slow ? w.swift[k] : k;
    const auto& c = t.collider[i];
    if (c.body == body || !may_collide(t, body, c)) continue;
    const Vec relative = step - moved(c.body);
    const Mask fast =
        has_core & (radius < sqrt(dot(relative, relative))) & !absent_lanes(g, c.body);
    if (!any(fast)) continue;
    const auto row = [&](int number) {
      if (c.kind == kernels::ShapeKind::hull && number >= 20) {
        return Float(t.hulls[4 * c.hull + number - 20]);
      }
      alignas(64) Real values[kLanes];
      for (int l = 0; l < kLanes; ++l) values[l] = w.pose_rows[w.pose_base[l] + c.row + number];
      return Float::load(values);
    };
    least = min(least, free_share(c.kind, row, start, relative, core, fast));
  }
  return select(least < Float(Real(1)), step * least, step);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
