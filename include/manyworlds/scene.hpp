// Scene: the description of one world as plain data, independent of lanes, batches and steps.
// validate() lists all issues of a scene, compile() (plan.hpp) makes a Plan of it.
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
  kinematic,  // moves with its own velocity; contacts do not affect it
  fixed,      // never moves; only its contacts cost time
};

// Mass, centre and inertia of a body. In a planar scene only inertia(2,2) is used.
struct MassProperties {
  double mass = 1;                  // kg
  Vec3 center = Vec3::Zero();       // m, centre of mass in the body frame
  Mat3 inertia = Mat3::Identity();  // kg m^2 about the centre of mass, body axes
  // Principal axes of inertia in the body frame (no meaning in planar scenes). If two moments are
  // equal, inertia does not determine the axes, but the drag of a medium acts along them. Default:
  // axes found from inertia.
  std::optional<Quat> axes = {};
};

// Random initial states. Every entry is the half range of a uniform draw around the value in Body.
// Each component, world and body has a separate draw.
struct Jitter {
  Vec3 position = Vec3::Zero();          // m
  Vec3 linear_velocity = Vec3::Zero();   // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, world
  double angle = 0;                      // rad, about z
  bool any_orientation = false;          // spatial: orientation uniform over all rotations
  // A body whose draws also move this one, as one rigid piece with the same change of velocity.
  // They apply before the draws of this body. Use it for assemblies with joints. Bodies may form a
  // chain: the draws of each body move all bodies after it.
  BodyId with = {};
};

struct Body {
  std::string name = {};
  Motion motion = Motion::dynamic;
  bool enabled = true;  // false: absent until a Batch enables or spawns it; not for fixed bodies
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

// A point that attracts every dynamic body with the acceleration
//   Body::gravity_scale strength d / (d^2 + softening^2)^(3/2),
// where d is the vector from the body's centre of mass to the point. A negative strength repels. A
// planet of mass M has strength G M (Newton).
struct Attractor {
  Vec3 position = Vec3::Zero();  // m, world
  double strength = 0;           // m^3/s^2
  double softening = 0;          // m
};

// Two bodies whose shapes do not collide with each other.
struct Exclusion {
  BodyId body_a = {}, body_b = {};
};

// A named point of a body or of the world (MuJoCo's site). It does not affect the motion. Observers
// and tasks use it (Observer::sites).
struct Site {
  std::string name = {};
  BodyId body = {};              // none: the world
  Vec3 position = Vec3::Zero();  // m, in the body's frame or in the world
};

// A state to which worlds can be reset (Batch::reset). generalized_position and
// generalized_velocity are the fields of Solver::newton with these names. Empty members keep the
// values of a plain reset.
struct Keyframe {
  std::string name = {};                          // empty or unique
  std::vector<double> generalized_position = {};  // [coordinate], m, rad or of unit quaternions
  std::vector<double> generalized_velocity = {};  // [dof], m/s or rad/s
  std::vector<double> controls = {};              // [control], as in Batch::set_controls
};

// A random draw of initial generalized positions or velocities (Solver::newton), at each reset.
// Each value is uniform between its low and high. With `normal`, the midpoint is the mean and half
// the range the standard deviation. Draws apply in their order.
struct CoordinateDraw {
  bool velocity = false;  // values are of dofs, else of coordinates
  int first = 0;          // index of the first of low.size() values, in MuJoCo's qpos or qvel
  std::vector<double> low = {}, high = {};
  bool normal = false;
  bool replaces = false;  // replaces the present values, else adds to them
  // Repeats the draw, up to 1000 times, until the norm of the drawn values is more than `nearest`
  // and less than `farthest`.
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
  std::vector<Exclusion> exclusions = {};  // in addition to those of joints (Joint::collide)
  std::vector<Tendon> tendons = {};
  std::vector<Keyframe> keyframes = {};
  std::vector<CoordinateDraw> coordinate_draws = {};
  std::vector<Site> sites = {};

  // Append and return the handle. Shape k of a body is ShapeId(body, k).
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

  // Find an item by name. Names may be empty or shared, but then cannot be found. Throw
  // std::invalid_argument, which lists the existing names, if no item or several items have the
  // name.
  BodyId body(std::string_view name) const;
  ShapeId shape(std::string_view name) const;  // among the shapes of all bodies
  // Also throws std::out_of_range for a body that is not in the scene.
  ShapeId shape(BodyId body, std::string_view name) const;
  JointId joint(std::string_view name) const;
  ControlId control(std::string_view name) const;
  TendonId tendon(std::string_view name) const;
  SiteId site(std::string_view name) const;
  KeyframeId keyframe(std::string_view name) const;

  // The item of a handle. Throws std::out_of_range for a handle that is not in this scene.
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

// A problem of a scene.
struct Issue {
  std::string place = {};    // "body 3 'crate', shape 1: half_extents.y"
  std::string message = {};  // "is -0.2 m, must be > 0"
};
// "body 3 'crate', shape 1: half_extents.y is -0.2 m, must be > 0"
std::string to_string(const Issue& issue);

// All issues, in the order of the scene. If it is empty, compile() succeeds.
std::vector<Issue> validate(const Scene& scene);

// Converts a frame of a body (none: the world) to the world, at the bodies' initial poses.
Frame frame_in_world(const Scene& scene, BodyId body, const Frame& frame);
// A joint of two bodies (none: the world). At the bodies' initial poses, both of its frames
// coincide with `frame` in the world. Both functions throw std::out_of_range for a body that is not
// in the scene.
Joint joint_at(const Scene& scene, BodyId body_a, BodyId body_b, const Frame& frame,
               JointType type);

// Mass properties of a body: Body::mass_properties, else the sum over its shapes by closed forms
// and the parallel-axis theorem. Precondition: the body passes validate().
MassProperties mass_properties(const Scene& scene, const Body& body);

}  // namespace manyworlds
