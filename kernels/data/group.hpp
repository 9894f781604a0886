// GroupView: the persistent state of the worlds that share one register, one world per lane.
#pragma once

#include "kernels/data/tables.hpp"

namespace manyworlds::kernels {

inline constexpr int kEndOfKeys = 0x7fffffff;

// Rows of a lane's stored impulses: one that stays zero, one for what nobody reads, then those of
// its manifolds. What is used of a group is together, however much there is room for.
inline constexpr int kZeroRow = 0, kSpillRow = 1, kFirstRow = 2;

template <class Real>
struct ContactCache {
  Real* rows;          // [kFirstRow + capacity][lane][cache row]
  std::int32_t* keys;  // [capacity + 1][lane]; of a lane ascending, closed by kEndOfKeys
};

template <class Real>
struct GroupView {
  Real* state;  // [body][component][lane]
  ContactCache<Real> cache[kLists];
  std::uint32_t* status;  // [lane], bits of Status, and of the audit
  const Real* force;      // [body][force 3, torque 3][lane], or nullptr
  ConstantBlocks<Real> constants;
  Real* joint_impulse;  // [part][kPartImpulses][lane]
  const Real* control;  // [control][lane]
  // [joint of the scene] lanes in which it is broken or disabled; nullptr: all hold in all lanes.
  std::uint32_t* disabled_joints;

  // Which bodies take part, as lanes of each body; nullptr: all do. Sleep needs all of them,
  // disabled bodies the first three.
  std::uint32_t* asleep;        // [body]
  const std::uint32_t* absent;  // [body], disabled
  std::uint32_t* idle;          // [1], not 0 when some body is asleep or absent in some lane
  Real* rest_time;              // [body][lane], s
  std::int32_t* island;         // [body][lane], label of the island that fell asleep together
  std::uint32_t* resting;       // [1], lanes in which nothing can move until the world is woken
};

// Bits of the public Status (include/manyworlds/batch.hpp).
inline constexpr std::uint32_t kNonFinite = 1, kOutOfRange = 2, kOutOfBounds = 4, kOverflow = 8,
                               kJointBroken = 16, kDiverged = 32;
inline constexpr std::uint32_t kFrozen = kNonFinite | kOutOfRange;
// The rest of a status word belongs to the audit of energy (kernels/observe/audit.hpp): what has
// been gained so far, and the world's steps since the last audit.
inline constexpr std::uint32_t kPublicStatus = 0xff;
inline constexpr int kGainShift = 8, kAuditShift = 24;
inline constexpr std::uint32_t kMaxGain = 0xffff;
inline constexpr std::uint32_t kAuditCount = 0xffu << kAuditShift;
inline constexpr int kMaxAuditEvery = 255;

// What a group's step counted; the pipeline adds it up per thread.
struct GroupCounters {
  std::uint32_t dense_blocks = 0;  // blocks that the dense layout needs (or would need)
  std::uint32_t active = 0;        // active lanes in them
  std::uint32_t points = 0;        // contact points within 4 slop
  std::uint32_t manifolds = 0;
};

}  // namespace manyworlds::kernels
