// Floors, and bodies that stand on them.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <variant>

#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {
namespace {

// A field of cells of random sizes whose surface is the plane of the normal.
HeightField field_of(Random& kind, double extent, const Vec3& normal) {
  HeightField field;
  field.columns = kind.integer(6, 40);
  const int rows = kind.integer(6, 40);
  field.cell = {2 * extent / (field.columns - 1), 2 * extent / (rows - 1)};
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      const double x = i * field.cell.x() - extent, y = j * field.cell.y() - extent;
      field.heights.push_back(-(normal.x() * x + normal.y() * y) / normal.z());
    }
  }
  return field;
}

struct Floors {
  Space space;
  Random* kind;
  const FloorDraw* draw;
  Quat tilt;
  Floor floor;
  Body body;

  void shape(Geometry geometry, const Vec3& at = Vec3::Zero()) {
    body.shapes.push_back(scenes::shape_of(std::move(geometry), draw->material));
    body.shapes.back().position = at;
  }
  void block(double extent) {
    const double thick = extent * kind->uniform(0.05, 0.5);
    if (space == Space::planar)
      shape(Polygon::box(extent, thick), {0, -thick, 0});
    else
      shape(Box{{extent, extent, thick}}, {0, 0, -thick});
    body.rotation = tilt, floor.rotation = tilt;
  }
  void belt() {
    const double reach = draw->belt;
    block(draw->extent);
    Vec3 along = kind->planar_direction();
    if (space == Space::planar) along = Vec3(along.x() < 0 ? -1 : 1, 0, 0);
    floor.velocity = tilt * (reach * along), body.linear_velocity = floor.velocity;
    body.motion = Motion::kinematic, floor.name = "belt";
  }
  void planar(int type) {
    const double extent = draw->extent;
    switch (type) {
      case 0:
      case 1: shape(HalfPlane{}), body.rotation = floor.rotation; break;
      case 2: block(extent), floor.name = "box"; break;
      case 3: {
        Terrain terrain;
        const int count = kind->integer(2, 60);
        for (int i = 0; i < count; ++i) {
          const double jitter = i > 0 && i + 1 < count ? kind->uniform(-0.3, 0.3) : 0;
          terrain.points.push_back({extent * (2 * (i + jitter) / (count - 1) - 1), 0});
        }
        shape(terrain), body.rotation = floor.rotation = tilt, floor.name = "terrain";
        break;
      }
      default:
        shape(Segment{{-extent, 0}, {extent, 0}});
        body.rotation = floor.rotation = tilt, floor.name = "segment";
    }
  }
  void spatial(int type) {
    const double extent = draw->extent;
    switch (type) {
      case 0:
      case 1: shape(Plane{}), body.rotation = floor.rotation; break;
      case 2: block(extent), floor.name = "box"; break;
      case 3:
        shape(field_of(*kind, extent, Vec3::UnitZ()));
        body.rotation = floor.rotation = tilt, floor.name = "tilted field";
        break;
      default:
        shape(field_of(*kind, extent, tilt * Vec3::UnitZ()));
        floor.rotation = tilt, floor.name = "slope of a field";
    }
  }
};

// The body frame's height over the lowest points, the centre of mass, and the area of support.
void find_base(Space space, const std::vector<Vec3>& points, Standing& out) {
  const bool planar = space == Space::planar;
  const auto up = [&](const Vec3& p) { return planar ? p.y() : p.z(); };
  double least = 1e300, size = 0;
  for (const Vec3& p : points) least = std::min(least, up(p)), size = std::max(size, p.norm());
  out.height = -least;
  for (const Vec3& p : points) {
    if (up(p) < least + 1e-6 * size) out.base.push_back(p);
  }
  Scene scene;
  scene.space = space;
  const MassProperties mass = mass_properties(scene, out.body);
  out.center = out.rotation * mass.center;
  double volume = 0;
  for (const Shape& s : out.body.shapes) {
    Body alone;
    alone.shapes = {s};
    alone.shapes[0].density = 1;
    volume += mass_properties(scene, alone).mass;
  }
  out.size = planar ? std::sqrt(volume) : std::cbrt(volume);
  out.support = 1e300;
  constexpr int kDirections = 360;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * scenes::kPi * i / kDirections;
    if (planar && i % (kDirections / 2) != 0) continue;
    const Vec3 d(std::cos(angle), planar ? 0 : std::sin(angle), 0);
    double most = -1e300;
    for (const Vec3& p : out.base) most = std::max(most, d.dot(p - out.center));
    out.support = std::min(out.support, most);
  }
}

// A convex polytope of random vertices, on a face over which its centre of mass is best supported.
Standing on_a_face(Random& kind, Space space, double size, const Material& material, int type) {
  Scene scene;
  scene.space = space;
  Geometry geometry = draw_shape(kind, space, size, type);
  double radius = 0;
  if (auto* polygon = std::get_if<Polygon>(&geometry)) radius = polygon->radius;
  scene.add(scenes::body_of(scenes::shape_of(geometry, material), Vec3::Zero()));
  const Solid solid = solid_of(scene, 0, 1);
  const int first = kind.integer(0, 1000);
  Standing best;
  for (std::size_t k = 0; k < solid.faces.size(); ++k) {
    const auto& face = solid.faces[(k + static_cast<std::size_t>(first)) % solid.faces.size()];
    const auto at = [&](std::size_t i) {
      return solid.vertices[static_cast<std::size_t>(face[i])];
    };
    const Vec3 edge = at(1) - at(0);
    Standing s;
    s.body.shapes = scene.bodies[0].shapes;
    if (space == Space::planar) {
      s.rotation = Quat(Eigen::AngleAxisd(-std::atan2(edge.y(), edge.x()), Vec3::UnitZ()));
    } else {
      s.rotation = Quat::FromTwoVectors(edge.cross(at(2) - at(0)).normalized(), -Vec3::UnitZ());
    }
    std::vector<Vec3> points;
    for (const Vec3& p : solid.vertices) {
      points.push_back(s.rotation * p - radius * scenes::up_of(space));
    }
    find_base(space, points, s);
    // The first that is good enough, so that not all lie on their widest face.
    if (s.support > best.support || best.base.empty()) best = s;
    if (best.support > 0.4 * (best.height + best.center.dot(scenes::up_of(space)))) break;
  }
  best.name = space == Space::planar ? "polygon" : "hull";
  return best;
}

Standing of_shape(Space space, Geometry geometry, const Material& material,
                  std::vector<Vec3> points, const char* name) {
  Standing s;
  s.body.shapes = {scenes::shape_of(std::move(geometry), material)};
  s.name = name;
  find_base(space, points, s);
  return s;
}

// A deck on feet or runners, each a shape of the body.
Standing on_feet(Random& kind, Space space, double size, const Material& material) {
  Standing s;
  const bool planar = space == Space::planar;
  const double a = size * kind.uniform(0.4, 1), b = size * kind.uniform(0.4, 1);
  const double c = size * kind.uniform(0.05, 0.4), foot = size * kind.uniform(0.05, 0.2);
  const bool runners = !planar && kind.chance(0.3);
  s.body.shapes = {
      scenes::shape_of(planar ? scenes::box_of(space, {a, c, 0}) : Box{{a, b, c}}, material)};
  std::vector<Vec3> points;
  const auto add = [&](Geometry geometry, const Vec3& at) {
    s.body.shapes.push_back(scenes::shape_of(std::move(geometry), material));
    s.body.shapes.back().position = at;
  };
  if (planar) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 at(side * a * kind.uniform(0.6, 1), -c - foot, 0);
      add(Circle{foot}, at), points.push_back(at - foot * Vec3::UnitY());
    }
  } else if (runners) {
    for (const double side : {-1.0, 1.0}) {
      const Vec3 half(a * kind.uniform(0.7, 1), 0.15 * b, foot), at(0, side * 0.8 * b, -c - foot);
      add(Box{half}, at);
      for (int i = 0; i < 4; ++i) {
        points.push_back(at + half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, -1)));
      }
    }
  } else {
    const double start = kind.uniform(0, 2 * scenes::kPi);
    for (int i = 0; i < 3; ++i) {
      const double angle = start + 2 * scenes::kPi * (i + kind.uniform(-0.15, 0.15)) / 3;
      const double out = kind.uniform(0.7, 1);
      const Vec3 at(a * out * std::cos(angle), b * out * std::sin(angle), -c - foot);
      add(Sphere{foot}, at), points.push_back(at - foot * Vec3::UnitZ());
    }
  }
  find_base(space, points, s);
  s.name = runners ? "runners" : "feet";
  return s;
}

}  // namespace

Floor add_floor(Scene& scene, Random& kind, const Scale& scale, const FloorDraw& draw) {
  const bool planar = scene.space == Space::planar;
  Floors floors{scene.space, &kind, &draw, Quat::Identity(), {}, {}};
  const double around = kind.uniform(-scenes::kPi, scenes::kPi);
  const Vec3 axis =
      planar ? Vec3(0, 0, around < 0 ? -1 : 1) : Vec3(std::cos(around), std::sin(around), 0);
  floors.tilt = Quat(Eigen::AngleAxisd(draw.tilt, axis));
  floors.body.motion = Motion::fixed;
  const int type = kind.integer(0, draw.belt > 0 ? 5 : 4);
  floors.floor.name = type == 0 ? "tilted plane" : "plane, tilted gravity";
  if (type != 1) floors.floor.rotation = floors.tilt;
  if (type == 5)
    floors.belt();
  else if (planar)
    floors.planar(type);
  else
    floors.spatial(type);
  const Vec3 gravity = -scale.gravity * scenes::up_of(scene.space);
  scene.options.gravity = type == 1 ? Vec3(floors.tilt.conjugate() * gravity) : gravity;
  floors.floor.body = scene.add(floors.body);
  return floors.floor;
}

Standing draw_prism(Random& kind, double size, int sides, const Material& material) {
  Hull hull;
  const double half = size * kind.uniform(0.2, 1),
               taper = kind.chance(0.5) ? 1 : kind.uniform(0.5, 1);
  const double radius = size * kind.uniform(0.3, 1), start = kind.uniform(0, 2 * scenes::kPi);
  for (int i = 0; i < 2 * sides; ++i) {
    const double angle = start + 2 * scenes::kPi * (i / 2) / sides,
                 r = radius * (i % 2 == 0 ? 1 : taper);
    hull.vertices.push_back({r * std::cos(angle), r * std::sin(angle), i % 2 == 0 ? -half : half});
  }
  const auto points = hull.vertices;
  return of_shape(Space::spatial, hull, material, points, "prism");
}

Standing draw_standing(Random& kind, Space space, double size, const Material& material) {
  const double a = size * kind.uniform(0.1, 1), b = size * kind.uniform(0.1, 1);
  const double c = size * kind.uniform(0.1, 1);
  if (space == Space::planar) {
    switch (kind.integer(0, 4)) {
      case 0:
        return of_shape(space, Polygon::box(a, b), material, {{-a, -b, 0}, {a, -b, 0}}, "box");
      case 1: return on_a_face(kind, space, size, material, 1);
      case 2: return on_a_face(kind, space, size, material, 3);
      case 3: {
        Standing s = of_shape(space, Capsule{b, a}, material, {{-a, -b, 0}, {a, -b, 0}}, "capsule");
        s.rotation = Quat(Eigen::AngleAxisd(scenes::kPi / 2, Vec3::UnitZ()));
        return s;
      }
      default: return on_feet(kind, space, size, material);
    }
  }
  switch (kind.integer(0, 4)) {
    case 0: {
      std::vector<Vec3> points;
      for (int i = 0; i < 4; ++i) points.push_back({i & 1 ? a : -a, i & 2 ? b : -b, -c});
      return of_shape(space, Box{{a, b, c}}, material, points, "box");
    }
    case 1: {
      std::vector<Vec3> points;
      for (int i = 0; i < 24; ++i) {
        const double angle = scenes::kPi * i / 12;
        points.push_back({a * std::cos(angle), a * std::sin(angle), -c});
      }
      return of_shape(space, Cylinder{a, c}, material, points, "cylinder");
    }
    case 2: return on_a_face(kind, space, size, material, 5);
    case 3: return draw_prism(kind, size, kind.integer(3, 8), material);
    default: return on_feet(kind, space, size, material);
  }
}

Body stand(Space space, const Standing& standing, const Floor& floor, const Vec3& at, double yaw) {
  Body body = standing.body;
  const Quat turn(Eigen::AngleAxisd(yaw, scenes::up_of(space)));
  const Quat rotation = space == Space::planar ? floor.rotation : Quat(floor.rotation * turn);
  body.rotation = rotation * standing.rotation;
  body.position = floor.rotation * (at + standing.height * scenes::up_of(space));
  return body;
}

}  // namespace manyworlds::invariants
