// Trees of joints under loads, for tests and reports. Gravity is 10 m/s^2.
#pragma once

#include <optional>

#include "scenes/builders.hpp"

namespace manyworlds::scenes {

// Adds rods of 1 kg and `length`, end to end from the origin along x; the last one weighs `load`.
inline void add_rods(Scene& scene, int rods, double length, double load, const JointType& type) {
  BodyId last;
  for (int i = 0; i < rods; ++i) {
    const double mass = i + 1 == rods ? load : 1;
    const BodyId rod =
        scene.add(uniform_rod(scene.space, mass, length, {(i + 0.5) * length, 0, 0}));
    const Frame frame{{i * length, 0, 0}, hinge_axes(scene.space)};
    scene.add(joint_at(scene, last, rod, frame, type));
    last = rod;
  }
}

// A plate of `mass` on legs of three welded links of 0.1 kg each, 1 cm above the ground: body 1, or
// the first with state.
inline Scene welded_table(Space space, double mass) {
  const bool flat = space == Space::planar;
  Scene scene = empty_scene(space, 10);
  scene.add(ground(space, 0.6));
  const Vec3 up = up_of(space), plate = flat ? Vec3(0.3, 0.05, 0) : Vec3(0.3, 0.3, 0.05),
             link = flat ? Vec3(0.02, 0.05, 0) : Vec3(0.02, 0.02, 0.05);
  const BodyId top = scene.add(solid_box(space, mass, plate, 0.36 * up, 0.6));
  for (int leg = 0; leg < (flat ? 2 : 4); ++leg) {
    const double y = flat ? 0 : ((leg & 2) != 0 ? 0.2 : -0.2);
    BodyId last = top;
    for (int i = 0; i < 3; ++i) {
      const Vec3 upper = Vec3((leg & 1) != 0 ? 0.2 : -0.2, y, 0) + (0.31 - 0.1 * i) * up;
      const BodyId id = scene.add(solid_box(space, 0.1, link, upper - 0.05 * up, 0.6));
      scene.add(joint_at(scene, last, id, frame_at(upper), FixedJoint{}));
      last = id;
    }
  }
  return scene;
}

// Bodies with state of `gripper`.
inline constexpr int kHand = 2, kGripped = 5;

// A hand with two fingers of 50 g on an arm of two driven links; they grip a box with 60 N.
inline Scene gripper(double mass) {
  Scene scene = empty_scene(Space::spatial, 10);
  const auto link = [&](double kg, const Vec3& half, const Vec3& place) {
    Body body = solid_box(Space::spatial, kg, half, place, 0.6);
    body.shapes[0].filter = {2, 4};
    return scene.add(body);
  };
  const auto hinge = [&](BodyId a, BodyId b, const Vec3& where) {
    const Drive drive{0, 0, Spring{2e4, 400, 0, 0}};
    scene.add(joint_at(scene, a, b, {where, z_to_y()}, HingeJoint{std::nullopt, drive}));
  };
  const BodyId upper = link(2, {0.25, 0.04, 0.04}, {0.25, 0, 1}),
               lower = link(1.5, {0.25, 0.03, 0.03}, {0.75, 0, 1}),
               hand = link(0.5, {0.03, 0.08, 0.02}, {1.03, 0, 1});
  hinge({}, upper, {0, 0, 1}), hinge(upper, lower, {0.5, 0, 1});
  scene.add(joint_at(scene, lower, hand, frame_at({1, 0, 1}), FixedJoint{}));
  const Quat along_y(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  for (const double side : {-1.0, 1.0}) {
    const BodyId finger = link(0.05, {0.01, 0.01, 0.05}, {1.03, side * 0.0401, 0.93});
    const Drive grip{-side * 0.05, 0, Spring{1e4, 50, 0, 0}, 60};
    scene.add(joint_at(scene, hand, finger, {{1.03, side * 0.0401, 0.98}, along_y},
                       SliderJoint{std::nullopt, grip}));
  }
  Body box = solid_box(Space::spatial, mass, {0.03, 0.03, 0.03}, {1.03, 0, 0.9}, 1);
  box.shapes[0].filter = {4, 2};
  scene.add(box);
  return scene;
}

}  // namespace manyworlds::scenes
