// Inverse weights of dofs and links, from a dense joint-space inertia at the reference.
#include <Eigen/Dense>

#include "src/plan/tree_kinematics.hpp"

namespace manyworlds {

namespace {

class Weights {
 public:
  Weights(const PlanTrees& trees, const std::vector<NewLink>& links)
      : trees_(trees),
        links_(links),
        at_(kinematics_of(trees, reference_coordinates(trees))),
        dofs_(static_cast<Eigen::Index>(trees.dofs.size())) {}

  TreeWeights find() const {
    TreeWeights out;
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(dofs_, dofs_);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Eigen::MatrixXd j = jacobian(i);
      const Mat3 axes = (at_.rotation[i] * links_[i].principal.normalized()).toRotationMatrix();
      const Mat3 inertia = axes * links_[i].moments.asDiagonal() * axes.transpose();
      m += links_[i].mass * j.topRows<3>().transpose() * j.topRows<3>();
      m += j.bottomRows<3>().transpose() * inertia * j.bottomRows<3>();
    }
    for (Eigen::Index k = 0; k < dofs_; ++k) {
      m(k, k) += trees_.dof_numbers[static_cast<std::size_t>(k)].armature;
    }
    if (dofs_ > 0) out.mean_inertia = m.diagonal().mean();
    const Eigen::MatrixXd inverse = m.ldlt().solve(Eigen::MatrixXd::Identity(dofs_, dofs_));
    out.inverse = inverse;
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
  // Of a link's centre of mass: velocity, then angular velocity.
  Eigen::MatrixXd jacobian(std::size_t link) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(6, dofs_);
    for_each_dof_of(trees_, link, [&](std::size_t k) {
      const DofMotion& motion = at_.motions[k];
      out.col(static_cast<Eigen::Index>(k)) << motion.velocity(at_.center[link]), motion.axis;
    });
    return out;
  }

  const PlanTrees& trees_;
  const std::vector<NewLink>& links_;
  TreeKinematics at_;
  Eigen::Index dofs_;
};

}  // namespace

TreeWeights weights_of(const PlanTrees& trees, const std::vector<NewLink>& links) {
  return Weights(trees, links).find();
}

}  // namespace manyworlds
