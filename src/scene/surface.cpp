#include "src/scene/surface.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/base/enum_names.hpp"
#include "src/base/float_mode.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {
namespace detail {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;  // rad

}  // namespace

void add_face(Surface& surface, const std::vector<Vec3>& corners, const Vec3& normal) {
  const int first = static_cast<int>(surface.points.size());
  const int count = static_cast<int>(corners.size());
  if (count < 3) return;
  for (const Vec3& p : corners) {
    surface.points.push_back(p);
    surface.normals.push_back(normal);
  }
  for (int i = 1; i + 1 < count; ++i)
    surface.triangles.push_back({first, first + i, first + i + 1});
  surface.faces.push_back({first, count});
}

void add_revolved(Surface& surface, const std::vector<Ring>& rings, int around) {
  const int first = static_cast<int>(surface.points.size());
  for (const Ring& ring : rings) {
    for (int k = 0; k < around; ++k) {
      const double angle = kFullTurn * k / around;
      const double c = std::cos(angle), s = std::sin(angle);
      surface.points.push_back({ring.radius * c, ring.radius * s, ring.height});
      surface.normals.push_back({ring.out * c, ring.out * s, ring.up});
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    const bool low_pole = rings[i].radius == 0, high_pole = rings[i + 1].radius == 0;
    const int low = first + static_cast<int>(i) * around, high = low + around;
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      if (!low_pole) surface.triangles.push_back({low + k, low + next, high + next});
      if (!high_pole) {
        // Where the low ring is a pole, any of its points is that.
        surface.triangles.push_back({low + k, high + next, high + k});
      }
    }
  }
}

Surface ball(double radius, int around) {
  Surface out;
  std::vector<Ring> rings;
  const int half = (around + 1) / 2;
  for (int i = 0; i <= half; ++i) {
    const double polar = kFullTurn / 2 * (half - i) / half;  // rad, from the top
    const double c = i == 0 || i == half ? 0 : std::sin(polar);
    const double s = std::cos(polar);
    rings.push_back({radius * c, radius * s, c, s});
  }
  add_revolved(out, rings, around);
  out.marks.push_back(closed(circle(radius, 0, around)));
  return out;
}

std::vector<Vec3> circle(double radius, double height, int around) {
  std::vector<Vec3> out;
  for (int k = 0; k < around; ++k) {
    const double angle = kFullTurn * k / around;
    out.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
  }
  return out;
}

std::vector<Vec3> closed(std::vector<Vec3> line) {
  if (!line.empty()) line.push_back(Vec3(line.front()));
  return line;
}

Surface planar_solid(const std::vector<Vec3>& outline) {
  Surface out;
  add_face(out, outline, Vec3::UnitZ());
  out.lines.push_back(closed(outline));
  return out;
}

void add_arc(std::vector<Vec3>& outline, const Vec3& center, double radius, double from, double to,
             int around) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil((to - from) * around / kFullTurn - 1e-9)));
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    outline.push_back(center + radius * Vec3(std::cos(angle), std::sin(angle), 0));
  }
}

std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = normal.dot(a) - offset, over_b = normal.dot(b) - offset;
    if (over_a <= 0) out.push_back(a);
    if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0)) {
      out.push_back(a + over_a / (over_a - over_b) * (b - a));
    }
  }
  return out;
}

}  // namespace detail

namespace {

constexpr int kMinAround = 8, kMaxAround = 1024;

void check(const SurfaceOptions& options) {
  checked_enum(options.space);
  if (options.around < kMinAround || options.around > kMaxAround) {
    throw std::invalid_argument("surface: around is " + std::to_string(options.around) +
                                ", must be " + std::to_string(kMinAround) + " to " +
                                std::to_string(kMaxAround));
  }
  for (int c = 0; c < (options.space == Space::planar ? 2 : 3); ++c) {
    const double low = options.low[c], high = options.high[c];
    if (std::isfinite(low) && std::isfinite(high) && low < high) continue;
    throw std::invalid_argument(std::string("surface: low.") + "xyz"[c] + " is " +
                                detail::number_text(low) + " m and high." + "xyz"[c] + " is " +
                                detail::number_text(high) + " m, must be finite, the low one less");
  }
}

}  // namespace

Surface surface(const Geometry& geometry, const SurfaceOptions& options) {
  const FloatMode mode;
  check(options);
  const GeometryTraits& traits = traits_of(geometry);
  SurfaceOptions fitting = options;
  // Of what one space alone has, the space is not in question.
  if (!traits.in_plane) fitting.space = Space::spatial;
  if (!traits.in_space) fitting.space = Space::planar;
  std::vector<Issue> issues;
  detail::Checker checker(issues, fitting.space);
  traits.check(checker, geometry);
  if (!issues.empty()) throw SceneError(traits.name, std::move(issues));
  return traits.surface(geometry, fitting);
}

}  // namespace manyworlds
