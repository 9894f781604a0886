// Gymnasium's tasks by name, and their arguments as lists.
#include <stdexcept>
#include <string>
#include <type_traits>

#include "manyworlds/gymnasium.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds::gymnasium {

namespace {

// visit(name, member) of all, in Gymnasium's order. A member that is missing here does not compile.
void visit(auto& options, const InvertedPendulumOptions*, auto&& visit) {
  auto& [frame_skip, reset_noise_scale] = options;
  visit("frame_skip", frame_skip), visit("reset_noise_scale", reset_noise_scale);
}
void visit(auto& options, const InvertedDoublePendulumOptions*, auto&& visit) {
  auto& [frame_skip, healthy_reward, reset_noise_scale] = options;
  visit("frame_skip", frame_skip), visit("healthy_reward", healthy_reward);
  visit("reset_noise_scale", reset_noise_scale);
}
void visit(auto& options, const ReacherOptions*, auto&& visit) {
  auto& [frame_skip, reward_dist_weight, reward_control_weight] = options;
  visit("frame_skip", frame_skip), visit("reward_dist_weight", reward_dist_weight);
  visit("reward_control_weight", reward_control_weight);
}
void visit(auto& options, const PusherOptions*, auto&& visit) {
  auto& [frame_skip, near, dist, control] = options;
  visit("frame_skip", frame_skip), visit("reward_near_weight", near);
  visit("reward_dist_weight", dist), visit("reward_control_weight", control);
}
void visit(auto& options, const SwimmerOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, noise, exclude] = options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("reset_noise_scale", noise);
  visit("exclude_current_positions_from_observation", exclude);
}
void visit(auto& options, const HalfCheetahOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, noise, exclude] = options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("reset_noise_scale", noise);
  visit("exclude_current_positions_from_observation", exclude);
}
void visit(auto& options, const HopperOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, healthy, terminate, state, z, angle, noise, exclude] =
      options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("healthy_reward", healthy);
  visit("terminate_when_unhealthy", terminate), visit("healthy_state_range", state);
  visit("healthy_z_range", z), visit("healthy_angle_range", angle);
  visit("reset_noise_scale", noise), visit("exclude_current_positions_from_observation", exclude);
}
void visit(auto& options, const Walker2dOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, healthy, terminate, z, angle, noise, exclude] = options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("healthy_reward", healthy);
  visit("terminate_when_unhealthy", terminate), visit("healthy_z_range", z);
  visit("healthy_angle_range", angle), visit("reset_noise_scale", noise);
  visit("exclude_current_positions_from_observation", exclude);
}
void visit(auto& options, const AntOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, contact, healthy, main, terminate, z, force, noise, exclude,
         cfrc_ext] = options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("contact_cost_weight", contact);
  visit("healthy_reward", healthy), visit("main_body", main);
  visit("terminate_when_unhealthy", terminate), visit("healthy_z_range", z);
  visit("contact_force_range", force), visit("reset_noise_scale", noise);
  visit("exclude_current_positions_from_observation", exclude);
  visit("include_cfrc_ext_in_observation", cfrc_ext);
}
void visit(auto& options, const HumanoidOptions*, auto&& visit) {
  auto& [frame_skip, forward, control, contact, contact_range, healthy, terminate, z, noise,
         exclude, cinert, cvel, qfrc_actuator, cfrc_ext] = options;
  visit("frame_skip", frame_skip), visit("forward_reward_weight", forward);
  visit("ctrl_cost_weight", control), visit("contact_cost_weight", contact);
  visit("contact_cost_range", contact_range), visit("healthy_reward", healthy);
  visit("terminate_when_unhealthy", terminate), visit("healthy_z_range", z);
  visit("reset_noise_scale", noise), visit("exclude_current_positions_from_observation", exclude);
  visit("include_cinert_in_observation", cinert), visit("include_cvel_in_observation", cvel);
  visit("include_qfrc_actuator_in_observation", qfrc_actuator);
  visit("include_cfrc_ext_in_observation", cfrc_ext);
}
void visit(auto& options, const HumanoidStandupOptions*, auto&& visit) {
  auto& [frame_skip, uph, control, impact, impact_range, noise, exclude, cinert, cvel,
         qfrc_actuator, cfrc_ext] = options;
  visit("frame_skip", frame_skip), visit("uph_cost_weight", uph);
  visit("ctrl_cost_weight", control), visit("impact_cost_weight", impact);
  visit("impact_cost_range", impact_range), visit("reset_noise_scale", noise);
  visit("exclude_current_positions_from_observation", exclude);
  visit("include_cinert_in_observation", cinert), visit("include_cvel_in_observation", cvel);
  visit("include_qfrc_actuator_in_observation", qfrc_actuator);
  visit("include_cfrc_ext_in_observation", cfrc_ext);
}

Argument argument(const char* name, int value) {
  return {name, Argument::Kind::integer, {static_cast<double>(value), 0}};
}
Argument argument(const char* name, double value) {
  return {name, Argument::Kind::number, {value, 0}};
}
Argument argument(const char* name, bool value) {
  return {name, Argument::Kind::flag, {value ? 1.0 : 0.0, 0}};
}
Argument argument(const char* name, const Range& value) {
  return {name, Argument::Kind::range, value};
}
void set(Range& member, const Range& value) { member = value; }
template <class T>
void set(T& member, const Range& value) {
  member = static_cast<T>(value[0]);
}

template <class Options>
Entry entry(const char* name, const char* model, Task (*make)(const Scene&, const Options&)) {
  Entry out{name, model, {}, {}};
  const Options defaults;
  visit(defaults, static_cast<const Options*>(nullptr), [&](const char* member, const auto& value) {
    out.arguments.push_back(argument(member, value));
  });
  out.make = [make, count = out.arguments.size()](const Scene& scene,
                                                  const std::vector<Argument>& arguments) {
    if (arguments.size() != count) {
      throw std::invalid_argument("arguments are " + std::to_string(arguments.size()) +
                                  ", must be " + std::to_string(count));
    }
    Options options;
    std::size_t i = 0;
    visit(options, static_cast<const Options*>(nullptr),
          [&](const char*, auto& member) { set(member, arguments[i++].value); });
    const FloatMode mode;
    return make(scene, options);
  };
  return out;
}

}  // namespace

const std::vector<Entry>& all() {
  static const std::vector<Entry> entries = {
      entry("InvertedPendulum-v5", "inverted_pendulum.xml", inverted_pendulum),
      entry("InvertedDoublePendulum-v5", "inverted_double_pendulum.xml", inverted_double_pendulum),
      entry("Reacher-v5", "reacher.xml", reacher),
      entry("Pusher-v5", "pusher_v5.xml", pusher),
      entry("Swimmer-v5", "swimmer.xml", swimmer),
      entry("Hopper-v5", "hopper.xml", hopper),
      entry("HalfCheetah-v5", "half_cheetah.xml", half_cheetah),
      entry("Walker2d-v5", "walker2d_v5.xml", walker2d),
      entry("Ant-v5", "ant.xml", ant),
      entry("Humanoid-v5", "humanoid.xml", humanoid),
      entry("HumanoidStandup-v5", "humanoidstandup.xml", humanoid_standup),
  };
  return entries;
}

const Entry* find(std::string_view name) {
  for (const Entry& entry : all()) {
    if (entry.name == name) return &entry;
  }
  return nullptr;
}

}  // namespace manyworlds::gymnasium
