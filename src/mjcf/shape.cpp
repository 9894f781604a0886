#include "src/mjcf/shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <variant>

#include "manyworlds/hull.hpp"
#include "manyworlds/plan.hpp"

namespace manyworlds::mjcf {
namespace {

// Geoms that have a shape.
struct GeomKind {
  mjtGeom type;
  const char* name;
};
constexpr GeomKind kGeoms[] = {{mjGEOM_SPHERE, "a sphere"},     {mjGEOM_CAPSULE, "a capsule"},
                               {mjGEOM_CYLINDER, "a cylinder"}, {mjGEOM_ELLIPSOID, "an ellipsoid"},
                               {mjGEOM_BOX, "a box"},           {mjGEOM_MESH, "a mesh"},
                               {mjGEOM_PLANE, "a plane"},       {mjGEOM_HFIELD, "a height field"}};

// Those that MuJoCo collides: the corners of its own hull where it made one (mesh_graph: number of
// corners and of faces, an edge address for each corner, then the index of each among the
// vertices), or else all. In the frame of the geom.
std::vector<Vec3> mesh_points(const mjModel& m, int mesh) {
  const float* vertices = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
  const auto vertex = [&](int i) {
    const float* v = vertices + 3 * i;
    return Vec3(v[0], v[1], v[2]);
  };
  std::vector<Vec3> points;
  if (m.mesh_graphadr[mesh] >= 0) {
    const int* graph = m.mesh_graph + m.mesh_graphadr[mesh];
    const int count = graph[0];
    for (int i = 0; i < count; ++i) points.push_back(vertex(graph[2 + count + i]));
  } else {
    for (int i = 0; i < m.mesh_vertnum[mesh]; ++i) points.push_back(vertex(i));
  }
  return points;
}

HeightField height_field(const mjModel& m, int field) {
  const mjtNum* size = m.hfield_size + 4 * field;  // half width, half depth, elevation, base
  const int columns = m.hfield_ncol[field], rows = m.hfield_nrow[field];
  HeightField result;
  result.columns = columns;
  result.cell = {2 * size[0] / (columns - 1), 2 * size[1] / (rows - 1)};
  const float* data = m.hfield_data + m.hfield_adr[field];  // 0 to 1, x varies fastest
  for (int i = 0; i < rows * columns; ++i) result.heights.push_back(size[2] * data[i]);
  return result;
}

struct Diameter {
  double operator()(const Sphere& sphere) const { return 2 * sphere.radius; }
  double operator()(const Box& box) const { return 2 * box.half_extents.norm(); }
  double operator()(const Capsule& c) const { return 2 * (c.radius + c.half_length); }
  double operator()(const Cylinder& c) const { return 2 * std::hypot(c.radius, c.half_length); }
  double operator()(const Ellipsoid& e) const { return 2 * e.radii.maxCoeff(); }
  double operator()(const Hull& hull) const {
    Eigen::AlignedBox3d box;
    for (const Vec3& v : hull.vertices) box.extend(v);
    return box.diagonal().norm();
  }
  template <typename Other>
  double operator()(const Other&) const {
    return 0;
  }
};

}  // namespace

bool has_shape(int geom_type) {
  return std::any_of(std::begin(kGeoms), std::end(kGeoms),
                     [=](const GeomKind& g) { return g.type == geom_type; });
}

std::string shape_names() {
  std::string out;
  for (const GeomKind& g : kGeoms) {
    out += &g == kGeoms ? "" : &g + 1 == std::end(kGeoms) ? " or " : ", ";
    out += g.name;
  }
  return out;
}

std::optional<std::string> hull_problem(const Model& model, int geom) {
  const int mesh = model.compiled->geom_dataid[geom];
  const std::vector<Vec3> points = mesh_points(*model.compiled, mesh);
  try {
    make_hull(points);
  } catch (const SceneError& error) {
    const Issue& issue = error.issues().front();
    const std::string place = model.place(mjOBJ_MESH, mesh);
    if (points.size() > kMaxHullVertices && issue.place == "vertices") {
      const std::string most = std::to_string(kMaxHullVertices);
      return place + " has a convex hull of more than " + most + " corners; expected at most " +
             most + "; set maxhullvert=\"" + most + "\" on the mesh";
    }
    return place + " has no hull: " + to_string(issue);
  }
  return std::nullopt;
}

std::optional<Shape> shape_of(const Model& model, int geom, const Pose& body) {
  const mjModel& m = *model.compiled;
  const mjtNum* size = m.geom_size + 3 * geom;
  const Pose pose = body * Pose{vec3(m.geom_pos + 3 * geom), quat(m.geom_quat + 4 * geom)};
  Shape shape;
  shape.name = model.name(mjOBJ_GEOM, geom);
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE: shape.geometry = Sphere{size[0]}; break;
    // Both along z, as ours.
    case mjGEOM_CAPSULE: shape.geometry = Capsule{size[0], size[1]}; break;
    case mjGEOM_CYLINDER: shape.geometry = Cylinder{size[0], size[1]}; break;
    case mjGEOM_ELLIPSOID: shape.geometry = Ellipsoid{vec3(size)}; break;
    case mjGEOM_BOX: shape.geometry = Box{vec3(size)}; break;
    case mjGEOM_PLANE: {
      // Solid below the geom's xy plane, without end: MuJoCo's sizes are for rendering only.
      const Vec3 normal = pose.rotation * Vec3::UnitZ();
      shape.geometry = Plane{normal, normal.dot(pose.position)};
      return shape;
    }
    case mjGEOM_MESH:
      if (!model.collides(geom)) return std::nullopt;
      shape.geometry = make_hull(mesh_points(m, m.geom_dataid[geom]));
      break;
    case mjGEOM_HFIELD:
      if (!model.collides(geom)) return std::nullopt;
      shape.geometry = height_field(m, m.geom_dataid[geom]);
      break;
    default: return std::nullopt;
  }
  shape.position = pose.position;
  shape.rotation = pose.rotation;
  return shape;
}

double bounding_diameter(const Geometry& geometry) { return std::visit(Diameter{}, geometry); }

}  // namespace manyworlds::mjcf
