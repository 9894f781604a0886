// 15 standing dominoes in a row; the first one tips over and takes the others down.
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene domino() {
  const Vec3 half_extents{0.05, 0.25, 0.5};  // m
  constexpr double kSpacing = 0.5;           // m
  // Tips at 0.4 rad/s: kinetic energy about the edge against the rise of the centre over it.
  constexpr double kPush = 1;  // rad/s

  Scene scene = spatial_scene("domino");
  scene.options.bounds = bounds_of(Space::spatial, 20);
  scene.add(ground(Space::spatial));
  for (int i = 0; i < 15; ++i) {
    Body domino = named_body("domino" + std::to_string(i), {kSpacing * i, 0, half_extents.z()},
                             Box{half_extents});
    domino.jitter.position = {0.01, 0.01, 0};
    domino.jitter.angle = 0.02;
    if (i == 0) {
      // A rotation about the lower front edge, which stays where it is.
      domino.angular_velocity = {0, kPush, 0};
      domino.linear_velocity = {kPush * half_extents.z(), 0, kPush * half_extents.x()};
    }
    scene.add(domino);
  }
  return scene;
}

}  // namespace manyworlds::scenes
