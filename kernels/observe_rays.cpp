// Ray casts of a group: every ray against every shape, in lanes, at the poses that begin has just
// put down.
#include "kernels/activity.hpp"
#include "kernels/integrate.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/observe/ray_shapes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

template <class Pose, class Vec>
MW_INLINE RayHit<Vec> cast_pose(const Real* base, const std::int32_t* o, const RayOf<Vec>& ray) {
  Pose pose;
  load_pose(base, o, pose);
  return cast(ray, pose);
}

RayHit<Vec3> cast_shape(ShapeKind kind, const Real* base, const std::int32_t* o,
                        const RayOf<Vec3>& ray) {
  switch (kind) {
    case ShapeKind::sphere: return cast_pose<SpherePose>(base, o, ray);
    case ShapeKind::box: return cast_pose<BoxPose>(base, o, ray);
    case ShapeKind::capsule: return cast_pose<CapsulePose<Vec3>>(base, o, ray);
    default: return cast_pose<PlanePose>(base, o, ray);
  }
}
RayHit<Vec2> cast_shape(ShapeKind kind, const Real* base, const std::int32_t* o,
                        const RayOf<Vec2>& ray) {
  switch (kind) {
    case ShapeKind::circle: return cast_pose<CirclePose>(base, o, ray);
    case ShapeKind::rectangle: return cast_pose<RectanglePose>(base, o, ray);
    case ShapeKind::polygon: return cast_pose<PolygonPose>(base, o, ray);
    case ShapeKind::capsule: return cast_pose<CapsulePose<Vec2>>(base, o, ray);
    case ShapeKind::link: return cast_pose<LinkPose>(base, o, ray);
    default: return cast_pose<PlanePose>(base, o, ray);
  }
}

// The ray in the world: one that belongs to a body goes where that goes.
template <class S>
RayOf<typename S::Vec> place_ray(const Tables& t, const Group& g, int body, const Real* rows) {
  RayOf<typename S::Vec> ray{load_as<typename S::Vec>(rows),
                             load_as<typename S::Vec>(rows + 3 * kLanes)};
  if (body < 0) return ray;
  const auto x = load_as<typename S::Vec>(state_of(t, g, body, kState<S>.position));
  if (t.has_orientation) {
    const auto q = load_as<typename S::Orientation>(state_of(t, g, body, kState<S>.orientation));
    ray.from = rotate(q, ray.from);
    ray.way = rotate(q, ray.way);
  }
  ray.from = ray.from + x;
  return ray;
}

template <class S>
void cast_rays(const Tables& t, const Group& g, const Work& w, const Observation& o) {
  using Vec = typename S::Vec;
  for (int i = 0; i < o.rays; ++i) {
    const Real* rows = o.ray_rows + i * kernels::kRayRows * kLanes;
    const kernels::RayTable& shared = o.ray[i];
    const RayOf<Vec> ray = place_ray<S>(t, g, shared.body, rows);
    Float best = Float::load(rows + 6 * kLanes), shape(Real(-1));
    Vec normal = zero_of<Vec>();
    const auto take = [&](const RayHit<Vec>& h, Mask seen, int index) {
      const Mask nearest =
          seen & h.hit & ((h.distance < best) | ((h.distance == best) & (shape < Float(Real(0)))));
      best = select(nearest, h.distance, best);
      normal = select(nearest, h.normal, normal);
      shape = select(nearest, Float(static_cast<Real>(index)), shape);
    };
    alignas(64) std::int32_t at[kLanes];
    for (int f = 0; f < t.fixed_shapes; ++f) {
      if ((o.fixed_category[f] & shared.mask) == 0) continue;
      for (int l = 0; l < kLanes; ++l) at[l] = t.fixed[f].row;
      take(cast_shape(t.fixed[f].kind, t.fixed_rows, at, ray), mask_from_bits(kAllLanes), f);
    }
    for (int c = 0; c < t.colliders; ++c) {
      const auto& collider = t.collider[c];
      if ((collider.category & shared.mask) == 0 || collider.body == shared.body) continue;
      for (int l = 0; l < kLanes; ++l) at[l] = w.pose_base[l] + collider.row;
      take(cast_shape(collider.kind, w.pose_rows, at, ray), !absent_lanes(g, collider.body),
           t.fixed_shapes + c);
    }
    Real* hit = o.hit_rows + i * kernels::kHitRows * kLanes;
    best.store(hit);
    if constexpr (S::kDim == 2) Float(Real(0)).store(hit + 3 * kLanes);
    store(hit + kLanes, normal);
    alignas(64) Real index[kLanes];
    shape.store(index);
    for (int l = 0; l < kLanes; ++l) {
      o.hit_shape[i * kLanes + l] = static_cast<std::int32_t>(index[l]);
    }
  }
}

template <class S>
bool cast_one_in(ShapeKind kind, const Real* row, const Real* rows, Real* out) {
  using Vec = typename S::Vec;
  alignas(64) Real numbers[6][kLanes];
  for (int i = 0; i < 6; ++i) Float(rows[i]).store(numbers[i]);
  const RayOf<Vec> ray{load_as<Vec>(numbers[0]), load_as<Vec>(numbers[3])};
  alignas(64) std::int32_t at[kLanes];
  for (int l = 0; l < kLanes; ++l) at[l] = 0;
  const RayHit<Vec> h = cast_shape(kind, row, at, ray);
  h.distance.store(numbers[0]);
  Float(Real(0)).store(numbers[3]);
  store(numbers[1], h.normal);
  for (int i = 0; i < kernels::kHitRows; ++i) out[i] = numbers[i][0];
  return (bits(h.hit) & 1u) != 0 && out[0] <= rows[6];
}

}  // namespace

void observe_rays(const Tables& t, const Group& g, kernels::Scratch* scratch,
                  const Observation& o) {
  const Work& w = work_of(scratch);
  if (t.dimension == kernels::Dimension::planar) {
    cast_rays<Planar>(t, g, w, o);
  } else {
    cast_rays<Isotropic>(t, g, w, o);
  }
}

bool cast_one(kernels::Dimension dimension, ShapeKind kind, const Real* row, const Real* ray,
              Real* out) {
  return dimension == kernels::Dimension::planar ? cast_one_in<Planar>(kind, row, ray, out)
                                                 : cast_one_in<Isotropic>(kind, row, ray, out);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
