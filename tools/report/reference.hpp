// Short ways to describe the bodies of a case.
#pragma once

#include <utility>

#include "manyworlds/batch.hpp"
#include "scenes/known_motion.hpp"
#include "scenes/world_state.hpp"

namespace manyworlds::report {

using scenes::angle_between;
using scenes::frame_at;
using scenes::kG;
using scenes::kPi;
using scenes::lump;
using scenes::position;
using scenes::rotation;
using scenes::spin;
using scenes::up_of;
using scenes::velocity;

inline Scene empty(Space space, double gravity = kG) { return scenes::empty_scene(space, gravity); }

// Without friction unless told.
inline Body with_shape(Geometry geometry, const Vec3& position, double friction = 0,
                       double restitution = 0) {
  return scenes::body_of(scenes::shape_of(std::move(geometry), friction, restitution), position);
}
inline Body ground(Space space, double friction = 0, double restitution = 0) {
  return scenes::ground(space, friction, restitution);
}
inline void weigh(Body& body, double mass, const Vec3& moments) {
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
}

}  // namespace manyworlds::report
