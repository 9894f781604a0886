#include "tools/base/joint_gap.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

namespace manyworlds::tools {
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

  // A frame of a body (none: the world) in the world.
  Frame in_world(BodyId body, const Frame& frame) const {
    const auto row = body ? plan_.find_row(body) : std::nullopt;
    if (!row) return frame_in_world(plan_.scene(), body, frame);
    const auto b = static_cast<std::size_t>(*row);
    Vec3 x;
    Quat q;
    if (planar_) {
      x = {position_[2 * b], position_[2 * b + 1], 0};
      const double angle = std::atan2(orientation_[2 * b + 1], orientation_[2 * b]);
      q = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    } else {
      x = {position_[3 * b], position_[3 * b + 1], position_[3 * b + 2]};
      const double* o = &orientation_[4 * b];
      q = Quat(o[0], o[1], o[2], o[3]).normalized();
    }
    return {x + q * frame.position, q * frame.rotation.normalized()};
  }

 private:
  const Plan& plan_;
  bool planar_;
  std::vector<double> position_, orientation_;
};

// How far what a joint holds is from where it holds it, m.
double gap_of(const Scene& scene, const Poses& poses, const Joint& joint) {
  const Frame a = poses.in_world(joint.body_a, joint.frame_a),
              b = poses.in_world(joint.body_b, joint.frame_b);
  const Vec3 apart = b.position - a.position;
  const auto is = [&](auto type) { return std::holds_alternative<decltype(type)>(joint.type); };
  if (is(BallJoint{}) || is(HingeJoint{}) || is(FixedJoint{})) return apart.norm();
  if (is(SliderJoint{}) || is(WheelJoint{})) {
    return apart.cross(Vec3(a.rotation * Vec3::UnitX())).norm();
  }
  const Vec3 start_a = frame_in_world(scene, joint.body_a, joint.frame_a).position,
             start_b = frame_in_world(scene, joint.body_b, joint.frame_b).position;
  if (const auto* rod = std::get_if<DistanceJoint>(&joint.type)) {
    if (rod->limit || rod->spring) return 0;
    return std::abs(apart.norm() - rod->length.value_or((start_b - start_a).norm()));
  }
  if (const auto* rope = std::get_if<PulleyJoint>(&joint.type)) {
    const auto length = [&](const Vec3& at_a, const Vec3& at_b) {
      return (at_a - rope->ground_a).norm() + rope->ratio * (at_b - rope->ground_b).norm();
    };
    return std::abs(length(a.position, b.position) -
                    rope->length.value_or(length(start_a, start_b)));
  }
  return 0;
}

}  // namespace

double max_joint_gap(const Batch& batch) {
  double most = 0;
  for (int world = 0; world < batch.worlds(); ++world) {
    const Scene& scene = batch.plan(batch.kind_of(world)).scene();
    const std::vector<Joint>& joints = scene.joints;
    if (joints.empty() || frozen(batch.status(world))) continue;
    if (scene.options.solver.method == Solver::newton) continue;
    const Poses poses(batch, world);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!batch.joint_enabled(world, JointId(static_cast<int>(j)))) continue;
      most = std::max(most, gap_of(scene, poses, joints[j]));
    }
  }
  return most;
}

}  // namespace manyworlds::tools
