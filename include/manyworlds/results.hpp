// Results of a Batch: status, energy, contacts and stage times of its worlds.
#pragma once

#include <cstdint>
#include <string>

#include "manyworlds/ids.hpp"
#include "manyworlds/scene.hpp"

namespace manyworlds {

// Why a world is lost or what went wrong in it; a set of bits.
enum class Status : std::uint32_t {
  ok = 0,
  non_finite = 1,        // frozen: a value was not finite
  out_of_range = 2,      // frozen: |x| > 1e10 m or |v| > 1e5 m/s
  out_of_bounds = 4,     // a body left Options::bounds; the world still steps
  contact_overflow = 8,  // more contacts than the plan's capacity; the newest were dropped
  joint_broken = 16,     // a joint broke since the reset (Joint::break_force)
  diverged = 32,         // energy increased without a source (BatchOptions::audit_every)
};
inline constexpr Status operator|(Status a, Status b) {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
inline constexpr Status operator&(Status a, Status b) {
  return static_cast<Status>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
inline constexpr Status operator~(Status a) {
  return static_cast<Status>(~static_cast<std::uint32_t>(a));
}
inline constexpr bool has(Status set, Status bit) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit)) != 0;
}
inline constexpr bool frozen(Status s) { return has(s, Status::non_finite | Status::out_of_range); }
inline constexpr bool lost(Status s) { return frozen(s) || has(s, Status::out_of_bounds); }
std::string to_string(Status status);  // "ok", "non_finite", "out_of_bounds|contact_overflow"

// Energy of one world at its current state, J. Potential energy is zero at the world's origin.
struct Energy {
  double kinetic = 0;
  double potential = 0;
};

// Contacts of the last step, over all worlds (see Batch::measure_contacts).
struct ContactSummary {
  double points_per_world = 0;  // points closer than 4 slop
  double manifolds_per_world = 0;
  double max_penetration = 0;  // m, measured from the shapes at the current state
  double mean_occupancy = 0;   // active lanes / lanes of the dense contact blocks, last step
};

// One contact point at the current state, as the next step would find it.
struct Contact {
  BodyId body_a = {}, body_b = {};     // if one is fixed, it is body_a
  ShapeId shape_a = {}, shape_b = {};  // of these bodies
  Vec3 normal = Vec3::Zero();          // unit, from A to B, world
  Vec3 point = Vec3::Zero();           // m, world, half way between the surfaces
  double separation = 0;               // m, negative when the shapes overlap
  int feature = 0;                     // which features touch; equal ids persist from step to step
  double normal_impulse = 0;           // N s, the warm start impulse of the next substep
};

struct StageTime {
  std::string stage = {};
  double seconds = 0;
};

}  // namespace manyworlds
