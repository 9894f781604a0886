#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {

Pose pose_in_root(const mjModel& m, int b) {
  Pose pose;
  for (const int root = m.body_weldid[b]; b != root; b = m.body_parentid[b]) {
    pose = Pose{vec3(m.body_pos + 3 * b), quat(m.body_quat + 4 * b)} * pose;
  }
  return pose;
}

}  // namespace manyworlds::mjcf
