#include "scenes/parts.hpp"

#include <utility>

namespace manyworlds::scenes {
namespace {

constexpr double kWallMargin = 0.5;  // m
constexpr double kCeiling = 100;     // m

}  // namespace

Scene planar_scene(std::string name) {
  Scene scene;
  scene.name = std::move(name);
  scene.space = Space::planar;
  scene.options.gravity = {0, -10, 0};
  scene.options.density = 1;
  return scene;
}

Scene spatial_scene(std::string name) {
  Scene scene;
  scene.name = std::move(name);
  scene.space = Space::spatial;
  scene.options.gravity = {0, 0, -10};
  scene.options.density = 1000;
  return scene;
}

Shape shape_of(Geometry geometry) {
  Shape shape;
  shape.geometry = std::move(geometry);
  return shape;
}

Body planar_ground(const Material& material) {
  Body ground;
  ground.name = "ground";
  ground.motion = Motion::fixed;
  ground.shapes.push_back(shape_of(HalfPlane{{0, 1}, 0}));
  ground.shapes.back().material = material;
  return ground;
}

Body spatial_ground(const Material& material) {
  Body ground;
  ground.name = "ground";
  ground.motion = Motion::fixed;
  ground.shapes.push_back(shape_of(Plane{{0, 0, 1}, 0}));
  ground.shapes.back().material = material;
  return ground;
}

Body planar_bin(double half_width) {
  Body bin = planar_ground();
  bin.name = "bin";
  bin.shapes.push_back(shape_of(HalfPlane{{1, 0}, -half_width}));
  bin.shapes.push_back(shape_of(HalfPlane{{-1, 0}, -half_width}));
  return bin;
}

Body spatial_bin(double half_width) {
  Body bin = spatial_ground();
  bin.name = "bin";
  bin.shapes.push_back(shape_of(Plane{{1, 0, 0}, -half_width}));
  bin.shapes.push_back(shape_of(Plane{{-1, 0, 0}, -half_width}));
  bin.shapes.push_back(shape_of(Plane{{0, 1, 0}, -half_width}));
  bin.shapes.push_back(shape_of(Plane{{0, -1, 0}, -half_width}));
  return bin;
}

Eigen::AlignedBox3d planar_bounds(double half_width) {
  const double wall = half_width + kWallMargin;
  return {Vec3(-wall, -kWallMargin, -1), Vec3(wall, kCeiling, 1)};
}

Eigen::AlignedBox3d spatial_bounds(double half_width) {
  const double wall = half_width + kWallMargin;
  return {Vec3(-wall, -wall, -kWallMargin), Vec3(wall, wall, kCeiling)};
}

BodyId add_body(Scene& scene, std::string name, const Vec3& position, Geometry geometry) {
  Body body;
  body.name = std::move(name);
  body.position = position;
  body.shapes.push_back(shape_of(std::move(geometry)));
  return scene.add(std::move(body));
}

Frame frame_at(double x, double y) { return {Vec3(x, y, 0), Quat::Identity()}; }

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
