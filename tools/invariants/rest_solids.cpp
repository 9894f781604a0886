// Where flat faces touch.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <variant>

#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {
namespace {

// The faces of the convex hull of few vertices: planes with all of them on one side.
std::vector<std::vector<int>> faces_of(const std::vector<Vec3>& v) {
  std::vector<std::vector<int>> faces;
  std::vector<Vec3> normals;
  double size = 0;
  for (const Vec3& p : v) size = std::max(size, (p - v[0]).norm());
  const double near = 1e-7 * size;
  const int n = static_cast<int>(v.size());
  const auto at = [&](int i) -> const Vec3& { return v[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        Vec3 normal = (at(j) - at(i)).cross(at(k) - at(i));
        if (normal.norm() < 1e-6 * size * size) continue;
        normal.normalize();
        double most = -1e300, least = 1e300;
        for (const Vec3& p : v) {
          const double d = normal.dot(p - at(i));
          most = std::max(most, d), least = std::min(least, d);
        }
        if (most > near && least < -near) continue;
        if (most > near) normal = -normal;
        const auto same = [&](const Vec3& other) { return other.dot(normal) > 1 - 1e-9; };
        if (std::any_of(normals.begin(), normals.end(), same)) continue;
        normals.push_back(normal);
        std::vector<int> face;
        Vec3 middle = Vec3::Zero();
        for (int m = 0; m < n; ++m) {
          if (std::abs(normal.dot(at(m) - at(i))) <= near) face.push_back(m), middle += at(m);
        }
        middle /= static_cast<double>(face.size());
        const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
        const auto angle = [&](int m) {
          return std::atan2(y.dot(at(m) - middle), x.dot(at(m) - middle));
        };
        std::sort(face.begin(), face.end(), [&](int p, int q) { return angle(p) < angle(q); });
        faces.push_back(std::move(face));
      }
    }
  }
  return faces;
}

// Keeps what is on the inner side of a plane.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double s = normal.dot(p) - offset, t = normal.dot(q) - offset;
    if (s <= 0) out.push_back(p);
    if ((s < 0 && t > 0) || (s > 0 && t < 0)) out.push_back(p + s / (s - t) * (q - p));
  }
  return out;
}

// The common area of a face of a and what b has in its plane.
bool touch_faces(Space space, const Solid& a, const Solid& b, double tolerance, double shrink,
                 bool flip, std::vector<Touch>& out) {
  const auto at = [&](int i) -> const Vec3& { return a.vertices[static_cast<std::size_t>(i)]; };
  for (const auto& face : a.faces) {
    const Vec3 edge = at(face[1]) - at(face[0]);
    const Vec3 normal = space == Space::planar
                            ? Vec3(edge.y(), -edge.x(), 0).normalized()
                            : Vec3(edge.cross(at(face[2]) - at(face[0])).normalized());
    const double offset = normal.dot(at(face[0]));
    double least = 1e300;
    for (const Vec3& p : b.vertices) least = std::min(least, normal.dot(p) - offset);
    if (std::abs(least) > tolerance) continue;
    std::vector<Vec3> area;
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : b.vertices) {
      if (normal.dot(p) - offset < tolerance) area.push_back(p), middle += p;
    }
    middle /= static_cast<double>(area.size());
    if (area.size() > 2) {
      const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
      const auto angle = [&](const Vec3& p) {
        return std::atan2(y.dot(p - middle), x.dot(p - middle));
      };
      std::sort(area.begin(), area.end(),
                [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
    }
    if (space == Space::planar) {
      const Vec3 along = edge.normalized();
      area = cut(area, along, along.dot(at(face[1])));
      area = cut(area, -along, -along.dot(at(face[0])));
    } else {
      for (std::size_t i = 0; i < face.size() && !area.empty(); ++i) {
        const Vec3 &p = at(face[i]), &q = at(face[(i + 1) % face.size()]);
        const Vec3 outward = (q - p).cross(normal).normalized();
        area = cut(area, outward, outward.dot(p));
      }
    }
    std::vector<Vec3> corners;
    for (const Vec3& p : area) {
      const auto same = [&](const Vec3& q) { return (p - q).norm() < tolerance; };
      if (std::none_of(corners.begin(), corners.end(), same)) corners.push_back(p);
    }
    if (corners.empty()) continue;
    middle.setZero();
    for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
    for (const Vec3& p : corners) {
      out.push_back(
          {a.body, b.body, p + shrink * (middle - p), normal, std::sqrt(a.friction * b.friction)});
      if (flip) std::swap(out.back().a, out.back().b), out.back().normal = -normal;
    }
    return true;
  }
  return false;
}

}  // namespace

Solid solid_of(const Scene& scene, int body, double extent) {
  const Body& b = scene.bodies[static_cast<std::size_t>(body)];
  const Shape& shape = b.shapes[0];
  Solid solid;
  solid.body = body, solid.friction = shape.material.friction;
  auto& v = solid.vertices;
  const auto box = [&](const Vec3& half, const Vec3& middle) {
    for (int i = 0; i < 8; ++i) {
      v.push_back(middle + half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    }
  };
  Quat turn = shape.rotation.normalized();
  if (const auto* s = std::get_if<Box>(&shape.geometry)) box(s->half_extents, Vec3::Zero());
  if (const auto* s = std::get_if<Hull>(&shape.geometry)) v = s->vertices;
  if (const auto* s = std::get_if<Cylinder>(&shape.geometry)) {
    constexpr int kSides = 12;
    for (int i = 0; i < 2 * kSides; ++i) {
      const double angle = scenes::kPi * (i / 2) / (kSides / 2);
      v.push_back({s->radius * std::cos(angle), s->radius * std::sin(angle),
                   i % 2 == 0 ? s->half_length : -s->half_length});
    }
  }
  if (const auto* s = std::get_if<Plane>(&shape.geometry)) {
    turn = turn * Quat::FromTwoVectors(Vec3::UnitZ(), s->normal);
    box(Vec3::Constant(extent), Vec3(0, 0, s->offset - extent));
  }
  if (const auto* s = std::get_if<Polygon>(&shape.geometry)) {
    for (const Vec2& p : s->vertices) v.push_back({p.x(), p.y(), 0});
  }
  if (const auto* s = std::get_if<HalfPlane>(&shape.geometry)) {
    turn = turn * Quat::FromTwoVectors(Vec3::UnitY(), Vec3(s->normal.x(), s->normal.y(), 0));
    for (const auto& [x, y] : {std::pair(-1.0, -2.0), {1.0, -2.0}, {1.0, 0.0}, {-1.0, 0.0}}) {
      v.push_back({extent * x, s->offset + extent * y, 0});
    }
  }
  const Quat rotation = b.rotation.normalized();
  for (Vec3& p : v) p = b.position + rotation * (shape.position + turn * p);
  if (scene.space == Space::spatial) {
    solid.faces = faces_of(v);
  } else {
    const int n = static_cast<int>(v.size());
    for (int i = 0; i < n; ++i) solid.faces.push_back({i, (i + 1) % n});
  }
  return solid;
}

std::vector<Touch> touches_of(Space space, const std::vector<Solid>& solids, double tolerance,
                              double shrink) {
  std::vector<Touch> out;
  const auto middle_and_radius = [](const Solid& s) {
    Vec3 low = s.vertices[0], high = low;
    for (const Vec3& p : s.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    return std::pair<Vec3, Vec3>(low, high);
  };
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const auto [low_a, high_a] = middle_and_radius(solids[i]);
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      const auto [low_b, high_b] = middle_and_radius(solids[j]);
      if (((low_a - high_b).array() > tolerance).any()) continue;
      if (((low_b - high_a).array() > tolerance).any()) continue;
      if (touch_faces(space, solids[i], solids[j], tolerance, shrink, false, out)) continue;
      touch_faces(space, solids[j], solids[i], tolerance, shrink, true, out);
    }
  }
  return out;
}

}  // namespace manyworlds::invariants
