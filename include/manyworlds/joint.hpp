// Joints connect two bodies, or one body and the world. A joint has a frame on each body. The joint
// is satisfied if the frames coincide, or differ only along a coordinate of the joint. A hinge
// rotates about z of its frames, a slider slides along x.
//
// A coordinate is the motion of B's frame relative to A's: the angle of a hinge in rad, the travel
// of a slider in m, the length of a distance joint in m. It may have a limit and a drive. Angles
// are between -pi and pi.
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

// A position and axes on a body, or in the world.
struct Frame {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  Eigen::Quaternion<double, Eigen::DontAlign> rotation =
      Eigen::Quaternion<double, Eigen::DontAlign>::Identity();  // need not be unit
};

// A spring and damper along a coordinate, integrated implicitly. Set either stiffness and damping,
// or frequency and damping ratio; the latter use the mass that the joint moves.
struct Spring {
  double stiffness = 0;      // N/m or N m/rad
  double damping = 0;        // N s/m or N m s/rad
  double frequency = 0;      // Hz
  double damping_ratio = 0;  // 1: critical
};

// Keeps a coordinate between two values. Without a spring the limit is hard.
struct Limit {
  double low = 0, high = 0;  // m or rad
  std::optional<Spring> spring = {};
  // Solver::newton only, whose limits have no spring: softness, and the distance from the limit at
  // which it starts to act, m or rad.
  Compliance compliance = {};
  double margin = 0;
};

// Acts on a coordinate x of speed v with the force
//   spring stiffness (target_position - x) + spring damping (target_speed - v), |.| <= max_force.
// Without a spring it is a motor, which holds target_speed with a force up to max_force. Controls
// (control.hpp) set the targets of each world.
struct Drive {
  double target_position = 0;  // m or rad
  double target_speed = 0;     // m/s or rad/s
  std::optional<Spring> spring = {};
  double max_force = std::numeric_limits<double>::infinity();  // N or N m
};

// The frames' origins coincide. Spatial. The twist is undefined where z of B is opposite to z of A:
// set a cone, too, if the bodies can reach that attitude.
struct BallJoint {
  std::optional<double> cone = {};  // rad, 0 to pi: largest angle between z of B and z of A
  std::optional<Limit> twist = {};  // rad, about z
  // Solver::newton only, which supports neither cone nor twist: limit of the rotation angle of B's
  // frame relative to A's, rad, 0 to pi. Its low is 0. A high above pi never acts.
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
// The distance between the frames' origins. Without limit and spring it is fixed at `length`. A
// spring pulls it to `length`. A limit bounds it: a rope has low 0.
struct DistanceJoint {
  std::optional<double> length = {};  // m; default: the distance at the start
  std::optional<Limit> limit = {};
  std::optional<Spring> spring = {};
};
// B is a wheel: its frame moves along x of A's on a suspension and, in space, rotates about the
// common z axis only.
struct WheelJoint {
  Spring suspension = {};
  std::optional<Limit> travel = {};  // m, along x
  std::optional<Drive> drive = {};   // drives the rotation about z
};
// A rope of constant length over two pulleys at ground_a and ground_b:
//   |A's origin - ground_a| + ratio |B's origin - ground_b| = length
struct PulleyJoint {
  Eigen::Vector3d ground_a = Eigen::Vector3d::Zero();  // m, world
  Eigen::Vector3d ground_b = Eigen::Vector3d::Zero();  // m, world
  double ratio = 1;
  std::optional<double> length = {};  // m; default: the length at the start
};
// Pulls the origin of B's frame to the origin of A's, or to the point frame_a.position of the
// world.
struct TargetJoint {
  Spring spring = {};
  double max_force = std::numeric_limits<double>::infinity();  // N
};
using JointType = std::variant<BallJoint, HingeJoint, SliderJoint, FixedJoint, DistanceJoint,
                               WheelJoint, PulleyJoint, TargetJoint>;

// Solver::newton only: passive forces along each coordinate of a joint, and its zero.
struct JointDynamics {
  double armature = 0;  // kg m^2 or kg, rotor inertia
  double damping = 0;   // N m s/rad or N s/m
  // N m/rad or N/m. Pulls a hinge or slider to `rest`, and a ball joint to coinciding frames along
  // the shortest rotation.
  double stiffness = 0;
  double rest = 0;       // rad or m, hinge and slider
  double reference = 0;  // rad or m, hinge and slider: the coordinate where the frames coincide
  bool operator==(const JointDynamics&) const = default;
};

struct Joint {
  std::string name = {};
  JointType type = HingeJoint{};
  BodyId body_a = {};  // none: the world
  BodyId body_b = {};
  Frame frame_a = {};    // in the body frame of A, or in the world
  Frame frame_b = {};    // in the body frame of B
  bool collide = false;  // whether shapes of A and B collide, also after the joint breaks
  // Breaking load, compared with the mean load over a step. The torque is about the frames' origin.
  // A joint that breaks sets Status::joint_broken, and Batch::joint_enabled() becomes false.
  double break_force = std::numeric_limits<double>::infinity();   // N
  double break_torque = std::numeric_limits<double>::infinity();  // N m
  // Solver::newton only: the joint of the same A and B that precedes this one. Joints in series
  // have massless frames between A and B, as the hinges of a shoulder. Each joint's frame_a is in
  // the frame that the preceding joint moves. The last joint moves B.
  JointId after = {};
  JointDynamics dynamics = {};
};

// A linear combination of coordinates of hinges and sliders (MuJoCo's fixed tendon). Solver::newton
// only, which keeps its length within the limit. A tendon without a limit has no effect on the
// motion; Observer::tendons reads its length.
struct TendonTerm {
  JointId joint = {};
  double coefficient = 1;  // m/rad or 1, or any unit that matches the limit
};
struct Tendon {
  std::string name = {};
  std::vector<TendonTerm> terms = {};
  std::optional<Limit> limit = {};
};

}  // namespace manyworlds
