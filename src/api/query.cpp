// Queries on single shapes: distances by closed forms, manifolds and rays by the kernels.
#include "manyworlds/query.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/data/observer.hpp"
#include "manyworlds/batch.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/base/float_mode.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/length_unit.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {

namespace {

bool only_fixed(const Geometry& g) { return traits_of(g).ground; }
bool is_half_space(const Geometry& g) {
  return std::holds_alternative<Plane>(g) || std::holds_alternative<HalfPlane>(g);
}

Space space_of(const Geometry& a, const Geometry& b, std::optional<Space> given) {
  if (given) return *given;
  return traits_of(a).in_space && traits_of(b).in_space ? Space::spatial : Space::planar;
}

Body body_of(const char* name, const Shape& shape, const Pose& pose, Motion motion) {
  Body body;
  body.name = name;
  body.motion = motion;
  body.position = pose.position;
  body.rotation = pose.rotation;
  body.shapes = {shape};
  body.shapes[0].filter = {};
  body.shapes[0].material = {};
  body.shapes[0].density.reset();
  return body;
}

void check(const Scene& scene) {
  std::vector<Issue> issues = validate(scene);
  if (!issues.empty()) throw SceneError("query", std::move(issues));
}

Scene fixed_scene(Space space, std::initializer_list<Body> bodies) {
  Scene scene;
  scene.space = space;
  scene.options.gravity.setZero();
  scene.bodies = bodies;
  check(scene);
  return scene;
}

[[noreturn]] void no_answer(const std::string& what) { throw std::invalid_argument(what); }

// m, of a shape that is not infinite.
double extent(const Convex& c) {
  double most = 0;
  for (const Vec3& p : c.points) most = std::max(most, (p - c.points[0]).norm());
  return std::max(most + 2 * c.radius, 2 * c.radii.maxCoeff());
}

template <class Real>
std::optional<RayHit> cast(const kernels::Kernels<Real>& kernels, const PlanData& plan,
                           const Ray& ray) {
  const Vec3 way = ray.direction.normalized();
  Real rows[kernels::kRayRows], hit[kernels::kHitRows];
  for (int c = 0; c < 3; ++c) {
    rows[c] = static_cast<Real>(ray.origin[c]), rows[3 + c] = static_cast<Real>(way[c]);
  }
  rows[6] = static_cast<Real>(ray.length);
  std::optional<RayHit> best;
  for (const PlanFixed& f : plan.fixed) {
    AlignedBuffer<Real> row(f.row.size());
    for (std::size_t i = 0; i < f.row.size(); ++i) row[i] = static_cast<Real>(f.row[i]);
    if (!kernels.observer->cast(plan.dimension(), f.kind, row.data(), rows, hit)) continue;
    if (best && best->distance <= static_cast<double>(hit[0])) continue;
    best = RayHit{static_cast<double>(hit[0]), BodyId(0), ShapeId(BodyId(0), 0), Vec3::Zero()};
    for (int c = 0; c < 3; ++c) best->normal[c] = static_cast<double>(hit[1 + c]);
  }
  return best;
}

}  // namespace

Separation distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    std::optional<Space> given) {
  const FloatMode mode;
  const Space space = space_of(a.geometry, b.geometry, given);
  fixed_scene(space,
              {body_of("a", a, pose_a, Motion::fixed), body_of("b", b, pose_b, Motion::fixed)});
  if (is_half_space(a.geometry) && is_half_space(b.geometry)) {
    no_answer("distance: both shapes are planes, at least one must be another shape");
  }
  std::optional<Separation> best;
  for (const Convex& part_a : convex_parts(a, pose_a, space)) {
    for (const Convex& part_b : convex_parts(b, pose_b, space)) {
      const Separation s = separation(part_a, part_b);
      if (!best || s.distance < best->distance) best = s;
    }
  }
  return *best;
}

bool overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
             std::optional<Space> space) {
  return distance(a, pose_a, b, pose_b, space).distance <= 0;
}

std::vector<ManifoldPoint> manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                    const Pose& pose_b, double margin, std::optional<Space> given) {
  const FloatMode mode;
  if (!(margin >= 0) || !std::isfinite(margin)) {
    no_answer("manifold: the margin is " + std::to_string(margin) + " m, must be >= 0");
  }
  if (only_fixed(a.geometry) && only_fixed(b.geometry)) {
    no_answer("manifold: neither shape can belong to a body that moves, at least one must");
  }
  const Space space = space_of(a.geometry, b.geometry, given);
  const auto motion = [](const Shape& shape) {
    return only_fixed(shape.geometry) ? Motion::fixed : Motion::dynamic;
  };
  Scene scene =
      fixed_scene(space, {body_of("a", a, pose_a, motion(a)), body_of("b", b, pose_b, motion(b))});
  // What the step takes for small follows the smaller shape.
  double unit = 1e8;
  for (const auto& [shape, pose] : {std::pair(&a, &pose_a), std::pair(&b, &pose_b)}) {
    for (const Convex& c : convex_parts(*shape, *pose, space)) {
      if (!c.half_space) unit = std::min(unit, extent(c) / 2);
    }
  }
  scene.options.length_unit = unit;
  scene.options.contact.slop = std::max(slop_of(scene), margin / 4 * (1 + 1e-6));
  BatchOptions options;
  options.threads = 1;
  options.isa = available_isas().front();
  options.precision = has_kernels(Precision::f64) ? Precision::f64 : Precision::f32;
  std::vector<ManifoldPoint> points;
  for (const Contact& c : Batch(compile(scene), options).contacts(0)) {
    if (c.separation > margin) continue;
    points.push_back(
        {c.body_a == BodyId(0) ? c.normal : Vec3(-c.normal), c.point, c.separation, c.feature});
  }
  return points;
}

std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray,
                               std::optional<Space> given) {
  const FloatMode mode;
  const Space space = space_of(shape.geometry, shape.geometry, given);
  PlanData plan;
  plan.scene = fixed_scene(space, {body_of("a", shape, pose, Motion::fixed)});
  Ray in_space = ray;
  if (space == Space::planar) in_space.direction.z() = in_space.origin.z() = 0;
  if (!in_space.direction.allFinite() || in_space.direction.isZero(0) ||
      !in_space.origin.allFinite() || !(ray.length > 0)) {
    no_answer(
        "ray_cast: origin and direction must be finite, the direction not zero, the length > 0");
  }
  choose_polygons(plan);
  collect_fixed(plan);
  if (has_kernels(Precision::f64)) return cast(kernels_for<double>(Isa::scalar), plan, in_space);
  return cast(kernels_for<float>(Isa::scalar), plan, in_space);
}

Geometry resized(Geometry geometry, const Vec3& size) {
  const GeometryTraits& kind = traits_of(geometry);
  for (int c = 0; c < kind.sizes(); ++c) kind.resize(geometry, c, size[c]);
  return geometry;
}

}  // namespace manyworlds
