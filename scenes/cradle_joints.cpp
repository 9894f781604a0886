// Newton's cradle whose balls hang on rods of constant length, the first one raised. No friction,
// no loss at impacts; newton-cradle is the same without gravity.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene cradle_joints() {
  constexpr double kRadius = 0.5, kGap = 1e-3, kLength = 4;  // m
  constexpr double kSine = 0.5;                              // of the first ball's angle
  Scene scene = planar_scene("cradle-joints");
  // An impact is over within a substep; short steps keep the swing's energy.
  scene.options.dt = 1.0 / 240;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-10, -6, -1), Vec3(14, 6, 1));
  for (int i = 0; i < 5; ++i) {
    const double x = i * (2 * kRadius + kGap);
    const Vec3 place(x, -kLength, 0);
    const Vec3 raised(x - kLength * kSine, -kLength * std::sqrt(1 - kSine * kSine), 0);
    const BodyId ball =
        add_body(scene, "ball" + std::to_string(i), i == 0 ? raised : place, Circle{kRadius});
    Body& body = scene.bodies.back();
    body.shapes[0].material = {.friction = 0, .restitution = 1};
    if (i == 0) body.jitter.linear_velocity = {0.5, 0, 0};
    Joint rod;
    rod.name = "rod" + std::to_string(i);
    rod.type = DistanceJoint{kLength, std::nullopt, std::nullopt};
    rod.body_b = ball;
    rod.frame_a = frame_at(x, 0);
    scene.add(rod);
  }
  return scene;
}

}  // namespace manyworlds::scenes
