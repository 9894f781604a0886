// What the kernels know of joints. A joint is one part or several that are solved one after the
// other, such as a swing (two axes stay parallel) and a point (two anchors coincide) for a hinge.
// All lanes have the same parts between the same bodies.
#pragma once

#include <cstdint>

namespace manyworlds::kernels {

// A and B are the bodies, z and x the axes of the joint's frames on them.
enum class PartKind : std::int32_t {
  point,     // the anchors coincide
  lock,      // the frames have the same axes
  swing,     // the z axes are parallel (space)
  line,      // B's anchor lies on the x axis of A
  slide,     // row along x of A
  angle,     // row about z, which both frames share
  twist,     // row about z of frames whose z axes may lean (space)
  cone,      // row for the angle between the z axes (space)
  distance,  // row between the anchors
  pulley,    // row for the length of the rope
};
// What the other parts of a row's joint hold: rotations (all, or those that lean the z axes against
// each other), and motions of the anchors (all, or those across x of A).
enum class TurnHold : std::int32_t { free, swing, lock };
enum class PointHold : std::int32_t { free, line, point };
// Stored per part: the impulse on B as a world vector, or of a row what holds or drives it, of its
// lower and of its upper limit.
inline constexpr int kPartImpulses = 3;

// Softness of a row with effective mass m = 1 / K, gap or error C and speed v:
//   lambda' = lambda - m' (v + bias_rate C + (K' - K) lambda),  m' = 1 / K',  K' = (1 + rho) K +
//   gamma
// rho comes from a frequency and damping ratio, gamma from a stiffness k and damping c: 1 / (h (c +
// h k)).
template <class T>
struct RowSoftness {
  T bias_rate, rho, gamma;
};

template <class T>
struct JointConstants {
  T anchor_a[3], anchor_b[3];  // from the centre of mass, principal axes, m; A the world: world
  T frame_a[4], frame_b[4];    // in principal axes; planar: cos, sin
  RowSoftness<T> soft;         // of what the part holds together
  T pull, angular_pull;        // max speed at which it corrects errors, m/s and rad/s
  T slack;                     // error of a tree's joint beyond which that is no maximum, m
  T rest;                      // value that an equality row is held at
  RowSoftness<T> drive_soft;
  T target_position, target_speed;
  T speed_share;  // of the target speed: c / (c + h k)
  T max_impulse;  // of the drive or of a soft point, N s or N m s in a substep
  RowSoftness<T> limit_soft;
  T low, high;
  T stiffness, damping;               // of a spring that is a force, N/m and N s/m
  T ground_a[3], ground_b[3], ratio;  // of a pulley
  T max_force, max_torque;            // that its joint bears in a step, N s and N m s
};

// Thrust or torque of a control on a body.
template <class T>
struct ThrustConstants {
  T point[3];      // from the centre of mass, principal axes, m
  T direction[3];  // unit, principal axes
};
struct ThrustTable {
  std::int32_t body, control;
  bool torque;
};

struct JointPart {
  PartKind kind;
  std::int32_t joint;           // of the scene
  std::int32_t body_a, body_b;  // state bodies; SceneConstants::bodies: the world
  bool equality;                // a row held at its rest
  bool drive, low, high;        // what else a row has
  bool springy;                 // its drive has a spring
  bool soft_limit;              // its limits are springs
  bool spring;                  // a point that is drawn with limited force
  bool force;                   // nothing but a spring, which the integrator of the plan evaluates
  TurnHold turn_hold;
  PointHold point_hold;
  bool direct;    // of a tree that is solved at once, not swept over
  bool attached;  // to a body of such a tree, without being part of it (direct/attached_rows.hpp)
  bool gradual;   // begins apart, and closes by its `pull`
  bool curved;    // closes where the rotation of its bodies takes it (motion/substep_rotation.hpp)
  std::int32_t position_control, speed_control;  // of its drive's targets; -1: the Plan's
};
// May its rows give energy to the bodies?
static inline constexpr bool gives_energy(const JointPart& p) {
  return !p.force && (p.drive || p.spring || p.soft_limit || p.gradual);
}

// The joint that a body of a tree hangs on (kernels/direct/), by its parts.
struct TreeEdge {
  std::int32_t child, parent;  // state bodies
  bool prescribed;             // the parent is the world, SceneConstants::bodies, or kinematic
  bool reversed;               // the child is A
  bool slides;                 // along x of A: `hold` is a line, else a point
  bool ball;                   // rotates freely in space
  std::int32_t hold;           // point or line
  std::int32_t turn;           // lock or swing; -1: of a ball joint, and of a hinge in the plane
  bool locked;                 // `turn` is a lock
  std::int32_t slide, angle;   // rows along x and about z that drive or limit it; -1: none
  std::int32_t cone;           // row that limits a ball joint; -1: none
};
// Joints that close the loops of what hangs together: edges between bodies that others hold
// already. `row`, `factor`: where its numbers begin.
struct JointLoops {
  std::int32_t first, end;  // among TreeEdge
  std::int32_t rows, row, factor;
  bool gradual;  // joints of what they close begin apart
};
// Edges follow those of their parents; those that close loops follow all of them.
struct JointTrees {
  std::int32_t edges, roots, bodies;
  std::int32_t closures;  // edges that close loops
  std::int32_t loops;
  std::int32_t loop_rows, loop_factors;  // of all loops
  std::int32_t parts;                    // that edges are made of
  std::int32_t attached;                 // other parts that act on bodies of trees
  bool bounded;                          // some edge has a drive or limits
  const TreeEdge* edge;
  const JointLoops* loop;
  const std::int32_t* root;     // bodies that hang on nothing
  const std::int32_t* body;     // all that trees move
  const std::int32_t* edge_of;  // [body] that it hangs on; -1: none
};

// A joint that may break; what it bears is with the constants of its parts, which follow one
// another.
struct BreakTable {
  std::int32_t joint, first_part, parts;
};

// A coordinate of a joint, for observers. Its frames are those of any part of the joint.
struct JointCoordinate {
  JointPart what;
  std::int32_t part;
};

}  // namespace manyworlds::kernels
