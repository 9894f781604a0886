#include <utility>

#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Scene planar_scene(double dt, double gravity) {
  Scene scene;
  scene.space = Space::planar;
  scene.options.dt = dt;
  scene.options.gravity = {0, -gravity, 0};
  scene.options.density = 1;
  return scene;
}

Shape ghost(Geometry geometry, double area, double mass) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.density = mass / area;
  shape.filter.mask = 0;
  return shape;
}

Control torque(std::string name, int body, double most, const Vec3& axis) {
  Control out;
  out.name = std::move(name);
  out.kind = ControlKind::torque;
  out.body = body;
  out.direction = axis;
  out.low = -most, out.high = most;
  return out;
}

Control thrust(std::string name, int body, const Vec3& direction, double low, double high) {
  Control out;
  out.name = std::move(name);
  out.kind = ControlKind::thrust;
  out.body = body;
  out.direction = direction;
  out.low = low, out.high = high;
  return out;
}

}  // namespace manyworlds::tasks
