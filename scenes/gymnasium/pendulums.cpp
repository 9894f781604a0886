// A cart with one pole, and with two.
#include <stdexcept>

#include "scenes/gymnasium/parts.hpp"

namespace manyworlds::gymnasium {

Task inverted_pendulum(const Scene& model, const InvertedPendulumOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "InvertedPendulum-v5", .coordinates = 2, .dofs = 2, .solved_at = 950});
  t.observe_positions(0);
  t.observe_velocities();
  const Expression fallen = abs(qpos(1)) > 0.2;
  t.reward("reward_survive", !fallen);
  t.task.terminated = fallen;
  t.begin_with_noise(o.reset_noise_scale);
  return t.task;
}

Task inverted_double_pendulum(const Scene& model, const InvertedDoublePendulumOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "InvertedDoublePendulum-v5", .coordinates = 3, .dofs = 3, .solved_at = 9100});
  t.observe("cart", qpos(0));
  for (const int i : {1, 2}) t.observe("sin " + std::to_string(i), sin(qpos(i)));
  for (const int i : {1, 2}) t.observe("cos " + std::to_string(i), cos(qpos(i)));
  t.observe_velocities(10);
  t.observe("constraint force on the cart", clamp(constraint_force(0), -10, 10));

  const SiteId tip = t.first_site();
  const Expression x = site_position(tip, 0), y = site_position(tip, 2), fallen = y <= 1;
  t.reward("reward_survive", o.healthy_reward * !fallen);
  t.reward("distance_penalty", -(0.01 * square(x) + square(y - 2)));
  t.reward("velocity_penalty", -(1e-3 * square(qvel(1)) + 5e-3 * square(qvel(2))));
  t.task.terminated = fallen;
  t.draw(false, 0, t.coordinates(), o.reset_noise_scale);
  t.draw(true, 0, t.dofs(), o.reset_noise_scale, true);
  return t.task;
}

}  // namespace manyworlds::gymnasium
