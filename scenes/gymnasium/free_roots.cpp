// Those whose root moves freely: Ant, Humanoid, HumanoidStandup. Their first coordinates are x, y,
// z and the rotation of the torso.
#include <utility>

#include "scenes/gymnasium/parts.hpp"

namespace manyworlds::gymnasium {

namespace {

struct Component {
  Observed what;
  int axis;
  const char* name;
};
// The order in which MuJoCo has the numbers of a body.
constexpr Component kInertia[] = {
    {Observed::link_inertia, 0, "xx"}, {Observed::link_inertia, 1, "yy"},
    {Observed::link_inertia, 2, "zz"}, {Observed::link_product, 0, "xy"},
    {Observed::link_product, 1, "xz"}, {Observed::link_product, 2, "yz"},
    {Observed::link_moment, 0, "mx"},  {Observed::link_moment, 1, "my"},
    {Observed::link_moment, 2, "mz"},  {Observed::link_mass, 0, "m"}};
constexpr Component kVelocity[] = {
    {Observed::link_angular_velocity, 0, "wx"}, {Observed::link_angular_velocity, 1, "wy"},
    {Observed::link_angular_velocity, 2, "wz"}, {Observed::link_velocity, 0, "vx"},
    {Observed::link_velocity, 1, "vy"},         {Observed::link_velocity, 2, "vz"}};
constexpr Component kForce[] = {
    {Observed::external_torque, 0, "tx"}, {Observed::external_torque, 1, "ty"},
    {Observed::external_torque, 2, "tz"}, {Observed::external_force, 0, "fx"},
    {Observed::external_force, 1, "fy"},  {Observed::external_force, 2, "fz"}};

template <std::size_t n, class Map>
void observe_links(TaskOf& t, const char* name, const Component (&components)[n], Map map) {
  for (const BodyId body : t.links()) {
    // Bodies of Gymnasium's ant have no names.
    const std::string& given = t.task.scene.at(body).name;
    const std::string link = given.empty() ? std::to_string(body.index()) : given;
    for (const Component& c : components) {
      t.observe(std::string(name) + " " + link + " " + c.name,
                map(observed(c.what, body.index(), c.axis)));
    }
  }
}
template <std::size_t n>
void observe_links(TaskOf& t, const char* name, const Component (&components)[n]) {
  observe_links(t, name, components, [](const Expression& x) { return x; });
}

template <class Map>
Expression squares_of_forces(const TaskOf& t, Map map) {
  std::vector<Expression> all;
  for (const BodyId body : t.links()) {
    for (const Component& c : kForce) {
      all.push_back(square(map(observed(c.what, body.index(), c.axis))));
    }
  }
  return sum(all);
}

// What both humanoids observe.
template <class Options>
void observe_humanoid(TaskOf& t, const Options& o) {
  t.observe_positions(o.exclude_current_positions_from_observation ? 2 : 0);
  t.observe_velocities();
  if (o.include_cinert_in_observation) observe_links(t, "cinert", kInertia);
  if (o.include_cvel_in_observation) observe_links(t, "cvel", kVelocity);
  for (int i = 6; i < t.dofs() && o.include_qfrc_actuator_in_observation; ++i) {
    t.observe("qfrc_actuator " + std::to_string(i), actuator_force(i));
  }
  if (o.include_cfrc_ext_in_observation) observe_links(t, "cfrc_ext", kForce);
}

Expression clipped(const Expression& x, const Range& range) {
  Expression out = x;
  if (range[0] > -kInfinity) out = max(out, range[0]);
  if (range[1] < kInfinity) out = min(out, range[1]);
  return out;
}

// x or y of the mass centre of all bodies, m.
Expression mass_center(const TaskOf& t, int axis) {
  double total = 0;
  std::vector<Expression> moments;
  for (const BodyId body : t.links()) {
    const double mass = mass_properties(t.task.scene, t.task.scene.at(body)).mass;
    total += mass;
    moments.push_back(mass * link_center(body, axis));
  }
  return sum(moments) / total;
}

constexpr int kFreeCoordinates = 7;

}  // namespace

Task ant(const Scene& model, const AntOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "Ant-v5", .least_coordinates = kFreeCoordinates, .solved_at = 6000});
  const auto clip = [&](const Expression& x) { return clipped(x, o.contact_force_range); };
  t.observe_positions(o.exclude_current_positions_from_observation ? 2 : 0);
  t.observe_velocities();
  if (o.include_cfrc_ext_in_observation) observe_links(t, "cfrc_ext", kForce, clip);

  const BodyId main = t.link_of_mujoco(o.main_body);
  const Expression x_velocity = t.rate(link_position(main, 0));
  const Expression healthy = within_or_at(qpos(2), o.healthy_z_range);
  tell_xy(t);
  t.step_info("x_velocity", x_velocity);
  t.step_info("y_velocity", t.rate(link_position(main, 1)));
  t.reward("reward_forward", o.forward_reward_weight * x_velocity);
  t.reward("reward_ctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.reward("reward_contact", -o.contact_cost_weight * squares_of_forces(t, clip));
  t.reward("reward_survive", o.healthy_reward * healthy);
  if (o.terminate_when_unhealthy) t.task.terminated = !healthy;
  t.begin_with_noise(o.reset_noise_scale, true);
  return t.task;
}

Task humanoid(const Scene& model, const HumanoidOptions& o) {
  TaskOf t(model, o.frame_skip, {.name = "Humanoid-v5", .least_coordinates = kFreeCoordinates});
  observe_humanoid(t, o);
  const Expression x_velocity = t.rate(mass_center(t, 0));
  const Expression healthy = within(qpos(2), o.healthy_z_range);
  const Expression forces = squares_of_forces(t, [](const Expression& x) { return x; });
  tell_xy(t);
  tell_tendons(t);
  t.step_info("x_velocity", x_velocity);
  t.step_info("y_velocity", t.rate(mass_center(t, 1)));
  t.reward("reward_survive", o.healthy_reward * healthy);
  t.reward("reward_forward", o.forward_reward_weight * x_velocity);
  t.reward("reward_ctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.reward("reward_contact", -clipped(o.contact_cost_weight * forces, o.contact_cost_range));
  if (o.terminate_when_unhealthy) t.task.terminated = !healthy;
  t.begin_with_noise(o.reset_noise_scale);
  return t.task;
}

Task humanoid_standup(const Scene& model, const HumanoidStandupOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "HumanoidStandup-v5", .least_coordinates = kFreeCoordinates});
  observe_humanoid(t, o);
  const Expression forces = squares_of_forces(t, [](const Expression& x) { return x; });
  t.info("x_position", qpos(0));
  t.info("y_position", qpos(1));
  t.info("z_distance_from_origin", qpos(2) - t.start(2));
  tell_tendons(t);
  t.reward("reward_linup", qpos(2) / t.task.scene.options.dt);
  t.reward("reward_quadctrl", -o.ctrl_cost_weight * t.sum_of_squares_of_actions());
  t.reward("reward_impact", -clipped(o.impact_cost_weight * forces, o.impact_cost_range));
  t.task.rewards.push_back({"reward_constant", 1});
  t.begin_with_noise(o.reset_noise_scale);
  return t.task;
}

}  // namespace manyworlds::gymnasium
