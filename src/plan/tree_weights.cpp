// Inverse weights of dofs and links, from a dense joint-space inertia at the reference.
#include <Eigen/Dense>

#include "src/plan/trees.hpp"

namespace manyworlds {

namespace {

using kernels::TreeJointKind;

struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
};
Vec3 vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }
Quat rotation(const double (&q)[4]) { return Quat(q[0], q[1], q[2], q[3]); }

// How fast the dof moves a point, and rotates.
struct DofMotion {
  Vec3 axis = Vec3::Zero(), direction = Vec3::Zero(), point = Vec3::Zero();
  Vec3 velocity(const Vec3& at) const { return direction + axis.cross(at - point); }
};

class Weights {
 public:
  Weights(const PlanTrees& trees, const std::vector<NewLink>& links)
      : trees_(trees), links_(links), dofs_(static_cast<Eigen::Index>(trees.dofs.size())) {
    for (const auto& link : trees_.links) add(link);
  }

  TreeWeights find() const {
    TreeWeights out;
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(dofs_, dofs_);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Eigen::MatrixXd j = jacobian(i);
      const Mat3 axes = poses_[i].rotation * links_[i].principal.normalized().toRotationMatrix();
      const Mat3 inertia = axes * links_[i].moments.asDiagonal() * axes.transpose();
      m += links_[i].mass * j.topRows<3>().transpose() * j.topRows<3>();
      m += j.bottomRows<3>().transpose() * inertia * j.bottomRows<3>();
    }
    for (Eigen::Index k = 0; k < dofs_; ++k) {
      m(k, k) += trees_.dofs[static_cast<std::size_t>(k)].armature;
    }
    if (dofs_ > 0) out.mean_inertia = m.diagonal().mean();
    const Eigen::MatrixXd inverse = m.ldlt().solve(Eigen::MatrixXd::Identity(dofs_, dofs_));
    const Eigen::VectorXd diagonal = inverse.diagonal();
    out.dof.assign(diagonal.data(), diagonal.data() + dofs_);
    for (const auto& joint : trees_.joints) {
      const int count = kernels::dofs_of(joint.kind);
      for (int first = 0; first < count && count > 1; first += 3) {
        const double mean = diagonal.segment<3>(joint.dof + first).mean();
        for (int k = 0; k < 3; ++k) out.dof[static_cast<std::size_t>(joint.dof + first + k)] = mean;
      }
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Eigen::MatrixXd j = jacobian(i);
      const Eigen::Matrix<double, 6, 1> a = (j * inverse * j.transpose()).diagonal();
      out.link.push_back({a.head<3>().mean(), a.tail<3>().mean()});
    }
    return out;
  }

 private:
  void add(const kernels::TreeLink<double>& link) {
    Pose at;
    if (link.parent >= 0) at = poses_[static_cast<std::size_t>(link.parent)];
    at.origin += at.rotation * vector(link.position);
    at.rotation = at.rotation * rotation(link.rotation).toRotationMatrix();
    poses_.push_back(at);
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      const auto& joint = trees_.joints[static_cast<std::size_t>(j)];
      const Vec3 axis = at.rotation * vector(joint.axis);
      const Vec3 point = at.origin + at.rotation * vector(joint.anchor);
      switch (joint.kind) {
        case TreeJointKind::slide: motions_.push_back({Vec3::Zero(), axis, point}); break;
        case TreeJointKind::hinge: motions_.push_back({axis, Vec3::Zero(), point}); break;
        case TreeJointKind::free:
          for (int k = 0; k < 3; ++k) motions_.push_back({Vec3::Zero(), Vec3::Unit(k), point});
          for (int k = 0; k < 3; ++k) {
            motions_.push_back({at.rotation.col(k), Vec3::Zero(), at.origin});
          }
          break;
        case TreeJointKind::ball:
          for (int k = 0; k < 3; ++k) motions_.push_back({at.rotation.col(k), Vec3::Zero(), point});
      }
    }
  }

  // Of a link's centre of mass: velocity, then angular velocity.
  Eigen::MatrixXd jacobian(std::size_t link) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6, dofs_);
    const Vec3 center = poses_[link].origin + poses_[link].rotation * links_[link].center;
    int i = static_cast<int>(link);
    for (; i >= 0; i = trees_.links[static_cast<std::size_t>(i)].parent) {
      const auto& l = trees_.links[static_cast<std::size_t>(i)];
      for (int k = l.first_dof; k < l.first_dof + l.dofs; ++k) {
        const DofMotion& motion = motions_[static_cast<std::size_t>(k)];
        out.col(k) << motion.velocity(center), motion.axis;
      }
    }
    return out;
  }

  const PlanTrees& trees_;
  const std::vector<NewLink>& links_;
  Eigen::Index dofs_;
  std::vector<Pose> poses_;
  std::vector<DofMotion> motions_;
};

}  // namespace

TreeWeights weights_of(const PlanTrees& trees, const std::vector<NewLink>& links) {
  return Weights(trees, links).find();
}

}  // namespace manyworlds
