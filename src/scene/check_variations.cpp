// Checks of what varies from world to world.
#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "src/scene/checks.hpp"
#include "src/scene/variations.hpp"

namespace manyworlds::detail {
namespace {

// Range of numbers that a scene may have, whatever else is in it.
bool check_number(Checker& checker, const std::string& field, Parameter parameter, double value) {
  const std::string unit = std::string(info(parameter).unit) == "1" ? "" : info(parameter).unit;
  switch (parameter) {
    case Parameter::size: return checker.size(field, value);
    case Parameter::density: return checker.density(field, value);
    case Parameter::mass: return checker.positive(field, value, unit, kMinMass, kLargestMass);
    case Parameter::restitution: return checker.between(field, value, 0, 1);
    case Parameter::gravity:
    case Parameter::gravity_scale: return checker.finite(field, value, unit);
    default: return checker.not_negative(field, value, unit);
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
  const std::string every = std::string("-1: ") + parameter.name + " is of the ";
  const int body = body_of(v).index(), shape = v.shape.index();
  if (v.body && v.shape.body() && v.body != v.shape.body()) {
    return reject("shape", shape,
                  "a shape of body " + std::to_string(v.body.index()) + ", is one of body " +
                      std::to_string(body));
  }
  if (parameter.owner == ParameterInfo::world && body != -1) {
    return reject("body", body, every + "world");
  }
  if (parameter.owner != ParameterInfo::shape && shape != -1) {
    return reject("shape", shape, every + (body < 0 ? "world" : "body"));
  }
  const int bodies = static_cast<int>(scene.bodies.size());
  if (body < -1 || body >= bodies) {
    return reject("body", body, "-1 or the index of one of " + std::to_string(bodies));
  }
  if (body < 0 && shape != -1) return reject("shape", shape, "-1 where body is -1");
  if (body < 0) return true;
  const int shapes = static_cast<int>(scene.bodies[static_cast<std::size_t>(body)].shapes.size());
  if (shape < -1 || shape >= shapes) {
    return reject("shape", shape, "-1 or the index of one of " + std::to_string(shapes));
  }
  const bool named = parameter.owner == ParameterInfo::body || shape >= 0;
  if (named && !can_vary(scene, v.parameter, body, shape)) {
    const char* why = v.parameter == Parameter::size      ? "a shape of a moving body with a size"
                      : v.parameter == Parameter::density ? "a dynamic body whose mass is not given"
                                                          : "a dynamic body";
    checker.add(parameter.name, std::string("cannot vary here, must be of ") + why);
    return false;
  }
  return true;
}

// Numbers that are worked out from shapes, which have to be sound for it.
bool is_of_shapes(Parameter parameter) {
  return parameter == Parameter::mass || parameter == Parameter::size;
}

// Every number of the scene that it is about: its range, and the scene's own where nothing draws.
void check_range(Checker& checker, const Scene& scene, bool sound, const Variation& v,
                 const VariedNumber& n) {
  std::string low = "low", high = "high";
  if (info(v.parameter).numbers > 1) {
    low = element_name(low, static_cast<std::size_t>(n.component));
    high = element_name(high, static_cast<std::size_t>(n.component));
  }
  const bool good = check_number(checker, low, v.parameter, n.low) &&
                    check_number(checker, high, v.parameter, n.high);
  if (!good) return;
  if (checker.planar() && v.parameter == Parameter::gravity && n.component == 2) {
    if (n.low != 0 || n.high != 0) checker.add(high, "must be 0 in a planar scene, as " + low);
    return;
  }
  if (n.low > n.high) {
    checker.add(low, "is " + number_text(n.low) + ", must be at most " + high + ", which is " +
                         number_text(n.high));
  } else if (v.draw == Draw::log_uniform && n.low <= 0) {
    checker.add(low, "is " + number_text(n.low) + ", must be > 0 for a logarithmic draw");
  } else if (v.draw == Draw::none && (sound || !is_of_shapes(v.parameter))) {
    const double own = get_number(scene, n.parameter, n.body, n.shape, n.component);
    if (own >= n.low && own <= n.high) return;
    std::string place;
    if (n.body >= 0) place = " of body " + std::to_string(n.body);
    if (n.shape >= 0) place += ", shape " + std::to_string(n.shape);
    checker.add("draw", "is none, but the scene's " + std::string(info(v.parameter).name) + place +
                            ", " + number_text(own) + ", is not within " + low + " and " + high);
  }
}

// A hull that is stretched far along one axis and not along another would become flat.
void check_hulls(Checker checker, const Scene& scene, int variation) {
  constexpr double kMaxStretch = 1000;
  std::map<std::pair<int, int>, std::pair<double, double>> range;  // of a shape's half extents
  for (const VariedNumber& n : varied_numbers(scene)) {
    if (n.variation != variation || n.parameter != Parameter::size) continue;
    const Shape& shape =
        scene.bodies[static_cast<std::size_t>(n.body)].shapes[static_cast<std::size_t>(n.shape)];
    if (!std::holds_alternative<Hull>(shape.geometry)) continue;
    const std::pair<int, int> of(n.body, n.shape);
    auto& [low, high] = range.try_emplace(of, n.low, n.high).first->second;
    low = std::min(low, n.low), high = std::max(high, n.high);
    if (high <= kMaxStretch * low) continue;
    checker.add("size", "of a hull goes from " + number_text(low) + " to " + number_text(high) +
                            " m, must be by no more than " + number_text(kMaxStretch) + " times");
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

  std::map<std::tuple<Parameter, int, int, int>, int> seen;
  std::vector<std::size_t> numbers(scene.variations.size()), issues(scene.variations.size());
  for (const VariedNumber& n : varied_numbers(scene)) {
    const auto v = static_cast<std::size_t>(n.variation);
    Checker part = at(n.variation);
    ++numbers[v];
    const auto [other, fresh] =
        seen.insert({{n.parameter, n.body, n.shape, n.component}, n.variation});
    if (issues[v] > 0) continue;  // the same again for every body
    const std::size_t count = checker.count();
    if (fresh) {
      check_range(part, scene, sound, scene.variations[v], n);
    } else {
      part.add(info(n.parameter).name, "varies already, by variation " +
                                           std::to_string(other->second) + " (body " +
                                           std::to_string(n.body) + ")");
    }
    issues[v] += checker.count() - count;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] > 0) continue;
    at(static_cast<int>(i))
        .add(info(scene.variations[i].parameter).name, "is of nothing in this scene");
  }
  if (!sound || checker.count() != before) return;
  for (std::size_t i = 0; i < scene.variations.size(); ++i) {
    if (scene.variations[i].parameter == Parameter::size) {
      check_hulls(at(static_cast<int>(i)), scene, static_cast<int>(i));
    }
  }

  // What is fine one by one must be so together, at either end.
  for (const bool high : {false, true}) {
    Scene extreme = scene;
    extreme.variations.clear();
    for (const VariedNumber& n : varied_numbers(scene)) {
      set_number(extreme, n, high ? n.high : n.low);
    }
    for (const Issue& issue : validate(extreme)) {
      checker.add(high ? "variations at their highest:" : "variations at their lowest:",
                  to_string(issue));
    }
  }
}

}  // namespace manyworlds::detail
