#include "quantities.hpp"

#include <nanobind/nanobind.h>

#include "names.hpp"

namespace manyworlds::python {

namespace {

enum class Width { one, dimension, spin, two };

struct ObservedInfo {
  Observed what;
  const char* name;
  const char* observer;
  const char* item;
  Width width;
  const char* unit;
  const char* meaning;
};

// Observed::mass is called total_mass: a parameter has the name already.
constexpr ObservedInfo kObserved[] = {
    {Observed::kinetic_energy, "kinetic_energy", "motion", "world", Width::one, "J", ""},
    {Observed::potential_energy, "potential_energy", "motion", "world", Width::one, "J",
     "0 at the world's origin"},
    {Observed::mass, "total_mass", "motion", "world", Width::one, "kg", "of dynamic bodies"},
    {Observed::momentum, "momentum", "motion", "world", Width::dimension, "N s", ""},
    {Observed::angular_momentum, "angular_momentum", "motion", "world", Width::spin, "N m s",
     "about the world's origin"},
    {Observed::mass_center, "mass_center", "motion", "world", Width::dimension, "m", ""},
    {Observed::penetration, "penetration", "penetration", "world", Width::one, "m",
     "deepest overlap that the last step began with, 0 if none"},
    {Observed::contact_count, "contact_count", "contacts", "world", Width::one, "1",
     "contact points of the last step"},
    {Observed::touching, "touching", "touching", "body", Width::one, "1",
     "1 where a contact pushed the body in the last step, else 0"},
    {Observed::joint_position, "joint_position", "joints", "coordinate", Width::one, "m or rad",
     "coordinates of the joints (Plan.first_coordinate)"},
    {Observed::joint_speed, "joint_speed", "joints", "coordinate", Width::one, "m/s or rad/s", ""},
    {Observed::joint_force, "joint_force", "joint_loads", "joint", Width::dimension, "N",
     "on body B, world axes, last substep"},
    {Observed::joint_torque, "joint_torque", "joint_loads", "joint", Width::spin, "N m",
     "on body B about its anchor, last substep"},
    {Observed::residual, "residual", "residual", "world", Width::two, "m/s, rad/s",
     "largest change that one more sweep of the solver would make"},
    {Observed::ray_distance, "ray_distance", "rays", "ray", Width::one, "m",
     "the ray's length where it hits nothing"},
    {Observed::ray_normal, "ray_normal", "rays", "ray", Width::dimension, "1",
     "out of what is hit, world; 0: no hit"},
    {Observed::ray_body, "ray_body", "rays", "ray", Width::one, "1", "scene body, -1: no hit"},
    {Observed::ray_shape, "ray_shape", "rays", "ray", Width::one, "1",
     "index in Body.shapes, -1: no hit"},
};
static_assert(std::size(kObserved) == kObservedCount);

int components_of(Width width, bool planar) {
  switch (width) {
    case Width::one: return 1;
    case Width::dimension: return planar ? 2 : 3;
    case Width::spin: return planar ? 1 : 3;
    case Width::two: return 2;
  }
  return 1;
}

const char* owner_name(ParameterInfo::Owner owner) {
  return owner == ParameterInfo::world ? "world" : owner == ParameterInfo::body ? "body" : "shape";
}

}  // namespace

std::vector<Quantity> quantities_of(const Batch& batch, const KindRange& of) {
  const Plan& plan = batch.plan(of.kind);
  const Scene& scene = plan.scene();
  const Space space = scene.space;
  const auto items = [&](std::string_view item) {
    if (item == "body") return plan.bodies();
    if (item == "joint") return static_cast<int>(scene.joints.size());
    if (item == "coordinate") return plan.coordinates();
    if (item == "ray") {  // every world casts them all
      return static_cast<int>(batch.size(Observed::ray_distance)) / batch.worlds();
    }
    std::size_t shapes = 0;
    for (const Body& body : scene.bodies) shapes += body.shapes.size();
    return item == "shape" ? static_cast<int>(shapes) : 1;
  };
  std::vector<Quantity> out;
  for (int i = 0; i < kFieldCount; ++i) {
    const Field field{i};
    const FieldInfo& f = info(field);
    const int n = components(field, space);
    out.push_back({field, f.name, "state", "", "body", items("body"), n, f.unit, f.meaning});
  }
  for (int i = 0; i < kParameterCount; ++i) {
    const Parameter parameter{i};
    const ParameterInfo& p = info(parameter);
    const char* const owner = owner_name(p.owner);
    out.push_back(
        {parameter, p.name, "parameter", "", owner, items(owner), p.numbers, p.unit, p.meaning});
  }
  for (const ObservedInfo& o : kObserved) {
    const int n = components_of(o.width, space == Space::planar);
    out.push_back(
        {o.what, o.name, "observed", o.observer, o.item, items(o.item), n, o.unit, o.meaning});
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
