// Where the fields of the state lie, as rows of one number per lane:
//   [group][kind of item][item][row of its fields][lane]
// Of the fields of an item, those that every plan has come first, in the table's order; so a plan
// that leaves one out moves no other.
#pragma once

#include <initializer_list>

#include "manyworlds/field_table.hpp"

namespace manyworlds::kernels {

enum class Dimension : int { planar, spatial };

// Rows of the fields among those of their item, -1: left out; and how many rows an item has.
struct ItemLayout {
  int row[kFieldCount];
  int stride[kItemKinds];
};
static inline constexpr ItemLayout item_layout(Dimension d, bool has_orientation) {
  ItemLayout out{};
  for (const bool always : {true, false}) {
    for (int f = 0; f < kFieldCount; ++f) {
      const FieldInfo& field = kFieldTable[f];
      if ((field.presence == FieldPresence::always) != always) continue;
      int& rows = out.stride[static_cast<int>(field.item)];
      out.row[f] = always || has_orientation ? rows : -1;
      if (out.row[f] < 0) continue;
      ++rows;  // a component more than there are spaces between their names
      for (const char* c = d == Dimension::planar ? field.planar : field.spatial; *c != 0; ++c) {
        rows += *c == ' ' ? 1 : 0;
      }
    }
  }
  return out;
}

// Rows of the fields of bodies that the kernels know. Bodies come first in the state of a group.
struct StateOffsets {
  int position, linear, angular, orientation;
};
static inline constexpr StateOffsets body_offsets(const ItemLayout& at) {
  const auto row = [&](Field f) { return at.row[static_cast<int>(f)]; };
  return {row(Field::position), row(Field::linear_velocity), row(Field::angular_velocity),
          row(Field::orientation)};
}
// Constants, so that no kernel reads the table.
static constexpr StateOffsets kPlanarOffsets = body_offsets(item_layout(Dimension::planar, true));
static constexpr StateOffsets kSpatialOffsets = body_offsets(item_layout(Dimension::spatial, true));
static inline constexpr StateOffsets state_offsets(Dimension d) {
  return d == Dimension::planar ? kPlanarOffsets : kSpatialOffsets;
}

}  // namespace manyworlds::kernels
