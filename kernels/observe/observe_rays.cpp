// Ray casts of a group: every ray against every shape, in lanes, at the poses that begin has just
// put down.
#include "kernels/motion/integrate.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/observe/ray_field.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// Calls visit(pose) with the pose of a shape of this kind.
template <class Pose, class Visit>
MW_INLINE void visit_pose(const Real* base, const std::int32_t* o, Visit& visit) {
  Pose pose;
  load_pose(base, o, pose);
  visit(pose);
}
// `hulls`: where the corners of hulls are; nullptr: behind the pose row.
template <class S, class Visit>
MW_INLINE void with_pose(ShapeKind kind, const Real* base, const std::int32_t* o, const Real* hulls,
                         Visit visit) {
  using Capsule = CapsulePose<typename S::Vec>;
  if (kind == ShapeKind::capsule) return visit_pose<Capsule>(base, o, visit);
  if (kind == ShapeKind::plane) return visit_pose<PlanePose>(base, o, visit);
  if constexpr (S::kDim == 3) {
    if (kind == ShapeKind::sphere) return visit_pose<SpherePose>(base, o, visit);
    if (kind == ShapeKind::cylinder) return visit_pose<CylinderPose>(base, o, visit);
    if (kind == ShapeKind::tile) return visit(FieldPose{base, o});
    if (kind == ShapeKind::hull) {
      HullPose pose;
      load_hull(base, o, hulls, pose);
      return visit(pose);
    }
    visit_pose<BoxPose>(base, o, visit);
  } else {
    if (kind == ShapeKind::circle) return visit_pose<CirclePose>(base, o, visit);
    if (kind == ShapeKind::rectangle) return visit_pose<RectanglePose>(base, o, visit);
    if (kind == ShapeKind::link) return visit_pose<LinkPose>(base, o, visit);
    if (kind == ShapeKind::rounded) return visit_pose<RoundedPose>(base, o, visit);
    visit_pose<PolygonPose>(base, o, visit);
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

// A shape of all lanes, as rays see it.
struct Target {
  ShapeKind kind;
  const Real* base;  // of its pose rows
  const std::int32_t* offset;
  int body;  // -1: fixed
  std::uint32_t category, lanes;
  int index;
  const Real* hulls;
};

// One shape against all rays; nearer hits replace those found so far.
template <class S>
void cast_at(const Observation& o, const Target& target) {
  using Vec = typename S::Vec;
  const Mask there = mask_from_bits(target.lanes);
  with_pose<S>(target.kind, target.base, target.offset, target.hulls, [&](const auto& pose) {
    for (int i = 0; i < o.rays; ++i) {
      const kernels::RayTable& shared = o.ray[i];
      const bool own = target.body >= 0 && target.body == shared.body;
      if (own || (target.category & shared.mask) == 0) continue;
      const Real* rows = o.placed + i * 6 * kLanes;
      Real* hit = o.hit_rows + i * kernels::kHitRows * kLanes;
      const RayOf<Vec> ray{load_as<Vec>(rows), load_as<Vec>(rows + 3 * kLanes)};
      const RayHit<Vec> h = cast(ray, pose);
      const Float best = Float::load(hit);
      const Mask nearest = there & h.hit & (h.distance < best);
      std::uint32_t m = bits(nearest);
      if (m == 0) continue;
      select(nearest, h.distance, best).store(hit);
      store(hit + kLanes, select(nearest, h.normal, load_as<Vec>(hit + kLanes)));
      for (; m != 0; m &= m - 1) o.hit_shape[i * kLanes + __builtin_ctz(m)] = target.index;
    }
  });
}

template <class S>
void cast_rays(const Tables& t, const Group& g, const Work& w, const Observation& o) {
  for (int i = 0; i < o.rays; ++i) {
    const Real* rows = o.ray_rows + i * kernels::kRayRows * kLanes;
    const auto ray = place_ray<S>(t, g, o.ray[i].body, rows);
    store(o.placed + i * 6 * kLanes, ray.from);
    store(o.placed + (i * 6 + 3) * kLanes, ray.way);
    Real* hit = o.hit_rows + i * kernels::kHitRows * kLanes;
    Float::load(rows + 6 * kLanes).store(hit);
    for (int c = 1; c < kernels::kHitRows; ++c) Float(Real(0)).store(hit + c * kLanes);
    for (int l = 0; l < kLanes; ++l) o.hit_shape[i * kLanes + l] = -1;
  }
  alignas(64) std::int32_t at[kLanes];
  for (int f = 0; f < t.fixed_shapes; ++f) {
    for (int l = 0; l < kLanes; ++l) at[l] = t.fixed[f].row;
    cast_at<S>(o,
               {t.fixed[f].kind, t.fixed_rows, at, -1, o.fixed_category[f], kAllLanes, f, nullptr});
  }
  for (int c = 0; c < t.colliders; ++c) {
    const auto& shape = t.collider[c];
    for (int l = 0; l < kLanes; ++l) at[l] = w.pose_base[l] + shape.row;
    const std::uint32_t lanes = kAllLanes & ~bits(absent_lanes(g, shape.body));
    cast_at<S>(o, {shape.kind, w.pose_rows, at, shape.body, shape.category, lanes,
                   t.fixed_shapes + c, t.hulls});
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
  RayHit<Vec> h{};
  with_pose<S>(kind, row, at, nullptr, [&](const auto& pose) { h = cast(ray, pose); });
  h.distance.store(numbers[0]);
  Float(Real(0)).store(numbers[3]);
  store(numbers[1], h.normal);
  for (int i = 0; i < kernels::kHitRows; ++i) out[i] = numbers[i][0];
  return (bits(h.hit) & 1u) != 0 && out[0] < rows[6];
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
