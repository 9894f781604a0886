#include "src/plan/state_layout.hpp"

#include "manyworlds/fields.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

int item_count(ItemKind kind, const PlanData& plan) {
  switch (kind) {
    case ItemKind::body: return static_cast<int>(plan.bodies.size());
    case ItemKind::world: return 1;
    case ItemKind::shape: {
      std::size_t shapes = 0;
      for (const Body& body : plan.scene.bodies) shapes += body.shapes.size();
      return static_cast<int>(shapes);
    }
    case ItemKind::coordinate: return plan.trees.coordinates;
    case ItemKind::dof: return static_cast<int>(plan.trees.dofs.size());
    case ItemKind::particle: return 0;  // no scene has any
  }
  return 0;
}

StateLayout state_layout(const PlanData& plan) {
  StateLayout out{};
  static_cast<kernels::ItemLayout&>(out) =
      kernels::item_layout(plan.dimension(), plan.has(Feature::orientation));
  for (int k = 0; k < kItemKinds; ++k) {
    out.items[k] = item_count(static_cast<ItemKind>(k), plan);
    out.first[k] = out.rows;
    out.rows += out.items[k] * out.stride[k];
  }
  return out;
}

int Plan::items(ItemKind kind) const { return item_count(checked_enum(kind), data()); }
std::size_t Plan::numbers(Field field) const {
  return static_cast<std::size_t>(items(info(field).item)) *
         static_cast<std::size_t>(components(field, scene().space));
}

}  // namespace manyworlds
