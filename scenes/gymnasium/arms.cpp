// Arms: one in the plane that reaches for a target, one that pushes an object to a goal.
#include "scenes/gymnasium/parts.hpp"

namespace manyworlds::gymnasium {

namespace {

// From body b to body a, m.
std::vector<Expression> apart(BodyId a, BodyId b) {
  std::vector<Expression> out;
  for (int axis = 0; axis < 3; ++axis)
    out.push_back(link_position(a, axis) - link_position(b, axis));
  return out;
}

}  // namespace

Task reacher(const Scene& model, const ReacherOptions& o) {
  TaskOf t(
      model, o.frame_skip,
      {.name = "Reacher-v5", .coordinates = 4, .dofs = 4, .max_steps = 50, .solved_at = -3.75});
  const BodyId finger = t.body("fingertip"), target = t.body("target");
  const std::vector<Expression> way = apart(finger, target);
  for (const int i : {0, 1}) t.observe("cos " + std::to_string(i), cos(qpos(i)));
  for (const int i : {0, 1}) t.observe("sin " + std::to_string(i), sin(qpos(i)));
  for (const int i : {2, 3}) t.observe("qpos " + std::to_string(i), qpos(i));
  for (const int i : {0, 1}) t.observe("qvel " + std::to_string(i), qvel(i));
  t.observe("from target x", way[0]);
  t.observe("from target y", way[1]);
  t.reward("reward_dist", -o.reward_dist_weight * norm(way));
  t.reward("reward_ctrl", -o.reward_control_weight * t.sum_of_squares_of_actions());
  t.draw(false, 0, 2, 0.1);
  t.draw(true, 0, 2, 0.005);
  CoordinateDraw goal;
  goal.first = 2, goal.low = {-0.2, -0.2}, goal.high = {0.2, 0.2};
  goal.replaces = true, goal.farthest = 0.2;
  t.task.scene.coordinate_draws.push_back(goal);
  return t.task;
}

Task pusher(const Scene& model, const PusherOptions& o) {
  TaskOf t(model, o.frame_skip,
           {.name = "Pusher-v5", .coordinates = 11, .dofs = 11, .max_steps = 100, .solved_at = 0});
  const BodyId tips = t.body("tips_arm"), object = t.body("object"), goal = t.body("goal");
  for (int i = 0; i < 7; ++i) t.observe("qpos " + std::to_string(i), qpos(i));
  for (int i = 0; i < 7; ++i) t.observe("qvel " + std::to_string(i), qvel(i));
  for (const auto& [name, body] :
       {std::pair("tips_arm", tips), std::pair("object", object), std::pair("goal", goal)}) {
    for (int axis = 0; axis < 3; ++axis) {
      t.observe(std::string(name) + " " + "xyz"[axis], link_position(body, axis));
    }
  }
  t.reward("reward_dist", -o.reward_dist_weight * norm(apart(object, goal)));
  t.reward("reward_ctrl", -o.reward_control_weight * t.sum_of_squares_of_actions());
  t.reward("reward_near", -o.reward_near_weight * norm(apart(object, tips)));
  t.draw(true, 0, 7, 0.005);
  CoordinateDraw place;  // of the object, not where the goal is
  place.first = 7, place.low = {-0.3, -0.2}, place.high = {0, 0.2};
  place.replaces = true, place.nearest = 0.17;
  CoordinateDraw middle;
  middle.first = 9, middle.low = middle.high = {0, 0}, middle.replaces = true;
  t.task.scene.coordinate_draws.push_back(place);
  t.task.scene.coordinate_draws.push_back(middle);
  return t.task;
}

}  // namespace manyworlds::gymnasium
