// Flat shapes, and how far they reach.
#include <algorithm>
#include <cmath>

#include "tools/invariants/penetration.hpp"

namespace manyworlds::invariants {
namespace {

Geometry flat_hull(Random& random, double size, int count) {
  const double width = size * random.uniform(0.5, 1);
  const double height = size * random.uniform(0.1, 0.4);
  Hull hull;
  while (static_cast<int>(hull.vertices.size()) < count) {
    const Vec3 p = random.direction();
    // Vertices apart, so that no two of them are one in float32.
    const bool apart = std::all_of(hull.vertices.begin(), hull.vertices.end(), [&](const Vec3& v) {
      return (v.cwiseQuotient(Vec3(size, width, height)) - p).norm() > 0.05;
    });
    if (apart) hull.vertices.push_back(p.cwiseProduct(Vec3(size, width, height)));
  }
  return hull;
}

Geometry flat_octagon(Random& random, double size) {
  const double height = size * random.uniform(0.1, 0.4);
  const double start = random.uniform(0, scenes::kPi);
  Polygon polygon;
  for (int i = 0; i < 8; ++i) {
    const double angle = start + scenes::kPi * i / 4;
    polygon.vertices.push_back({size * std::cos(angle), height * std::sin(angle)});
  }
  return polygon;
}

}  // namespace

int flat_types(Space space) { return space == Space::planar ? 4 : 7; }

Geometry draw_flat(Random& random, Space space, double size) {
  return draw_flat(random, space, size, random.integer(0, flat_types(space) - 1));
}

Geometry draw_flat(Random& random, Space space, double size, int type) {
  const double thin = size * random.uniform(0.05, 0.2), wide = size * random.uniform(0.4, 1);
  if (space == Space::planar) {
    switch (type) {
      case 0: return Polygon::box(size, thin);
      case 1: return Capsule{thin, size - thin};
      case 2: return flat_octagon(random, size);
      default: {
        Polygon rounded = Polygon::box(size - thin / 2, thin / 2);
        rounded.radius = thin / 2;
        return rounded;
      }
    }
  }
  switch (type) {
    case 0: return Ellipsoid{{size, wide, 0.1 * size}};
    case 1: return Ellipsoid{{size, 0.6 * size, 0.3 * size}};
    case 2: return flat_hull(random, size, 40);
    case 3: return flat_hull(random, size, 64);
    case 4: return Box{{size, wide, thin}};
    case 5: return Cylinder{size, thin};
    default: return Capsule{thin, size - thin};
  }
}

double draw_small_size(Random& random, const Scale& scale) {
  const double least = 3.67 * scale.gravity * scale.dt * scale.dt;  // 1 cm at 9.81 m/s^2, 1/60 s
  return std::max(scale.length * random.log_uniform(0.01, 1), least);
}

Piece piece_of(BodyId body, const Geometry& geometry) {
  return {static_cast<std::size_t>(body.index()), geometry, half_thickness(geometry),
          outer_radius(geometry)};
}

Body dynamic_body(const Geometry& geometry, const Material& material) {
  return scenes::body_of(scenes::shape_of(geometry, material), Vec3::Zero());
}

Material draw_surface(Random& random, double restitution) {
  Material material;
  material.friction = random.chance(0.2) ? 0 : random.uniform(0, 2);
  material.restitution = random.chance(0.5) ? 0 : random.uniform(0, restitution);
  return material;
}

double reach(const Piece& piece, Space space, const BodyNow& now, const Vec3& direction) {
  return reach(piece.geometry, space, now.rotation.conjugate() * direction);
}

Vec3 support(const Geometry& geometry, Space space, const Vec3& d) {
  const Vec3 unit = d.normalized();
  const auto signed_of = [](double x, double size) { return x < 0 ? -size : size; };
  if (const auto* s = std::get_if<Sphere>(&geometry)) return s->radius * unit;
  if (const auto* s = std::get_if<Circle>(&geometry)) return s->radius * unit;
  if (const auto* s = std::get_if<Box>(&geometry)) {
    const Vec3& h = s->half_extents;
    return {signed_of(d.x(), h.x()), signed_of(d.y(), h.y()), signed_of(d.z(), h.z())};
  }
  if (const auto* s = std::get_if<Capsule>(&geometry)) {
    const Vec3 axis = space == Space::planar ? Vec3::UnitY() : Vec3::UnitZ();
    return s->radius * unit + axis * signed_of(axis.dot(d), s->half_length);
  }
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    const double across = std::max(std::hypot(d.x(), d.y()), 1e-300);
    return {s->radius * d.x() / across, s->radius * d.y() / across,
            signed_of(d.z(), s->half_length)};
  }
  if (const auto* s = std::get_if<Ellipsoid>(&geometry)) {
    const Vec3 scaled = s->radii.cwiseProduct(unit);
    return s->radii.cwiseProduct(scaled.normalized());
  }
  Vec3 best = Vec3::Zero();
  double most = -1e300;
  const auto offer = [&](const Vec3& p) {
    if (p.dot(d) > most) most = p.dot(d), best = p;
  };
  if (const auto* hull = std::get_if<Hull>(&geometry)) {
    for (const Vec3& v : hull->vertices) offer(v);
  }
  if (const auto* polygon = std::get_if<Polygon>(&geometry)) {
    for (const Vec2& v : polygon->vertices) offer({v.x(), v.y(), 0});
    best += polygon->radius * unit;
  }
  return best;
}

bool finite(const BodyNow& now) {
  return now.position.allFinite() && now.velocity.allFinite() && now.rotation.coeffs().allFinite();
}

double slop_of(const Scene& scene) { return *compile(scene).resolved().contact.slop; }

}  // namespace manyworlds::invariants
