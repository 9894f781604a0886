// How often a step finds contacts. Points of contact are those of the pose at which a pass begins.
// A body of half width a and half thickness c that falls over turns by about sqrt(g / a) dt in a
// pass. With the radius of curvature R = a^2 / c of its flat side, its lowest point is then by
// (R - c) / 2 times the square of that angle below those points. With n passes of dt / n that is
//   c / (2 k) for n^2 = k (g dt^2 / c) (a^2 - c^2) / (a c)
// Measured over ellipsoids, hulls and octagons, a / c from 1 to 10: the deepest of 128 drops is
// c / k. Below k = 0.5 bodies sink through floors.
#include "src/plan/collision_passes.hpp"

#include <algorithm>
#include <cmath>

#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"
#include "src/scene/convex.hpp"

namespace manyworlds {

namespace {

constexpr double kPasses = 5;  // k: a fifth of the half thickness deep

// Whether the lowest point moves along the body when it turns: of others contacts hold the corners
// or ends that come down next.
bool rolls(const Shape& shape, const Convex& part) {
  if (std::holds_alternative<Polygon>(shape.geometry)) return part.points.size() > 4;
  if (std::holds_alternative<Hull>(shape.geometry)) return part.points.size() > 8;
  return std::holds_alternative<Ellipsoid>(shape.geometry);
}

// A tip that is deeper in a sheet than its body is thick is pushed out on a wrong side.
bool has_sheets(const Scene& scene) {
  const auto is_sheet = [](const Shape& shape) {
    return std::holds_alternative<Segment>(shape.geometry) ||
           std::holds_alternative<Terrain>(shape.geometry);
  };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body& body) {
    return std::any_of(body.shapes.begin(), body.shapes.end(), is_sheet);
  });
}

bool meets_others(const Scene& scene, BodyId body) {
  const Body& own = scene.bodies[static_cast<std::size_t>(body.index())];
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body& other) {
    return &other != &own && filters_let_touch(own, other);
  });
}

// visit(body, fall in a step over the half thickness c, a / c, n^2) of each shape.
template <class Visit>
void for_each_need(const Scene& scene, Visit visit) {
  const Options& o = scene.options;
  const bool sheets = has_sheets(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const double fall = std::abs(body.gravity_scale) * o.gravity.norm() * o.dt * o.dt;
    if (body.motion != Motion::dynamic || fall == 0) continue;
    for (const Shape& shape : body.shapes) {
      if (shape.filter.mask == 0) continue;
      for (const Convex& part : convex_parts(shape, {}, scene.space)) {
        if (!sheets && !rolls(shape, part)) continue;
        const auto [c, a] = half_widths(part, scene.space);
        visit(BodyId(static_cast<int>(i)), fall / c, a / c,
              kPasses * fall / c * (a * a - c * c) / (a * c));
      }
    }
  }
}

}  // namespace

PassChoice choose_passes(const std::vector<Scene>& extremes) {
  PassChoice out{1, "no body falls by much of its thickness in a step"};
  if (extremes.front().options.solver.method == Solver::newton) {
    return {1, "newton finds contacts in every substep"};
  }
  double most = 1;
  for (const Scene& scene : extremes) {
    for_each_need(scene, [&](BodyId body, double fall, double flatness, double square) {
      if (square <= most * most || !meets_others(scene, body)) return;
      most = std::sqrt(square);
      out.why = body_text(scene, body) + " falls by " + short_text(fall) +
                " of its half thickness in a step and is " + short_text(flatness) +
                " times as wide as thick";
    });
  }
  const double slack = 1e-6;  // what is meant to be exact may be off by rounding
  out.passes = static_cast<int>(std::ceil(std::min(most - slack, double{kMostPasses})));
  if (most > kMostPasses) {
    out.why += "; " + short_text(std::ceil(most)) + " are needed, the maximum is " +
               std::to_string(kMostPasses);
  }
  return out;
}

}  // namespace manyworlds
