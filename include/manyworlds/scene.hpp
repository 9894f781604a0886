// Scene: what one world is. Plain values that a person or a loader fills in; nothing here knows
// about lanes, batches or steps. validate() lists everything that is wrong with it, compile()
// (plan.hpp) turns it into what the step needs.
//
// Units are SI (m, kg, s, rad). A planar scene uses x and y, with rotations about z; a spatial
// scene uses all three axes. Frames: "body" is the frame the user places by Body::position and
// Body::rotation, "world" is the frame of gravity and positions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "manyworlds/control.hpp"
#include "manyworlds/ids.hpp"
#include "manyworlds/integrator.hpp"
#include "manyworlds/joint.hpp"
#include "manyworlds/solver.hpp"
#include "manyworlds/variation.hpp"

namespace manyworlds {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
// Eigen's constructor order: (w, x, y, z). Unaligned, so that structs have the same layout whatever
// instruction set the user compiles for.
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

enum class Space { planar, spatial };

// ---- shapes --------------------------------------------------------------------------------

struct Sphere {         // spatial
  double radius = 0.5;  // m
};
struct Box {                         // spatial, centred on the shape frame
  Vec3 half_extents{0.5, 0.5, 0.5};  // m
};
struct Plane {  // spatial, fixed bodies only: all points p with normal . p <= offset are solid
  Vec3 normal{0, 0, 1};  // unit, body frame, pointing out of the solid
  double offset = 0;     // m
};
// All points no farther than the radius from a straight line of length 2 half_length, centred on
// the shape frame: along z in a spatial scene, along y in a planar one.
struct Capsule {
  double radius = 0.25;      // m
  double half_length = 0.5;  // m, without the round ends
};
// Spatial: all points within the radius of the z axis of the shape frame and no farther than
// half_length from its origin along it.
struct Cylinder {
  double radius = 0.5;       // m
  double half_length = 0.5;  // m
};
// Spatial, a convex polyhedron: the smallest convex solid around its vertices, 4 to 64 of them.
// make_hull (hull.hpp) finds those of a cloud of points. Faces that lie in one plane are one.
struct Hull {
  std::vector<Vec3> vertices = {};  // m, shape frame, in any order
};
struct Circle {         // planar
  double radius = 0.5;  // m
};
struct Polygon {                    // planar, convex, 3 to 8 vertices
  std::vector<Vec2> vertices = {};  // m, shape frame, counter-clockwise
  double radius = 0;  // m, the solid is all points no farther than that from the polygon

  // Rectangle of half extents (half_x, half_y) centred on the shape frame.
  static Polygon box(double half_x, double half_y) {
    return {{{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}}, 0};
  }
};
struct HalfPlane {    // planar, fixed bodies only: all points p with normal . p <= offset are solid
  Vec2 normal{0, 1};  // unit, body frame
  double offset = 0;  // m
};
struct Segment {               // planar, fixed bodies only: a line that is solid from either side
  Vec2 a{-0.5, 0}, b{0.5, 0};  // m, shape frame
};
// Planar, fixed bodies only: a chain of segments, solid on the right of somebody who walks along
// the points (so hills run from left to right), free on the left. Bodies slide over its vertices as
// over one smooth ground. At the ends of an open chain the solid falls off at a right angle.
struct Terrain {
  std::vector<Vec2> points = {};  // m, shape frame; 2 or more, of a loop 3 or more
  bool loop = false;              // the last point is joined to the first
};
// Spatial, fixed bodies only: everything below a surface of triangles over a grid of points, which
// is centred on the shape frame. Each cell has two, on either side of the diagonal from its corner
// of low x and y. Bodies slide and roll over its edges as over one smooth ground; at its border the
// solid falls off at a right angle. A body that got below the surface is pushed up.
struct HeightField {
  std::vector<double> heights = {};  // m, of the points: x varies fastest
  int columns = 2;                   // points along x, 2 or more; as many rows as that leaves
  Vec2 cell{1, 1};                   // m, between points along x and y
  int rows() const { return columns > 0 ? static_cast<int>(heights.size()) / columns : 0; }
};
using Geometry = std::variant<Sphere, Box, Plane, Circle, Polygon, HalfPlane, Capsule, Segment,
                              Terrain, Cylinder, Hull, HeightField>;

struct Material {
  double friction = 0.6;     // Coulomb coefficient; a pair uses the geometric mean of its two
  double restitution = 0.0;  // 0 to 1; a pair uses the larger of its two
};

// Two shapes collide when each one's category is in the other's mask and they are on different
// bodies of which at least one is dynamic.
struct Filter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffffu;
};

struct Shape {
  Geometry geometry = Sphere{};
  Vec3 position = Vec3::Zero();        // m, of the shape frame in the body frame
  Quat rotation = Quat::Identity();    // of the shape frame in the body frame; need not be unit
  std::optional<double> density = {};  // kg/m^3 (kg/m^2 planar); default Options::density
  Material material = {};
  Filter filter = {};
  std::string name = {};
};

// ---- bodies --------------------------------------------------------------------------------

enum class Motion {
  dynamic,    // moved by forces and contacts
  kinematic,  // moves with its own velocity, whatever touches it
  fixed,      // never moves; costs nothing but its contacts
};

// Mass, centre and inertia of a body. In a planar scene only inertia(2,2) is used.
struct MassProperties {
  double mass = 1;                  // kg
  Vec3 center = Vec3::Zero();       // m, centre of mass in the body frame
  Mat3 inertia = Mat3::Identity();  // kg m^2 about the centre of mass, body axes
};

// How the initial state differs from world to world: every entry is the half range of a uniform
// draw around the value given in Body, one draw per component, world and body.
struct Jitter {
  Vec3 position = Vec3::Zero();         // m
  Vec3 linear_velocity = Vec3::Zero();  // m/s
  double angle = 0;                     // rad, about z
  bool any_orientation = false;         // spatial: orientation uniform over all rotations
  // What is drawn for that body moves this one, too, as one rigid piece with it and with its change
  // of velocity, before anything of its own: for assemblies on joints.
  BodyId with = {};
};

struct Body {
  std::string name = {};
  Motion motion = Motion::dynamic;
  bool enabled = true;  // false: not there until a Batch enables or spawns it; not for fixed bodies
  Vec3 position = Vec3::Zero();          // m, of the body frame in the world
  Quat rotation = Quat::Identity();      // of the body frame in the world; need not be unit
  Vec3 linear_velocity = Vec3::Zero();   // m/s, of the centre of mass, world
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, world
  std::vector<Shape> shapes = {};
  std::optional<MassProperties> mass_properties = {};  // default: from shapes and densities
  double gravity_scale = 1;
  double linear_drag = 0;   // 1/s: v' = (v + h c wind) / (1 + h c)
  double angular_drag = 0;  // 1/s
  Jitter jitter = {};
};

// ---- options -------------------------------------------------------------------------------

struct Options {
  double dt = 1.0 / 60.0;   // s, one step
  int substeps = 4;         // of the solver and of the integrator, per step
  Vec3 gravity{0, 0, -10};  // m/s^2 (planar scenes: set {0, -10, 0})
  Vec3 wind{0, 0, 0};       // m/s, of the air that Body::linear_drag is against
  double density = 1000;    // kg/m^3 or kg/m^2, for shapes that give none
  Integrator integrator = Integrator::symplectic_euler;
  // Default: splitting with symplectic_euler and the Verlets, which take nothing else but
  // symplectic_euler; exponential with the others.
  std::optional<Rotation> rotation = {};
  // Spins are integrated as angular momenta instead of angular velocities, without splitting and
  // not by implicit_euler.
  bool angular_momentum = false;
  Solver solver = Solver::tgs_soft;
  // Sweeps over all rows per substep, of tgs_soft those before the motion. Default: 1 for tgs_soft
  // and penalty, 10 for the others, which are usually given fewer substeps.
  std::optional<int> iterations = {};
  double relaxation = 1.3;  // of sor, in (0, 2)
  // Of sequential_impulse, sor and nncg: the share of an overlap beyond slop, or of a joint's gap,
  // that a substep removes, and whether contacts do so without leaving a speed.
  double push_out_share = 0.2;
  bool split_impulse = false;
  // Size of a typical body, m. Scales slop, margins and speed limits of the contact model.
  double length_unit = 1;

  // Hz, of the soft contacts of tgs_soft and penalty; doubled against fixed shapes.
  double contact_frequency = 60;
  double contact_damping_ratio = 10;
  // m/s per length_unit: cap on the speed at which a pair's overlap is removed. Speeds of bodies
  // add up along a row: a row of n that overlap deeply can part at n / 4 times as much.
  double push_out_speed = 1.5;
  double slop = 0.005;               // m per length_unit: contact margin is 4 slop
  double restitution_threshold = 1;  // m/s per length_unit: slower impacts do not bounce
  int restitution_sweeps = 16;       // most repeats of the restitution pass
  // Of tgs_soft: much less sway of tall stacks; off is a little faster.
  bool friction_in_bias_pass = true;
  bool cast_against_fixed = true;    // stop fast bodies at thin fixed shapes
  bool cast_between_moving = false;  // and at moving ones; for bullets

  // What joints hold together is pulled back as by a spring and damper of this frequency and
  // damping ratio. Not capped: stiffer than the default may ring.
  // Hz; default a quarter per substep, and hard rows in sequential_impulse, sor and nncg.
  std::optional<double> joint_frequency = {};
  double joint_damping_ratio = 2;
  // m/s per length_unit, and rad/s: cap on the speed at which a joint closes what has come apart.
  // For scenes whose joints begin far apart; under heavy loads a low one lets chains stretch.
  double joint_pull_speed = std::numeric_limits<double>::infinity();

  // A body is at rest while |v| + |w| radius of its bounding sphere stays below sleep_speed; an
  // island all of whose bodies have been at rest for time_to_sleep falls asleep
  // (BatchOptions::sleep).
  double sleep_speed = 0.05;   // m/s per length_unit
  double time_to_sleep = 0.5;  // s

  // Manifolds between moving bodies that a world has room for, of each kind (of several points, of
  // one). Default: 4 per shape (planar: 3) and 8 more. What exceeds it is left out of the step and
  // flagged (Status::contact_overflow).
  std::optional<int> contact_capacity = {};

  // A world is lost when a body's position leaves this box. Default: no bounds.
  std::optional<Eigen::AlignedBox3d> bounds = {};
};

// Options::iterations, or the default of the solver.
int iterations_of(const Options& options);

// A point that draws every dynamic body to it with the acceleration
//   Body::gravity_scale strength d / (d^2 + softening^2)^(3/2),  d: from the body's centre of mass,
// or away from it if the strength is negative. A planet: strength G M (Newton).
struct Attractor {
  Vec3 position = Vec3::Zero();  // m, world
  double strength = 0;           // m^3/s^2
  double softening = 0;          // m
};

struct Scene {
  std::string name = {};
  Space space = Space::spatial;
  std::vector<Body> bodies = {};
  std::vector<Joint> joints = {};
  std::vector<Control> controls = {};
  std::vector<Attractor> attractors = {};
  Options options = {};
  std::vector<Variation> variations = {};

  // Appends and returns the handle. Shape k of a body is ShapeId(body, k).
  BodyId add(Body body) {
    bodies.push_back(std::move(body));
    return BodyId(static_cast<int>(bodies.size()) - 1);
  }
  JointId add(Joint joint) {
    joints.push_back(std::move(joint));
    return JointId(static_cast<int>(joints.size()) - 1);
  }
  ControlId add(Control control) {
    controls.push_back(std::move(control));
    return ControlId(static_cast<int>(controls.size()) - 1);
  }

  // The one of a name. Names may be empty or shared, but then they find nothing: throw
  // std::invalid_argument, with the names that there are, for a name that none has or several have.
  BodyId body(std::string_view name) const;
  ShapeId shape(std::string_view name) const;  // of all bodies' shapes
  ShapeId shape(BodyId body, std::string_view name) const;
  JointId joint(std::string_view name) const;
  ControlId control(std::string_view name) const;

  // What a handle stands for. Throw std::out_of_range where there is none.
  Body& at(BodyId id) { return bodies.at(static_cast<std::size_t>(id.index())); }
  const Body& at(BodyId id) const { return bodies.at(static_cast<std::size_t>(id.index())); }
  Shape& at(ShapeId id) { return at(id.body()).shapes.at(static_cast<std::size_t>(id.index())); }
  const Shape& at(ShapeId id) const {
    return at(id.body()).shapes.at(static_cast<std::size_t>(id.index()));
  }
  Joint& at(JointId id) { return joints.at(static_cast<std::size_t>(id.index())); }
  const Joint& at(JointId id) const { return joints.at(static_cast<std::size_t>(id.index())); }
  Control& at(ControlId id) { return controls.at(static_cast<std::size_t>(id.index())); }
  const Control& at(ControlId id) const {
    return controls.at(static_cast<std::size_t>(id.index()));
  }
};

// ---- checks and derived values -----------------------------------------------------------------

// One thing that is wrong with a scene.
struct Issue {
  std::string place = {};    // "body 3 'crate', shape 1: half_extents.y"
  std::string message = {};  // "is -0.2 m, must be > 0"
};
// "body 3 'crate', shape 1: half_extents.y is -0.2 m, must be > 0"
std::string to_string(const Issue& issue);

// Every issue at once, in the order of the scene; empty means that compile() will succeed.
std::vector<Issue> validate(const Scene& scene);

// A frame of a body (none: the world) in the world, as the bodies begin.
Frame frame_in_world(const Scene& scene, BodyId body, const Frame& frame);
// A joint of two bodies (none: the world) with both frames where `frame` is in the world as the
// bodies begin.
Joint joint_at(const Scene& scene, BodyId body_a, BodyId body_b, const Frame& frame,
               JointType type);

// Mass properties of a body: what the user gave, or the sum over its shapes by closed forms and
// the parallel-axis theorem. Precondition: the body passes validate().
MassProperties mass_properties(const Scene& scene, const Body& body);

}  // namespace manyworlds
