#include "src/mjcf/convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "src/mjcf/filter.hpp"

namespace manyworlds::mjcf {
namespace {

Vec3 vec3(const mjtNum* v) { return {v[0], v[1], v[2]}; }
Quat quat(const mjtNum* q) { return {q[0], q[1], q[2], q[3]}; }  // both are (w, x, y, z)

struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
};
Pose operator*(const Pose& a, const Pose& b) {
  return {a.position + a.rotation * b.position, a.rotation * b.rotation};
}

// Pose of body b in the frame of the body that it is welded to: the world for static bodies, the
// free body for its jointless children. Identity for the free body itself.
Pose pose_in_root(const mjModel& m, int b) {
  Pose pose;
  for (const int root = m.body_weldid[b]; b != root; b = m.body_parentid[b]) {
    pose = Pose{vec3(m.body_pos + 3 * b), quat(m.body_quat + 4 * b)} * pose;
  }
  return pose;
}

Mat3 steiner(double mass, const Vec3& d) {
  return mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

// Of a free body and everything welded to it, as MuJoCo's compiler computed them.
MassProperties mass_properties_of(const mjModel& m, int root) {
  MassProperties total;
  total.mass = 0;
  Vec3 moment = Vec3::Zero();  // kg m
  for (int b = root; b < m.nbody; ++b) {
    if (m.body_weldid[b] != root) continue;
    const Pose pose = pose_in_root(m, b);
    total.mass += m.body_mass[b];
    moment += m.body_mass[b] * (pose.position + pose.rotation * vec3(m.body_ipos + 3 * b));
  }
  total.center = moment / total.mass;
  total.inertia = Mat3::Zero();
  for (int b = root; b < m.nbody; ++b) {
    if (m.body_weldid[b] != root) continue;
    const Pose principal =
        pose_in_root(m, b) * Pose{vec3(m.body_ipos + 3 * b), quat(m.body_iquat + 4 * b)};
    const Mat3 axes = principal.rotation.toRotationMatrix();
    total.inertia += axes * vec3(m.body_inertia + 3 * b).asDiagonal() * axes.transpose() +
                     steiner(m.body_mass[b], principal.position - total.center);
  }
  // Rounding must not leave a tensor that is only almost symmetric.
  total.inertia = (0.5 * (total.inertia + total.inertia.transpose())).eval();
  return total;
}

// Sliding friction of each geom. MuJoCo's pair has the larger condim of the two: only where every
// geom has condim 1 is nothing frictional.
std::vector<double> frictions(const Model& model) {
  const mjModel& m = *model.compiled;
  std::vector<double> friction(static_cast<std::size_t>(m.ngeom), 0.0);
  bool frictional = false;
  for (int g = 0; g < m.ngeom; ++g) {
    frictional = frictional || (model.collides(g) && m.geom_condim[g] != 1);
  }
  if (!frictional) return friction;
  const bool one_for_all = (m.opt.enableflags & mjENBL_OVERRIDE) != 0;
  for (int g = 0; g < m.ngeom; ++g) {
    friction[static_cast<std::size_t>(g)] =
        one_for_all ? m.opt.o_friction[0] : m.geom_friction[3 * g];
  }
  return friction;
}

// Nothing for the kinds that are only seen.
std::optional<Shape> shape_of(const Model& model, int geom, const Pose& body) {
  const mjModel& m = *model.compiled;
  const mjtNum* size = m.geom_size + 3 * geom;
  const Pose pose = body * Pose{vec3(m.geom_pos + 3 * geom), quat(m.geom_quat + 4 * geom)};
  Shape shape;
  shape.name = model.name(mjOBJ_GEOM, geom);
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE: shape.geometry = Sphere{size[0]}; break;
    case mjGEOM_CAPSULE: shape.geometry = Capsule{size[0], size[1]}; break;  // both along z
    case mjGEOM_BOX: shape.geometry = Box{vec3(size)}; break;
    case mjGEOM_PLANE: {
      // Solid below the geom's xy plane, without end: MuJoCo's sizes are for rendering only.
      const Vec3 normal = pose.rotation * Vec3::UnitZ();
      shape.geometry = Plane{normal, normal.dot(pose.position)};
      return shape;
    }
    default: return std::nullopt;
  }
  shape.position = pose.position;
  shape.rotation = pose.rotation;
  return shape;
}

double round_to_two_digits(double x) {
  const int shift = 1 - static_cast<int>(std::floor(std::log10(x)));
  const double scale = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? std::round(x * scale) / scale : std::round(x / scale) * scale;
}

// Median bounding diameter of the geoms of free bodies; 1 m if there are none.
double typical_size(const Scene& scene) {
  std::vector<double> diameters;
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic) continue;
    for (const Shape& shape : body.shapes) {
      if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        diameters.push_back(2 * sphere->radius);
      } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
        diameters.push_back(2 * box->half_extents.norm());
      } else if (const auto* capsule = std::get_if<Capsule>(&shape.geometry)) {
        diameters.push_back(2 * (capsule->radius + capsule->half_length));
      }
    }
  }
  if (diameters.empty()) return Options{}.length_unit;
  const auto median = diameters.begin() + static_cast<std::ptrdiff_t>(diameters.size() / 2);
  std::nth_element(diameters.begin(), median, diameters.end());
  return round_to_two_digits(*median);
}

}  // namespace

Scene make_scene(const Model& model, const std::string& name) {
  const mjModel& m = *model.compiled;
  Scene scene;
  scene.name = name;
  scene.space = Space::spatial;
  scene.options.dt = m.opt.timestep;
  scene.options.gravity =
      (m.opt.disableflags & mjDSBL_GRAVITY) != 0 ? Vec3::Zero().eval() : vec3(m.opt.gravity);

  const std::vector<Filter> filter = filters(model);
  const std::vector<double> friction = frictions(model);
  // Static bodies and free ones get a Body; -1 marks those that are part of another one.
  std::vector<int> scene_body(static_cast<std::size_t>(m.nbody), -1);
  for (int b = 0; b < m.nbody; ++b) {
    const bool fixed = m.body_weldid[b] == 0;
    if (fixed ? m.body_geomnum[b] == 0 : m.body_weldid[b] != b) continue;
    Body body;
    body.name = model.name(mjOBJ_BODY, b);
    body.motion = fixed ? Motion::fixed : Motion::dynamic;
    if (fixed) {
      const Pose pose = pose_in_root(m, b);
      body.position = pose.position;
      body.rotation = pose.rotation;
    } else {
      body.position = vec3(m.body_pos + 3 * b);
      body.rotation = quat(m.body_quat + 4 * b);
      body.mass_properties = mass_properties_of(m, b);
      body.gravity_scale = 1 - m.body_gravcomp[b];
    }
    scene_body[static_cast<std::size_t>(b)] = scene.add(std::move(body));
  }
  for (int g = 0; g < m.ngeom; ++g) {
    const int b = m.geom_bodyid[g];
    const bool fixed = m.body_weldid[b] == 0;
    const int owner = scene_body[static_cast<std::size_t>(fixed ? b : m.body_weldid[b])];
    // A static body keeps its own frame; what is welded to a free body moves into that one's.
    const Pose frame = fixed ? Pose{} : pose_in_root(m, b);
    if (auto shape = shape_of(model, g, frame)) {
      shape->material = {.friction = friction[static_cast<std::size_t>(g)], .restitution = 0};
      shape->filter = filter[static_cast<std::size_t>(g)];
      scene.bodies[static_cast<std::size_t>(owner)].shapes.push_back(std::move(*shape));
    }
  }
  // A static body that only had something to see is of no use.
  std::erase_if(scene.bodies, [](const Body& body) {
    return body.motion == Motion::fixed && body.shapes.empty();
  });
  scene.options.length_unit = typical_size(scene);
  return scene;
}

}  // namespace manyworlds::mjcf
