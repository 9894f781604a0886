// A car on two sprung wheels, its rear one driven, on a rough road.
#include <cmath>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kRoad = 200;  // m, its length
constexpr double kStep = 0.5;  // m, between two points of it

// Heights by square root and division only, which give the same bits with every mathematical
// library: bumps of 10 and 23 points, up to 0.3 m high.
double bump(int i, int period, double height) {
  const double x = 2.0 * (i % period) / period - 1;
  return height * (1 - x * x);
}

Terrain road() {
  Terrain out;
  const int points = static_cast<int>(kRoad / kStep);
  out.points.emplace_back(-10, 5);
  for (int i = 0; i <= points; ++i) {
    const double height = i < 16 ? 0 : bump(i, 10, 0.1) + bump(i, 23, 0.2);
    out.points.emplace_back(-8 + i * kStep, height);
  }
  out.points.emplace_back(kRoad - 6, 5);
  return out;
}

}  // namespace

Scene car2d() {
  Scene scene = planar_scene("car2d");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-12, -0.5, -1), Vec3(kRoad, 50, 1));
  Body ground;
  ground.name = "road";
  ground.motion = Motion::fixed;
  ground.shapes.push_back(shape_of(road()));
  ground.shapes.back().material.friction = 0.9;
  scene.add(ground);

  Body chassis;
  chassis.name = "chassis";
  chassis.position = {-5, 0.9, 0};
  chassis.jitter.position = {0.5, 0.1, 0};
  chassis.jitter.linear_velocity = {1, 0, 0};
  chassis.shapes.push_back(shape_of(
      Polygon{{{-1.5, -0.25}, {1.5, -0.25}, {1.5, 0.05}, {0.5, 0.45}, {-1.2, 0.5}, {-1.5, 0.1}}}));
  const BodyId car = scene.add(chassis);
  const double quarter_turn = std::sqrt(0.5);
  for (const double x : {-1.0, 1.0}) {
    Body wheel = named_body(x < 0 ? "rear wheel" : "front wheel",
                            chassis.position + Vec3(x, -0.45, 0), Circle{0.4});
    wheel.jitter.with = car;
    wheel.shapes.back().material.friction = 0.9;
    const BodyId body = scene.add(wheel);
    WheelJoint suspension{Spring{0, 0, 3, 0.5}, Limit{-0.25, 0.25, std::nullopt}, std::nullopt};
    if (x < 0) suspension.drive = Drive{0, -15, std::nullopt, 4};
    // The wheel moves along x of this frame: up.
    const Frame frame{wheel.position, Quat(quarter_turn, 0, 0, quarter_turn)};
    const JointId joint = scene.add(joint_at(scene, car, body, frame, suspension));
    if (x > 0) continue;
    Control throttle;
    throttle.name = "throttle";  // rad/s, positive forward
    throttle.kind = ControlKind::target_speed;
    throttle.joint = joint;
    throttle.low = -25, throttle.high = 25, throttle.initial = -15;
    scene.controls.push_back(throttle);
  }
  return scene;
}

}  // namespace manyworlds::scenes
