// A car with a sprung wheel at each corner on rough ground: the rear wheels have motors, the front
// ones turn on steering knuckles, which position drives hold at an angle.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {
namespace {

constexpr double kWheelRadius = 0.4;  // m
constexpr double kGrip = 0.9;         // friction of wheels and ground

// A cylinder rolls about z of its frame.
Shape wheel_shape() {
  Shape wheel = shape_of(Cylinder{kWheelRadius, 0.15});
  wheel.rotation = Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // z to -y
  wheel.density = 180;
  wheel.material.friction = kGrip;
  return wheel;
}

// Low hills, half-sunken logs across the track, and ramps under one wheel or the other.
Body rough_ground() {
  Body ground;
  ground.name = "rough ground";
  ground.motion = Motion::fixed;
  ground.shapes.push_back(shape_of(rough_field(101, 51, 2, 0.06)));
  ground.shapes[0].position.z() = -0.06;  // no hill is higher than 0
  for (int i = 0; i < 12; ++i) {
    Shape log = shape_of(Capsule{0.3, 3});
    log.position = {6 + 5.0 * i, 1.0 * (i % 3) - 1, -0.2};
    const double turn = 0.05 * (i % 5 - 2);  // sine of half its angle from straight across
    log.rotation = Quat(std::sqrt(1 - turn * turn), 0, 0, turn) *
                   Quat(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // z to -y
    ground.shapes.push_back(log);
    Shape ramp = shape_of(Box{{1, 0.6, 0.1}});
    ramp.position = {8.5 + 5.0 * i, i % 2 == 0 ? 0.9 : -0.9, 0};
    const double tilt = i % 4 < 2 ? -0.06 : 0.06;
    ramp.rotation = Quat(std::sqrt(1 - tilt * tilt), 0, tilt, 0);
    ground.shapes.push_back(ramp);
  }
  for (Shape& shape : ground.shapes) shape.material.friction = kGrip;
  return ground;
}

}  // namespace

Scene car3d() {
  Scene scene = spatial_scene("car3d");
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-100, -50, -2), Vec3(100, 50, 100));
  scene.options.substeps = 8;  // blows of logs pull its joints apart by 10 mm, with 4 by 25 mm
  scene.add(rough_ground());

  Body chassis = named_body("chassis", {0, 0, 0.72}, Box{{1.6, 0.4, 0.2}});
  chassis.jitter.position = {0.5, 0.2, 0};
  chassis.jitter.angle = 0.05;
  chassis.shapes.back().density = 300;
  const BodyId car = scene.add(chassis);

  const auto wheel_at = [&](const std::string& name, BodyId carrier, const Vec3& place,
                            bool driven) {
    Body wheel;
    wheel.name = name + " wheel";
    wheel.position = place;
    wheel.jitter.with = car;
    wheel.shapes.push_back(wheel_shape());
    const BodyId body = scene.add(wheel);
    // Gives way by 6 cm under the car's weight.
    WheelJoint joint{Spring{12000, 800, 0, 0}, Limit{-0.2, 0.2, std::nullopt}, std::nullopt};
    if (driven) joint.drive = Drive{0, 0, std::nullopt, 400};
    // x up, along which the wheel is sprung; z to the left, about which it turns.
    const Frame frame{place, Quat(0.5, -0.5, -0.5, -0.5)};
    return scene.add(joint_at(scene, carrier, body, frame, joint));
  };
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "rear left" : "rear right";
    const JointId joint = wheel_at(name, car, {-1.1, 0.85 * side, 0.42}, true);
    scene.controls.push_back(speed_of(name, joint, 30, 12));
  }
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "front left" : "front right";
    const Vec3 place(1.1, 0.85 * side, 0.42);
    Body knuckle = named_body(name + " knuckle", place, Sphere{0.2});
    knuckle.jitter.with = car;
    knuckle.shapes.back().filter.mask = 0;
    const BodyId body = scene.add(knuckle);
    const HingeJoint pivot{Limit{-0.6, 0.6, std::nullopt}, Drive{0, 0, Spring{0, 0, 8, 1}}};
    const JointId steering =
        scene.add(joint_at(scene, car, body, {place, Quat::Identity()}, pivot));
    wheel_at(name, body, place, false);
    Control angle = speed_of(name + " steering", steering, 0.5, 0);
    angle.kind = ControlKind::target_position;  // rad, positive to the left
    scene.controls.push_back(angle);
  }
  return scene;
}

}  // namespace manyworlds::scenes
