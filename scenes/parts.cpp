#include "scenes/parts.hpp"

#include <utility>

namespace manyworlds::scenes {
namespace {

constexpr double kWallMargin = 0.5;  // m
constexpr double kCeiling = 100;     // m

}  // namespace

Scene planar_scene(std::string name) {
  Scene scene = empty_scene(Space::planar, 10, std::move(name));
  scene.options.density = 1;
  return scene;
}

Scene spatial_scene(std::string name) {
  Scene scene = empty_scene(Space::spatial, 10, std::move(name));
  scene.options.density = 1000;
  return scene;
}

Body bin(Space space, double half_width) {
  Body bin = ground(space);
  bin.name = "bin";
  for (double side : {1.0, -1.0}) {
    if (space == Space::planar) bin.shapes.push_back(shape_of(HalfPlane{{side, 0}, -half_width}));
    if (space == Space::spatial) bin.shapes.push_back(shape_of(Plane{{side, 0, 0}, -half_width}));
  }
  if (space == Space::spatial) {
    bin.shapes.push_back(shape_of(Plane{{0, 1, 0}, -half_width}));
    bin.shapes.push_back(shape_of(Plane{{0, -1, 0}, -half_width}));
  }
  return bin;
}

Eigen::AlignedBox3d bounds_of(Space space, double half_width) {
  const double wall = half_width + kWallMargin;
  if (space == Space::planar) return {Vec3(-wall, -kWallMargin, -1), Vec3(wall, kCeiling, 1)};
  return {Vec3(-wall, -wall, -kWallMargin), Vec3(wall, wall, kCeiling)};
}

Body named_body(std::string name, const Vec3& position, Geometry geometry) {
  Body body = body_of(shape_of(std::move(geometry)), position);
  body.name = std::move(name);
  return body;
}

BodyId add_body(Scene& scene, std::string name, const Vec3& position, Geometry geometry) {
  return scene.add(named_body(std::move(name), position, std::move(geometry)));
}

Control thrust(std::string name, BodyId body, const Vec3& point, const Vec3& direction, double low,
               double high) {
  Control out;
  out.name = std::move(name);
  out.kind = ControlKind::thrust;
  out.body = body;
  out.point = point;
  out.direction = direction;
  out.low = low, out.high = high;
  return out;
}

Control torque(std::string name, BodyId body, double most, const Vec3& axis) {
  Control out;
  out.name = std::move(name);
  out.kind = ControlKind::torque;
  out.body = body;
  out.direction = axis;
  out.low = -most, out.high = most;
  return out;
}

Control speed_of(std::string name, JointId joint, double most, double initial) {
  Control out;
  out.name = std::move(name);
  out.kind = ControlKind::target_speed;
  out.joint = joint;
  out.low = -most, out.high = most, out.initial = initial;
  return out;
}

}  // namespace manyworlds::scenes
