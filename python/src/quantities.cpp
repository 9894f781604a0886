#include "quantities.hpp"

#include <nanobind/nanobind.h>

#include "names.hpp"

namespace manyworlds::python {

const char* word_of(ObservedItem item) {
  switch (item) {
    case ObservedItem::world: return "world";
    case ObservedItem::body: return "body";
    case ObservedItem::joint: return "joint";
    case ObservedItem::coordinate: return "coordinate";
    case ObservedItem::dof: return "dof";
    case ObservedItem::tendon: return "tendon";
    case ObservedItem::site: return "site";
    case ObservedItem::ray: return "ray";
    case ObservedItem::point: return "point";
  }
  return "?";
}

std::vector<Quantity> quantities_of(const Batch& batch, const KindRange& of) {
  const Plan& plan = batch.plan(of.kind);
  const Scene& scene = plan.scene();
  const Space space = scene.space;
  const auto items = [&](std::string_view item) {
    if (item == "body") return plan.bodies();
    if (item == "joint") return static_cast<int>(scene.joints.size());
    if (item == "control") return static_cast<int>(scene.controls.size());
    if (item == "attractor") return static_cast<int>(scene.attractors.size());
    if (item == "coordinate") return plan.coordinates();
    if (item == "dof") return plan.items(ItemKind::dof);
    if (item == "tendon") return static_cast<int>(scene.tendons.size());
    if (item == "site") return static_cast<int>(scene.sites.size());
    std::size_t shapes = 0;
    for (const Body& body : scene.bodies) shapes += body.shapes.size();
    return item == "shape" ? static_cast<int>(shapes) : 1;
  };
  std::vector<Quantity> out;
  for (const Field field : kFields) {
    const FieldInfo& f = info(field);
    out.push_back({field, f.name, "state", "", to_string(f.item), plan.items(f.item),
                   components(field, space), f.unit, f.meaning});
  }
  for (int i = 0; i < kParameterCount; ++i) {
    const Parameter parameter{i};
    const ParameterInfo& p = info(parameter);
    const char* const owner = to_string(p.owner);
    out.push_back(
        {parameter, p.name, "parameter", "", owner, items(owner), p.numbers, p.unit, p.meaning});
  }
  for (int i = 0; i < kObservedCount; ++i) {
    const Observed what{i};
    const ObservedInfo& o = info(what);
    const ObserverInfo& by = info(o.observer);
    const char* const item = word_of(by.item);
    const int n = components(what, space);
    // Every world has all that is given.
    const int count =
        is_given(by.item) ? static_cast<int>(batch.size(what)) / batch.worlds() / n : items(item);
    out.push_back({what, o.name, "observed", by.name, item, count, n, o.unit, o.meaning});
  }
  return out;
}

const Quantity& find_quantity(const std::vector<Quantity>& all, std::string_view name) {
  for (const Quantity& q : all) {
    if (name == q.name) return q;
  }
  std::vector<std::string> known;
  for (const Quantity& q : all) known.emplace_back(q.name);
  throw nanobind::value_error(("the field " + unknown_name(name, known)).c_str());
}

}  // namespace manyworlds::python
