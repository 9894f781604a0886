// Mass, centre of mass and inertia of bodies made of shapes.
//
// Each shape gives its own mass, centre and inertia about that centre by a closed form; the body
// sums them with the parallel-axis theorem
//   I = sum_k R_k I_k R_k^T + m_k (d_k^2 1 - d_k d_k^T),   d_k = c_k - c,   c = sum m_k c_k / m.
// The centre is found first and the inertia summed about it: summing about the origin and
// subtracting m c^2 would lose digits when shapes are far from the origin of their body.
// Shapes that overlap simply add. Planes and lines have no mass.
#include <cmath>
#include <type_traits>
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/scene/convex_hull.hpp"
#include "src/scene/mesh_moments.hpp"

namespace manyworlds {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Diagonal tensor about z: a planar body has one moment. The other two repeat it, so that the
// matrix stays positive definite for whoever inverts it.
Mat3 planar_inertia(double moment) { return moment * Mat3::Identity(); }

// Each overload: mass properties in the shape frame for `density` in kg/m^3 (kg/m^2 planar).
MassProperties of(const Sphere& sphere, double density) {
  const double r = sphere.radius;
  const double mass = density * 4.0 / 3.0 * kPi * r * r * r;
  return {mass, Vec3::Zero(), 0.4 * mass * r * r * Mat3::Identity()};
}

MassProperties of(const Box& box, double density) {
  const Vec3 squares = box.half_extents.cwiseAbs2();
  const double mass = density * 8 * box.half_extents.prod();
  const Vec3 moments = mass / 3.0 * (Vec3::Constant(squares.sum()) - squares);
  return {mass, Vec3::Zero(), moments.asDiagonal()};
}

MassProperties of(const Circle& circle, double density) {
  const double r = circle.radius;
  const double mass = density * kPi * r * r;
  return {mass, Vec3::Zero(), planar_inertia(0.5 * mass * r * r)};
}

// A cylinder and two half balls, whose centres of mass are 3/8 r beyond its ends: about the middle,
// across the axis, a pair of them of mass m has m (2/5 r^2 + h^2 + 3/4 h r).
MassProperties capsule_in_space(const Capsule& capsule, double density) {
  const double r = capsule.radius, h = capsule.half_length;
  const double cylinder = density * 2 * kPi * r * r * h;
  const double ends = density * 4.0 / 3.0 * kPi * r * r * r;
  const double along = cylinder * r * r / 2 + ends * 0.4 * r * r;
  const double across =
      cylinder * (r * r / 4 + h * h / 3) + ends * (0.4 * r * r + h * h + 0.75 * h * r);
  return {cylinder + ends, Vec3::Zero(), Vec3(across, across, along).asDiagonal()};
}

// A rectangle and two half discs, whose centres of mass are 4 r / (3 pi) beyond its ends.
MassProperties capsule_in_plane(const Capsule& capsule, double density) {
  const double r = capsule.radius, h = capsule.half_length;
  const double rectangle = density * 4 * r * h;
  const double ends = density * kPi * r * r;
  const double moment =
      rectangle * (r * r + h * h) / 3 + ends * (r * r / 2 + h * h + 8 * r * h / (3 * kPi));
  return {rectangle + ends, Vec3::Zero(), planar_inertia(moment)};
}

// What a radius r adds to area, centre moment and polar moment about vertex 0: a rectangle along
// each edge of length l, with (l^2 + r^2) / 12 about its own centre, and at each corner a sector of
// the angle a that the outline turns there, whose centre of mass is 4 r sin(a / 2) / (3 a) away
// from the corner and which has r^2 / 2 about it.
void add_rounding(const Polygon& polygon, double& area, Vec2& first, double& second) {
  const std::vector<Vec2>& v = polygon.vertices;
  const std::size_t n = v.size();
  const double r = polygon.radius;
  const auto way = [&](std::size_t i) { return Vec2(v[(i + 1) % n] - v[i % n]); };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 corner = v[i] - v[0], edge = way(i), before = way(i + n - 1);
    const double length = edge.norm();
    const Vec2 normal = Vec2(edge.y(), -edge.x()) / length;
    const Vec2 middle = corner + edge / 2 + normal * (r / 2);
    area += length * r;
    first += length * r * middle;
    second += length * r * ((length * length + r * r) / 12 + middle.squaredNorm());

    const double turn = std::atan2(before.x() * edge.y() - before.y() * edge.x(), before.dot(edge));
    const double sector = turn * r * r / 2;
    const Vec2 out = (normal + Vec2(before.y(), -before.x()).normalized()).normalized();
    const Vec2 away = out * (4 * r * std::sin(turn / 2) / (3 * turn));
    area += sector;
    first += sector * (corner + away);
    // About the corner, shifted to vertex 0.
    second += sector * (r * r / 2 + corner.squaredNorm() + 2 * corner.dot(away));
  }
}

// A fan of triangles (0, a, b) from vertex 0, with twice the signed area D = a x b each:
//   area += D / 2,  centre moment += D (a + b) / 6,  polar moment += D (a.a + a.b + b.b) / 12.
MassProperties of(const Polygon& polygon, double density) {
  const Vec2& origin = polygon.vertices.front();
  double area = 0;
  Vec2 first = Vec2::Zero();
  double second = 0;  // about vertex 0
  for (std::size_t i = 1; i + 1 < polygon.vertices.size(); ++i) {
    const Vec2 a = polygon.vertices[i] - origin;
    const Vec2 b = polygon.vertices[i + 1] - origin;
    const double twice_area = a.x() * b.y() - a.y() * b.x();
    area += twice_area / 2;
    first += twice_area / 6 * (a + b);
    second += twice_area / 12 * (a.dot(a) + a.dot(b) + b.dot(b));
  }
  if (polygon.radius > 0) add_rounding(polygon, area, first, second);
  const Vec2 offset = first / area;
  const Vec2 center = origin + offset;
  const double moment = density * (second - area * offset.squaredNorm());
  return {density * area, {center.x(), center.y(), 0}, planar_inertia(moment)};
}

MassProperties of(const Cylinder& cylinder, double density) {
  const double r = cylinder.radius, h = cylinder.half_length;
  const double mass = density * 2 * kPi * r * r * h;
  const double across = mass * (r * r / 4 + h * h / 3);
  return {mass, Vec3::Zero(), Vec3(across, across, mass * r * r / 2).asDiagonal()};
}
MassProperties of(const Hull& hull, double density) {
  const TriangleMesh mesh = detail::surface(detail::convex_hull(hull.vertices));
  const Vec3 middle = detail::mesh_middle(mesh);
  const detail::MeshMoments about_middle = detail::mesh_moments(mesh, middle);
  // The centre of a symmetric hull comes out of sums: what is only rounding is zero.
  Vec3 offset = about_middle.first / about_middle.volume;
  const double size = (mesh.vertices[0] - middle).norm();
  for (int c = 0; c < 3; ++c) {
    if (std::abs(offset[c]) <= 1e-14 * size) offset[c] = 0;
  }
  const Vec3 center = middle + offset;
  const detail::MeshMoments about_center = detail::mesh_moments(mesh, center);
  const Mat3 spread = density * about_center.second;
  return {density * about_middle.volume, center, spread.trace() * Mat3::Identity() - spread};
}

MassProperties of(const Plane&, double) { return {0, Vec3::Zero(), Mat3::Zero()}; }
MassProperties of(const HalfPlane&, double) { return {0, Vec3::Zero(), Mat3::Zero()}; }

MassProperties of(const Segment&, double) { return {0, Vec3::Zero(), Mat3::Zero()}; }
MassProperties of(const Terrain&, double) { return {0, Vec3::Zero(), Mat3::Zero()}; }
MassProperties of(const HeightField&, double) { return {0, Vec3::Zero(), Mat3::Zero()}; }

// In the body frame.
MassProperties of(const Shape& shape, const Scene& scene) {
  const double density = shape.density.value_or(scene.options.density);
  const bool planar = scene.space == Space::planar;
  const auto in_shape_frame = [&](const auto& geometry) {
    if constexpr (std::is_same_v<decltype(geometry), const Capsule&>) {
      return planar ? capsule_in_plane(geometry, density) : capsule_in_space(geometry, density);
    } else {
      return of(geometry, density);
    }
  };
  MassProperties part = std::visit(in_shape_frame, shape.geometry);
  const Mat3 rotation = shape.rotation.normalized().toRotationMatrix();
  part.center = shape.position + rotation * part.center;
  // Isotropic tensors look the same in every frame: rounding must not make them differ.
  if (part.inertia != part.inertia(0, 0) * Mat3::Identity()) {
    part.inertia = rotation * part.inertia * rotation.transpose();
  }
  return part;
}

}  // namespace

MassProperties mass_properties(const Scene& scene, const Body& body) {
  const FloatMode mode;
  if (body.mass_properties) return *body.mass_properties;

  std::vector<MassProperties> parts;
  MassProperties total{0, Vec3::Zero(), Mat3::Zero()};
  for (const Shape& shape : body.shapes) {
    parts.push_back(of(shape, scene));
    total.mass += parts.back().mass;
  }
  if (total.mass == 0) return total;  // no shapes, or only planes and lines

  // Relative to the first part, for the same reason as above.
  for (const MassProperties& part : parts) {
    total.center += part.mass / total.mass * (part.center - parts.front().center);
  }
  total.center += parts.front().center;

  for (const MassProperties& part : parts) {
    const Vec3 d = part.center - total.center;
    total.inertia += part.inertia;
    if (scene.space == Space::planar) {
      total.inertia += planar_inertia(part.mass * d.squaredNorm());
    } else {
      total.inertia += part.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
  }
  return total;
}

}  // namespace manyworlds
