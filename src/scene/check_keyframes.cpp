// Checks of the keyframes of a scene.
#include <map>

#include "src/scene/checks.hpp"
#include "src/scene/tree_order.hpp"

namespace manyworlds::detail {
namespace {

// What a world has in joint coordinates: nothing but with Solver::newton. Its trees are sound.
class Coordinates {
 public:
  struct Rotation {
    std::size_t first;  // coordinate
    std::string of;
  };
  std::size_t positions = 0, velocities = 0;
  std::vector<Rotation> rotations;

  Coordinates() = default;
  explicit Coordinates(const Scene& scene) {
    if (scene.options.solver.method != Solver::newton) return;
    const TreeOrder order = tree_order(scene);
    for (const int link : order.links) {
      const auto body = static_cast<std::size_t>(link);
      add(scene, body, order.series[body]);
    }
  }

 private:
  void add(const Scene& scene, std::size_t body, const std::vector<int>& series) {
    if (series.empty()) {
      rotations.push_back({positions + 3, named_part("body", body, scene.bodies[body].name)});
      positions += 7, velocities += 6;
    }
    for (const int index : series) {
      const auto j = static_cast<std::size_t>(index);
      const Joint& joint = scene.joints[j];
      if (std::holds_alternative<FixedJoint>(joint.type)) continue;
      const bool ball = std::holds_alternative<BallJoint>(joint.type);
      if (ball) rotations.push_back({positions, named_part("joint", j, joint.name)});
      positions += ball ? 4 : 1, velocities += ball ? 3 : 1;
    }
  }
};

// `size`: what there must be, unless there is nothing. Returns whether it is good.
bool check_numbers(Checker& at, const char* name, const std::vector<double>& numbers,
                   const std::size_t* size) {
  if (size != nullptr && !numbers.empty() && numbers.size() != *size) {
    at.add(name, "has " + std::to_string(numbers.size()) + " values, must have " +
                     std::to_string(*size) + (*size > 0 ? ", or none" : ""));
    return false;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!at.finite(element_name(name, i), numbers[i], "")) return false;
  }
  return true;
}

// Quaternions need not be unit.
void check_rotations(Checker& at, const Coordinates& coordinates,
                     const std::vector<double>& numbers) {
  for (const Coordinates::Rotation& r : coordinates.rotations) {
    const double* q = numbers.data() + r.first;
    at.rotation("generalized_position of " + r.of, Quat(q[0], q[1], q[2], q[3]));
  }
}

}  // namespace

void check_keyframes(Checker checker, const Scene& scene, bool sound) {
  if (scene.keyframes.empty()) return;
  const Coordinates coordinates = sound ? Coordinates(scene) : Coordinates();
  const std::size_t controls = scene.controls.size();
  std::map<std::string, std::size_t> first;  // of each name
  for (std::size_t i = 0; i < scene.keyframes.size(); ++i) {
    const Keyframe& keyframe = scene.keyframes[i];
    Checker at = checker.at(named_part("keyframe", i, keyframe.name));
    const auto [same, fresh] = first.emplace(keyframe.name, i);
    if (!fresh && !keyframe.name.empty()) {
      at.add("name", "is also that of keyframe " + std::to_string(same->second) +
                         ", must be unique or empty");
    }
    const bool good = check_numbers(at, "generalized_position", keyframe.generalized_position,
                                    sound ? &coordinates.positions : nullptr);
    if (good && !keyframe.generalized_position.empty()) {
      check_rotations(at, coordinates, keyframe.generalized_position);
    }
    check_numbers(at, "generalized_velocity", keyframe.generalized_velocity,
                  sound ? &coordinates.velocities : nullptr);
    check_numbers(at, "controls", keyframe.controls, &controls);
  }
}

}  // namespace manyworlds::detail
