// Trees: bodies in joint coordinates. A link is a body with state; it moves against its parent, or
// the world, by its joints, one after the other. A degree of freedom (dof) is one number of the
// velocities; a coordinate one of the positions, of which free and ball joints have one more.
//
// Coordinates and velocities are MuJoCo's: a free joint has the origin of the link's frame in the
// world and its rotation (w, x, y, z), then the velocity of that origin in world axes and the
// angular velocity in the link's axes; a ball joint has a rotation and an angular velocity in the
// link's axes; hinges and slides have an angle, rad, or a travel, m. The reference is the pose at
// which the coordinates of hinges and slides are their references and balls do not rotate.
#pragma once

#include <cstdint>

namespace manyworlds::kernels {

enum class TreeJointKind : std::int32_t { free, ball, hinge, slide };
static inline constexpr int dofs_of(TreeJointKind kind) {
  return kind == TreeJointKind::free ? 6 : kind == TreeJointKind::ball ? 3 : 1;
}
static inline constexpr int coordinates_of(TreeJointKind kind) {
  return kind == TreeJointKind::free ? 7 : kind == TreeJointKind::ball ? 4 : 1;
}

// Parents come before their children, and the links of a tree follow one another.
template <class Real>
struct TreeLink {
  std::int32_t body;    // its row among bodies with state
  std::int32_t parent;  // link; -1: the world
  std::int32_t root;    // of its tree
  std::int32_t first_joint, joints;
  std::int32_t first_dof, dofs;          // of its own joints
  std::int32_t last_dof;                 // on the way from the world; -1: none
  std::int32_t first_child, next_child;  // links; the next one with the same parent; -1: none
  bool moves_freely;                     // and nothing is jointed to it
  Real position[3], rotation[4];         // of its frame in the parent's at the reference
};

// Of a link what sizes of shapes may change from world to world (kernels/data/tables.hpp).
template <class T>
struct LinkConstants {
  T center[3], principal[4];  // centre of mass and principal axes in its frame
};

template <class Real>
struct TreeJoint {
  TreeJointKind kind;
  std::int32_t coordinate, dof;  // the first ones
  Real anchor[3], axis[3];       // in the link's frame at the reference; the axis is unit
  Real reference;                // of a hinge or slide
};

struct TreeDof {
  std::int32_t link;
  std::int32_t parent;      // the dof before it on the way to the root; -1: none
  std::int32_t depth;       // how many those are
  std::int32_t entry;       // its row of the inertia matrix: itself, its parent, and so on
  std::int32_t coordinate;  // of a hinge or slide
  bool sprung;              // a hinge or slide that has a spring, in some world
};

// Numbers of a dof that may differ from world to world.
template <class T>
struct DofConstants {
  T armature;   // kg m^2 or kg
  T damping;    // N m s/rad or N s/m
  T stiffness;  // N m/rad or N/m; of the first dof of a ball joint that of the joint
  T rest;       // rad or m, of a hinge or slide
};

// How soft a row is (MuJoCo's solref and solimp; src/plan/compliance.hpp): with the violation r and
// the impedance d(r), the reference acceleration is -damping J v - stiffness d(r) r, and the
// regularisation R = (1 - d) / d times the row's inverse inertia.
template <class T>
struct Compliance {
  T stiffness, damping;     // 1/s^2, 1/s
  T least, gain;            // d = least + gain y(|r| inverse_width)
  T inverse_width, middle;  // y = rising x^power up to the middle, then the same from the end
  T rising, falling;        // the power is the row's, of all worlds
};
// Where a limit ends, and how soft it is.
template <class T>
struct LimitConstants {
  T end;  // rad or m, or what a tendon is in
  Compliance<T> compliance;
};

// A length stays on one side of its end: side 1 above, -1 below. It is the coordinate of a hinge or
// slide, or the sum of several, each times its coefficient (a fixed tendon).
template <class Real>
struct TreeLimit {
  Real side;
  Real margin;          // rad or m, where the row begins
  Real inverse_weight;  // J M^-1 J' at the reference
  std::int32_t power;   // of its compliance
  std::int32_t first_term, terms;
  std::uint64_t coupled;  // its dofs
};
template <class Real>
struct TreeTerm {
  std::int32_t coordinate, dof;  // in a limit the last dof first
  Real coefficient;
};

// The angle of a ball joint's rotation stays below its end. Its constants follow those of limits.
template <class Real>
struct TreeBallLimit {
  std::int32_t coordinate, dof;  // the first ones
  Real margin;                   // rad, where the row begins
  Real inverse_weight;           // of M^-1 at the reference, the mean over the joint's dofs
  std::int32_t power;            // of its compliance
};
// A torque that draws a ball joint to where its rotation is none.
struct TreeBallSpring {
  std::int32_t coordinate, dof;  // the first ones
};

// A force along a hinge's or slide's coordinate (Actuator in manyworlds/control.hpp).
struct TreeActuator {
  std::int32_t control, coordinate, dof;
};
template <class T>
struct ActuatorConstants {
  T gain[3], bias[3];
  T gear;
  T low, high;  // N or N m, before the gear
};

// What friction may do at a contact, and the rows of it: the normal; the edges of a pyramid; the
// normal and two tangents, within a round cone.
enum class ContactCone : std::int32_t { frictionless, pyramidal, elliptic };

// Contacts of two shapes (SoftContact in manyworlds/shape.hpp).
template <class Real>
struct TreePair {
  std::int32_t link_a, link_b;  // -1: the world
  std::int32_t only_link;       // the one of them that has dofs on its way; -1: both have
  ContactCone cone;
  std::int32_t material_a, material_b;  // whose friction counts: the larger one, or one twice
  Real margin;                          // m, separation below which a contact acts
  Real inverse_weight;                  // of the rows
  Real friction_weight;                 // times the square of the friction, added to that
  std::int32_t compliance, power;       // which one of the plan's; its power
  // The dofs that move one link against the other, the last one first: ~dof where they move A.
  std::int32_t first_dof, dofs;
  std::uint64_t coupled;  // those
};

// Drag of a medium on a link, about its principal axes (Medium in manyworlds/options.hpp): force
// -(viscous + speed |v|) v of the centre of mass, moment -(spin_viscous + spin |w|) w.
template <class T>
struct DragConstants {
  T viscous, spin_viscous;  // N s/m, N m s/rad
  T speed[3], spin[3];      // kg/m, kg m^2
};

// Dofs of a plan of trees, at most: sets of them are bits.
inline constexpr int kMaxTreeDofs = 64;

// How the newton solver stops (src/plan/trees.hpp).
template <class Real>
struct NewtonOptions {
  std::int32_t iterations, line_iterations;
  Real tolerance, line_tolerance;
  Real scale;  // 1 / (mean inertia max(1, dofs)): of gradients
};

template <class Real>
struct TreeTable {
  std::int32_t links, dofs, coordinates;
  std::int32_t entries;  // of the inertia matrix
  // Some forces of velocities are implicit: dampers of dofs, and with `implicit` actuators, too.
  bool damped, implicit;
  std::int32_t stages;  // of the integrator: 1, or 4 of Runge-Kutta
  // Newton steps by links (kernels/tree/link_space.hpp), with so many rows at most that couple
  // branches; else in joint space.
  bool by_links;
  std::int32_t couplings;
  std::int32_t limits, actuators;
  std::int32_t ball_limits, ball_springs;
  // Rows of the state: of the coordinates, and of the dofs, each with a velocity and the
  // acceleration of the step before.
  std::int32_t first_coordinate, first_dof;
  NewtonOptions<Real> newton;
  const TreeLink<Real>* link;
  const TreeJoint<Real>* joint;
  const TreeDof* dof;
  const TreeLimit<Real>* limit;
  const TreeTerm<Real>* term;  // of limits
  const TreeBallLimit<Real>* ball_limit;
  const TreeBallSpring* ball_spring;
  const TreeActuator* actuator;
  const std::uint64_t* ancestors;  // [dof] those on the way to the root
  // Of plans with contacts, else nullptr.
  const TreePair<Real>* pair;  // [key]
  const std::int32_t* pair_dof;
  bool has_rows;  // there are limits or contacts
  bool elliptic;  // the cones of contacts are
  Real impedance_ratio;
  bool has_medium;  // which drags links
  Real wind[3];     // m/s, of the medium
};

}  // namespace manyworlds::kernels
