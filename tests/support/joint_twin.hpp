// An independent solve of joints in double precision: the whole system of equations of bodies and
// joints at once, dense, with a Lagrange multiplier for every row.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

struct TwinBody {
  double mass = 1;
  Mat3 inertia = Mat3::Identity();  // world axes
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  Vec3 moments = Vec3::Ones();  // about its own axes
  Vec3 swept = Vec3::Zero();    // rad, dt times the mean of its angular velocities in the motion
};

// Ball joints, hinges, sliders, fixed and wheel joints, and springs of given lengths, between
// bodies that begin as the scene says, with drives that are springs and hard limits of ball joints;
// neither other limits nor bounds of drives.
class JointTwin {
 public:
  explicit JointTwin(const Scene& scene);

  // One step of dt, s, without substeps: velocities that close what is apart, bodies moved by them
  // and rotated with their angular momentum, velocities that keep what is left.
  void step(double dt);
  // As found by the last step before it moved the bodies; then as it left them.
  const std::vector<TwinBody>& closing() const { return closing_; }
  const std::vector<TwinBody>& bodies() const { return bodies_; }
  // Limits that acted in the first of its solves.
  int acting() const { return acting_; }

 private:
  struct Row {
    Eigen::VectorXd j;  // by velocities of all bodies
    double error = 0;
  };
  struct DriveRow {
    Eigen::VectorXd j;
    double stiffness = 0, push = 0, impulse = 0;  // impulse = push - stiffness j v
  };
  // j v is at least `least`, by an impulse of the step that is at least 0.
  struct LimitRow {
    Eigen::VectorXd j;
    double least = 0, before = 0;  // impulse so far
    bool acts = false;
  };
  std::vector<Row> rows() const;
  std::vector<LimitRow> limits(double dt, bool first) const;
  Vec3 anchor(BodyId body, const Frame& frame) const;
  Quat axes(BodyId body, const Frame& frame) const;
  // j += d . velocity of the point at `place` of a body, times sign.
  void add_point(Eigen::VectorXd& j, BodyId body, const Vec3& place, const Vec3& d,
                 double sign) const;
  void add_spin(Eigen::VectorXd& j, BodyId body, const Vec3& d, double sign) const;
  Eigen::VectorXd about(const Joint& joint, const Vec3& d) const;
  Eigen::VectorXd between(const Joint& joint) const;
  Eigen::VectorXd along(const Joint& joint, const Vec3& d) const;
  std::vector<Eigen::VectorXd> drive_axes() const;
  void find_drives(double dt);
  void solve(double dt, bool first);
  // Velocities of all bodies, with the limits that act; `impulse` of those.
  Eigen::VectorXd solve_with(const std::vector<LimitRow>& limits, double rate, bool first,
                             Eigen::VectorXd& impulse);

  Scene scene_;
  std::vector<TwinBody> bodies_, closing_;
  std::vector<DriveRow> drives_;
  std::vector<double> twist_;  // of each joint, when the step began
  std::vector<double> limit_impulses_;
  int acting_ = 0;
};

}  // namespace manyworlds::test
