// Ray casts of a group: every ray against every shape, in lanes, at the poses that begin has just
// put down.
#include "kernels/motion/integrate.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/shape/shapes.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// Calls visit(pose) with the pose of a shape of this kind.
template <class S, class Visit>
MW_INLINE void with_pose(ShapeKind kind, const Real* base, const std::int32_t* o, const Real* hulls,
                         Visit visit) {
  using Shapes = ShapesOf<typename S::Vec>;
  visit_pose(typename Shapes::Moving{}, kind, base, o, hulls, visit) ||
      visit_pose(typename Shapes::Ground{}, kind, base, o, hulls, visit);
}

// The ray in the world: one that belongs to a body goes where that goes.
template <class S>
RayOf<typename S::Vec> place_ray(const Constants& t, const Group& g, int body, const Real* rows) {
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
  const kernels::SeenShape& seen;
  std::uint32_t lanes;
  const Real* hulls;
};

static_assert(row_of(Observed::ray_distance) == 0 && row_of(Observed::ray_normal) == 1 &&
              row_of(Observed::ray_body) == kernels::kHitRows);

// One shape against all rays; nearer hits replace those found so far.
template <class S>
void cast_at(const ObserverView& o, const Target& target) {
  using Vec = typename S::Vec;
  const Mask there = mask_from_bits(target.lanes);
  with_pose<S>(target.kind, target.base, target.offset, target.hulls, [&](const auto& pose) {
    for (int i = 0; i < items_of(o, Observer::rays); ++i) {
      const kernels::RayTable& shared = o.ray[i];
      const bool own = target.body >= 0 && target.body == shared.body;
      if (own || (target.seen.category & shared.mask) == 0) continue;
      const Real* rows = o.placed + i * 6 * kLanes;
      Real* hit = rows_for(o, Observer::rays) + i * rows_of(Observer::rays) * kLanes;
      const RayOf<Vec> ray{load_as<Vec>(rows), load_as<Vec>(rows + 3 * kLanes)};
      const RayHit<Vec> h = cast(ray, pose);
      const Float best = Float::load(hit);
      const Mask nearest = there & h.hit & (h.distance < best);
      if (bits(nearest) == 0) continue;
      select(nearest, h.distance, best).store(hit);
      Real* normal = hit + row_of(Observed::ray_normal) * kLanes;
      store(normal, select(nearest, h.normal, load_as<Vec>(normal)));
      const auto name = [&](int row, std::int32_t index) {
        Real* at = hit + row * kLanes;
        select(nearest, Float(static_cast<Real>(index)), Float::load(at)).store(at);
      };
      name(row_of(Observed::ray_body), target.seen.body);
      name(row_of(Observed::ray_shape), target.seen.shape);
    }
  });
}

template <class S>
void cast_rays(const Constants& t, const Group& g, const Work& w, const ObserverView& o) {
  constexpr int kRows = rows_of(Observer::rays);
  for (int i = 0; i < items_of(o, Observer::rays); ++i) {
    const Real* rows = o.ray_rows + i * kernels::kRayRows * kLanes;
    const auto ray = place_ray<S>(t, g, o.ray[i].body, rows);
    store(o.placed + i * 6 * kLanes, ray.from);
    store(o.placed + (i * 6 + 3) * kLanes, ray.way);
    Real* hit = rows_for(o, Observer::rays) + i * kRows * kLanes;
    Float::load(rows + 6 * kLanes).store(hit);
    for (int c = 1; c < kernels::kHitRows; ++c) Float(Real(0)).store(hit + c * kLanes);
    for (int c = kernels::kHitRows; c < kRows; ++c) Float(Real(-1)).store(hit + c * kLanes);
  }
  alignas(64) std::int32_t at[kLanes];
  for (int f = 0; f < t.fixed_shapes; ++f) {
    for (int l = 0; l < kLanes; ++l) at[l] = t.fixed[f].row;
    cast_at<S>(o, {t.fixed[f].kind, t.fixed_rows, at, -1, o.seen_shape[f], kAllLanes, nullptr});
  }
  for (int c = 0; c < t.colliders; ++c) {
    const auto& shape = t.collider[c];
    for (int l = 0; l < kLanes; ++l) at[l] = w.pose_base[l] + shape.row;
    const std::uint32_t lanes = kAllLanes & ~bits(absent_lanes(g, shape.body));
    cast_at<S>(o, {shape.kind, w.pose_rows, at, shape.body, o.seen_shape[t.fixed_shapes + c], lanes,
                   t.hulls});
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

void observe_rays(const Constants& t, const Group& g, kernels::Scratch* scratch,
                  const ObserverView& o) {
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
