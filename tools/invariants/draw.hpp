// What families draw their worlds with.
#pragma once

#include "scenes/builders.hpp"
#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {

// Without bodies; gravity and step of the scale.
Scene scene_of(Space space, const Scale& scale);
inline Scene free_scene(Space space, const Scale& scale) {  // without gravity
  Scene scene = scene_of(space, scale);
  scene.options.gravity.setZero();
  return scene;
}

// A convex shape of any type, or of a given one. Its extents are within 0.3 to 1 of `size`, those
// of capsules from half as much.
Geometry draw_shape(Random& random, Space space, double size);
inline constexpr int kShapeTypes = 6;  // ball, box, capsule, cylinder, ellipsoid, hull; planar: 4
Geometry draw_shape(Random& random, Space space, double size, int type);
int shape_types(Space space);
const char* shape_name(Space space, int type);

// Half of the least width of the shape.
double half_thickness(const Geometry& geometry);
// Radius of the sphere about its origin that holds it.
double outer_radius(const Geometry& geometry);
// How far it reaches from its origin along a direction of its frame.
double reach(const Geometry& geometry, Space space, const Vec3& direction);

Quat draw_rotation(Random& random, Space space);
Vec3 draw_direction(Random& random, Space space);
// A vector about which bodies can turn: any, or z in the plane.
Vec3 draw_axis(Random& random, Space space);

// In a third of the kinds bodies resist rolling and spinning by up to 0.2 lengths.
void resist_in_some(Random& kind, Scene& scene, const Scale& scale);

// kg, of a cube of water of the scale's length; planar: per metre of depth.
double unit_mass(Space space, const Scale& scale);
// Gives all shapes of a body the density with which it weighs `mass`, kg.
void set_mass(Scene& scene, BodyId body, double mass);
// Mass and inertia at the start.
MassProperties mass_of(const Scene& scene, BodyId body);
// Inertia in world axes.
Mat3 inertia_of(const MassProperties& mass, const Quat& rotation);

}  // namespace manyworlds::invariants
