#include <utility>

#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {

Scene planar_scene(const Task& task, double dt, double gravity) {
  Scene scene = scenes::planar_scene(task.name);
  scene.options.dt = dt;
  scene.options.gravity = {0, -gravity, 0};
  return scene;
}

Shape ghost(Geometry geometry, double area, double mass) {
  Shape shape = shape_of(std::move(geometry));
  shape.density = mass / area;
  shape.filter.mask = 0;
  return shape;
}

}  // namespace manyworlds::tasks
