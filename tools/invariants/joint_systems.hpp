// Random trees and loops of bodies on joints, which touch nothing.
#pragma once

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

struct JointSystem {
  Space space = Space::spatial;
  int bodies = 2;
  double mass_ratio = 100;  // of the heaviest body to the lightest, at most
  bool loop = false;        // the first bodies are a ring, of at least four
  bool hung = false;        // the first body is on a joint with the world, and sliders have limits
};
Scene draw_joints(Random& kind, const Scale& scale, const JointSystem& system);

// Velocities that all joints allow. The fastest body moves by its size or turns by 1 rad in
// 1 / `spin`.
void set_moving(Random& state, Scene& scene, double spin);

// Where a joint's frames are, world.
struct JointFrames {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  Quat turn_a = Quat::Identity(), turn_b = Quat::Identity();
};
JointFrames frames_of(const Joint& joint, const std::vector<BodyNow>& bodies);
// The angle of a hinge, rad, or the travel of a slider, m.
double coordinate_of(const Joint& joint, const std::vector<BodyNow>& bodies);

}  // namespace manyworlds::invariants
