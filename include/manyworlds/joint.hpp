// Joints: what holds two bodies of a scene together, or one to the world. Each has a frame on both
// bodies; where the joint is satisfied, they coincide or one is displaced along a coordinate
// of the joint. A hinge rotates about z of its frames, a slider slides along x.
//
// A coordinate (the angle of a hinge, rad; the travel of a slider, m; the length of a distance
// joint, m) is what B's frame has moved against A's. It may have a limit and a drive. Angles are
// between -pi and pi.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "manyworlds/compliance.hpp"
#include "manyworlds/ids.hpp"

namespace manyworlds {

// A place and axes on a body, or in the world.
struct Frame {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  Eigen::Quaternion<double, Eigen::DontAlign> rotation =
      Eigen::Quaternion<double, Eigen::DontAlign>::Identity();  // need not be unit
};

// A spring and damper along a coordinate, integrated implicitly: finite however stiff. Given either
// by stiffness and damping, or by frequency and damping ratio of the masses that the joint moves.
struct Spring {
  double stiffness = 0;      // N/m or N m/rad
  double damping = 0;        // N s/m or N m s/rad
  double frequency = 0;      // Hz
  double damping_ratio = 0;  // 1: critical
};

// Keeps a coordinate between two values; hard without a spring.
struct Limit {
  double low = 0, high = 0;  // m or rad
  std::optional<Spring> spring = {};
  // Of Solver::newton, whose limits have no spring: how soft it is, and from which distance on it
  // acts, m or rad.
  Compliance compliance = {};
  double margin = 0;
};

// Pulls a coordinate x with speed v by
//   spring stiffness (target_position - x) + spring damping (target_speed - v), |.| <= max_force.
// Without a spring it is a motor: it holds target_speed with whatever that takes up to max_force.
// Controls (control.hpp) give each world targets of its own.
struct Drive {
  double target_position = 0;  // m or rad
  double target_speed = 0;     // m/s or rad/s
  std::optional<Spring> spring = {};
  double max_force = std::numeric_limits<double>::infinity();  // N or N m
};

// The frames' origins coincide. Spatial. A twist has no meaning where z of B points against z of A:
// give it a cone, too, where bodies can lean that far.
struct BallJoint {
  std::optional<double> cone = {};  // rad, 0 to pi: the most that z of B leans from z of A
  std::optional<Limit> twist = {};  // rad, about z
  // Of Solver::newton, which takes neither of the above: of the angle of the whole rotation of B's
  // frame against A's, rad, 0 to pi. Its low is 0; a high beyond pi never acts.
  std::optional<Limit> limit = {};
};
// The frames' origins coincide, and in space their z axes, too.
struct HingeJoint {
  std::optional<Limit> limit = {};  // rad
  std::optional<Drive> drive = {};
};
// B's frame slides along x of A's and does not rotate against it.
struct SliderJoint {
  std::optional<Limit> limit = {};  // m
  std::optional<Drive> drive = {};
};
// The frames coincide.
struct FixedJoint {};
// The distance between the frames' origins: held at `length` when there is neither limit nor
// spring, drawn to it by the spring, kept within the limit (a rope: low 0).
struct DistanceJoint {
  std::optional<double> length = {};  // m; default: as the bodies begin
  std::optional<Limit> limit = {};
  std::optional<Spring> spring = {};
};
// B is a wheel: its frame moves along x of A's on a suspension and, in space, rotates about the
// common z axis only.
struct WheelJoint {
  Spring suspension = {};
  std::optional<Limit> travel = {};  // m, along x
  std::optional<Drive> drive = {};   // of the rotation about z
};
// A rope of constant length over two pulleys at ground_a and ground_b:
//   |A's origin - ground_a| + ratio |B's origin - ground_b| = length
struct PulleyJoint {
  Eigen::Vector3d ground_a = Eigen::Vector3d::Zero();  // m, world
  Eigen::Vector3d ground_b = Eigen::Vector3d::Zero();  // m, world
  double ratio = 1;
  std::optional<double> length = {};  // m; default: as the bodies begin
};
// Draws the origin of B's frame to that of A's, or to the point frame_a.position of the world.
struct TargetJoint {
  Spring spring = {};
  double max_force = std::numeric_limits<double>::infinity();  // N
};
using JointType = std::variant<BallJoint, HingeJoint, SliderJoint, FixedJoint, DistanceJoint,
                               WheelJoint, PulleyJoint, TargetJoint>;

// Of Solver::newton: what acts along each coordinate of a joint, and where its zero is.
struct JointDynamics {
  double armature = 0;  // kg m^2 or kg, inertia of the rotor
  double damping = 0;   // N m s/rad or N s/m
  // N m/rad or N/m. Of a hinge or slider it draws towards `rest`; of a ball joint to where the
  // frames coincide, by the shortest rotation.
  double stiffness = 0;
  double rest = 0;       // rad or m, of a hinge or slider
  double reference = 0;  // rad or m: the coordinate of a hinge or slider whose frames coincide
  bool operator==(const JointDynamics&) const = default;
};

struct Joint {
  std::string name = {};
  JointType type = HingeJoint{};
  BodyId body_a = {};  // none: the world
  BodyId body_b = {};
  Frame frame_a = {};    // in the body frame of A, or in the world
  Frame frame_b = {};    // in the body frame of B
  bool collide = false;  // whether shapes of A and B collide with each other, also once it broke
  // What it bears at most, as the mean over a step; then it breaks: Batch::joint_enabled() is false
  // from then on and Status::joint_broken is set. The torque is that about the frames' origin.
  double break_force = std::numeric_limits<double>::infinity();   // N
  double break_torque = std::numeric_limits<double>::infinity();  // N m
  // Of Solver::newton: a joint of the same A and B that this one comes after. The joints of such a
  // series hold frames without mass between A and B: each moves what the one before it moves, in
  // which its frame_a is, and the last one moves B. Hinges of a shoulder, one after the other.
  JointId after = {};
  JointDynamics dynamics = {};
};

// A length made of coordinates of hinges and sliders, each times its coefficient: a cord over
// pulleys (MuJoCo's fixed tendon). Of Solver::newton, which keeps it within its limit; one without
// a limit is only looked at (Observer::tendons).
struct TendonTerm {
  JointId joint = {};
  double coefficient = 1;  // m/rad or 1, or any unit that the limit is in
};
struct Tendon {
  std::string name = {};
  std::vector<TendonTerm> terms = {};
  std::optional<Limit> limit = {};
};

}  // namespace manyworlds
