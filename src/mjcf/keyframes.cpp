#include "src/mjcf/keyframes.hpp"

#include <algorithm>
#include <cstddef>

namespace manyworlds::mjcf {
namespace {

// "key 'squat' and 2 more"
std::string places(const Model& model, const std::vector<int>& keys) {
  const std::string first = model.place(mjOBJ_KEY, keys.front());
  if (keys.size() == 1) return first;
  return first + " and " + std::to_string(keys.size() - 1) + " more";
}

}  // namespace

void add_keyframes(const Model& model, Scene& scene) {
  const mjModel& m = *model.compiled;
  const auto numbers = [](const mjtNum* all, int key, auto count) {
    const auto n = static_cast<std::ptrdiff_t>(count);
    return std::vector<double>(all + key * n, all + (key + 1) * n);
  };
  for (int k = 0; k < m.nkey; ++k) {
    scene.add(Keyframe{.name = model.name(mjOBJ_KEY, k),
                       .generalized_position = numbers(m.key_qpos, k, m.nq),
                       .generalized_velocity = numbers(m.key_qvel, k, m.nv),
                       .controls = numbers(m.key_ctrl, k, m.nu)});
  }
}

void compare_keyframes(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  std::vector<int> ignored, timed;
  for (int k = 0; k < m.nkey; ++k) {
    if (!model.articulated) {
      ignored.push_back(k);
    } else if (m.key_time[k] != 0) {
      timed.push_back(k);
    }
  }
  if (!ignored.empty()) {
    warnings.push_back(places(model, ignored) +
                       ": ignored; worlds start at the poses of the bodies, at rest");
  }
  if (!timed.empty()) {
    warnings.push_back(places(model, timed) + ": time is ignored; worlds have no separate clocks");
  }
}

}  // namespace manyworlds::mjcf
