// A compiled MJCF model beside the spec it came from: the model has the numbers, the spec knows
// what the user wrote and on which line.
#pragma once

#include <string>
#include <vector>

#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::mjcf {

struct Model {
  SpecPtr spec;
  ModelPtr compiled;
  // The spec's element of each compiled geom, body, joint, equality and actuator; null where the
  // compiler made one.
  std::vector<const mjsGeom*> geoms;
  std::vector<const mjsBody*> bodies;
  std::vector<const mjsJoint*> joints;
  std::vector<const mjsEquality*> equalities;
  std::vector<const mjsActuator*> actuators;
  // Whether anything moves on a joint that is not free: then the scene is one of trees, for
  // Solver::newton.
  bool articulated;

  Model(SpecPtr parsed, ModelPtr model);

  // "geom 'lid' of body 'crate', line 12"; an index stands for a missing name.
  std::string geom_place(int geom) const;
  std::string body_place(int body) const;
  std::string joint_place(int joint) const;
  std::string equality_place(int equality) const;
  std::string actuator_place(int actuator) const;
  // For the other kinds that belong to no body: "tendon 'rope'".
  std::string place(mjtObj type, int id) const;
  std::string name(mjtObj type, int id) const;  // empty when unnamed

  bool contacts_enabled() const;
  // False for what is only seen: no other geom can touch it.
  bool collides(int geom) const;

  // Which body's counterpart in the scene has the mass and the geoms of this one. A static body is
  // its own; what is welded to a free body is part of that one. In an articulated model every body
  // that moves is a link, but for those without mass and joints, which are part of their parents.
  int carrier(int body) const;
};

bool any_nonzero(const mjtNum* values, int count);

// "capsule", "hinge": the words that MJCF uses.
const char* geom_type_name(int type);
const char* joint_type_name(int type);

}  // namespace manyworlds::mjcf
