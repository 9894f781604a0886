// Poses of bodies, geoms and sites, from MuJoCo's arrays.
#pragma once

#include "manyworlds/scene.hpp"
#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::mjcf {

inline Vec3 vec3(const mjtNum* v) { return {v[0], v[1], v[2]}; }
// Both are (w, x, y, z).
inline Quat quat(const mjtNum* q) { return {q[0], q[1], q[2], q[3]}; }

struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
};
inline Pose operator*(const Pose& a, const Pose& b) {
  return {a.position + a.rotation * b.position, a.rotation * b.rotation};
}

// All at the reference, where each joint's coordinate is its `ref`: where the model is as written.

// Of body b in its parent.
Pose pose_of(const mjModel& m, int b);
// Of body b in one that it is inside of, or in itself; ancestor 0 is the world.
Pose pose_in(const mjModel& m, int b, int ancestor);
// Pose of body b in the frame of the body that it is welded to: the world for static bodies, the
// free body for its jointless children. Identity for the free body itself.
Pose pose_in_root(const mjModel& m, int b);

}  // namespace manyworlds::mjcf
