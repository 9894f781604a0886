// Gymnasium's MuJoCo tasks (gymnasium.hpp) of a model's file. Of the library manyworlds::mjcf.
//
//   const Task ant = gymnasium::ant("gymnasium/envs/mujoco/assets/ant.xml", {.frame_skip = 4});
//   const Task same = gymnasium::task_of_file("Ant-v5", file, {{"frame_skip", 4}});
//
// All throw MjcfError for a file that cannot be read or that holds what is not simulated, and
// std::invalid_argument for a model that is not one of the task's; both name the file. What was
// read but does not act as in MuJoCo is told by load_mjcf() alone (MjcfResult::warnings).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "manyworlds/gymnasium.hpp"
#include "manyworlds/mjcf.hpp"

namespace manyworlds::gymnasium {

using Path = std::filesystem::path;

// `files`: from which other folders the model may read, and how much.
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

// The task of a name, "Ant-v5", with the arguments that are given, by their names, and the defaults
// of the others: a flag is 1 or 0, a range both of its numbers, others the first. Throws
// std::invalid_argument for a task or an argument that there is not, too, with those that there
// are.
using Arguments = std::map<std::string, Range, std::less<>>;
Task task_of_file(std::string_view name, const Path& model, const Arguments& arguments = {},
                  const MjcfOptions& files = {});

}  // namespace manyworlds::gymnasium
