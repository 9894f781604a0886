// The members of everything that a scene consists of, by name: the one list that JSON, Python, and
// the fingerprint of a plan are read and written by. For loaders and editors, too:
//
//   Members<Body>::visit(body, [](const char* name, auto& member, Counted = {}) { ... });
//
// Each list names all members in a structured binding, so that one that is added to a struct and
// not here does not compile.
#pragma once

#include <type_traits>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// Whether plans that differ in a member have different fingerprints (Plan::fingerprint), and so
// snapshots and recordings that are not for one another.
struct Counted {
  bool yes = true;
  const char* unless = "";  // why not
};
constexpr Counted not_counted(const char* why) { return {false, why}; }
constexpr Counted counted_if(bool condition, const char* why_not) { return {condition, why_not}; }

template <class Struct>
struct Members;  // name; visit(value, visit): visit("member", value.member[, Counted]) in turn
template <class Struct>
concept HasMembers = requires {
  Members<Struct>::name;
};

// -- shapes
template <>
struct Members<Sphere> {
  static constexpr const char* name = "Sphere";
  static void visit(auto& value, auto&& visit) {
    auto& [radius] = value;
    visit("radius", radius);
  }
};
template <>
struct Members<Box> {
  static constexpr const char* name = "Box";
  static void visit(auto& value, auto&& visit) {
    auto& [half_extents] = value;
    visit("half_extents", half_extents);
  }
};
template <>
struct Members<Plane> {
  static constexpr const char* name = "Plane";
  static void visit(auto& value, auto&& visit) {
    auto& [normal, offset] = value;
    visit("normal", normal), visit("offset", offset);
  }
};
template <>
struct Members<Capsule> {
  static constexpr const char* name = "Capsule";
  static void visit(auto& value, auto&& visit) {
    auto& [radius, half_length] = value;
    visit("radius", radius), visit("half_length", half_length);
  }
};
template <>
struct Members<Cylinder> {
  static constexpr const char* name = "Cylinder";
  static void visit(auto& value, auto&& visit) {
    auto& [radius, half_length] = value;
    visit("radius", radius), visit("half_length", half_length);
  }
};
template <>
struct Members<Hull> {
  static constexpr const char* name = "Hull";
  static void visit(auto& value, auto&& visit) {
    auto& [vertices] = value;
    visit("vertices", vertices);
  }
};
template <>
struct Members<Circle> {
  static constexpr const char* name = "Circle";
  static void visit(auto& value, auto&& visit) {
    auto& [radius] = value;
    visit("radius", radius);
  }
};
template <>
struct Members<Polygon> {
  static constexpr const char* name = "Polygon";
  static void visit(auto& value, auto&& visit) {
    auto& [vertices, radius] = value;
    visit("vertices", vertices);
    visit("radius", radius,
          counted_if(radius != 0,
                     "a polygon without a rounding is what it was before there was one"));
  }
};
template <>
struct Members<HalfPlane> {
  static constexpr const char* name = "HalfPlane";
  static void visit(auto& value, auto&& visit) {
    auto& [normal, offset] = value;
    visit("normal", normal), visit("offset", offset);
  }
};
template <>
struct Members<Segment> {
  static constexpr const char* name = "Segment";
  static void visit(auto& value, auto&& visit) {
    auto& [a, b] = value;
    visit("a", a), visit("b", b);
  }
};
template <>
struct Members<Terrain> {
  static constexpr const char* name = "Terrain";
  static void visit(auto& value, auto&& visit) {
    auto& [points, loop] = value;
    visit("points", points), visit("loop", loop);
  }
};
template <>
struct Members<HeightField> {
  static constexpr const char* name = "HeightField";
  static void visit(auto& value, auto&& visit) {
    auto& [heights, columns, cell] = value;
    visit("heights", heights), visit("columns", columns), visit("cell", cell);
  }
};
template <>
struct Members<Material> {
  static constexpr const char* name = "Material";
  static void visit(auto& value, auto&& visit) {
    auto& [friction, restitution] = value;
    visit("friction", friction), visit("restitution", restitution);
  }
};
template <>
struct Members<Filter> {
  static constexpr const char* name = "Filter";
  static void visit(auto& value, auto&& visit) {
    auto& [category, mask] = value;
    visit("category", category), visit("mask", mask);
  }
};
template <>
struct Members<Shape> {
  static constexpr const char* name = "Shape";
  static void visit(auto& value, auto&& visit) {
    auto& [geometry, position, rotation, density, material, filter, name_] = value;
    visit("geometry", geometry), visit("position", position), visit("rotation", rotation);
    visit("density", density), visit("material", material), visit("filter", filter);
    visit("name", name_, not_counted("names are for people"));
  }
};
// -- bodies
template <>
struct Members<MassProperties> {
  static constexpr const char* name = "MassProperties";
  static void visit(auto& value, auto&& visit) {
    auto& [mass, center, inertia] = value;
    visit("mass", mass), visit("center", center), visit("inertia", inertia);
  }
};
template <>
struct Members<Jitter> {
  static constexpr const char* name = "Jitter";
  static void visit(auto& value, auto&& visit) {
    auto& [position, linear_velocity, angle, any_orientation, with] = value;
    visit("position", position), visit("linear_velocity", linear_velocity), visit("angle", angle);
    visit("any_orientation", any_orientation), visit("with", with);
  }
};
template <>
struct Members<Body> {
  static constexpr const char* name = "Body";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, motion, enabled, position, rotation, linear_velocity, angular_velocity, shapes,
           mass_properties, gravity_scale, linear_drag, angular_drag, jitter] = value;
    const Counted begun = counted_if(
        motion == Motion::fixed, "where a body begins does not matter to a world that has begun");
    visit("name", name_, not_counted("names are for people"));
    visit("motion", motion), visit("shapes", shapes), visit("mass_properties", mass_properties);
    visit("gravity_scale", gravity_scale), visit("linear_drag", linear_drag);
    visit("angular_drag", angular_drag);
    visit("enabled", enabled,
          not_counted("what a world begins with does not matter to one that has begun"));
    visit("position", position, begun), visit("rotation", rotation, begun);
    visit("linear_velocity", linear_velocity,
          not_counted("what a world begins with does not matter to one that has begun"));
    visit("angular_velocity", angular_velocity,
          not_counted("what a world begins with does not matter to one that has begun"));
    visit("jitter", jitter,
          not_counted("what a world begins with does not matter to one that has begun"));
  }
};
// -- joints
template <>
struct Members<Frame> {
  static constexpr const char* name = "Frame";
  static void visit(auto& value, auto&& visit) {
    auto& [position, rotation] = value;
    visit("position", position), visit("rotation", rotation);
  }
};
template <>
struct Members<Spring> {
  static constexpr const char* name = "Spring";
  static void visit(auto& value, auto&& visit) {
    auto& [stiffness, damping, frequency, damping_ratio] = value;
    visit("stiffness", stiffness), visit("damping", damping), visit("frequency", frequency);
    visit("damping_ratio", damping_ratio);
  }
};
template <>
struct Members<Limit> {
  static constexpr const char* name = "Limit";
  static void visit(auto& value, auto&& visit) {
    auto& [low, high, spring] = value;
    visit("low", low), visit("high", high), visit("spring", spring);
  }
};
template <>
struct Members<Drive> {
  static constexpr const char* name = "Drive";
  static void visit(auto& value, auto&& visit) {
    auto& [target_position, target_speed, spring, max_force] = value;
    visit("target_position", target_position), visit("target_speed", target_speed);
    visit("spring", spring), visit("max_force", max_force);
  }
};
template <>
struct Members<BallJoint> {
  static constexpr const char* name = "BallJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [cone, twist] = value;
    visit("cone", cone), visit("twist", twist);
  }
};
template <>
struct Members<HingeJoint> {
  static constexpr const char* name = "HingeJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [limit, drive] = value;
    visit("limit", limit), visit("drive", drive);
  }
};
template <>
struct Members<SliderJoint> {
  static constexpr const char* name = "SliderJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [limit, drive] = value;
    visit("limit", limit), visit("drive", drive);
  }
};
template <>
struct Members<FixedJoint> {
  static constexpr const char* name = "FixedJoint";
  static_assert(std::is_empty_v<FixedJoint>);
  static void visit(auto&, auto&&) {}
};
template <>
struct Members<DistanceJoint> {
  static constexpr const char* name = "DistanceJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [length, limit, spring] = value;
    visit("length", length), visit("limit", limit), visit("spring", spring);
  }
};
template <>
struct Members<WheelJoint> {
  static constexpr const char* name = "WheelJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [suspension, travel, drive] = value;
    visit("suspension", suspension), visit("travel", travel), visit("drive", drive);
  }
};
template <>
struct Members<PulleyJoint> {
  static constexpr const char* name = "PulleyJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [ground_a, ground_b, ratio, length] = value;
    visit("ground_a", ground_a), visit("ground_b", ground_b), visit("ratio", ratio);
    visit("length", length);
  }
};
template <>
struct Members<TargetJoint> {
  static constexpr const char* name = "TargetJoint";
  static void visit(auto& value, auto&& visit) {
    auto& [spring, max_force] = value;
    visit("spring", spring), visit("max_force", max_force);
  }
};
template <>
struct Members<Joint> {
  static constexpr const char* name = "Joint";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, type, body_a, body_b, frame_a, frame_b, collide, break_force, break_torque] =
        value;
    visit("name", name_, not_counted("names are for people"));
    visit("type", type), visit("body_a", body_a), visit("body_b", body_b);
    visit("frame_a", frame_a), visit("frame_b", frame_b), visit("collide", collide);
    visit("break_force", break_force), visit("break_torque", break_torque);
  }
};
// -- the rest of a scene
template <>
struct Members<Attractor> {
  static constexpr const char* name = "Attractor";
  static void visit(auto& value, auto&& visit) {
    auto& [position, strength, softening] = value;
    visit("position", position), visit("strength", strength), visit("softening", softening);
  }
};
template <>
struct Members<Control> {
  static constexpr const char* name = "Control";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, kind, joint, body, point, direction, low, high, initial] = value;
    visit("name", name_, not_counted("names are for people"));
    visit("kind", kind), visit("joint", joint), visit("body", body), visit("point", point);
    visit("direction", direction), visit("low", low), visit("high", high);
    visit("initial", initial,
          not_counted("what a world begins with does not matter to one that has begun"));
  }
};
template <>
struct Members<Variation> {
  static constexpr const char* name = "Variation";
  static void visit(auto& value, auto&& visit) {
    auto& [parameter, body, shape, low, high, draw, together] = value;
    visit("parameter", parameter), visit("body", body), visit("shape", shape), visit("low", low);
    visit("high", high), visit("draw", draw), visit("together", together);
  }
};
template <>
struct Members<Options> {
  static constexpr const char* name = "Options";
  static void visit(auto& value, auto&& visit) {
    auto& [dt, substeps, gravity, wind, density, integrator, rotation, angular_momentum, solver,
           iterations, relaxation, push_out_share, split_impulse, length_unit, contact_frequency,
           contact_damping_ratio, push_out_speed, slop, restitution_threshold, restitution_sweeps,
           friction_in_bias_pass, cast_against_fixed, cast_between_moving, joint_frequency,
           joint_damping_ratio, joint_pull_speed, sleep_speed, time_to_sleep, contact_capacity,
           bounds] = value;
    const Counted swept =
        counted_if(solver != Solver::tgs_soft || iterations_of(value) != 1,
                   "the default solver is what there was before there was a choice");
    const Counted hard = counted_if(has_hard_rows(solver), "of solvers with hard rows alone");
    const Counted flown =
        counted_if(integrator != Integrator::symplectic_euler ||
                       rotation.value_or(Rotation::splitting) != Rotation::splitting,
                   "the default integrator is what there was before there was a choice");
    visit("dt", dt), visit("substeps", substeps), visit("gravity", gravity), visit("wind", wind);
    visit("density", density), visit("length_unit", length_unit);
    visit("contact_frequency", contact_frequency);
    visit("contact_damping_ratio", contact_damping_ratio), visit("push_out_speed", push_out_speed);
    visit("slop", slop), visit("restitution_threshold", restitution_threshold);
    visit("restitution_sweeps", restitution_sweeps);
    visit("friction_in_bias_pass", friction_in_bias_pass);
    visit("cast_against_fixed", cast_against_fixed);
    visit("cast_between_moving", cast_between_moving), visit("joint_frequency", joint_frequency);
    visit("joint_damping_ratio", joint_damping_ratio), visit("joint_pull_speed", joint_pull_speed);
    visit("sleep_speed", sleep_speed), visit("time_to_sleep", time_to_sleep);
    visit("contact_capacity", contact_capacity), visit("bounds", bounds);
    visit("solver", solver, swept), visit("iterations", iterations, swept);
    visit("relaxation", relaxation, counted_if(solver == Solver::sor, "of sor alone"));
    visit("push_out_share", push_out_share, hard), visit("split_impulse", split_impulse, hard);
    visit("integrator", integrator, flown), visit("rotation", rotation, flown);
    visit("angular_momentum", angular_momentum, flown);
  }
};
template <>
struct Members<Scene> {
  static constexpr const char* name = "Scene";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, space, bodies, joints, controls, attractors, options, variations] = value;
    visit("name", name_, not_counted("names are for people"));
    visit("space", space), visit("bodies", bodies), visit("joints", joints);
    visit("controls", controls), visit("attractors", attractors), visit("options", options);
    visit("variations", variations,
          not_counted("what they vary is counted number by number, and not how it is drawn"));
  }
};

}  // namespace manyworlds
