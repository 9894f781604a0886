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
  // The spec's element of each compiled geom, body, joint and equality; null where the compiler
  // made one.
  std::vector<const mjsGeom*> geoms;
  std::vector<const mjsBody*> bodies;
  std::vector<const mjsJoint*> joints;
  std::vector<const mjsEquality*> equalities;

  Model(SpecPtr parsed, ModelPtr model);

  // "geom 'lid' of body 'crate', line 12"; an index stands for a missing name.
  std::string geom_place(int geom) const;
  std::string body_place(int body) const;
  std::string joint_place(int joint) const;
  std::string equality_place(int equality) const;
  // For the other kinds that belong to no body: "tendon 'rope'".
  std::string place(mjtObj type, int id) const;
  std::string name(mjtObj type, int id) const;  // empty when unnamed

  bool contacts_enabled() const;
  // False for what is only seen: no other geom can touch it.
  bool collides(int geom) const;
};

// "capsule", "hinge": the words that MJCF uses.
const char* geom_type_name(int type);
const char* joint_type_name(int type);

}  // namespace manyworlds::mjcf
