// The soft spring by which a page drags a body.
#pragma once

#include "manyworlds/batch.hpp"
#include "src/live/command.hpp"

namespace manyworlds::live {

struct Drag {
  int world = 0;
  BodyId body = {};
  Vec3 at = Vec3::Zero();  // m, body frame
  Vec3 to = Vec3::Zero();  // m, world

  // What follows from the body.
  double mass = 0;    // kg, of all that joints hang together with it; 0: nothing drags it
  double light = 0;   // kg, as which its point `at` answers a force where that is least
  double rate = 0;    // rad/s, of the spring, in steps that are short
  bool turns = true;  // false: the plan has no orientations; it is drawn along without turning
};
Drag make_drag(const KindOfWorlds& kind, int world, BodyId body, const Vec3& at);

// Adds the force of the spring to the next step() call, of `steps` steps.
//
// It is critically damped, and as stiff as makes the body, with all that joints hang on it, sag by
// a fifth of the body's radius under its weight, but not so stiff that a step() call is longer than
// a radian of it. Force and damping are those at the end of the call (implicit Euler), so that they
// do not overshoot however long it is.
void add_drag(Batch& batch, const KindOfWorlds& kind, const Drag& drag, int steps);

// Where a point of a body is in the world, m, and how fast, m/s.
struct PointMotion {
  Vec3 point = Vec3::Zero(), velocity = Vec3::Zero();
};
PointMotion motion_of(const Batch& batch, const KindOfWorlds& kind, int world, BodyId body,
                      const Vec3& at);

}  // namespace manyworlds::live
