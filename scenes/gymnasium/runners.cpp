// Those that run in a plane: Swimmer, HalfCheetah, Hopper, Walker2d. The first coordinates are the
// root's: of the swimmer x, y and its angle, of the others x, z and the pitch.
#include "scenes/gymnasium/parts.hpp"

namespace manyworlds::gymnasium {

Task swimmer(const Scene& model, const SwimmerOptions& o) {
  TaskOf t(model, o.frame_skip, {.name = "Swimmer-v5", .least_coordinates = 3, .solved_at = 360});
  t.observe_positions(o.exclude_current_positions_from_observation ? 2 : 0);
  t.observe_velocities();
  const Expression x_velocity = t.rate(qpos(0));
  tell_xy(t);
  t.step_info("x_velocity", x_velocity);
  t.step_info("y_velocity", t.rate(qpos(1)));
  t.reward("reward_forward", o.forward_reward_weight * x_velocity);
  t.reward("reward_ctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.begin_with_noise(o.reset_noise_scale);
  return t.task;
}

Task half_cheetah(const Scene& model, const HalfCheetahOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "HalfCheetah-v5", .least_coordinates = 3, .solved_at = 4800});
  t.observe_positions(o.exclude_current_positions_from_observation ? 1 : 0);
  t.observe_velocities();
  const Expression x_velocity = t.rate(qpos(0));
  tell_x(t, x_velocity);
  t.reward("reward_forward", o.forward_reward_weight * x_velocity);
  t.reward("reward_ctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.begin_with_noise(o.reset_noise_scale, true);
  return t.task;
}

namespace {

// What hoppers and walkers share: they run as long as they are healthy.
template <class Options>
Task run_upright(TaskOf& t, const Options& o, const Expression& healthy) {
  t.observe_positions(o.exclude_current_positions_from_observation ? 1 : 0);
  t.observe_velocities(10);
  const Expression x_velocity = t.rate(qpos(0));
  tell_x(t, x_velocity);
  t.info("z_distance_from_origin", qpos(1) - t.start(1));
  t.reward("reward_forward", o.forward_reward_weight * x_velocity);
  t.reward("reward_ctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.reward("reward_survive", o.healthy_reward * healthy);
  if (o.terminate_when_unhealthy) t.task.terminated = !healthy;
  t.begin_with_noise(o.reset_noise_scale);
  return t.task;
}

}  // namespace

Task hopper(const Scene& model, const HopperOptions& o) {
  TaskOf t(model, o.frame_skip, {.name = "Hopper-v5", .least_coordinates = 3, .solved_at = 3800});
  Expression healthy = within(qpos(1), o.healthy_z_range) & within(qpos(2), o.healthy_angle_range);
  for (int i = 2; i < t.coordinates(); ++i)
    healthy = healthy & within(qpos(i), o.healthy_state_range);
  for (int i = 0; i < t.dofs(); ++i) healthy = healthy & within(qvel(i), o.healthy_state_range);
  return run_upright(t, o, healthy);
}

Task walker2d(const Scene& model, const Walker2dOptions& o) {
  TaskOf t(model, o.frame_skip, {.name = "Walker2d-v5", .least_coordinates = 3});
  return run_upright(t, o,
                     within(qpos(1), o.healthy_z_range) & within(qpos(2), o.healthy_angle_range));
}

}  // namespace manyworlds::gymnasium
