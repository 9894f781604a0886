#include "src/mjcf/filter.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace manyworlds::mjcf {
namespace {

using Class = std::pair<int, int>;  // contype, conaffinity

Class class_of(const mjModel& m, int geom) {
  return {m.geom_contype[geom], m.geom_conaffinity[geom]};
}

// In the order of their first geom.
std::vector<Class> classes_of(const Model& model) {
  std::vector<Class> classes;
  for (int g = 0; g < model.compiled->ngeom; ++g) {
    const Class c = class_of(*model.compiled, g);
    if (model.collides(g) && std::find(classes.begin(), classes.end(), c) == classes.end()) {
      classes.push_back(c);
    }
  }
  return classes;
}

}  // namespace

int filter_classes(const Model& model) { return static_cast<int>(classes_of(model).size()); }

std::vector<Filter> filters(const Model& model) {
  const std::vector<Class> classes = classes_of(model);
  std::vector<Filter> of_class(classes.size(), Filter{0, 0});
  for (std::size_t i = 0; i < classes.size(); ++i) {
    of_class[i].category = std::uint32_t{1} << i;
    for (std::size_t j = 0; j < classes.size(); ++j) {
      if ((classes[i].first & classes[j].second) != 0 ||
          (classes[j].first & classes[i].second) != 0) {
        of_class[i].mask |= std::uint32_t{1} << j;
      }
    }
  }
  std::vector<Filter> result(static_cast<std::size_t>(model.compiled->ngeom), Filter{0, 0});
  for (int g = 0; g < model.compiled->ngeom; ++g) {
    if (!model.collides(g)) continue;
    const auto at = std::find(classes.begin(), classes.end(), class_of(*model.compiled, g));
    result[static_cast<std::size_t>(g)] = of_class[static_cast<std::size_t>(at - classes.begin())];
  }
  return result;
}

}  // namespace manyworlds::mjcf
