// Checks of the keyframes of a scene.
#include <map>

#include "src/scene/checks.hpp"

namespace manyworlds::detail {
namespace {

// Numbers of a world in joint coordinates: none but with Solver::newton.
struct Sizes {
  std::size_t coordinates = 0, dofs = 0;
};
Sizes sizes_of(const Scene& scene) {
  Sizes out;
  if (scene.options.solver.method != Solver::newton) return out;
  std::vector<bool> held(scene.bodies.size(), false);
  for (const Joint& joint : scene.joints) {
    held[static_cast<std::size_t>(joint.body_b.index())] = true;
    if (std::holds_alternative<FixedJoint>(joint.type)) continue;
    const bool ball = std::holds_alternative<BallJoint>(joint.type);
    out.coordinates += ball ? 4 : 1, out.dofs += ball ? 3 : 1;
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (held[b] || scene.bodies[b].motion != Motion::dynamic) continue;
    out.coordinates += 7, out.dofs += 6;
  }
  return out;
}

// `size`: what there must be, unless there is nothing.
void check_numbers(Checker& at, const char* name, const std::vector<double>& numbers,
                   const std::size_t* size) {
  if (size != nullptr && !numbers.empty() && numbers.size() != *size) {
    at.add(name, "has " + std::to_string(numbers.size()) + " numbers, must have " +
                     std::to_string(*size) + (*size > 0 ? ", or none" : ""));
    return;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!at.finite(element_name(name, i), numbers[i], "")) return;
  }
}

}  // namespace

void check_keyframes(Checker checker, const Scene& scene, bool sound) {
  if (scene.keyframes.empty()) return;
  const Sizes sizes = sound ? sizes_of(scene) : Sizes{};
  const std::size_t controls = scene.controls.size();
  std::map<std::string, std::size_t> first;  // of each name
  for (std::size_t i = 0; i < scene.keyframes.size(); ++i) {
    const Keyframe& keyframe = scene.keyframes[i];
    Checker at = checker.at(named_part("keyframe", i, keyframe.name));
    const auto [same, fresh] = first.emplace(keyframe.name, i);
    if (!fresh && !keyframe.name.empty()) {
      at.add("name",
             "is that of keyframe " + std::to_string(same->second) + ", must be another, or empty");
    }
    check_numbers(at, "generalized_position", keyframe.generalized_position,
                  sound ? &sizes.coordinates : nullptr);
    check_numbers(at, "generalized_velocity", keyframe.generalized_velocity,
                  sound ? &sizes.dofs : nullptr);
    check_numbers(at, "controls", keyframe.controls, &controls);
  }
}

}  // namespace manyworlds::detail
