// 20 tumbling boxes that never meet: integration and rotation alone, without contacts.
#include <array>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene free_flight() {
  // All three moments of inertia of each differ, so that the gyroscopic term has work to do.
  const std::array<Vec3, 3> half_extents = {Vec3(0.5, 0.3, 0.2), Vec3(0.6, 0.2, 0.4),
                                            Vec3(0.3, 0.45, 0.25)};
  Scene scene = spatial_scene("free-flight");
  scene.options.gravity.setZero();  // they would fall out of range in a long run
  for (int i = 0; i < 20; ++i) {
    Body box;
    box.name = "box" + std::to_string(i);
    box.position = {10.0 * (i % 5), 10.0 * (i / 5), 0};
    box.linear_velocity = {0.5, -0.25, 0.25};
    // Near the middle axis for some, so that they turn over; distinct for all.
    box.angular_velocity = {0.5 + 0.1 * (i % 7), 3.0 - 0.2 * (i % 5), 0.3 + 0.25 * (i % 4)};
    Shape shape = shape_of(Box{half_extents[static_cast<std::size_t>(i % 3)]});
    shape.filter.mask = 0;
    box.shapes.push_back(shape);
    box.jitter.linear_velocity = {1, 1, 1};
    box.jitter.any_orientation = true;
    scene.add(box);
  }
  return scene;
}

}  // namespace manyworlds::scenes
