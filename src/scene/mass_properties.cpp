// Mass, centre of mass and inertia of bodies made of shapes.
//
// Each shape gives its own mass, centre and inertia about that centre (shape/); the body sums them
// with the parallel-axis theorem
//   I = sum_k R_k I_k R_k^T + m_k (d_k^2 1 - d_k d_k^T),   d_k = c_k - c,   c = sum m_k c_k / m.
// The centre is found first and the inertia summed about it: summing about the origin and
// subtracting m c^2 would lose digits when shapes are far from the origin of their body.
// Shapes that overlap simply add. Planes and lines have no mass.
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

// In the body frame.
MassProperties of(const Shape& shape, const Scene& scene) {
  const double density = shape.density.value_or(scene.options.density);
  MassProperties part =
      traits_of(shape.geometry).mass_properties(shape.geometry, density, scene.space);
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
      total.inertia += detail::planar_inertia(part.mass * d.squaredNorm());
    } else {
      total.inertia += part.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
  }
  return total;
}

}  // namespace manyworlds
