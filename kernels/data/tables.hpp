// SceneConstants: what the kernels know of a Plan, in the kernels' number type. Every value is
// shared by all worlds of the Plan and reaches the lanes by a broadcast load. Built once per Batch
// by src/state/tables.cpp; plain pointers into arrays that the Batch owns.
#pragma once

#include <cstdint>

#include "kernels/data/flight_tables.hpp"
#include "kernels/data/joint_tables.hpp"
#include "kernels/data/shape_kinds.hpp"
#include "kernels/data/solver_options.hpp"
#include "kernels/data/state_layout.hpp"
#include "kernels/data/tree_tables.hpp"

namespace manyworlds::kernels {

// Functions here are static: every kernel library includes this header with flags of its own, and a
// shared inline function could put one library's instructions into another's calls.

// How a body's inertia enters the rows: a scalar in the plane or when isotropic, else a tensor.
enum class InertiaKind : int { planar, isotropic, tensor };
inline constexpr int kInertiaKinds = 3;

// Contacts of a world live in four lists, solved in this order.
enum class ListId : int { pair_multi, pair_single, fixed_multi, fixed_single };
inline constexpr int kLists = 4;
static inline constexpr bool is_fixed(ListId id) { return id >= ListId::fixed_multi; }
static inline constexpr bool is_multi(ListId id) {
  return id == ListId::pair_multi || id == ListId::fixed_multi;
}

// Numbers that may differ from world to world. T is a number, or one of every lane: what a group
// sees are blocks of them, [item][member][lane] (kernels/work/constants.hpp), its own where some
// differ and one of the whole Plan where none does.
template <class T>
struct MaterialOf {
  T friction, restitution;
  T rolling_resistance, torsional_resistance;  // m
};

// Free rotation of a body about its principal axes (kernels/motion/rotate.hpp). A kinematic body
// has equal moments of 1, which rotate it about its fixed axis.
template <class T>
struct PrincipalInertia {
  T inertia[3], inverse[3];
  T rate[3];      // dt / (2 I_x), dt / (2 I_y), dt / I_z
  T angle_bound;  // dt / sqrt(I_min): times sqrt(L . w), a bound of the angle about every axis, rad
};

template <class T>
struct BodyConstants {
  T inv_mass;
  T mass;            // kg; 0 for kinematic bodies
  T inertia[3];      // principal, kg m^2 (planar: [2])
  T inv_inertia[3];  // 0 for kinematic bodies
  T gravity_scale;
  T gravity[3];                 // times gravity scale, m/s^2; 0 for kinematic bodies
  T acceleration[3];            // that and what the wind does by drag
  T delta_v[3];                 // h times that; never -0
  T linear_drag, angular_drag;  // c, 1/s
  T linear_factor;              // 1 / (1 + h c), per substep
  T angular_factor;
  PrincipalInertia<T> principal;
  T radius;          // of the bounding sphere about the centre of mass, m
  T half_thickness;  // the least of its shapes, m; 0: never cast
};

// Bodies whose radius is more than so many half thicknesses are cast against planes, too.
inline constexpr double kThinBody = 3;

template <class T>
struct ShapeConstants {
  T offset[3];    // shape origin from the centre of mass, principal axes, m
  T rotation[9];  // shape axes in principal axes, columns; planar: [0] cos, [1] sin
  T half[3];      // half extents (box, rectangle, cylinder, hull); capsule: [0] half length
  T radius;  // sphere, circle, capsule, rounded; else of the bounding sphere about the shape origin
  T margin_cap;  // the maximum to which the speculative margin of this shape may grow, m
};

template <class T>
struct PolygonConstants {
  T vertices[2 * kMaxVertices];  // padded by repeating the first
  T normals[2 * kMaxVertices];
};

// Draws all bodies to a point: acceleration strength d / (d^2 + softening^2)^(3/2).
template <class T>
struct AttractorConstants {
  T position[3];
  T strength;    // m^3/s^2
  T softening2;  // m^2, never 0
};

template <class Real>
struct ConstantBlocks {
  const Real* body;       // [body][BodyConstants][lane]
  const Real* shape;      // [collider][ShapeConstants][lane]
  const Real* polygon;    // [collider][PolygonConstants][lane]; nullptr without polygons
  const Real* material;   // [collider, then fixed shape][MaterialOf][lane]
  const Real* joint;      // [part][JointConstants][lane]
  const Real* thrust;     // [thrust][ThrustConstants][lane]
  const Real* link;       // [link][LinkConstants][lane]
  const Real* drag;       // [link][DragConstants][lane]; nullptr without a medium
  const Real* dof;        // [dof][DofConstants][lane]
  const Real* actuator;   // [actuator][ActuatorConstants][lane]
  const Real* limit;      // [limit, then limit of a ball][LimitConstants][lane]
  const Real* contact;    // [TreePair::compliance][Compliance][lane]
  const Real* attractor;  // [attractor][AttractorConstants][lane]
};

// What is the same in all worlds.
struct BodyTable {
  bool kinematic;
  bool jointed;         // a joint acts on it
  bool rotated;         // by the substeps (kernels/motion/substep_rotation.hpp)
  std::uint8_t middle;  // principal axis: neither of the largest moment of inertia nor the least
};

struct ColliderTable {
  ShapeKind kind;
  std::int32_t body;
  std::int32_t row;              // offset of its pose row in a lane's block
  std::uint32_t category, mask;  // collision filter
  std::int32_t vertex_count;     // of a polygon
  std::int32_t hull;             // where its table is, in fours, in SceneConstants::hulls
};

template <class Real>
struct FixedTable {
  ShapeKind kind;
  std::int32_t row;      // offset of its pose row in SceneConstants::fixed_rows
  Real low[3], high[3];  // bounding box (not for planes)
  Real plane[4];         // normal, offset
  std::uint32_t category, mask;
  std::int32_t body;  // its place in SceneConstants::joined, beyond those of moving bodies
};

// Candidate pairs of one shape pair kind, all against fixed shapes or all between moving ones. In
// sparse plans count is that of the keys, and there are no arrays (kernels/data/pair_keys.hpp).
template <class Real>
struct PairClass {
  PairKind kind;
  ListId list;
  std::int32_t count;
  std::int32_t first_key;  // keys of the class are first_key + 0 .. count - 1
  const std::int32_t* a;   // [count] collider, or fixed shape
  const std::int32_t* b;   // [count] collider
};

template <class Real>
struct Softness {  // numerics of the soft constraint: lambda' = lambda - k (m v + b s) - i lambda
  Real bias_rate, mass_scale, impulse_scale;
};

template <class Real>
struct SceneConstants {
  Dimension dimension;
  InertiaKind inertia_kind;
  std::int32_t bodies;
  std::int32_t colliders;
  std::int32_t fixed_shapes;
  std::int32_t classes;
  std::int32_t joints, parts;  // of the scene, and what they are made of
  std::int32_t breakable;      // of them
  std::int32_t controls;
  std::int32_t attractors;
  std::int32_t passes;    // over the collision stages in a step
  std::int32_t substeps;  // of a pass
  std::int32_t restitution_sweeps, impact_sweeps;
  bool has_orientation, has_friction, has_restitution, has_contacts, has_drag, has_gravity;
  bool has_joints;
  bool has_resistance;    // of contacts against rolling and spinning
  bool looks_ahead;       // contacts are of bodies turned ahead (work/half_turn.hpp)
  bool slows;             // by linear drag
  bool has_substeps;      // some stages of the solver: not free motion
  bool collider_is_body;  // collider i is the only shape of body i, centred and aligned
  bool friction_in_bias;
  bool uniform_gravity;   // every body has the acceleration of body 0
  bool uniform_friction;  // every shape has that of collider 0
  bool sweep;             // sort and sweep instead of masked all-pairs
  bool sparse;            // pairs are found lane by lane, there are no tables of them
  bool seams;             // of several fixed shapes that are no planes (collide/at_touch.hpp)
  bool cast;              // cast fast bodies against fixed shapes
  bool cast_moving;       // cast fast bodies against moving shapes
  bool has_bounds;
  bool has_sleep;
  std::int32_t audit_every;  // steps of a world; 0: its energy is not audited
  bool has_drives;           // rows of joints that may give energy
  bool joints_curve;         // some parts are JointPart::curved
  FlightOptions flight;
  SolverOptions<Real> solver;

  bool delta_v_varies, drag_varies, bodies_vary;  // from world to world

  const BodyTable* body;
  const ColliderTable* collider;
  const std::int32_t* collider_row;    // [collider + 1], the last is the dummy's
  const std::int32_t* collider_body;   // [collider + 1]
  const std::int32_t* first_collider;  // [body + 1], those of a body follow one another
  const FixedTable<Real>* fixed;
  const Real* fixed_rows;
  const Real* hulls;  // corners of hulls that move
  const PairClass<Real>* pair_class;
  TreeTable<Real> tree;  // no links: bodies are not in joint coordinates
  const JointPart* part;
  const std::int32_t* jointed;  // state bodies that have parts
  std::int32_t jointed_bodies;
  JointTrees joint_trees;            // no edges: none is solved at once
  const BreakTable* breaking;        // [breakable]
  const ThrustTable* thrust;         // ordered by body
  const std::int32_t* first_thrust;  // [body + 1]; nullptr: there is none
  // Bodies that a body does not collide with, because of a joint: [first_joined[body] ...);
  // nullptr: there are none.
  const std::int32_t* joined;
  const std::int32_t* first_joined;  // [body + 1]
  // Sort and sweep: key of the candidate pair of colliders (i, j), in either order, or -1.
  const std::int32_t* pair_of;  // [collider][collider]
  // Sparse: class of two kinds of shape, in moving_class twice that, and 1 more where the second is
  // A; -2 and -1: none.
  std::int32_t moving_class[kShapeKinds][kShapeKinds], fixed_class[kShapeKinds][kShapeKinds];

  // Where no world has its own.
  ConstantBlocks<Real> constants;
  // delta_v and drag factors of one substep in the order of a velocity row, of worlds that have
  // none of their own: [body + pad][row].
  const Real* delta_v_rows;
  const Real* factor_rows;

  std::int32_t capacity[kLists];  // manifolds per world
  std::int32_t row_block;         // reals of one lane's pose rows
  std::int32_t state_stride;      // rows of the state per body
  std::int32_t state_size;        // rows of the state per world

  Real step_dt;       // s, a step of the scene: as many passes
  Real dt, h, inv_h;  // s, a pass and its substeps; 1/s
  Softness<Real> soft_pair, soft_fixed;
  Real push_out_speed;
  Real push_out_rate;  // 1/s, of an overlap with a fixed shape: between that speed and twice it
  Real fixed_leak;     // m/s, at most given up of what presses on a fixed shape (rows/contact.hpp)
  Real blow_speed;     // m/s, faster approaches are solved manifold by manifold
  // Of impacts (solver/strikes.hpp): m/s, of the slowest, but for gravity; of impulses, changes
  // that need no answer in the first round; and its growth from round to round.
  Real strike_speed, strike_tolerance, strike_growth;
  Real margin;  // 4 slop, m
  Real half_margin;
  Real restitution_threshold, restitution_time;  // m/s, and for how long gravity adds to it, s
  Real sleep_speed, sleep_time;                  // a body is at rest below; an island sleeps after
  Real bounds_low[3], bounds_high[3];            // of body positions, m
  Real face_tie;                                 // m, a face of A wins over one of B by this
  Real face_bias;  // m, preference of the previous kind of axis in separating-axis tests
};

static inline constexpr int velocity_row_size(Dimension d) {
  return d == Dimension::planar ? 4 : 8;
}

// Stored impulses of one manifold (see rows/contact_cache.hpp).
static inline constexpr int cache_row_size(Dimension d, ListId list, bool resists) {
  if (d == Dimension::planar) return is_multi(list) ? 8 : 4;
  if (is_multi(list)) return resists ? 24 : 16;
  return resists ? 8 : 4;
}
template <class Real>
static inline constexpr int cache_row_size(const SceneConstants<Real>& t, ListId list) {
  return cache_row_size(t.dimension, list, t.has_resistance);
}

}  // namespace manyworlds::kernels
