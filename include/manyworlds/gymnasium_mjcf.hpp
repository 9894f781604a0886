// Gymnasium's MuJoCo tasks (gymnasium.hpp), loaded from a model file. Part of manyworlds::mjcf.
//
//   const Task ant = gymnasium::ant("gymnasium/envs/mujoco/assets/ant.xml", {.frame_skip = 4});
//   const Task same = gymnasium::task_of_file("Ant-v5", file, {{"frame_skip", 4}});
//
// All functions throw MjcfError if the file cannot be read or contains an unsupported element, and
// std::invalid_argument if the model does not fit the task. Both name the file. Only load_mjcf()
// reports warnings (MjcfResult::warnings).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "manyworlds/gymnasium.hpp"
#include "manyworlds/mjcf.hpp"

namespace manyworlds::gymnasium {

using Path = std::filesystem::path;

// `files`: other folders from which the model may read, and its limits.
Task inverted_pendulum(const Path& model, const InvertedPendulumOptions& options = {},
                       const MjcfOptions& files = {});
Task inverted_double_pendulum(const Path& model, const InvertedDoublePendulumOptions& options = {},
                              const MjcfOptions& files = {});
Task reacher(const Path& model, const ReacherOptions& options = {}, const MjcfOptions& files = {});
Task pusher(const Path& model, const PusherOptions& options = {}, const MjcfOptions& files = {});
Task swimmer(const Path& model, const SwimmerOptions& options = {}, const MjcfOptions& files = {});
Task half_cheetah(const Path& model, const HalfCheetahOptions& options = {},
                  const MjcfOptions& files = {});
Task hopper(const Path& model, const HopperOptions& options = {}, const MjcfOptions& files = {});
Task walker2d(const Path& model, const Walker2dOptions& options = {},
              const MjcfOptions& files = {});
Task ant(const Path& model, const AntOptions& options = {}, const MjcfOptions& files = {});
Task humanoid(const Path& model, const HumanoidOptions& options = {},
              const MjcfOptions& files = {});
Task humanoid_standup(const Path& model, const HumanoidStandupOptions& options = {},
                      const MjcfOptions& files = {});

// The task with a name such as "Ant-v5". Arguments that are not listed have their defaults. A flag
// is 1 or 0, a range has two values, others use the first. For an unknown task or argument, throws
// std::invalid_argument, which lists the known ones.
using Arguments = std::map<std::string, Range, std::less<>>;
Task task_of_file(std::string_view name, const Path& model, const Arguments& arguments = {},
                  const MjcfOptions& files = {});

}  // namespace manyworlds::gymnasium
