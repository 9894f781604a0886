#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {

Pose pose_of(const mjModel& m, int b) {
  return {vec3(m.body_pos + 3 * b), quat(m.body_quat + 4 * b)};
}

Pose pose_in(const mjModel& m, int b, int ancestor) {
  if (b == ancestor) return {};
  Pose pose = pose_of(m, b);
  for (b = m.body_parentid[b]; b != ancestor; b = m.body_parentid[b]) {
    pose = pose_of(m, b) * pose;
  }
  return pose;
}

Pose pose_in_root(const mjModel& m, int b) { return pose_in(m, b, m.body_weldid[b]); }

}  // namespace manyworlds::mjcf
