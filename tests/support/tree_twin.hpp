// Trees by other equations than the kernels': positions, velocities and accelerations of every link
// in classical vectors, and Kane's equations. In double precision.
#pragma once

#include <vector>

#include "src/plan/trees.hpp"

namespace manyworlds::test {

struct TwinLink {
  NewLink frame;
  double mass = 1;
  Vec3 moments = Vec3::Ones();                       // about the principal axes
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // inputs: at the centre of mass, world
  std::vector<NewTreeJoint> joints;
};

// Of a link's centre of mass; rotation and velocities of the link.
struct TwinMotion {
  Mat3 rotation = Mat3::Identity();
  Vec3 origin = Vec3::Zero(), center = Vec3::Zero();
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // v of the centre
  Vec3 acceleration = Vec3::Zero(), angular = Vec3::Zero();
  Vec3 origin_velocity = Vec3::Zero(), origin_acceleration = Vec3::Zero();
};

class TreeTwin {
 public:
  TreeTwin(std::vector<TwinLink> links, const Vec3& gravity)
      : links_(std::move(links)), gravity_(gravity) {}

  int dofs() const;
  int coordinates() const;
  const std::vector<TwinLink>& links() const { return links_; }

  using Numbers = Eigen::VectorXd;
  std::vector<TwinMotion> motion(const Numbers& q, const Numbers& v, const Numbers& a) const;
  Eigen::MatrixXd inertia(const Numbers& q) const;           // of the joint space
  Numbers forces(const Numbers& q, const Numbers& v) const;  // M a = forces
  Numbers damping() const;
  // Kinetic, of gravity and of springs.
  double energy(const Numbers& q, const Numbers& v) const;
  // The coordinates after v for dt.
  Numbers advanced(const Numbers& q, const Numbers& v, double dt) const;

 private:
  std::vector<TwinLink> links_;
  Vec3 gravity_;
};

}  // namespace manyworlds::test
