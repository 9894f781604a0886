// StateLayout: where the fields of a plan's worlds lie, as rows of one number per lane. One kind of
// item comes after the other, each item with all of its fields.
#pragma once

#include "kernels/data/state_layout.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

struct StateLayout : kernels::ItemLayout {
  int items[kItemKinds];
  int first[kItemKinds];  // row of the first item
  int rows;               // of a world

  bool has(Field field) const { return row[static_cast<int>(field)] >= 0; }
  // Row of a field's first component; the others follow.
  int row_of(Field field, int item) const {
    const auto kind = static_cast<int>(kFieldTable[static_cast<int>(field)].item);
    return first[kind] + item * stride[kind] + row[static_cast<int>(field)];
  }
};
StateLayout state_layout(const PlanData& plan);

// How many of these a world has.
int item_count(ItemKind kind, const PlanData& plan);

}  // namespace manyworlds
