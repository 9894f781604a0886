#include "src/mjcf/convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "src/mjcf/equality.hpp"
#include "src/mjcf/filter.hpp"
#include "src/mjcf/pose.hpp"
#include "src/mjcf/shape.hpp"

namespace manyworlds::mjcf {
namespace {

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

// One for each of MuJoCo's bodies. Parts of free bodies stay empty and fixed: their mass and shapes
// are in the body that they are welded to.
std::vector<Body> bodies_of(const Model& model) {
  const mjModel& m = *model.compiled;
  std::vector<Body> bodies(static_cast<std::size_t>(m.nbody));
  for (int b = 0; b < m.nbody; ++b) {
    Body& body = bodies[static_cast<std::size_t>(b)];
    body.name = model.name(mjOBJ_BODY, b);
    body.motion = m.body_weldid[b] == b && b != 0 ? Motion::dynamic : Motion::fixed;
    if (body.motion == Motion::fixed) {
      const Pose pose = pose_in_root(m, b);
      body.position = pose.position;
      body.rotation = pose.rotation;
    } else {
      body.position = vec3(m.body_pos + 3 * b);
      body.rotation = quat(m.body_quat + 4 * b);
      body.mass_properties = mass_properties_of(m, b);
      body.gravity_scale = 1 - m.body_gravcomp[b];
    }
  }
  const std::vector<Filter> filter = filters(model);
  const std::vector<double> friction = frictions(model);
  for (int g = 0; g < m.ngeom; ++g) {
    const int b = m.geom_bodyid[g];
    const bool fixed = m.body_weldid[b] == 0;
    const int owner = fixed ? b : m.body_weldid[b];
    // A static body keeps its own frame; what is welded to a free body moves into that one's.
    const Pose frame = fixed ? Pose{} : pose_in_root(m, b);
    if (auto shape = shape_of(model, g, frame)) {
      shape->material = {.friction = friction[static_cast<std::size_t>(g)], .restitution = 0};
      shape->filter = filter[static_cast<std::size_t>(g)];
      bodies[static_cast<std::size_t>(owner)].shapes.push_back(std::move(*shape));
    }
  }
  return bodies;
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
      diameters.push_back(bounding_diameter(shape.geometry));
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

  std::vector<Body> bodies = bodies_of(model);
  std::vector<BodyId> scene_body(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    // A static body that only had something to see is of no use; a part of a free body has none.
    const bool moves = bodies[b].motion == Motion::dynamic;
    if (moves || !bodies[b].shapes.empty()) scene_body[b] = scene.add(std::move(bodies[b]));
  }
  scene.options.length_unit = typical_size(scene);
  add_joints(model, scene_body, scene);
  return scene;
}

}  // namespace manyworlds::mjcf
