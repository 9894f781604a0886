#include "src/page/look.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "manyworlds/query.hpp"
#include "manyworlds/surface.hpp"
#include "src/base/enum_names.hpp"
#include "src/page/base64.hpp"
#include "src/page/joints.hpp"
#include "src/page/numbers.hpp"

namespace manyworlds::page {
namespace {

constexpr int kFine = 32, kCoarse = 12;  // corners of a circle, near and far
constexpr int kExtent = 64;              // and to measure it, to a quarter of a percent

template <class T, class Rows>
std::string table_of(const Rows& rows) {
  std::vector<T> flat;
  for (const auto& row : rows) {
    for (const auto number : row) flat.push_back(static_cast<T>(number));
  }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(flat.data());
  return base64({bytes, flat.size() * sizeof(T)});
}

// Chains as pairs of points.
std::string segments_of(const std::vector<std::vector<Vec3>>& chains) {
  std::vector<Vec3> pairs;
  for (const auto& chain : chains) {
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      pairs.insert(pairs.end(), {chain[i], chain[i + 1]});
    }
  }
  return table_of<float>(pairs);
}

Json mesh_of(const Surface& surface) {
  return {{"points", table_of<float>(surface.points)},
          {"normals", table_of<float>(surface.normals)},
          {"triangles", table_of<std::uint32_t>(surface.triangles)},
          {"lines", segments_of(surface.lines)},
          {"marks", segments_of(surface.marks)}};
}

bool has_end(const Geometry& geometry) {
  return !std::holds_alternative<Plane>(geometry) && !std::holds_alternative<HalfPlane>(geometry);
}

// Points around a shape that has an end, in the frame of its body.
std::vector<Vec3> extent_of(const Shape& shape, Space space) {
  const Surface surface = manyworlds::surface(shape.geometry, {.space = space, .around = kExtent});
  std::vector<Vec3> out = surface.points;
  for (const auto& line : surface.lines) out.insert(out.end(), line.begin(), line.end());
  for (Vec3& p : out) p = shape.position + shape.rotation.normalized() * p;
  return out;
}

// A box in the frame of a shape that holds one of the world.
Room seen_from(const Room& room, const Body& body, const Shape& shape) {
  Room out;
  const Quat body_turn = body.rotation.normalized(), turn = shape.rotation.normalized();
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? room.high.x() : room.low.x(), i & 2 ? room.high.y() : room.low.y(),
                      i & 4 ? room.high.z() : room.low.z());
    const Vec3 in_body = body_turn.conjugate() * (corner - body.position);
    out.add(turn.conjugate() * (in_body - shape.position));
  }
  return out;
}

// Of a polygon that is a rectangle about its origin, along the axes: half its sides.
std::optional<Vec3> rectangle(const Geometry& geometry) {
  const auto* p = std::get_if<Polygon>(&geometry);
  if (p == nullptr || p->radius != 0 || p->vertices.size() != 4) return std::nullopt;
  const Vec2 half = p->vertices[0].cwiseAbs();
  Vec2 sum = Vec2::Zero();
  for (const Vec2& v : p->vertices) {
    if (v.cwiseAbs() != half) return std::nullopt;
    sum += v;
  }
  if (sum != Vec2::Zero()) return std::nullopt;
  return Vec3(half.x(), half.y(), 1);
}

}  // namespace

int Meshes::add(const char* kind, const Geometry& geometry, const SurfaceOptions& options) {
  Json levels = Json::array();
  levels.push_back(mesh_of(surface(geometry, options)));
  const auto [at, fresh] =
      known_.try_emplace(kind + levels.front().dump(), static_cast<int>(json_.size()));
  if (fresh) {
    SurfaceOptions coarse = options;
    coarse.around = kCoarse;
    Json far = mesh_of(surface(geometry, coarse));
    if (far != levels.front()) levels.push_back(std::move(far));
    json_.push_back({{"kind", kind}, {"levels", std::move(levels)}});
  }
  return at->second;
}

Meshes::Use Meshes::use(const Geometry& geometry) {
  Use out;
  const auto unit = [&](const char* kind, const Geometry& mesh, const Vec3& size) {
    out.mesh = add(kind, mesh, {.space = space_, .around = kFine});
    out.size = size;
    return out;
  };
  if (const auto* s = std::get_if<Sphere>(&geometry)) {
    return unit("sphere", Sphere{1}, Vec3::Constant(s->radius));
  }
  if (const auto* e = std::get_if<Ellipsoid>(&geometry)) return unit("sphere", Sphere{1}, e->radii);
  if (const auto* b = std::get_if<Box>(&geometry)) {
    return unit("box", Box{Vec3::Ones()}, b->half_extents);
  }
  if (const auto* c = std::get_if<Cylinder>(&geometry)) {
    return unit("cylinder", Cylinder{1, 1}, {c->radius, c->radius, c->half_length});
  }
  if (const auto* c = std::get_if<Circle>(&geometry)) {
    return unit("circle", Circle{1}, {c->radius, c->radius, 1});
  }
  if (const auto* c = std::get_if<Capsule>(&geometry)) {
    // Every point of the mesh is clearly at one of its ends.
    unit("capsule", Capsule{1, 1}, Vec3::Constant(c->radius));
    (space_ == Space::planar ? out.stretch.y() : out.stretch.z()) = c->half_length - c->radius;
    return out;
  }
  if (const auto half = rectangle(geometry)) return unit("rectangle", Polygon::box(1, 1), *half);
  return unit("own", geometry, Vec3::Ones());
}

Meshes::Use Meshes::use(const Geometry& geometry, const Vec3& size) {
  const bool own_corners =
      std::holds_alternative<Hull>(geometry) || std::holds_alternative<Polygon>(geometry);
  if (!own_corners) return use(resized(geometry, size));
  // Stretched, so that all worlds share a mesh.
  Use out = use(geometry);
  Vec3 low = Vec3::Constant(1e300), high = -low;
  const auto corner = [&](const auto& v) {
    for (Eigen::Index c = 0; c < v.size(); ++c) {
      low[c] = std::min(low[c], v[c]), high[c] = std::max(high[c], v[c]);
    }
  };
  if (const auto* hull = std::get_if<Hull>(&geometry)) {
    for (const Vec3& v : hull->vertices) corner(v);
  } else {
    for (const Vec2& v : std::get<Polygon>(geometry).vertices) corner(v);
  }
  for (int c = 0; c < (space_ == Space::planar ? 2 : 3); ++c) {
    out.size[c] *= size[c] / ((high[c] - low[c]) / 2);
  }
  return out;
}

int Meshes::ground(const Geometry& geometry, const Vec3& low, const Vec3& high) {
  return add("ground", geometry, {.space = space_, .low = low, .high = high});
}

std::vector<double> radii_of(const Scene& scene, double otherwise) {
  std::vector<double> out;
  for (const Body& body : scene.bodies) {
    double radius = 0;
    for (const Shape& shape : body.shapes) {
      if (!has_end(shape.geometry)) continue;
      for (const Vec3& p : extent_of(shape, scene.space)) radius = std::max(radius, p.norm());
    }
    out.push_back(radius > 0 ? radius : otherwise);
  }
  return out;
}

Room fixed_room(const Scene& scene) {
  Room out;
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::fixed) continue;
    for (const Shape& shape : body.shapes) {
      if (!has_end(shape.geometry)) continue;
      for (const Vec3& p : extent_of(shape, scene.space)) {
        out.add(body.position + body.rotation.normalized() * p);
      }
    }
  }
  return out;
}

Json look_of(const Plan& plan, const std::vector<double>& radii, const Room& room, Meshes& meshes) {
  const Scene& scene = plan.scene();
  Json bodies = Json::array();
  int index = 0;  // of a shape among all of the scene
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    Json shapes = Json::array();
    for (const Shape& shape : body.shapes) {
      Meshes::Use use;
      if (has_end(shape.geometry)) {
        use = meshes.use(shape.geometry);
      } else {
        const Room cut = seen_from(room, body, shape);
        use.mesh = meshes.ground(shape.geometry, cut.low, cut.high);
      }
      shapes.push_back({{"shape", index++},
                        {"mesh", use.mesh},
                        {"size", numbers(use.size)},
                        {"stretch", numbers(use.stretch)},
                        {"position", numbers(shape.position)},
                        {"rotation", numbers(shape.rotation)}});
    }
    const std::optional<int> row = plan.find_row(BodyId(static_cast<int>(b)));
    const MassProperties mass =
        body.motion == Motion::dynamic ? mass_properties(scene, body) : MassProperties{};
    bodies.push_back({{"name", body.name},
                      {"motion", name_of(body.motion)},
                      {"row", row ? Json(*row) : Json()},
                      {"radius", radii[b]},
                      {"position", numbers(body.position)},
                      {"rotation", numbers(body.rotation)},
                      {"center", numbers(mass.center)},
                      {"mass", mass.mass},
                      {"shapes", std::move(shapes)}});
  }
  return {{"scene", scene.name},
          {"gravity", numbers(scene.options.gravity)},
          {"turns", plan.has(Feature::orientation)},
          {"rows", plan.bodies()},
          {"low", numbers(room.low)},
          {"high", numbers(room.high)},
          {"bodies", std::move(bodies)},
          {"joints", joints_of(scene)}};
}

}  // namespace manyworlds::page
