// Checks of what varies from world to world.
#include <algorithm>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "src/scene/checks.hpp"
#include "src/scene/joint_numbers.hpp"
#include "src/scene/variations.hpp"

namespace manyworlds::detail {
namespace {

// "body 3, shape 1", "joint 2"
std::string place_of(const NumberOwner& of) {
  if (of.joint >= 0) return "joint " + std::to_string(of.joint);
  if (of.control >= 0) return "control " + std::to_string(of.control);
  if (of.attractor >= 0) return "attractor " + std::to_string(of.attractor);
  if (of.body < 0) return "the world";
  return "body " + std::to_string(of.body) +
         (of.shape >= 0 ? ", shape " + std::to_string(of.shape) : "");
}

// Range of numbers that a scene may have, whatever else is in it.
bool check_number(Checker& checker, const std::string& field, Parameter parameter, int component,
                  double value) {
  std::string unit = info(parameter).unit;
  const ParameterInfo::Owner owner = info(parameter).owner;
  const bool of_joint = owner == ParameterInfo::joint || owner == ParameterInfo::control;
  if (unit == "1" || of_joint) unit.clear();  // it depends on the kind of joint
  switch (parameter) {
    case Parameter::size: return checker.size(field, value);
    case Parameter::density: return checker.density(field, value);
    case Parameter::mass: return checker.positive(field, value, unit, kMinMass, kLargestMass);
    case Parameter::restitution: return checker.between(field, value, 0, 1);
    case Parameter::break_force:
    case Parameter::break_torque:
      if (value > 0) return checker.finite(field, value, unit);
      checker.add(field, "is " + number_text(value) + ", must be > 0");
      return false;
    case Parameter::inertia_scale: return checker.positive(field, value, unit, 1e-6, 1e6);
    case Parameter::gravity:
    case Parameter::wind:
    case Parameter::attractor_position:
    case Parameter::attractor_strength:
    case Parameter::anchor_a:
    case Parameter::anchor_b:
    case Parameter::axes_a:
    case Parameter::axes_b:
    case Parameter::shape_position:
    case Parameter::shape_rotation:
    case Parameter::initial_position:
    case Parameter::initial_rotation:
    case Parameter::initial_linear_velocity:
    case Parameter::initial_angular_velocity:
    case Parameter::center_of_mass:
    case Parameter::control_low:
    case Parameter::control_high:
    case Parameter::gravity_scale:
    case Parameter::rest:
    case Parameter::limit_low:
    case Parameter::limit_high:
    case Parameter::motor_speed:
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::gear:
    case Parameter::force_low:
    case Parameter::force_high:
    case Parameter::limit_solref:
    case Parameter::contact_solref: return checker.finite(field, value, unit);
    case Parameter::limit_solimp:
    case Parameter::contact_solimp:
      if (component < 2) return checker.between(field, value, 0, 1);
      return checker.not_negative(field, value, unit);
    case Parameter::motor_position:
    case Parameter::control_point:
    case Parameter::control_direction: return checker.finite(field, value, unit);
    case Parameter::cone: return checker.between(field, value, 0, std::numbers::pi);
    case Parameter::pulley_ratio:
      return checker.positive(field, value, unit, kMinSize, kLargestSize);
    case Parameter::drive_frequency:
    case Parameter::limit_frequency:
    case Parameter::spring_frequency:
    case Parameter::kp:
      if (value > 0) return checker.finite(field, value, unit);
      checker.add(field, "is " + number_text(value) + ", must be > 0");
      return false;
    default: return checker.not_negative(field, value, unit);
  }
}

const char* who_can(Parameter parameter) {
  switch (parameter) {
    case Parameter::size: return "a shape of a moving body with a size";
    case Parameter::shape_position:
    case Parameter::shape_rotation: return "a shape of a moving body";
    case Parameter::density: return "a dynamic body whose mass is not given";
    case Parameter::torsional_resistance: return "a shape of a spatial scene";
    case Parameter::armature:
    case Parameter::damping:
    case Parameter::stiffness: return "a hinge, slider or ball joint";
    case Parameter::rest: return "a hinge or slider";
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::gear:
    case Parameter::force_low:
    case Parameter::force_high: return "a control of kind joint_force";
    case Parameter::kp:
      return "a position servo, of gain (kp, 0, 0) and bias (0, -kp, -kv), kp > 0";
    case Parameter::kv:
      return "a position servo, of gain (kp, 0, 0) and bias (0, -kp, -kv), kp > 0, or a velocity "
             "servo, of gain (kv, 0, 0) and bias (0, 0, -kv), kv > 0";
    case Parameter::limit_low:
    case Parameter::limit_high: return "a joint with a limit that is finite there";
    case Parameter::limit_solref:
    case Parameter::limit_solimp: return "a hinge, slider or ball joint with a finite limit";
    case Parameter::motor_speed:
    case Parameter::motor_force: return "a hinge, slider or wheel with a drive";
    case Parameter::drive_stiffness:
    case Parameter::drive_damping:
      return "a hinge, slider or wheel whose drive has a spring of stiffness and damping";
    case Parameter::drive_frequency:
    case Parameter::drive_damping_ratio:
      return "a hinge, slider or wheel whose drive has a spring of a frequency";
    case Parameter::motor_position: return "a hinge, slider or wheel whose drive has a spring";
    case Parameter::limit_stiffness:
    case Parameter::limit_damping:
      return "a joint whose limit has a spring of stiffness and damping";
    case Parameter::limit_frequency:
    case Parameter::limit_damping_ratio: return "a joint whose limit has a spring of a frequency";
    case Parameter::spring_stiffness:
    case Parameter::spring_damping:
      return "a distance, wheel or target joint with a spring of stiffness and damping";
    case Parameter::spring_frequency:
    case Parameter::spring_damping_ratio:
      return "a distance, wheel or target joint with a spring of a frequency";
    case Parameter::length: return "a distance joint or pulley with a length";
    case Parameter::cone: return "a ball joint with a cone";
    case Parameter::pulley_ratio: return "a pulley";
    case Parameter::control_point: return "a control of kind thrust";
    case Parameter::control_direction:
      return "a control of kind thrust or, in space, of kind torque";
    case Parameter::break_force:
    case Parameter::break_torque: return "a joint with such a load, which is finite";
    case Parameter::axes_a:
    case Parameter::axes_b:
      return "a hinge, slider, fixed or wheel joint, or a ball joint with a cone or twist";
    case Parameter::initial_position:
    case Parameter::initial_rotation:
    case Parameter::initial_linear_velocity:
    case Parameter::initial_angular_velocity: return "a body that moves";
    default: return "a dynamic body";
  }
}

// Does it name something that is there and has the parameter?
bool check_target(Checker& checker, const Scene& scene, const Variation& v) {
  if (!checker.named("parameter", v.parameter) || !checker.named("draw", v.draw)) return false;
  const ParameterInfo& parameter = info(v.parameter);
  const auto reject = [&](const char* field, int index, const std::string& expected) {
    checker.add(field, "is " + std::to_string(index) + ", must be " + expected);
    return false;
  };
  const std::string every =
      std::string("-1: ") + parameter.name + " belongs to the " + to_string(parameter.owner);
  const NumberOwner of{body_of(v).index(), v.shape.index(), v.joint.index(), v.control.index(),
                       v.attractor};
  const int body = of.body, shape = of.shape;
  const bool of_shape = parameter.owner == ParameterInfo::shape;
  if (v.body && v.shape.body() && v.body != v.shape.body()) {
    return reject("shape", shape,
                  "a shape of body " + std::to_string(v.body.index()) + ", but belongs to body " +
                      std::to_string(body));
  }
  if (is_of_newton(v.parameter) && scene.options.solver.method != Solver::newton) {
    checker.add("parameter", std::string("is ") + parameter.name +
                                 ", which varies per world only with the newton solver, not " +
                                 to_string(scene.options.solver.method));
    return false;
  }
  if (is_of_bodies(v.parameter) && scene.options.solver.method == Solver::newton) {
    checker.add("parameter", std::string("is ") + parameter.name +
                                 ", which does not vary per world with the newton solver");
    return false;
  }
  if (parameter.owner != ParameterInfo::body && !of_shape && body != -1) {
    return reject("body", body, every);
  }
  if (!of_shape && shape != -1) return reject("shape", shape, every);
  if (parameter.owner != ParameterInfo::joint && of.joint != -1) {
    return reject("joint", of.joint, every);
  }
  if (parameter.owner != ParameterInfo::control && of.control != -1) {
    return reject("control", of.control, every);
  }
  if (parameter.owner != ParameterInfo::attractor && of.attractor != -1) {
    return reject("attractor", of.attractor, every);
  }
  const auto check_index = [&](const char* field, int index, std::size_t count) {
    if (-1 <= index && index < static_cast<int>(count)) return true;
    return reject(field, index, "-1 or the index of one of " + std::to_string(count));
  };
  if (!check_index("body", body, scene.bodies.size()) ||
      !check_index("joint", of.joint, scene.joints.size()) ||
      !check_index("control", of.control, scene.controls.size()) ||
      !check_index("attractor", of.attractor, scene.attractors.size())) {
    return false;
  }
  const auto can = [&] {
    if (can_vary(scene, v.parameter, of)) return true;
    checker.add(parameter.name,
                std::string("cannot vary here, must belong to ") + who_can(v.parameter));
    return false;
  };
  if (of.joint >= 0 || of.control >= 0) return can();
  if (body < 0 && shape != -1) return reject("shape", shape, "-1 where body is -1");
  if (body < 0) return true;
  if (!check_index("shape", shape, scene.bodies[static_cast<std::size_t>(body)].shapes.size())) {
    return false;
  }
  return (of_shape && shape < 0) || can();
}

// Numbers that are worked out from shapes, which have to be sound for it.
bool is_of_shapes(Parameter parameter) {
  return parameter == Parameter::mass || parameter == Parameter::size ||
         parameter == Parameter::center_of_mass;
}

// What a planar scene has no use for: z of vectors, x and y of rotations.
bool leaves_plane(Parameter parameter, int component) {
  switch (parameter) {
    case Parameter::gravity:
    case Parameter::wind:
    case Parameter::attractor_position:
    case Parameter::anchor_a:
    case Parameter::anchor_b:
    case Parameter::control_point:
    case Parameter::control_direction:
    case Parameter::shape_position:
    case Parameter::initial_position:
    case Parameter::initial_linear_velocity:
    case Parameter::center_of_mass: return component == 2;
    case Parameter::axes_a:
    case Parameter::axes_b:
    case Parameter::shape_rotation:
    case Parameter::initial_rotation:
    case Parameter::initial_angular_velocity: return component < 2;
    default: return false;
  }
}

// Every number of the scene that it is about: its range, and the scene's own where nothing draws.
void check_range(Checker& checker, const Scene& scene, bool sound, const Variation& v,
                 const VariedNumber& n) {
  std::string low = "low", high = "high";
  if (info(v.parameter).numbers > 1) {
    low = element_name(low, static_cast<std::size_t>(n.component));
    high = element_name(high, static_cast<std::size_t>(n.component));
  }
  const bool good = check_number(checker, low, v.parameter, n.component, n.low) &&
                    check_number(checker, high, v.parameter, n.component, n.high);
  if (!good) return;
  if (checker.planar() && leaves_plane(n.parameter, n.component)) {
    if (n.low != 0 || n.high != 0) checker.add(high, "must be 0 in a planar scene, as " + low);
    return;
  }
  if (v.parameter == Parameter::kv && n.low <= 0 && !can_vary(scene, Parameter::kp, n.of)) {
    checker.add(low, "is " + number_text(n.low) + ", must be > 0 for a velocity servo");
  } else if (n.low > n.high) {
    checker.add(low, "is " + number_text(n.low) + ", must be at most " + high + ", which is " +
                         number_text(n.high));
  } else if (is_solref(v.parameter) && (n.low > 0) != (n.high > 0)) {
    checker.add(low, "is " + number_text(n.low) + " and " + high + " " + number_text(n.high) +
                         ", both must be > 0 (time constant, damping ratio) or neither "
                         "(-stiffness, -damping)");
  } else if (v.draw == Draw::log_uniform && n.low <= 0) {
    checker.add(low, "is " + number_text(n.low) + ", must be > 0 for a logarithmic draw");
  } else if (v.draw == Draw::none && (sound || !is_of_shapes(v.parameter))) {
    const double own = get_number(scene, n.parameter, n.of, n.component);
    if (own >= n.low && own <= n.high) return;
    const bool of_world = info(v.parameter).owner == ParameterInfo::world;
    checker.add("draw", "is none, but the scene's " + std::string(info(v.parameter).name) +
                            (of_world ? "" : " of " + place_of(n.of)) + ", " + number_text(own) +
                            ", is not within " + low + " and " + high);
  }
}

using Key = std::tuple<Parameter, int, int, int, int, int, int>;
Key key_of(Parameter parameter, const VariedNumber& n) {
  return {parameter, n.of.body, n.of.shape, n.of.joint, n.of.control, n.of.attractor, n.component};
}
// The variation before that has this number, or one that it is made of; -1: none.
int already_varied(const std::map<Key, int>& seen, const VariedNumber& n) {
  const auto variation_of = [&](Parameter parameter, int component) {
    VariedNumber other = n;
    other.component = component;
    const auto at = seen.find(key_of(parameter, other));
    return at == seen.end() ? -1 : at->second;
  };
  if (n.parameter == Parameter::kp || n.parameter == Parameter::kv) {
    for (const Parameter numbers : {Parameter::gain, Parameter::bias}) {
      if (const int v = variation_of(numbers, 0); v >= 0) return v;
    }
  }
  return variation_of(n.parameter, n.component);
}

// A hull that is stretched far along one axis and not along another would become flat.
void check_hulls(Checker checker, const Scene& scene, int variation) {
  constexpr double kMaxStretch = 1000;
  std::map<std::pair<int, int>, std::pair<double, double>> range;  // of a shape's half extents
  for (const VariedNumber& n : varied_numbers(scene)) {
    if (n.variation != variation || n.parameter != Parameter::size) continue;
    const std::pair<int, int> of(n.of.body, n.of.shape);
    const Shape& shape = scene.bodies[static_cast<std::size_t>(of.first)]
                             .shapes[static_cast<std::size_t>(of.second)];
    if (!std::holds_alternative<Hull>(shape.geometry)) continue;
    auto& [low, high] = range.try_emplace(of, n.low, n.high).first->second;
    low = std::min(low, n.low), high = std::max(high, n.high);
    if (high <= kMaxStretch * low) continue;
    checker.add("size", "of a hull varies from " + number_text(low) + " to " + number_text(high) +
                            " m, must vary by a factor of at most " + number_text(kMaxStretch));
    return;
  }
}

}  // namespace

void check_variations(Checker checker, const Scene& scene, bool sound) {
  if (scene.variations.empty()) return;
  const std::size_t before = checker.count();
  const auto at = [&](int i) { return checker.at("variation " + std::to_string(i)); };
  bool found = true;
  for (std::size_t i = 0; i < scene.variations.size(); ++i) {
    Checker part = at(static_cast<int>(i));
    found &= check_target(part, scene, scene.variations[i]);
  }
  if (!found) return;

  std::map<Key, int> seen;
  std::vector<std::size_t> numbers(scene.variations.size()), issues(scene.variations.size());
  for (const VariedNumber& n : varied_numbers(scene)) {
    const auto v = static_cast<std::size_t>(n.variation);
    Checker part = at(n.variation);
    ++numbers[v];
    const int other = already_varied(seen, n);
    seen.emplace(key_of(n.parameter, n), n.variation);
    if (issues[v] > 0) continue;  // the same again for every body
    const std::size_t count = checker.count();
    if (other < 0) {
      check_range(part, scene, sound, scene.variations[v], n);
    } else {
      NumberOwner of = n.of;
      of.shape = -1;
      part.add(info(n.parameter).name,
               "varies already, by variation " + std::to_string(other) + " (" + place_of(of) + ")");
    }
    issues[v] += checker.count() - count;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] > 0) continue;
    at(static_cast<int>(i))
        .add(info(scene.variations[i].parameter).name, "matches nothing in this scene");
  }
  if (!sound || checker.count() != before) return;
  for (std::size_t i = 0; i < scene.variations.size(); ++i) {
    if (scene.variations[i].parameter == Parameter::size) {
      check_hulls(at(static_cast<int>(i)), scene, static_cast<int>(i));
    }
  }

  // What is fine one by one must be so together, at either end, and where the two ends of limits
  // come closest.
  const std::vector<VariedNumber> varied = varied_numbers(scene);
  const auto check_end = [&](const std::string& name, auto is_high) {
    Scene extreme = scene;
    extreme.variations.clear();
    std::vector<double> values;
    for (const VariedNumber& n : varied) values.push_back(is_high(n.parameter) ? n.high : n.low);
    set_numbers(extreme, varied, values.data());
    for (const Issue& issue : validate(extreme)) checker.add(name, to_string(issue));
  };
  check_end("variations at their lowest:", [](Parameter) { return false; });
  check_end("variations at their highest:", [](Parameter) { return true; });
  if (checker.count() != before) return;
  for (const Parameter low : {Parameter::limit_low, Parameter::control_low, Parameter::force_low}) {
    const auto is_low_end = [&](Parameter parameter) { return parameter == low; };
    const auto is_of_low_end = [&](const VariedNumber& n) { return is_low_end(n.parameter); };
    if (std::none_of(varied.begin(), varied.end(), is_of_low_end)) continue;
    check_end("variations at their lowest, " + std::string(info(low).name) + " at its highest:",
              is_low_end);
  }
}

}  // namespace manyworlds::detail
