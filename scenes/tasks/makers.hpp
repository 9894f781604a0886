// The makers behind the catalogue of tasks, and what the tasks have in common.
#pragma once

#include "manyworlds/task.hpp"

namespace manyworlds::tasks {

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

// A planar scene with this step and gravity, m/s^2 downwards.
Scene planar_scene(double dt, double gravity);
// A shape of this mass, kg, that touches nothing.
Shape ghost(Geometry geometry, double area, double mass);
// A body's torque about z (in the plane) or its x or y axis, N m.
Control torque(std::string name, int body, double most, const Vec3& axis = {0, 0, 1});
// A force on a body's frame origin along an axis of the body, N.
Control thrust(std::string name, int body, const Vec3& direction, double low, double high);

}  // namespace manyworlds::tasks
