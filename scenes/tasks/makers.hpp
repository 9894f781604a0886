// The makers behind the catalogue of tasks, and what the tasks have in common.
#pragma once

#include "manyworlds/task.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::tasks {

using scenes::ground, scenes::shape_of, scenes::thrust, scenes::torque;

Task cart_pole();
Task cart_pole_swing_up();
Task pendulum();
Task acrobot();
Task lunar_lander();
Task lunar_lander_continuous();
Task hopper();
Task pusher();
Task bird_sling();
Task ball_balance();
Task stacking();

// A planar scene of the task's name with this step, s, and gravity, m/s^2 downwards.
Scene planar_scene(const Task& task, double dt, double gravity);
// A shape of this mass, kg, that touches nothing.
Shape ghost(Geometry geometry, double area, double mass);

}  // namespace manyworlds::tasks
