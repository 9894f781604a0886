// The break of a pool game seen from above: 15 balls racked, a cue ball at 8 m/s, four cushions.
#include <cmath>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene billiards() {
  constexpr double kRadius = 0.028575;    // m, 2.25 inch balls
  constexpr double kBallMass = 0.17;      // kg
  constexpr double kHalfLength = 1.27;    // m, playing surface of a 9-foot table
  constexpr double kHalfWidth = 0.635;    // m
  constexpr double kGap = 0.0005;         // m, between racked balls
  constexpr double kRackJitter = 0.0001;  // m; closes no gap
  const Material material{0.05, 0.95};

  Scene scene = planar_scene("billiards");
  scene.options.gravity.setZero();
  scene.options.density = kBallMass / (kPi * kRadius * kRadius);
  // In 1/60 s the cue ball would cross half the rack before it is looked at again.
  scene.options.dt = 1.0 / 240.0;
  scene.options.bounds =
      Eigen::AlignedBox3d(Vec3(-kHalfLength - kRadius, -kHalfWidth - kRadius, -1),
                          Vec3(kHalfLength + kRadius, kHalfWidth + kRadius, 1));

  Body table;
  table.name = "table";
  table.motion = Motion::fixed;
  for (const HalfPlane& cushion :
       {HalfPlane{{1, 0}, -kHalfLength}, HalfPlane{{-1, 0}, -kHalfLength},
        HalfPlane{{0, 1}, -kHalfWidth}, HalfPlane{{0, -1}, -kHalfWidth}}) {
    table.shapes.push_back(shape_of(cushion));
    table.shapes.back().material = material;
  }
  scene.add(table);

  Body ball;
  ball.shapes.push_back(shape_of(Circle{kRadius}));
  ball.shapes.back().material = material;
  ball.linear_drag = 0.2;
  ball.angular_drag = 0.2;
  ball.jitter.position = {kRackJitter, kRackJitter, 0};

  // The apex stands on the foot spot, rows follow away from the cue ball.
  const double pitch = 2 * kRadius + kGap;
  int number = 1;
  for (int row = 0; row < 5; ++row) {
    for (int k = 0; k <= row; ++k) {
      ball.name = "ball" + std::to_string(number++);
      ball.position = {kHalfLength / 2 + row * pitch * std::sqrt(0.75), (k - row / 2.0) * pitch, 0};
      scene.add(ball);
    }
  }
  ball.name = "cue ball";
  ball.position = {-kHalfLength / 2, 0, 0};
  ball.linear_velocity = {8, 0, 0};
  ball.jitter.linear_velocity = {0.1, 0.02, 0};
  scene.add(ball);
  return scene;
}

}  // namespace manyworlds::scenes
