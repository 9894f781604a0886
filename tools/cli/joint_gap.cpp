#include "joint_gap.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace manyworlds::cli {
namespace {

class Poses {
 public:
  Poses(const Batch& batch, int world)
      : plan_(batch.plan(batch.kind_of(world))), planar_(plan_.scene().space == Space::planar) {
    const auto bodies = static_cast<std::size_t>(plan_.bodies());
    position_.resize(bodies * (planar_ ? 2 : 3));
    orientation_.resize(bodies * (planar_ ? 2 : 4));
    batch.read(Field::position, world, position_);
    batch.read(Field::orientation, world, orientation_);
  }

  // A frame of a scene body (-1: the world) in the world.
  Frame in_world(int scene_body, const Frame& frame) const {
    if (scene_body < 0) return frame;
    const Body& body = plan_.scene().bodies[static_cast<std::size_t>(scene_body)];
    Vec3 x = body.position;
    Quat q = body.rotation.normalized();
    const int state_body = plan_.state_body(scene_body);
    if (state_body >= 0) {
      const auto b = static_cast<std::size_t>(state_body);
      if (planar_) {
        x = {position_[2 * b], position_[2 * b + 1], 0};
        const double angle = std::atan2(orientation_[2 * b + 1], orientation_[2 * b]);
        q = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
      } else {
        x = {position_[3 * b], position_[3 * b + 1], position_[3 * b + 2]};
        const double* o = &orientation_[4 * b];
        q = Quat(o[0], o[1], o[2], o[3]).normalized();
      }
    }
    return {x + q * frame.position, q * frame.rotation.normalized()};
  }

 private:
  const Plan& plan_;
  bool planar_;
  std::vector<double> position_, orientation_;
};

double gap_of(const Poses& poses, const Joint& joint) {
  const Frame a = poses.in_world(joint.body_a, joint.frame_a),
              b = poses.in_world(joint.body_b, joint.frame_b);
  const Vec3 apart = b.position - a.position;
  const auto is = [&](auto type) { return std::holds_alternative<decltype(type)>(joint.type); };
  if (is(BallJoint{}) || is(HingeJoint{}) || is(FixedJoint{})) return apart.norm();
  if (is(SliderJoint{}) || is(WheelJoint{})) {
    return apart.cross(Vec3(a.rotation * Vec3::UnitX())).norm();
  }
  return 0;
}

}  // namespace

double max_joint_gap(const Batch& batch) {
  double most = 0;
  for (int world = 0; world < batch.worlds(); ++world) {
    const std::vector<Joint>& joints = batch.plan(batch.kind_of(world)).scene().joints;
    if (joints.empty() || frozen(batch.status(world))) continue;
    const Poses poses(batch, world);
    for (const Joint& joint : joints) most = std::max(most, gap_of(poses, joint));
  }
  return most;
}

}  // namespace manyworlds::cli
