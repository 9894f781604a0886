// Scenes and plan options as JSON. A member that is added to a struct and not here does not
// compile.
#include "manyworlds/record.hpp"
#include "src/base/float_mode.hpp"
#include "src/record/json.hpp"

namespace manyworlds::record {

template <>
struct Words<Geometry> {
  static constexpr const char* list[] = {"sphere",  "box",        "plane",   "circle",
                                         "polygon", "half_plane", "capsule", "segment",
                                         "terrain", "cylinder",   "hull",    "height_field"};
};
static_assert(std::size(Words<Geometry>::list) == std::variant_size_v<Geometry>);

template <>
struct Words<JointType> {
  static constexpr const char* list[] = {"ball",     "hinge", "slider", "fixed",
                                         "distance", "wheel", "pulley", "target"};
};
static_assert(std::size(Words<JointType>::list) == std::variant_size_v<JointType>);

#define MW_MEMBERS(Struct) \
  template <class Visit>   \
  void members(Visit& visit, Struct& value)

MW_MEMBERS(Sphere) {
  auto& [radius] = value;
  visit("radius", radius);
}
MW_MEMBERS(Box) {
  auto& [half_extents] = value;
  visit("half_extents", half_extents);
}
MW_MEMBERS(Plane) {
  auto& [normal, offset] = value;
  visit("normal", normal), visit("offset", offset);
}
MW_MEMBERS(Capsule) {
  auto& [radius, half_length] = value;
  visit("radius", radius), visit("half_length", half_length);
}
MW_MEMBERS(Cylinder) {
  auto& [radius, half_length] = value;
  visit("radius", radius), visit("half_length", half_length);
}
MW_MEMBERS(Hull) {
  auto& [vertices] = value;
  visit("vertices", vertices);
}
MW_MEMBERS(Circle) {
  auto& [radius] = value;
  visit("radius", radius);
}
MW_MEMBERS(Polygon) {
  auto& [vertices, radius] = value;
  visit("vertices", vertices), visit("radius", radius);
}
MW_MEMBERS(HalfPlane) {
  auto& [normal, offset] = value;
  visit("normal", normal), visit("offset", offset);
}
MW_MEMBERS(Segment) {
  auto& [a, b] = value;
  visit("a", a), visit("b", b);
}
MW_MEMBERS(Terrain) {
  auto& [points, loop] = value;
  visit("points", points), visit("loop", loop);
}
MW_MEMBERS(HeightField) {
  auto& [heights, columns, cell] = value;
  visit("heights", heights), visit("columns", columns), visit("cell", cell);
}
MW_MEMBERS(Material) {
  auto& [friction, restitution] = value;
  visit("friction", friction), visit("restitution", restitution);
}
MW_MEMBERS(Filter) {
  auto& [category, mask] = value;
  visit("category", category), visit("mask", mask);
}
MW_MEMBERS(Shape) {
  auto& [geometry, position, rotation, density, material, filter, name] = value;
  visit("geometry", geometry), visit("position", position), visit("rotation", rotation);
  visit("density", density), visit("material", material), visit("filter", filter);
  visit("name", name);
}
MW_MEMBERS(MassProperties) {
  auto& [mass, center, inertia] = value;
  visit("mass", mass), visit("center", center), visit("inertia", inertia);
}
MW_MEMBERS(Jitter) {
  auto& [position, linear_velocity, angle, any_orientation, with] = value;
  visit("position", position), visit("linear_velocity", linear_velocity);
  visit("angle", angle), visit("any_orientation", any_orientation), visit("with", with);
}
MW_MEMBERS(Body) {
  auto& [name, motion, enabled, position, rotation, linear_velocity, angular_velocity, shapes,
         mass_properties, gravity_scale, linear_drag, angular_drag, jitter] = value;
  visit("name", name), visit("motion", motion), visit("enabled", enabled);
  visit("position", position), visit("rotation", rotation);
  visit("linear_velocity", linear_velocity), visit("angular_velocity", angular_velocity);
  visit("shapes", shapes), visit("mass_properties", mass_properties);
  visit("gravity_scale", gravity_scale);
  visit("linear_drag", linear_drag), visit("angular_drag", angular_drag);
  visit("jitter", jitter);
}
// The corners are all that a box has.
MW_MEMBERS(Eigen::AlignedBox3d) { visit("min", value.min()), visit("max", value.max()); }
MW_MEMBERS(Options) {
  auto& [dt, substeps, gravity, wind, density, integrator, rotation, angular_momentum, solver,
         iterations, relaxation, push_out_share, split_impulse, length_unit, contact_frequency,
         contact_damping_ratio, push_out_speed, slop, restitution_threshold, restitution_sweeps,
         friction_in_bias_pass, cast_against_fixed, cast_between_moving, joint_frequency,
         joint_damping_ratio, joint_pull_speed, sleep_speed, time_to_sleep, contact_capacity,
         bounds] = value;
  visit("dt", dt), visit("substeps", substeps), visit("gravity", gravity), visit("wind", wind);
  visit("density", density), visit("integrator", integrator), visit("rotation", rotation);
  visit("angular_momentum", angular_momentum);
  visit("solver", solver), visit("iterations", iterations), visit("relaxation", relaxation);
  visit("push_out_share", push_out_share), visit("split_impulse", split_impulse);
  visit("length_unit", length_unit);
  visit("contact_frequency", contact_frequency);
  visit("contact_damping_ratio", contact_damping_ratio);
  visit("push_out_speed", push_out_speed), visit("slop", slop);
  visit("restitution_threshold", restitution_threshold);
  visit("restitution_sweeps", restitution_sweeps);
  visit("friction_in_bias_pass", friction_in_bias_pass);
  visit("cast_against_fixed", cast_against_fixed);
  visit("cast_between_moving", cast_between_moving);
  visit("joint_frequency", joint_frequency), visit("joint_damping_ratio", joint_damping_ratio);
  visit("joint_pull_speed", joint_pull_speed);
  visit("sleep_speed", sleep_speed), visit("time_to_sleep", time_to_sleep);
  visit("contact_capacity", contact_capacity), visit("bounds", bounds);
}
MW_MEMBERS(Frame) {
  auto& [position, rotation] = value;
  visit("position", position), visit("rotation", rotation);
}
MW_MEMBERS(Spring) {
  auto& [stiffness, damping, frequency, damping_ratio] = value;
  visit("stiffness", stiffness), visit("damping", damping);
  visit("frequency", frequency), visit("damping_ratio", damping_ratio);
}
MW_MEMBERS(Limit) {
  auto& [low, high, spring] = value;
  visit("low", low), visit("high", high), visit("spring", spring);
}
MW_MEMBERS(Drive) {
  auto& [target_position, target_speed, spring, max_force] = value;
  visit("target_position", target_position), visit("target_speed", target_speed);
  visit("spring", spring), visit("max_force", max_force);
}
MW_MEMBERS(BallJoint) {
  auto& [cone, twist] = value;
  visit("cone", cone), visit("twist", twist);
}
MW_MEMBERS(HingeJoint) {
  auto& [limit, drive] = value;
  visit("limit", limit), visit("drive", drive);
}
MW_MEMBERS(SliderJoint) {
  auto& [limit, drive] = value;
  visit("limit", limit), visit("drive", drive);
}
MW_MEMBERS(FixedJoint) { static_cast<void>(visit), static_cast<void>(value); }
MW_MEMBERS(DistanceJoint) {
  auto& [length, limit, spring] = value;
  visit("length", length), visit("limit", limit), visit("spring", spring);
}
MW_MEMBERS(WheelJoint) {
  auto& [suspension, travel, drive] = value;
  visit("suspension", suspension), visit("travel", travel), visit("drive", drive);
}
MW_MEMBERS(PulleyJoint) {
  auto& [ground_a, ground_b, ratio, length] = value;
  visit("ground_a", ground_a), visit("ground_b", ground_b), visit("ratio", ratio);
  visit("length", length);
}
MW_MEMBERS(TargetJoint) {
  auto& [spring, max_force] = value;
  visit("spring", spring), visit("max_force", max_force);
}
MW_MEMBERS(Joint) {
  auto& [name, type, body_a, body_b, frame_a, frame_b, collide, break_force, break_torque] = value;
  visit("name", name), visit("type", type), visit("body_a", body_a), visit("body_b", body_b);
  visit("frame_a", frame_a), visit("frame_b", frame_b), visit("collide", collide);
  visit("break_force", break_force), visit("break_torque", break_torque);
}
MW_MEMBERS(Attractor) {
  auto& [position, strength, softening] = value;
  visit("position", position), visit("strength", strength), visit("softening", softening);
}
MW_MEMBERS(Control) {
  auto& [name, kind, joint, body, point, direction, low, high, initial] = value;
  visit("name", name), visit("kind", kind), visit("joint", joint), visit("body", body);
  visit("point", point), visit("direction", direction);
  visit("low", low), visit("high", high), visit("initial", initial);
}
MW_MEMBERS(Variation) {
  auto& [parameter, body, shape, low, high, draw, together] = value;
  if (shape.body()) body = shape.body();
  int index = shape.index();
  visit("parameter", parameter), visit("body", body), visit("shape", index);
  shape = index == -1 ? ShapeId() : ShapeId(body, index);
  visit("low", low), visit("high", high), visit("draw", draw), visit("together", together);
}
MW_MEMBERS(Scene) {
  auto& [name, space, bodies, joints, controls, attractors, options, variations] = value;
  visit("name", name), visit("space", space), visit("options", options), visit("bodies", bodies);
  visit("joints", joints), visit("controls", controls), visit("attractors", attractors);
  visit("variations", variations);
}
MW_MEMBERS(PlanOptions) {
  auto& [broad_phase, keep] = value;
  visit("broad_phase", broad_phase), visit("keep", keep);
}
#undef MW_MEMBERS

}  // namespace manyworlds::record

namespace manyworlds {
namespace {

template <class Struct>
std::string to_json(Struct value) {
  const FloatMode mode;
  std::string text;
  record::JsonWriter::put(text, value);
  return text;
}

// What we write is not half as deep; to print what is wrong takes a call per level.
constexpr int kMostLevels = 64;

bool shallow(int depth, record::Json::parse_event_t, record::Json&) {
  if (depth <= kMostLevels) return true;
  throw RecordError("is nested deeper than " + std::to_string(kMostLevels) + " levels");
}

template <class Struct>
Struct from_json(std::string_view text) {
  const FloatMode mode;
  record::Json json;
  try {
    json = record::Json::parse(text, shallow);
  } catch (const nlohmann::json::exception& error) {
    // After the number of the error: "[json.exception.parse_error.101] parse error at line 1, ...".
    const std::string what = error.what();
    const std::size_t end = what.find("] ");
    throw RecordError("is not JSON: " + (end == std::string::npos ? what : what.substr(end + 2)));
  }
  std::vector<std::string> problems;
  Struct value;
  record::JsonReader(problems, json, "").get(json, value, "");
  if (!problems.empty()) throw RecordError(std::move(problems));
  return value;
}

}  // namespace

std::string scene_to_json(const Scene& scene) { return to_json(scene); }
std::string plan_options_to_json(const PlanOptions& options) { return to_json(options); }
Scene scene_from_json(std::string_view json) { return from_json<Scene>(json); }
PlanOptions plan_options_from_json(std::string_view json) { return from_json<PlanOptions>(json); }

}  // namespace manyworlds
