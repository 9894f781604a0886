#include "tests/support/tree_twin.hpp"

namespace manyworlds::test {

namespace {

using kernels::TreeJointKind;

template <class Visit>  // visit(link, joint, first coordinate, first dof)
void for_each_joint(const std::vector<TwinLink>& links, Visit visit) {
  int coordinate = 0, dof = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (const NewTreeJoint& joint : links[i].joints) {
      visit(i, joint, coordinate, dof);
      coordinate += kernels::coordinates_of(joint.kind), dof += kernels::dofs_of(joint.kind);
    }
  }
}

Quat quaternion(const Eigen::VectorXd& q, int at) {
  return Quat(q[at], q[at + 1], q[at + 2], q[at + 3]).normalized();
}

// Another point of the same rigid frame, d from the one that `m` is about.
void shift(TwinMotion& m, const Vec3& d) {
  m.origin_acceleration += m.angular.cross(d) + m.spin.cross(m.spin.cross(d));
  m.origin_velocity += m.spin.cross(d);
  m.origin += d;
}

// Relative rotation r about the origin, with the relative velocity and acceleration in its axes.
void spin_by(TwinMotion& m, const Quat& r, const Vec3& velocity, const Vec3& acceleration) {
  m.rotation = m.rotation * r.toRotationMatrix();
  const Vec3 own = m.rotation * velocity;
  m.angular += m.rotation * acceleration + m.spin.cross(own);
  m.spin += own;
}

void apply(TwinMotion& m, const NewTreeJoint& joint, const Eigen::VectorXd& q,
           const Eigen::VectorXd& v, const Eigen::VectorXd& a, int c, int k) {
  const Vec3 axis = joint.axis.normalized();
  switch (joint.kind) {
    case TreeJointKind::slide: {
      const Vec3 u = m.rotation * axis;
      shift(m, u * (q[c] - joint.reference));
      m.origin_acceleration += u * a[k] + 2 * m.spin.cross(u) * v[k];
      m.origin_velocity += u * v[k];
      break;
    }
    case TreeJointKind::hinge:
      shift(m, m.rotation * joint.anchor);
      spin_by(m, Quat(Eigen::AngleAxisd(q[c] - joint.reference, axis)), axis * v[k], axis * a[k]);
      shift(m, -(m.rotation * joint.anchor));
      break;
    case TreeJointKind::ball:
      shift(m, m.rotation * joint.anchor);
      spin_by(m, quaternion(q, c), v.segment<3>(k), a.segment<3>(k));
      shift(m, -(m.rotation * joint.anchor));
      break;
    case TreeJointKind::free:
      m = {};
      m.origin = q.segment<3>(c);
      m.origin_velocity = v.segment<3>(k), m.origin_acceleration = a.segment<3>(k);
      spin_by(m, quaternion(q, c + 3), v.segment<3>(k + 3), a.segment<3>(k + 3));
  }
}

Mat3 moments(const TwinLink& link, const TwinMotion& m) {
  const Mat3 axes = m.rotation * link.frame.principal.toRotationMatrix();
  return axes * link.frame.moments.asDiagonal() * axes.transpose();
}

}  // namespace

int TreeTwin::dofs() const {
  int count = 0;
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int, int k) {
    count = k + kernels::dofs_of(j.kind);
  });
  return count;
}
int TreeTwin::coordinates() const {
  int count = 0;
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int c, int) {
    count = c + kernels::coordinates_of(j.kind);
  });
  return count;
}

std::vector<TwinMotion> TreeTwin::motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                         const Eigen::VectorXd& a) const {
  std::vector<TwinMotion> out;
  int c = 0, k = 0;
  for (const TwinLink& link : links_) {
    TwinMotion m;
    if (link.frame.parent >= 0) m = out[static_cast<std::size_t>(link.frame.parent)];
    shift(m, m.rotation * link.frame.position);
    m.rotation = m.rotation * link.frame.rotation.normalized().toRotationMatrix();
    for (const NewTreeJoint& joint : link.joints) {
      apply(m, joint, q, v, a, c, k);
      c += kernels::coordinates_of(joint.kind), k += kernels::dofs_of(joint.kind);
    }
    TwinMotion at_center = m;
    shift(at_center, m.rotation * link.frame.center);
    m.center = at_center.origin;
    m.velocity = at_center.origin_velocity, m.acceleration = at_center.origin_acceleration;
    out.push_back(m);
  }
  return out;
}

namespace {

// Velocities of links per unit velocity of each dof, [dof][link].
using Partials = std::vector<std::vector<TwinMotion>>;
Partials partials_of(const TreeTwin& twin, const Eigen::VectorXd& q) {
  const int n = twin.dofs();
  Partials out;
  for (int k = 0; k < n; ++k)
    out.push_back(twin.motion(q, Eigen::VectorXd::Unit(n, k), Eigen::VectorXd::Zero(n)));
  return out;
}

// Generalised forces of a moment and a force at the centre of mass of each link.
template <class Wrench>
Eigen::VectorXd project(const Partials& partials, std::size_t links, Wrench wrench) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(partials.size()));
  for (std::size_t i = 0; i < links; ++i) {
    const std::pair<Vec3, Vec3> w = wrench(i);
    for (std::size_t k = 0; k < partials.size(); ++k) {
      const TwinMotion& partial = partials[k][i];
      out[static_cast<Eigen::Index>(k)] +=
          w.first.dot(partial.spin) + w.second.dot(partial.velocity);
    }
  }
  return out;
}

}  // namespace

Eigen::MatrixXd TreeTwin::inertia(const Eigen::VectorXd& q) const {
  const int n = dofs();
  const Partials partials = partials_of(*this, q);
  Eigen::MatrixXd out(n, n);
  for (int k = 0; k < n; ++k) {
    const auto m = motion(q, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Unit(n, k));
    out.col(k) = project(partials, links_.size(), [&](std::size_t i) {
      return std::pair<Vec3, Vec3>(moments(links_[i], m[i]) * m[i].angular,
                                   links_[i].frame.mass * m[i].acceleration);
    });
  }
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int, int k) {
    for (int i = 0; i < kernels::dofs_of(j.kind); ++i) out(k + i, k + i) += j.armature;
  });
  return out;
}

Eigen::VectorXd TreeTwin::forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  const auto m = motion(q, v, Eigen::VectorXd::Zero(dofs()));
  Eigen::VectorXd out = project(partials_of(*this, q), links_.size(), [&](std::size_t i) {
    const Mat3 inertia = moments(links_[i], m[i]);
    const Vec3 rate = inertia * m[i].angular + m[i].spin.cross(inertia * m[i].spin);
    return std::pair<Vec3, Vec3>(
        links_[i].torque - rate,
        links_[i].force + links_[i].frame.mass * (gravity_ - m[i].acceleration));
  });
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int c, int k) {
    for (int i = 0; i < kernels::dofs_of(j.kind); ++i) out[k + i] -= j.damping * v[k + i];
    if (j.stiffness != 0) out[k] -= j.stiffness * (q[c] - j.rest);
  });
  return out;
}

Eigen::VectorXd TreeTwin::damping() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(dofs());
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int, int k) {
    for (int i = 0; i < kernels::dofs_of(j.kind); ++i) out[k + i] = j.damping;
  });
  return out;
}

double TreeTwin::energy(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  const auto m = motion(q, v, Eigen::VectorXd::Zero(dofs()));
  double out = 0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    out += links_[i].frame.mass * (0.5 * m[i].velocity.squaredNorm() - gravity_.dot(m[i].center)) +
           0.5 * m[i].spin.dot(moments(links_[i], m[i]) * m[i].spin);
  }
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int c, int k) {
    for (int i = 0; i < kernels::dofs_of(j.kind); ++i)
      out += 0.5 * j.armature * v[k + i] * v[k + i];
    out += 0.5 * j.stiffness * (q[c] - j.rest) * (q[c] - j.rest);
  });
  return out;
}

Eigen::VectorXd TreeTwin::advanced(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                   double dt) const {
  Eigen::VectorXd out = q;
  for_each_joint(links_, [&](auto, const NewTreeJoint& j, int c, int k) {
    if (kernels::coordinates_of(j.kind) == 1) {
      out[c] += dt * v[k];
      return;
    }
    if (j.kind == TreeJointKind::free) {
      out.segment<3>(c) += dt * v.segment<3>(k);
      c += 3, k += 3;
    }
    const Vec3 way = dt * v.segment<3>(k);
    const double angle = way.norm();
    const Vec3 axis = angle > 0 ? Vec3(way / angle) : Vec3::UnitX();
    const Quat to = quaternion(q, c) * Quat(Eigen::AngleAxisd(angle, axis));
    out.segment<4>(c) = Eigen::Vector4d(to.w(), to.x(), to.y(), to.z());
  });
  return out;
}

}  // namespace manyworlds::test
