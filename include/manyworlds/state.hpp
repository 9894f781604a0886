// State as it is passed in and out of a Batch.
#pragma once

#include <cstddef>
#include <span>
#include <variant>

#include "manyworlds/fields.hpp"

namespace manyworlds {

// Numbers of a caller's array, whatever the batch computes in: to be filled, and to be read.
using Reals = std::variant<std::span<float>, std::span<double>>;
using ConstReals = std::variant<std::span<const float>, std::span<const double>>;

// Where a body is and how it moves, in the frames of Body.
struct BodyState {
  Vec3 position = Vec3::Zero();          // m
  Quat rotation = Quat::Identity();      // need not be unit
  Vec3 linear_velocity = Vec3::Zero();   // m/s, of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

// A state field as the step keeps it, for access in place (Batch::lane_blocks):
// component c of item i (FieldInfo::item) in lane l of group g is number
//   g group_stride + i item_stride + c component_stride + l
// of data, which points to float or double (Batch::precision()).
struct LaneBlocks {
  void* data = nullptr;  // nullptr: the plan leaves the field out (Feature::orientation)
  int groups = 0, items = 0, components = 0, lanes = 0;
  std::size_t group_stride = 0, item_stride = 0, component_stride = 0;  // numbers
};

}  // namespace manyworlds
