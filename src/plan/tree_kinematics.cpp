#include "src/plan/tree_kinematics.hpp"

namespace manyworlds {

namespace {

using kernels::TreeJointKind;

Vec3 vector_of(const double* v) { return {v[0], v[1], v[2]}; }
Quat rotation_of(const double* q) { return Quat(q[0], q[1], q[2], q[3]).normalized(); }

struct LinkPose {
  Quat rotation = Quat::Identity();
  Vec3 origin = Vec3::Zero();
};

class TreeMover {
 public:
  TreeMover(const PlanTrees& trees, std::span<const double> coordinates)
      : trees_(trees), q_(coordinates.data()) {}

  TreeKinematics find() {
    for (std::size_t i = 0; i < trees_.links.size(); ++i) add(trees_.links[i], i);
    return std::move(out_);
  }

 private:
  void add(const kernels::TreeLink<double>& link, std::size_t index) {
    LinkPose at;
    if (link.parent >= 0) at = poses_[static_cast<std::size_t>(link.parent)];
    at.origin += at.rotation * vector_of(link.position);
    at.rotation = at.rotation * rotation_of(link.rotation);
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      move(trees_.joints[static_cast<std::size_t>(j)], at);
    }
    // Those about the link's own axes are known when it is where it goes.
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      add_rotations(trees_.joints[static_cast<std::size_t>(j)], at);
    }
    at.rotation.normalize();
    poses_.push_back(at);
    out_.rotation.push_back(at.rotation);
    out_.origin.push_back(at.origin);
    const auto& numbers = trees_.link_numbers[index];
    out_.center.push_back(at.origin + at.rotation * vector_of(numbers.center));
  }

  void move(const kernels::TreeJoint<double>& joint, LinkPose& at) {
    const double* q = q_ + joint.coordinate;
    const Vec3 axis = at.rotation * vector_of(joint.axis);
    if (joint.kind == TreeJointKind::slide) {
      out_.motions.push_back({Vec3::Zero(), axis, Vec3::Zero()});
      at.origin += axis * (*q - joint.reference);
      return;
    }
    if (joint.kind == TreeJointKind::free) {
      at = {rotation_of(q + 3), vector_of(q)};
      for (int k = 0; k < 3; ++k) {
        out_.motions.push_back({Vec3::Zero(), Vec3::Unit(k), Vec3::Zero()});
      }
      out_.motions.resize(out_.motions.size() + 3);
      return;
    }
    const Vec3 point = at.origin + at.rotation * vector_of(joint.anchor);
    if (joint.kind == TreeJointKind::hinge) {
      out_.motions.push_back({axis, Vec3::Zero(), point});
      at.rotation =
          at.rotation * Quat(Eigen::AngleAxisd(*q - joint.reference, vector_of(joint.axis)));
    } else {
      out_.motions.resize(out_.motions.size() + 3, {Vec3::Zero(), Vec3::Zero(), point});
      at.rotation = at.rotation * rotation_of(q);
    }
    at.origin = point - at.rotation * vector_of(joint.anchor);
  }
  void add_rotations(const kernels::TreeJoint<double>& joint, const LinkPose& at) {
    if (kernels::dofs_of(joint.kind) == 1) return;
    const bool free = joint.kind == TreeJointKind::free;
    for (int k = 0; k < 3; ++k) {
      DofMotion& motion = out_.motions[static_cast<std::size_t>(joint.dof + (free ? 3 : 0) + k)];
      motion.axis = at.rotation * Vec3::Unit(k);
      // A slider that comes after a ball leaves its centre where it is.
      if (free) motion.point = at.origin;
    }
  }

  const PlanTrees& trees_;
  const double* q_;
  std::vector<LinkPose> poses_;
  TreeKinematics out_;
};

}  // namespace

TreeKinematics kinematics_of(const PlanTrees& trees, std::span<const double> coordinates) {
  return TreeMover(trees, coordinates).find();
}

std::vector<double> reference_coordinates(const PlanTrees& trees) {
  std::vector<double> out;
  for (const auto& link : trees.links) {
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      const auto& joint = trees.joints[static_cast<std::size_t>(j)];
      if (joint.kind == TreeJointKind::free) {
        out.insert(out.end(), link.position, link.position + 3);
        out.insert(out.end(), link.rotation, link.rotation + 4);
      } else if (joint.kind == TreeJointKind::ball) {
        out.insert(out.end(), {1, 0, 0, 0});
      } else {
        out.push_back(joint.reference);
      }
    }
  }
  return out;
}

}  // namespace manyworlds
