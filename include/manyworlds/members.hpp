// The members of all structs of a scene, by name. JSON, Python and the fingerprint of a plan use
// this list. Loaders and editors can use it, too:
//
//   Members<Body>::visit(body, [](const char* name, auto& member, Counted = {}) { ... });
//
// Each list names all members in a structured binding: a new member that is missing here does not
// compile. shape_members.hpp and option_members.hpp list the members of shapes and options.
#pragma once

#include <algorithm>

#include "manyworlds/member_list.hpp"
#include "manyworlds/option_members.hpp"
#include "manyworlds/scene.hpp"
#include "manyworlds/shape_members.hpp"

namespace manyworlds {

// -- bodies
template <>
struct Members<MassProperties> {
  static constexpr const char* name = "MassProperties";
  static void visit(auto& value, auto&& visit) {
    auto& [mass, center, inertia, axes] = value;
    visit("mass", mass), visit("center", center), visit("inertia", inertia);
    visit("axes", axes, counted_if(axes.has_value(), "the default: axes found from inertia"));
  }
};
template <>
struct Members<Jitter> {
  static constexpr const char* name = "Jitter";
  static void visit(auto& value, auto&& visit) {
    auto& [position, linear_velocity, angular_velocity, angle, any_orientation, with] = value;
    visit("position", position), visit("linear_velocity", linear_velocity);
    visit("angular_velocity", angular_velocity), visit("angle", angle);
    visit("any_orientation", any_orientation), visit("with", with);
  }
};
template <>
struct Members<Body> {
  static constexpr const char* name = "Body";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, motion, enabled, position, rotation, linear_velocity, angular_velocity, shapes,
           mass_properties, gravity_scale, linear_drag, angular_drag, jitter] = value;
    const Counted begun = counted_if(motion == Motion::fixed, kInitial);
    visit("name", name_, not_counted(kName));
    visit("motion", motion), visit("shapes", shapes), visit("mass_properties", mass_properties);
    visit("gravity_scale", gravity_scale), visit("linear_drag", linear_drag);
    visit("angular_drag", angular_drag);
    visit("enabled", enabled, not_counted(kInitial));
    visit("position", position, begun), visit("rotation", rotation, begun);
    visit("linear_velocity", linear_velocity, not_counted(kInitial));
    visit("angular_velocity", angular_velocity, not_counted(kInitial));
    visit("jitter", jitter, not_counted(kInitial));
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
    auto& [low, high, spring, compliance, margin] = value;
    visit("low", low), visit("high", high), visit("spring", spring);
    const Counted newton = counted_if(compliance != Compliance{} || margin != 0, kOfNewton);
    visit("compliance", compliance, newton), visit("margin", margin, newton);
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
    auto& [cone, twist, limit] = value;
    visit("cone", cone), visit("twist", twist);
    visit("limit", limit, counted_if(limit.has_value(), kOfNewton));
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
struct Members<JointDynamics> {
  static constexpr const char* name = "JointDynamics";
  static void visit(auto& value, auto&& visit) {
    auto& [armature, damping, stiffness, rest, reference] = value;
    visit("armature", armature), visit("damping", damping), visit("stiffness", stiffness);
    visit("rest", rest), visit("reference", reference);
  }
};
template <>
struct Members<Joint> {
  static constexpr const char* name = "Joint";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, type, body_a, body_b, frame_a, frame_b, collide, break_force, break_torque, after,
           dynamics] = value;
    visit("name", name_, not_counted(kName));
    visit("type", type), visit("body_a", body_a), visit("body_b", body_b);
    visit("frame_a", frame_a), visit("frame_b", frame_b), visit("collide", collide);
    visit("break_force", break_force), visit("break_torque", break_torque);
    visit("after", after, counted_if(after != JointId(), kOfNewton));
    visit("dynamics", dynamics, counted_if(dynamics != JointDynamics{}, kOfNewton));
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
struct Members<Actuator> {
  static constexpr const char* name = "Actuator";
  static void visit(auto& value, auto&& visit) {
    auto& [gear, gain, bias, low, high] = value;
    visit("gear", gear), visit("gain", gain), visit("bias", bias);
    visit("low", low), visit("high", high);
  }
};
template <>
struct Members<Control> {
  static constexpr const char* name = "Control";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, kind, joint, body, point, direction, low, high, initial, actuator] = value;
    visit("name", name_, not_counted(kName));
    visit("kind", kind), visit("joint", joint), visit("body", body), visit("point", point);
    visit("direction", direction), visit("low", low), visit("high", high);
    visit("initial", initial, not_counted(kInitial));
    visit("actuator", actuator, counted_if(actuator != Actuator{}, kOfNewton));
  }
};
template <>
struct Members<Variation> {
  static constexpr const char* name = "Variation";
  static void visit(auto& value, auto&& visit) {
    auto& [parameter, body, shape, joint, control, attractor, low, high, draw, together] = value;
    visit("parameter", parameter), visit("body", body), visit("shape", shape);
    visit("joint", joint), visit("control", control), visit("attractor", attractor);
    visit("low", low), visit("high", high), visit("draw", draw), visit("together", together);
  }
};
template <>
struct Members<TendonTerm> {
  static constexpr const char* name = "TendonTerm";
  static void visit(auto& value, auto&& visit) {
    auto& [joint, coefficient] = value;
    visit("joint", joint), visit("coefficient", coefficient);
  }
};
template <>
struct Members<Tendon> {
  static constexpr const char* name = "Tendon";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, terms, limit] = value;
    visit("name", name_, not_counted(kName));
    visit("terms", terms), visit("limit", limit);
  }
};
template <>
struct Members<Exclusion> {
  static constexpr const char* name = "Exclusion";
  static void visit(auto& value, auto&& visit) {
    auto& [body_a, body_b] = value;
    visit("body_a", body_a), visit("body_b", body_b);
  }
};
template <>
struct Members<Site> {
  static constexpr const char* name = "Site";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, body, position] = value;
    visit("name", name_), visit("body", body), visit("position", position);
  }
};
template <>
struct Members<Keyframe> {
  static constexpr const char* name = "Keyframe";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, generalized_position, generalized_velocity, controls] = value;
    visit("name", name_), visit("generalized_position", generalized_position);
    visit("generalized_velocity", generalized_velocity), visit("controls", controls);
  }
};
template <>
struct Members<CoordinateDraw> {
  static constexpr const char* name = "CoordinateDraw";
  static void visit(auto& value, auto&& visit) {
    auto& [velocity, first, low, high, normal, replaces, nearest, farthest] = value;
    visit("velocity", velocity), visit("first", first), visit("low", low), visit("high", high);
    visit("normal", normal), visit("replaces", replaces), visit("nearest", nearest);
    visit("farthest", farthest);
  }
};
// -- scene
template <>
struct Members<Scene> {
  static constexpr const char* name = "Scene";
  static void visit(auto& value, auto&& visit) {
    auto& [name_, space, bodies, joints, controls, attractors, options, variations, exclusions,
           tendons, keyframes, coordinate_draws, sites] = value;
    visit("name", name_, not_counted(kName));
    visit("space", space), visit("bodies", bodies), visit("joints", joints);
    visit("controls", controls), visit("attractors", attractors), visit("options", options);
    visit("variations", variations,
          not_counted("each varied parameter is counted, not its distribution"));
    visit("exclusions", exclusions, counted_if(!exclusions.empty(), "the default: no exclusions"));
    const bool limited = std::any_of(tendons.begin(), tendons.end(),
                                     [](const Tendon& tendon) { return tendon.limit.has_value(); });
    visit("tendons", tendons,
          counted_if(limited, "tendons without limits are for observation only"));
    visit("keyframes", keyframes, not_counted(kInitial));
    visit("coordinate_draws", coordinate_draws, not_counted(kInitial));
    visit("sites", sites, not_counted("sites are for observation only"));
  }
};

}  // namespace manyworlds
