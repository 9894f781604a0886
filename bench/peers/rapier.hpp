// Rapier, which is Rust (rapier/src/lib.rs), behind a C interface. What has a type here has the
// same members in the same order there.
#pragma once

#include <cstddef>

#include "bench/peers/peer.hpp"

namespace manyworlds::peers {

extern "C" {
struct PeerBody {
  int form;  // as Form
  double radius, half;
  double position[3], velocity[3];
  double angle;
  double rotation[4];
};
struct PeerSlab {
  double centre[3], half[3];
};
struct PeerScene {
  double step, gravity, friction, density, restitution;
  int chain;
  const PeerBody* bodies;
  std::size_t body_count;
  const PeerSlab* slabs;
  std::size_t slab_count;
};
struct PeerPose {
  double position[3];
  double angle;
  double rotation[4];
};
struct RapierWorld;

RapierWorld* peer_rapier_make(const PeerScene* scene);
void peer_rapier_step(RapierWorld* world);
void peer_rapier_poses(const RapierWorld* world, PeerPose* out);  // of all bodies
void peer_rapier_free(RapierWorld* world);
const char* peer_rapier_version();
}

// By the library that the program is linked to, planar or spatial.
Engine rapier_engine(bool planar);

}  // namespace manyworlds::peers
