// What the scenes have in common besides the builders: bins and controls. Gravity is
// 10 m/s^2 down, the floor is at height 0.
#pragma once

#include <string>

#include "manyworlds/scene.hpp"
#include "scenes/builders.hpp"

namespace manyworlds::scenes {

// Density 1 kg/m^2 and 1000 kg/m^3.
Scene planar_scene(std::string name);
Scene spatial_scene(std::string name);

// Floor and walls whose inner faces are half_width from the middle, as planes: nothing tunnels
// through them or leaves over the top.
Body bin(Space space, double half_width);

// Bounds that a body leaves only when its centre is more than 0.5 m through the floor or a wall,
// or 100 m up.
Eigen::AlignedBox3d bounds_of(Space space, double half_width);

// A dynamic body of one shape.
Body named_body(std::string name, const Vec3& position, Geometry geometry);
BodyId add_body(Scene& scene, std::string name, const Vec3& position, Geometry geometry);

// Hills about height 0, up to `height` m high, 4 m from top to top; shapes.cpp.
HeightField rough_field(int columns, int rows, double cell, double height);

// Thrust along a direction at a point of a body (both in its frame), N, and torque about z or
// another axis of the body, from -most to most, N m.
Control thrust(std::string name, BodyId body, const Vec3& point, const Vec3& direction, double low,
               double high);
Control torque(std::string name, BodyId body, double most, const Vec3& axis = {0, 0, 1});

// The target speed of a joint's drive, from -most to most, m/s or rad/s.
Control speed_of(std::string name, JointId joint, double most, double initial);

}  // namespace manyworlds::scenes
