// A ray against shapes, in lanes: what their files build on. A ray that begins in a shape or on it
// hits it at distance 0, with the normal against the ray. A ray that only grazes a surface hits it.
#pragma once

#include "kernels/lane/space.hpp"

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

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
