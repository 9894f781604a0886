#include "src/mjcf/convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "src/mjcf/actuators.hpp"
#include "src/mjcf/equality.hpp"
#include "src/mjcf/exclusions.hpp"
#include "src/mjcf/filter.hpp"
#include "src/mjcf/keyframes.hpp"
#include "src/mjcf/links.hpp"
#include "src/mjcf/material.hpp"
#include "src/mjcf/options.hpp"
#include "src/mjcf/pose.hpp"
#include "src/mjcf/shape.hpp"
#include "src/mjcf/sites.hpp"
#include "src/mjcf/tendons.hpp"

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

// Of one body alone.
MassProperties mass_properties_of_link(const mjModel& m, int b) {
  const Mat3 axes = quat(m.body_iquat + 4 * b).toRotationMatrix();
  const Mat3 inertia = axes * vec3(m.body_inertia + 3 * b).asDiagonal() * axes.transpose();
  MassProperties out{.mass = m.body_mass[b],
                     .center = vec3(m.body_ipos + 3 * b),
                     .inertia = 0.5 * (inertia + inertia.transpose())};
  if (has_medium(m)) out.axes = quat(m.body_iquat + 4 * b);
  return out;
}

// Free bodies have always been compensated.
double gravity_scale(const Model& model, int b) {
  const bool passive = !model.articulated || has_passive_forces(*model.compiled);
  return passive ? 1 - model.compiled->body_gravcomp[b] : 1;
}

// One for each of MuJoCo's bodies. Those that others carry stay empty and fixed.
std::vector<Body> bodies_of(const Model& model) {
  const mjModel& m = *model.compiled;
  std::vector<Body> bodies(static_cast<std::size_t>(m.nbody));
  for (int b = 0; b < m.nbody; ++b) {
    Body& body = bodies[static_cast<std::size_t>(b)];
    body.name = model.name(mjOBJ_BODY, b);
    const bool moves = m.body_weldid[b] != 0 && model.carrier(b) == b;
    body.motion = moves ? Motion::dynamic : Motion::fixed;
    const Pose pose = pose_in(m, b, 0);
    body.position = pose.position;
    body.rotation = pose.rotation;
    if (!moves) continue;
    body.mass_properties =
        model.articulated ? mass_properties_of_link(m, b) : mass_properties_of(m, b);
    body.gravity_scale = gravity_scale(model, b);
  }
  const std::vector<Filter> filter = filters(model);
  const std::vector<Material> material = materials(model);
  for (int g = 0; g < m.ngeom; ++g) {
    const int b = m.geom_bodyid[g];
    const int carrier = model.carrier(b);
    if (auto shape = shape_of(model, g, pose_in(m, b, carrier))) {
      shape->material = material[static_cast<std::size_t>(g)];
      shape->filter = filter[static_cast<std::size_t>(g)];
      bodies[static_cast<std::size_t>(carrier)].shapes.push_back(std::move(*shape));
    }
  }
  return bodies;
}

double round_to_two_digits(double x) {
  const int shift = 1 - static_cast<int>(std::floor(std::log10(x)));
  const double scale = std::pow(10.0, std::abs(shift));
  return shift >= 0 ? std::round(x * scale) / scale : std::round(x / scale) * scale;
}

// Median bounding diameter of the geoms of bodies that move; 1 m if there are none. Planes do not
// count, and neither do sizes whose diameter overflows, which the scene's check refuses by name.
double typical_size(const Scene& scene) {
  std::vector<double> diameters;
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic) continue;
    for (const Shape& shape : body.shapes) {
      const double diameter = bounding_diameter(shape.geometry);
      if (std::isnormal(diameter)) diameters.push_back(diameter);
    }
  }
  if (diameters.empty()) return 1;
  const auto median = diameters.begin() + static_cast<std::ptrdiff_t>(diameters.size() / 2);
  std::nth_element(diameters.begin(), median, diameters.end());
  return round_to_two_digits(*median);
}

}  // namespace

Scene make_scene(const Model& model, const std::string& name) {
  Scene scene;
  scene.name = name;
  scene.space = Space::spatial;
  set_options(model, scene.options);

  std::vector<Body> bodies = bodies_of(model);
  std::vector<BodyId> scene_body(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    // A static body without geoms is of no use, and one that is carried by another has none.
    const bool moves = bodies[b].motion == Motion::dynamic;
    if (moves || !bodies[b].shapes.empty()) scene_body[b] = scene.add(std::move(bodies[b]));
  }
  scene.options.length_unit = typical_size(scene);
  if (model.articulated) {
    const std::vector<JointId> scene_joint = add_links(model, scene_body, scene);
    add_actuators(model, scene_joint, scene);
    add_tendons(model, scene_joint, scene);
    add_exclusions(model, scene_body, scene);
    add_keyframes(model, scene);
  } else {
    add_joints(model, scene_body, scene);
  }
  add_sites(model, scene_body, scene);
  return scene;
}

}  // namespace manyworlds::mjcf
