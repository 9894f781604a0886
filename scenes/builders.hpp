// Geometries, bodies and scenes in short, the same words in the plane and in space. Planar scenes
// have y up, spatial ones z. Scenes, tests and reports build with these.
#pragma once

#include <string>
#include <utility>

#include "manyworlds/scene.hpp"

namespace manyworlds::scenes {

inline constexpr double kPi = 3.14159265358979323846;

inline Vec3 up_of(Space space) { return space == Space::planar ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

// Gravity in m/s^2, downward.
inline Scene empty_scene(Space space, double gravity, std::string name = {}) {
  Scene scene;
  scene.name = std::move(name);
  scene.space = space;
  scene.options.gravity = -gravity * up_of(space) + Vec3::Zero();  // 0 instead of -0
  return scene;
}

// A circle or sphere, a square or cube, a half-plane or plane below height 0.
inline Geometry round_of(Space space, double radius) {
  if (space == Space::planar) return Circle{radius};
  return Sphere{radius};
}
inline Geometry box_of(Space space, const Vec3& half) {  // the plane has the first two
  if (space == Space::planar) return Polygon::box(half.x(), half.y());
  return Box{half};
}
inline Geometry cube_of(Space space, double half) { return box_of(space, Vec3::Constant(half)); }
inline Geometry ground_of(Space space) {
  if (space == Space::planar) return HalfPlane{};
  return Plane{};
}

// A shape at the body frame.
inline Shape shape_of(Geometry geometry, const Material& material = {}) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.material = material;
  return shape;
}
inline Shape shape_of(Geometry geometry, double friction, double restitution = 0) {
  return shape_of(std::move(geometry), Material{friction, restitution});
}

inline Body body_of(Shape shape, const Vec3& position, Motion motion = Motion::dynamic) {
  Body body;
  body.motion = motion;
  body.position = position;
  body.shapes.push_back(std::move(shape));
  return body;
}
// A body whose mass properties are given and whose shapes touch nothing.
inline Body lump(Space space, double mass, const Vec3& moments, const Vec3& position) {
  Body body = body_of(shape_of(cube_of(space, 0.1)), position);
  body.shapes[0].filter.mask = 0;
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
  return body;
}
// A uniform rod along x, thin but for what keeps its inertia sound.
inline Body uniform_rod(Space space, double mass, double length, const Vec3& position) {
  const double across = mass * length * length / 12;
  return lump(space, mass, {across * 1e-3, across, across}, position);
}
// A uniform box of half extents, of which the plane has the first two, that weighs `mass`, kg.
inline Body solid_box(Space space, double mass, const Vec3& half, const Vec3& position,
                      double friction = 0.5) {
  Body body = body_of(shape_of(box_of(space, half), friction), position);
  const Vec3 square = half.cwiseProduct(half);
  const Vec3 moments = mass / 3 * (Vec3::Constant(square.sum()) - square);
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
  return body;
}
// Fixed, solid below height 0.
inline Body ground(Space space, const Material& material = {}) {
  Body body = body_of(shape_of(ground_of(space), material), Vec3::Zero(), Motion::fixed);
  body.name = "ground";
  return body;
}
inline Body ground(Space space, double friction, double restitution = 0) {
  return ground(space, Material{friction, restitution});
}

// Rotates z to y: a hinge about y, for spatial scenes that swing in the plane of x and z.
inline Quat z_to_y() { return Quat(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX())); }
inline Quat hinge_axes(Space space) {
  return space == Space::planar ? Quat(Quat::Identity()) : z_to_y();
}

// A frame whose axes are the world's.
inline Frame frame_at(const Vec3& position) { return {position, Quat::Identity()}; }
inline Frame frame_at(double x, double y) { return frame_at({x, y, 0}); }

}  // namespace manyworlds::scenes
