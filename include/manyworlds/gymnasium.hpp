// Gymnasium's MuJoCo tasks, version 5, for Gymnasium's models. Observations, rewards, infos and
// ends of episodes equal those of gymnasium.envs.mujoco 1.x, so that policies transfer.
//
//   const Task ant = gymnasium::ant(load_mjcf(".../gymnasium/envs/mujoco/assets/ant.xml").scene);
//
// The model files are part of the package gymnasium. A changed model keeps the task if the names
// that the task requires remain; sizes and gains may differ. All functions throw
// std::invalid_argument if the model does not fit the task, and say what they expect.
//
// After a step, positions, inertias and forces of links are from the last substep, as in MuJoCo
// (Observer::links and similar); coordinates are from its end. Costs use actions as passed, before
// controls are clamped to their ranges. docs/gymnasium.md lists the differences.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "manyworlds/task.hpp"

namespace manyworlds::gymnasium {

using Range = std::array<double, 2>;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Arguments have Gymnasium's names and defaults. Weights scale terms of the reward. Noise is the
// half range (or standard deviation) of the initial state.
struct InvertedPendulumOptions {
  int frame_skip = 2;
  double reset_noise_scale = 0.01;
};
struct InvertedDoublePendulumOptions {
  int frame_skip = 5;
  double healthy_reward = 10;
  double reset_noise_scale = 0.1;
};
struct ReacherOptions {
  int frame_skip = 2;
  double reward_dist_weight = 1, reward_control_weight = 1;
};
struct PusherOptions {
  int frame_skip = 5;
  double reward_near_weight = 0.5, reward_dist_weight = 1, reward_control_weight = 0.1;
};
struct SwimmerOptions {
  int frame_skip = 4;
  double forward_reward_weight = 1, ctrl_cost_weight = 1e-4;
  double reset_noise_scale = 0.1;
  bool exclude_current_positions_from_observation = true;
};
struct HalfCheetahOptions {
  int frame_skip = 5;
  double forward_reward_weight = 1, ctrl_cost_weight = 0.1;
  double reset_noise_scale = 0.1;
  bool exclude_current_positions_from_observation = true;
};
struct HopperOptions {
  int frame_skip = 4;
  double forward_reward_weight = 1, ctrl_cost_weight = 1e-3, healthy_reward = 1;
  bool terminate_when_unhealthy = true;
  Range healthy_state_range = {-100, 100};
  Range healthy_z_range = {0.7, kInfinity};  // m
  Range healthy_angle_range = {-0.2, 0.2};   // rad
  double reset_noise_scale = 5e-3;
  bool exclude_current_positions_from_observation = true;
};
struct Walker2dOptions {
  int frame_skip = 4;
  double forward_reward_weight = 1, ctrl_cost_weight = 1e-3, healthy_reward = 1;
  bool terminate_when_unhealthy = true;
  Range healthy_z_range = {0.8, 2};     // m
  Range healthy_angle_range = {-1, 1};  // rad
  double reset_noise_scale = 5e-3;
  bool exclude_current_positions_from_observation = true;
};
struct AntOptions {
  int frame_skip = 5;
  double forward_reward_weight = 1, ctrl_cost_weight = 0.5, contact_cost_weight = 5e-4;
  double healthy_reward = 1;
  int main_body = 1;  // MuJoCo's body whose x and y are the ant's; 0 is the world
  bool terminate_when_unhealthy = true;
  Range healthy_z_range = {0.2, 1};     // m
  Range contact_force_range = {-1, 1};  // N and N m
  double reset_noise_scale = 0.1;
  bool exclude_current_positions_from_observation = true;
  bool include_cfrc_ext_in_observation = true;
};
struct HumanoidOptions {
  int frame_skip = 5;
  double forward_reward_weight = 1.25, ctrl_cost_weight = 0.1, contact_cost_weight = 5e-7;
  Range contact_cost_range = {-kInfinity, 10};
  double healthy_reward = 5;
  bool terminate_when_unhealthy = true;
  Range healthy_z_range = {1, 2};  // m
  double reset_noise_scale = 1e-2;
  bool exclude_current_positions_from_observation = true;
  bool include_cinert_in_observation = true, include_cvel_in_observation = true;
  bool include_qfrc_actuator_in_observation = true, include_cfrc_ext_in_observation = true;
};
struct HumanoidStandupOptions {
  int frame_skip = 5;
  double uph_cost_weight = 1;  // no effect, as in Gymnasium
  double ctrl_cost_weight = 0.1, impact_cost_weight = 0.5e-6;
  Range impact_cost_range = {-kInfinity, 10};
  double reset_noise_scale = 1e-2;
  bool exclude_current_positions_from_observation = true;
  bool include_cinert_in_observation = true, include_cvel_in_observation = true;
  bool include_qfrc_actuator_in_observation = true, include_cfrc_ext_in_observation = true;
};

Task inverted_pendulum(const Scene& model, const InvertedPendulumOptions& options = {});
Task inverted_double_pendulum(const Scene& model,
                              const InvertedDoublePendulumOptions& options = {});
Task reacher(const Scene& model, const ReacherOptions& options = {});
Task pusher(const Scene& model, const PusherOptions& options = {});
Task swimmer(const Scene& model, const SwimmerOptions& options = {});
Task half_cheetah(const Scene& model, const HalfCheetahOptions& options = {});
Task hopper(const Scene& model, const HopperOptions& options = {});
Task walker2d(const Scene& model, const Walker2dOptions& options = {});
Task ant(const Scene& model, const AntOptions& options = {});
Task humanoid(const Scene& model, const HumanoidOptions& options = {});
Task humanoid_standup(const Scene& model, const HumanoidStandupOptions& options = {});

// The tasks and their arguments by name, for bindings and programs.
struct Argument {
  enum class Kind { integer, number, flag, range };
  const char* name;
  Kind kind;
  Range value;  // only a range uses the second value; a flag is 1 or 0
};
struct Entry {
  const char* name;                 // "Ant-v5", as in Gymnasium
  const char* model;                // "ant.xml", in Gymnasium's assets
  std::vector<Argument> arguments;  // with the defaults
  // Takes as many arguments, in the same order; ignores their kind.
  std::function<Task(const Scene& model, const std::vector<Argument>& arguments)> make;
};
const std::vector<Entry>& all();
const Entry* find(std::string_view name);  // nullptr if unknown

}  // namespace manyworlds::gymnasium
