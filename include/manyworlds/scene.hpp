// Scene: what one world is. Plain values that a person or a loader fills in; nothing here knows
// about lanes, batches or steps. validate() lists everything that is wrong with it, compile()
// (plan.hpp) compiles it for the step.
//
// Units are SI (m, kg, s, rad). A planar scene uses x and y, with rotations about z; a spatial
// scene uses all three axes. Frames: "body" is the frame the user places by Body::position and
// Body::rotation, "world" is the frame of gravity and positions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/control.hpp"
#include "manyworlds/ids.hpp"
#include "manyworlds/joint.hpp"
#include "manyworlds/options.hpp"
#include "manyworlds/shape.hpp"
#include "manyworlds/variation.hpp"

namespace manyworlds {

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
  // Principal axes of inertia in the body frame (planar: without meaning). Where two moments are
  // alike inertia does not tell them, but the drag of a medium acts along them. Default: any.
  std::optional<Quat> axes = {};
};

// How the initial state differs from world to world: every entry is the half range of a uniform
// draw around the value given in Body, one draw per component, world and body.
struct Jitter {
  Vec3 position = Vec3::Zero();          // m
  Vec3 linear_velocity = Vec3::Zero();   // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, world
  double angle = 0;                      // rad, about z
  bool any_orientation = false;          // spatial: orientation uniform over all rotations
  // What is drawn for that body moves this one, too, as one rigid piece with it and with its change
  // of velocity, before anything of its own: for assemblies on joints. That body may have one that
  // it moves with itself: what is drawn for each of such a chain moves all that follow.
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

// ---- scenes ---------------------------------------------------------------------------------

// A point that draws every dynamic body to it with the acceleration
//   Body::gravity_scale strength d / (d^2 + softening^2)^(3/2),  d: from the body's centre of mass,
// or away from it if the strength is negative. A planet: strength G M (Newton).
struct Attractor {
  Vec3 position = Vec3::Zero();  // m, world
  double strength = 0;           // m^3/s^2
  double softening = 0;          // m
};

// Two bodies whose shapes do not collide with each other.
struct Exclusion {
  BodyId body_a = {}, body_b = {};
};

// A point of a body, or of the world, that has a name: MuJoCo's site. It moves nothing; observers
// and tasks find it (Observer::sites).
struct Site {
  std::string name = {};
  BodyId body = {};              // none: the world
  Vec3 position = Vec3::Zero();  // m, in the body's frame or in the world
};

// A state that worlds can be reset to (Batch::reset): generalized_position and generalized_velocity
// of Solver::newton, as the fields of that name have them, and the controls. What is empty is as
// any reset leaves it.
struct Keyframe {
  std::string name = {};                          // empty, or no other keyframe's
  std::vector<double> generalized_position = {};  // [coordinate], m, rad or of unit quaternions
  std::vector<double> generalized_velocity = {};  // [dof], m/s or rad/s
  std::vector<double> controls = {};              // [control], as Batch::set_controls takes them
};

// Numbers of the generalized positions or velocities that worlds of Solver::newton begin with,
// drawn at each reset anew: each uniform between its low and high, or normal with the mean half way
// between them and half the range as standard deviation. Draws act in their order.
struct CoordinateDraw {
  bool velocity = false;  // of dofs, else of coordinates
  int first = 0;          // of low.size() in a row, as MuJoCo counts qpos and qvel
  std::vector<double> low = {}, high = {};
  bool normal = false;
  bool replaces = false;  // what is there by then; else they are added to it
  // Drawn again, up to 1000 times, until the norm of what was drawn is more than the one and less
  // than the other.
  double nearest = -std::numeric_limits<double>::infinity();
  double farthest = std::numeric_limits<double>::infinity();
};

namespace detail {

// Throws std::out_of_range: "joint is -1, must be 0 to 4".
[[noreturn]] void throw_no_item(const char* what, int index, std::size_t count);
template <class List>
auto& item(List& list, const char* what, int index) {
  const auto i = static_cast<std::size_t>(index);
  if (index < 0 || i >= list.size()) throw_no_item(what, index, list.size());
  return list[i];
}

}  // namespace detail

struct Scene {
  std::string name = {};
  Space space = Space::spatial;
  std::vector<Body> bodies = {};
  std::vector<Joint> joints = {};
  std::vector<Control> controls = {};
  std::vector<Attractor> attractors = {};
  Options options = {};
  std::vector<Variation> variations = {};
  std::vector<Exclusion> exclusions = {};  // beside those of joints (Joint::collide)
  std::vector<Tendon> tendons = {};
  std::vector<Keyframe> keyframes = {};
  std::vector<CoordinateDraw> coordinate_draws = {};
  std::vector<Site> sites = {};

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
  TendonId add(Tendon tendon) {
    tendons.push_back(std::move(tendon));
    return TendonId(static_cast<int>(tendons.size()) - 1);
  }
  SiteId add(Site site) {
    sites.push_back(std::move(site));
    return SiteId(static_cast<int>(sites.size()) - 1);
  }
  KeyframeId add(Keyframe keyframe) {
    keyframes.push_back(std::move(keyframe));
    return KeyframeId(static_cast<int>(keyframes.size()) - 1);
  }

  // The one of a name. Names may be empty or shared, but then they find nothing: throw
  // std::invalid_argument, with the names that there are, for a name that none has or several have.
  BodyId body(std::string_view name) const;
  ShapeId shape(std::string_view name) const;  // of all bodies' shapes
  // Also throws std::out_of_range for a body that is not in the scene.
  ShapeId shape(BodyId body, std::string_view name) const;
  JointId joint(std::string_view name) const;
  ControlId control(std::string_view name) const;
  TendonId tendon(std::string_view name) const;
  SiteId site(std::string_view name) const;
  KeyframeId keyframe(std::string_view name) const;

  // The item of a handle. Throws std::out_of_range for a handle that is none of this scene.
  Body& at(BodyId id) { return detail::item(bodies, "body", id.index()); }
  const Body& at(BodyId id) const { return detail::item(bodies, "body", id.index()); }
  Shape& at(ShapeId id) { return detail::item(at(id.body()).shapes, "shape", id.index()); }
  const Shape& at(ShapeId id) const {
    return detail::item(at(id.body()).shapes, "shape", id.index());
  }
  Joint& at(JointId id) { return detail::item(joints, "joint", id.index()); }
  const Joint& at(JointId id) const { return detail::item(joints, "joint", id.index()); }
  Control& at(ControlId id) { return detail::item(controls, "control", id.index()); }
  const Control& at(ControlId id) const { return detail::item(controls, "control", id.index()); }
  Tendon& at(TendonId id) { return detail::item(tendons, "tendon", id.index()); }
  const Tendon& at(TendonId id) const { return detail::item(tendons, "tendon", id.index()); }
  Site& at(SiteId id) { return detail::item(sites, "site", id.index()); }
  const Site& at(SiteId id) const { return detail::item(sites, "site", id.index()); }
  Keyframe& at(KeyframeId id) { return detail::item(keyframes, "keyframe", id.index()); }
  const Keyframe& at(KeyframeId id) const {
    return detail::item(keyframes, "keyframe", id.index());
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
// bodies begin. Both functions throw std::out_of_range for a body that is not in the scene.
Joint joint_at(const Scene& scene, BodyId body_a, BodyId body_b, const Frame& frame,
               JointType type);

// Mass properties of a body: what the user gave, or the sum over its shapes by closed forms and
// the parallel-axis theorem. Precondition: the body passes validate().
MassProperties mass_properties(const Scene& scene, const Body& body);

}  // namespace manyworlds
