#include "tools/invariants/draw.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace manyworlds::invariants {
namespace {

template <class... Fs>
struct Cases : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Cases(Fs...) -> Cases<Fs...>;

// Points on an ellipsoid, so that all of them are vertices, centred on their mean.
Hull draw_hull(Random& random, double size) {
  const Vec3 radii(size * random.uniform(0.3, 1), size * random.uniform(0.3, 1),
                   size * random.uniform(0.3, 1));
  Hull hull;
  const int count = random.integer(4, 24);
  // A tetrahedron first, so that it cannot be flat.
  const Quat turn = random.rotation();
  for (int i = 0; i < count; ++i) {
    Vec3 p = random.direction();
    if (i < 4) {
      p = turn * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, (i == 1 || i == 2) ? -1 : 1).normalized();
    }
    hull.vertices.push_back(p.cwiseProduct(radii));
  }
  return hull;
}

// Convex: on a circle, at angles that are apart.
Polygon draw_polygon(Random& random, double size, double radius) {
  Polygon polygon;
  polygon.radius = radius;
  const int count = random.integer(3, 8);
  const double inner = size - radius, start = random.uniform(0, 2 * scenes::kPi);
  const double flat = random.uniform(0.4, 1);
  for (int i = 0; i < count; ++i) {
    const double angle = start + 2 * scenes::kPi * (i + random.uniform(-0.3, 0.3)) / count;
    polygon.vertices.push_back({inner * std::cos(angle), inner * flat * std::sin(angle)});
  }
  return polygon;
}

}  // namespace

Scene scene_of(Space space, const Scale& scale) {
  Scene scene = scenes::empty_scene(space, scale.gravity);
  scene.options.dt = scale.dt;
  return scene;
}

int shape_types(Space space) { return space == Space::planar ? 4 : kShapeTypes; }
const char* shape_name(Space space, int type) {
  static constexpr const char* kPlanar[] = {"circle", "polygon", "capsule", "rounded polygon"};
  static constexpr const char* kSpatial[] = {"sphere",   "box",       "capsule",
                                             "cylinder", "ellipsoid", "hull"};
  return space == Space::planar ? kPlanar[type] : kSpatial[type];
}

Geometry draw_shape(Random& random, Space space, double size) {
  return draw_shape(random, space, size, random.integer(0, shape_types(space) - 1));
}

Geometry draw_shape(Random& random, Space space, double size, int type) {
  const auto extent = [&] { return size * random.uniform(0.3, 1); };
  // One by one: the order of arguments is the compiler's.
  const double a = extent(), b = extent(), c = extent();
  if (space == Space::planar) {
    switch (type) {
      case 0: return Circle{a};
      case 1: return draw_polygon(random, size, 0);
      case 2: return Capsule{0.5 * a, 0.5 * b};
      default: return draw_polygon(random, size, 0.2 * a);
    }
  }
  switch (type) {
    case 0: return Sphere{a};
    case 1: return Box{{a, b, c}};
    case 2: return Capsule{0.5 * a, 0.5 * b};
    case 3: return Cylinder{a, b};
    case 4: return Ellipsoid{{a, b, c}};
    default: return draw_hull(random, size);
  }
}

double reach(const Geometry& geometry, Space space, const Vec3& d) {
  const auto farthest = [&](const auto& vertices) {
    double most = -1e300;
    for (const auto& v : vertices) most = std::max(most, v.dot(d.head(v.size())));
    return most;
  };
  return std::visit(
      Cases{[&](const Sphere& s) { return s.radius * d.norm(); },
            [&](const Circle& s) { return s.radius * d.norm(); },
            [&](const Box& s) { return s.half_extents.dot(d.cwiseAbs()); },
            [&](const Capsule& s) {
              const double along = space == Space::planar ? d.y() : d.z();
              return s.radius * d.norm() + s.half_length * std::abs(along);
            },
            [&](const Cylinder& s) {
              return s.radius * std::hypot(d.x(), d.y()) + s.half_length * std::abs(d.z());
            },
            [&](const Ellipsoid& s) { return s.radii.cwiseProduct(d).norm(); },
            [&](const Hull& s) { return farthest(s.vertices); },
            [&](const Polygon& s) { return farthest(s.vertices) + s.radius * d.norm(); },
            [](const auto&) { return 0.0; }},
      geometry);
}

double half_thickness(const Geometry& geometry) {
  if (const auto* box = std::get_if<Box>(&geometry)) return box->half_extents.minCoeff();
  if (const auto* ellipsoid = std::get_if<Ellipsoid>(&geometry)) return ellipsoid->radii.minCoeff();
  if (const auto* capsule = std::get_if<Capsule>(&geometry)) return capsule->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) {
    return std::min(cylinder->radius, cylinder->half_length);
  }
  // Over directions on a spiral; the width of a polytope is least between these by little.
  const bool planar = std::holds_alternative<Polygon>(geometry);
  double least = 1e300;
  const Space space = planar ? Space::planar : Space::spatial;
  constexpr int kDirections = 2000;
  for (int i = 0; i < kDirections; ++i) {
    const double t = (i + 0.5) / kDirections, angle = planar ? scenes::kPi * t : 2.399963 * i;
    const double z = planar ? 0 : t, across = std::sqrt(1 - z * z);
    const Vec3 d(across * std::cos(angle), across * std::sin(angle), z);
    least = std::min(least, (reach(geometry, space, d) + reach(geometry, space, -d)) / 2);
  }
  return least;
}

double outer_radius(const Geometry& geometry) {
  if (const auto* box = std::get_if<Box>(&geometry)) return box->half_extents.norm();
  if (const auto* capsule = std::get_if<Capsule>(&geometry)) {
    return capsule->radius + capsule->half_length;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) {
    return std::hypot(cylinder->radius, cylinder->half_length);
  }
  if (const auto* ellipsoid = std::get_if<Ellipsoid>(&geometry)) return ellipsoid->radii.maxCoeff();
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return sphere->radius;
  if (const auto* circle = std::get_if<Circle>(&geometry)) return circle->radius;
  double most = 0;
  if (const auto* hull = std::get_if<Hull>(&geometry)) {
    for (const Vec3& v : hull->vertices) most = std::max(most, v.norm());
  }
  if (const auto* polygon = std::get_if<Polygon>(&geometry)) {
    for (const Vec2& v : polygon->vertices) most = std::max(most, v.norm() + polygon->radius);
  }
  return most;
}

Quat draw_rotation(Random& random, Space space) {
  return space == Space::planar ? random.planar_rotation() : random.rotation();
}
Vec3 draw_direction(Random& random, Space space) {
  return space == Space::planar ? random.planar_direction() : random.direction();
}
Vec3 draw_axis(Random& random, Space space) {
  return space == Space::planar ? Vec3(0, 0, random.chance(0.5) ? 1 : -1) : random.direction();
}

void resist_in_some(Random& kind, Scene& scene, const Scale& scale) {
  if (!kind.chance(1.0 / 3)) return;
  for (Body& body : scene.bodies) {
    const double rolling = scale.length * kind.uniform(0, 0.2);
    const double torsional = scale.length * kind.uniform(0, 0.2);
    for (Shape& s : body.shapes) {
      s.material.rolling_resistance = rolling;
      if (scene.space == Space::spatial) s.material.torsional_resistance = torsional;
    }
  }
}

double unit_mass(Space space, const Scale& scale) {
  return 1000 * std::pow(scale.length, space == Space::planar ? 2 : 3);
}
void set_mass(Scene& scene, BodyId id, double mass) {
  Body& body = scene.at(id);
  for (Shape& shape : body.shapes) shape.density = 1;
  const double density = mass / mass_properties(scene, body).mass;
  for (Shape& shape : body.shapes) shape.density = density;
}
MassProperties mass_of(const Scene& scene, BodyId body) {
  return mass_properties(scene, scene.at(body));
}
Mat3 inertia_of(const MassProperties& mass, const Quat& rotation) {
  const Mat3 r = rotation.toRotationMatrix();
  return r * mass.inertia * r.transpose();
}

}  // namespace manyworlds::invariants
