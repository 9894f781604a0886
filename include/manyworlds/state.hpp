// Types in which state is read from and written to a Batch.
#pragma once

#include <cstddef>
#include <span>
#include <variant>

#include "manyworlds/fields.hpp"

namespace manyworlds {

// A caller's array to write to, or to read from. Its precision is independent of the batch's.
using Reals = std::variant<std::span<float>, std::span<double>>;
using ConstReals = std::variant<std::span<const float>, std::span<const double>>;

// Pose and velocities of a body, in the frames of Body.
struct BodyState {
  Vec3 position = Vec3::Zero();          // m
  Quat rotation = Quat::Identity();      // need not be unit
  Vec3 linear_velocity = Vec3::Zero();   // m/s, of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

// Memory layout of a state field, for direct access (Batch::lane_blocks). Component c of item i
// (FieldInfo::item) in lane l of group g is the element
//   g group_stride + i item_stride + c component_stride + l
// of data, which points to float or double (Batch::precision()).
struct LaneBlocks {
  void* data = nullptr;  // nullptr: the plan omits the field (Feature::orientation)
  int groups = 0, items = 0, components = 0, lanes = 0;
  std::size_t group_stride = 0, item_stride = 0, component_stride = 0;  // elements
};

}  // namespace manyworlds
