#include "scenes/cradle.hpp"

#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene newton_cradle(int moving, double gap) {
  constexpr double kRadius = 0.5;
  Scene scene = planar_scene("newton-cradle");
  scene.options.gravity.setZero();
  for (int i = 0; i < 5; ++i) {
    Body ball =
        named_body("ball" + std::to_string(i), {i * (2 * kRadius + gap), 0, 0}, Circle{kRadius});
    ball.linear_velocity = {i < moving ? 1.0 : 0.0, 0, 0};
    ball.shapes.back().material = {.friction = 0, .restitution = 1};
    scene.add(ball);
  }
  return scene;
}

}  // namespace manyworlds::scenes
