// Springs at the contacts within a group of touching bodies. Used inside src/plan only.
#pragma once

#include <vector>

#include "src/plan/touching.hpp"

namespace manyworlds {

// A spring between two bodies of the group. Their coordinates are displacements in m, rotations
// times a length of the body (ContactSprings::lengths).
struct ContactSpring {
  int a = -1, b = -1;                 // of the group; a is -1 if it does not move
  double mass = 0;                    // kg, effective: the stiffness is mass w^2
  double of_a[6] = {}, of_b[6] = {};  // how far the spring's length changes with coordinates
  Vec3 place = Vec3::Zero(), way = Vec3::Zero();
  double change(const double* coordinates, int dofs) const {
    double out = 0;
    for (int k = 0; k < dofs; ++k) {
      out += of_b[k] * coordinates[b * dofs + k];
      if (a >= 0) out += of_a[k] * coordinates[a * dofs + k];
    }
    return out;
  }
};

struct ContactRows {
  const Touching* touching = nullptr;
  std::vector<ContactSpring> points;    // along the normal
  std::vector<ContactSpring> friction;  // one or two along the surface, then twist about the normal
  double arm = 0;                       // m, of the twist: the farthest point from the middle
};

struct ContactSprings {
  bool planar = false;
  int dofs = 6;
  std::vector<const StandingBody*> bodies;
  std::vector<double> lengths;  // m, radii of gyration
  std::vector<ContactRows> contacts;
  std::size_t coordinates() const { return bodies.size() * static_cast<std::size_t>(dofs); }
};

// What stands at the start of a scene: groups of bodies that touch each other, each with at least
// one contact.
struct StandingScene {
  TouchingBodies touching;
  std::vector<ContactSprings> groups;  // of bodies and contacts in `touching`
};
StandingScene standing_scene(const Scene& scene);

// Of the body that is most contacts away from what is fixed or on joints: how many.
int depth_of(const ContactSprings& group);

BodyId highest_of(const Scene& scene, const ContactSprings& group);

}  // namespace manyworlds
