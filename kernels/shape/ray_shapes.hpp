// A ray against one shape of each kind, in lanes. A ray that begins in a shape or on it hits it at
// distance 0, with the normal against the ray. A ray that only grazes a surface hits it.
#pragma once

#include "kernels/shape/corners.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class Vec>
struct RayOf {
  Vec from, way;  // m, world; unit
};

template <class Vec>
struct RayHit {
  Float distance;  // along the ray, >= 0 where it hits
  Vec normal;      // unit, out of the shape
  Mask hit;
};

inline constexpr Real kRayFar = Real(1e30);  // m

template <class Vec>
MW_INLINE RayHit<Vec> begin_inside(const RayOf<Vec>& ray, Mask inside, RayHit<Vec> h) {
  return {select(inside, Float(Real(0)), h.distance), select(inside, -ray.way, h.normal),
          inside | h.hit};
}

template <class Vec>
MW_INLINE RayHit<Vec> nearer(const RayHit<Vec>& a, const RayHit<Vec>& b) {
  const Mask take = b.hit & ((!a.hit) | (b.distance < a.distance));
  return {select(take, b.distance, a.distance), select(take, b.normal, a.normal), a.hit | b.hit};
}

// Ball about `centre`, given from the ray's origin. The discriminant is taken where the ray passes
// nearest to the centre: it then loses no digits far away.
template <class Vec>
MW_INLINE RayHit<Vec> cast_round(const RayOf<Vec>& ray, Vec centre, Float radius) {
  const Float zero(Real(0)), one(Real(1));
  const Float along = dot(centre, ray.way);
  const Vec aside = fnma(ray.way, along, centre);
  const Float rest = fnma(radius, radius, dot(aside, aside));
  const Float distance = along - sqrt(max(-rest, zero));
  const Vec out = fma(ray.way, distance, -centre);
  const Float length2 = dot(out, out);
  RayHit<Vec> h;
  h.distance = distance;
  h.normal = out * (one / sqrt(select(zero < length2, length2, one)));
  h.hit = (rest <= zero) & (zero <= distance);
  return begin_inside(ray, dot(centre, centre) <= radius * radius, h);
}

// The solid below a surface through `height` below the origin, along its outward normal.
template <class Vec>
MW_INLINE RayHit<Vec> cast_half_space(const RayOf<Vec>& ray, Vec normal, Float height) {
  const Float zero(Real(0)), one(Real(1));
  const Float fall = -dot(normal, ray.way);
  const Mask toward = zero < fall;
  const RayHit<Vec> h{height / select(toward, fall, one), normal, toward & (zero < height)};
  return begin_inside(ray, height <= zero, h);
}

// Convex solids as what lies below all of their faces: in at the last face that the ray comes
// through, out at the first.
struct Clip {
  Float enter, leave;
  MW_INLINE Clip() : enter(-kRayFar), leave(kRayFar) {}
  // A face that the ray's origin is `height` above and that the ray falls to at `fall` per meter.
  // Whether it is the last entered so far.
  MW_INLINE Mask add(Float height, Float fall) {
    const Float zero(Real(0)), one(Real(1));
    const Mask toward = zero < fall, away = fall < zero;
    const Float at = height / select(toward | away, fall, one);
    // Along a face: nothing of the ray is below it, or all.
    const Float in = select(toward, at, select(away | (height <= zero), Float(-kRayFar), kRayFar));
    const Mask last = enter < in;
    enter = max(in, enter);
    leave = select(away, min(at, leave), leave);
    return last;
  }
  MW_INLINE Mask hits() const {
    return (enter <= leave) & (Float(Real(0)) <= leave) & (enter < Float(kRayFar));
  }
};

template <class Vec>
MW_INLINE RayHit<Vec> clipped(const RayOf<Vec>& ray, const Clip& clip, Vec normal) {
  const Mask inside = clip.hits() & (clip.enter <= Float(Real(0)));
  return begin_inside(ray, inside, {clip.enter, normal, clip.hits()});
}

// Adds the two faces across an axis to a clip, and their outward normal where it is the last.
template <class Vec>
MW_INLINE void clip_slab(Clip& clip, Vec axis, Float place, Float way, Float half, Vec& normal) {
  const Float zero(Real(0)), one(Real(1)), far(kRayFar);
  const Mask crosses = (way < zero) | (zero < way);
  const Float inv = one / select(crosses, way, one), front = copysign(half, way);
  // Along both faces: the ray is between them or misses.
  const Float beside = select(abs(place) <= half, -far, far);
  const Float in = select(crosses, (-front - place) * inv, beside);
  const Float out = select(crosses, (front - place) * inv, far);
  normal = select(clip.enter < in, axis * copysign(one, -way), normal);
  clip.enter = max(in, clip.enter);
  clip.leave = min(out, clip.leave);
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const SpherePose& s) {
  return cast_round(ray, s.p - ray.from, s.radius);
}
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const CirclePose& c) {
  return cast_round(ray, c.p - ray.from, c.radius);
}
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const PlanePose& p) {
  return cast_half_space(ray, p.normal, dot(p.normal, ray.from) - p.offset);
}
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const PlanePose& p) {
  const Vec2 normal{p.normal.x, p.normal.y};
  return cast_half_space(ray, normal, dot(normal, ray.from) - p.offset);
}
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const BoxPose& b) {
  const Vec3 place = mul_transposed(b.r, ray.from - b.p), way = mul_transposed(b.r, ray.way);
  Clip clip;
  Vec3 normal = b.r.x;
  clip_slab(clip, b.r.x, place.x, way.x, b.half.x, normal);
  clip_slab(clip, b.r.y, place.y, way.y, b.half.y, normal);
  clip_slab(clip, b.r.z, place.z, way.z, b.half.z, normal);
  return clipped(ray, clip, normal);
}
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const RectanglePose& r) {
  const Vec2 place = rotate_inverse(r.q, ray.from - r.p), way = rotate_inverse(r.q, ray.way);
  const Vec2 x{r.q.c, r.q.s}, y{-r.q.s, r.q.c};
  Clip clip;
  Vec2 normal = x;
  clip_slab(clip, x, place.x, way.x, r.half.x, normal);
  clip_slab(clip, y, place.y, way.y, r.half.y, normal);
  return clipped(ray, clip, normal);
}
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const PolygonPose& p) {
  const Vec2 place = ray.from - p.p;
  Clip clip;
  Vec2 normal = -ray.way;
  for (int i = 0; i < kernels::kMaxVertices; i += 2) {
    Vec2 vertex[2], out[2];
    load_vertex_pair(p, i, vertex[0], vertex[1]);
    load_vertex_pair(p, i + kernels::kMaxVertices, out[0], out[1]);
    for (int k = 0; k < 2; ++k) {
      const Mask last = clip.add(dot(out[k], place - vertex[k]), -dot(out[k], ray.way));
      normal = select(last, out[k], normal);
    }
  }
  return clipped(ray, clip, normal);
}

// Round corners, and edges moved out between them.
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const RoundedPose& p) {
  const Float zero(Real(0)), one(Real(1));
  const PolygonCorners c = load_corners(p);
  const Vec2 from = ray.from - p.p;
  RayHit<Vec2> best{Float(kRayFar), -ray.way, zero < zero};
  Float height = Real(-1e30), nearest2 = Real(1e30);
  for (int i = 0; i < kernels::kMaxVertices; ++i) {
    best = nearer(best, cast_round(ray, c.vertex[i] - from, p.radius));
    const Vec2 edge = c.vertex[(i + 1) % kernels::kMaxVertices] - c.vertex[i];
    const Vec2 place = from - c.vertex[i];
    const Float above = dot(c.normal[i], place), fall = -dot(c.normal[i], ray.way);
    const Mask toward = zero < fall;
    RayHit<Vec2> side;
    side.distance = (above - p.radius) / select(toward, fall, one);
    side.normal = c.normal[i];
    const Float along = dot(edge, fma(ray.way, side.distance, place)), length2 = dot(edge, edge);
    side.hit =
        toward & (zero <= side.distance) & (zero <= along) & (along <= length2) & (zero < length2);
    best = nearer(best, side);
    height = max(above, height);
    const Vec2 out =
        fnma(edge, clamp(dot(edge, place) / max(length2, Real(1e-20)), zero, one), place);
    nearest2 = min(dot(out, out), nearest2);
  }
  return begin_inside(ray, (height <= zero) | (nearest2 <= p.radius * p.radius), best);
}

// The side of a capsule: in space a cylinder, in the plane the two lines along it. `to`: its middle
// from the ray's origin.
MW_INLINE RayHit<Vec3> cast_side(const RayOf<Vec3>& ray, Vec3 to, const CapsulePose<Vec3>& c) {
  const Float zero(Real(0)), one(Real(1));
  const Float slope = dot(ray.way, c.axis);
  const Vec3 across_way = fnma(c.axis, slope, ray.way),
             across_to = fnma(c.axis, dot(to, c.axis), to);
  const Float a = dot(across_way, across_way);
  const Mask crosses = Float(Real(1e-12)) < a;
  const Float inv = one / select(crosses, a, one);
  const Float nearest = dot(across_to, across_way) * inv;
  const Vec3 aside = fnma(across_way, nearest, across_to);
  const Float rest = fnma(c.radius, c.radius, dot(aside, aside));
  RayHit<Vec3> h;
  h.distance = nearest - sqrt(max(-rest, zero) * inv);
  const Vec3 out = fma(across_way, h.distance, -across_to);
  const Float length2 = dot(out, out);
  h.normal = out * (one / sqrt(select(zero < length2, length2, one)));
  const Float place = fma(slope, h.distance, -dot(to, c.axis));
  h.hit = crosses & (rest <= zero) & (zero <= h.distance) & (abs(place) <= c.half);
  return h;
}
MW_INLINE RayHit<Vec2> cast_side(const RayOf<Vec2>& ray, Vec2 to, const CapsulePose<Vec2>& c) {
  const Float zero(Real(0)), one(Real(1));
  const Vec2 up = across(c.axis);
  const Float above = -dot(up, to), rise = dot(up, ray.way);
  const Float side = copysign(one, above), fall = -(side * rise);
  const Mask toward = zero < fall;
  RayHit<Vec2> h;
  h.distance = (abs(above) - c.radius) / select(toward, fall, one);
  h.normal = up * side;
  const Float place = fma(dot(ray.way, c.axis), h.distance, -dot(to, c.axis));
  h.hit = toward & (zero <= h.distance) & (abs(place) <= c.half);
  return h;
}
template <class Vec>
MW_INLINE RayHit<Vec> cast(const RayOf<Vec>& ray, const CapsulePose<Vec>& c) {
  const Vec to = c.p - ray.from, end = c.axis * c.half;
  const RayHit<Vec> ends =
      nearer(cast_round(ray, to + end, c.radius), cast_round(ray, to - end, c.radius));
  const Vec out = to - c.axis * clamp(dot(to, c.axis), -c.half, c.half);
  return begin_inside(ray, dot(out, out) <= c.radius * c.radius,
                      nearer(ends, cast_side(ray, to, c)));
}

// Between its caps and within its round side.
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const CylinderPose& c) {
  const Float zero(Real(0)), one(Real(1)), far(kRayFar);
  const Vec3 from = ray.from - c.p;
  const Float place = dot(c.r.z, from), slope = dot(c.r.z, ray.way);
  const Vec3 from_axis = fnma(c.r.z, place, from), way = fnma(c.r.z, slope, ray.way);
  Clip clip;
  Vec3 normal = c.r.z;
  clip_slab(clip, c.r.z, place, slope, c.half, normal);
  const Float a = dot(way, way);
  const Mask crosses = Float(Real(1e-12)) < a;
  const Float inv = one / select(crosses, a, one), nearest = -(dot(from_axis, way) * inv);
  const Vec3 aside = fma(way, nearest, from_axis);
  const Float rest = fnma(c.radius, c.radius, dot(aside, aside));
  const Float half = sqrt(max(-rest, zero) * inv);
  const Mask misses =
      zero < select(crosses, rest, fnma(c.radius, c.radius, dot(from_axis, from_axis)));
  const Float in = select(misses, far, select(crosses, nearest - half, -far));
  const Float out = select(crosses, nearest + half, far);
  const Mask last = clip.enter < in;
  const Vec3 rim = fma(way, in, from_axis);
  normal = select(last & crosses & !misses, rim * (one / c.radius), normal);
  clip.enter = max(in, clip.enter);
  clip.leave = min(out, clip.leave);
  return clipped(ray, clip, normal);
}
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const HullPose& h) {
  const Vec3 from = ray.from - h.p, inverse = inverse_of(h.half);
  Clip clip;
  Vec3 normal = -ray.way;
  for (int i = 0; i < h.most_faces; ++i) {
    const HullFace face = hull_face(h, inverse, i);
    const Mask last = clip.add(dot(face.normal, from) - face.reach, -dot(face.normal, ray.way));
    normal = select(last, face.normal, normal);
  }
  return clipped(ray, clip, normal);
}

// From the front only: what is behind a link is solid, and not its business.
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const LinkPose& l) {
  const Float zero(Real(0)), one(Real(1));
  const Vec2 from = ray.from - l.p, up = across(l.axis);
  const Float height = dot(up, from), fall = -dot(up, ray.way);
  const Mask toward = zero < fall;
  RayHit<Vec2> h;
  h.distance = height / select(toward, fall, one);
  h.normal = up;
  const Float place = fma(dot(ray.way, l.axis), h.distance, dot(from, l.axis));
  // A little more, so that nothing slips through where two links meet.
  const Float slack(sizeof(Real) == 4 ? Real(4e-7) : Real(1e-15));
  h.hit = toward & (zero <= height) & (abs(place) <= fma(slack, l.half + h.distance, l.half));
  return h;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
