#include "src/mjcf/material.hpp"

#include <cstddef>

#include "src/mjcf/compliance.hpp"

namespace manyworlds::mjcf {
namespace {

Material of_free_bodies(const mjModel& m, int g, bool frictional) {
  const bool one_for_all = (m.opt.enableflags & mjENBL_OVERRIDE) != 0;
  const double friction = one_for_all ? m.opt.o_friction[0] : m.geom_friction[3 * g];
  return {.friction = frictional ? friction : 0, .restitution = 0};
}

Material of_links(const mjModel& m, int g) {
  return {.friction = m.geom_friction[3 * g],
          .restitution = 0,
          .soft = {.dimensions = m.geom_condim[g],
                   .compliance = compliance(m.geom_solref + mjNREF * g, m.geom_solimp + mjNIMP * g),
                   .margin = m.geom_margin[g],
                   .gap = m.geom_gap[g],
                   .priority = m.geom_priority[g],
                   .weight = m.geom_solmix[g]}};
}

}  // namespace

// MuJoCo's pair has the larger condim of the two: only where every geom has condim 1 is nothing
// frictional.
bool any_friction(const Model& model) {
  for (int g = 0; g < model.compiled->ngeom; ++g) {
    if (model.collides(g) && model.compiled->geom_condim[g] != 1) return true;
  }
  return false;
}

void check_materials(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  if (!model.articulated) return;
  for (int g = 0; g < m.ngeom; ++g) {
    const int condim = m.geom_condim[g];
    if (!model.collides(g) || condim == 1 || condim == 3) continue;
    problems.push_back(model.geom_place(g) + ": condim " + std::to_string(condim) +
                       " is not simulated with joints yet; expected 1 or 3");
  }
}

std::vector<Material> materials(const Model& model) {
  const mjModel& m = *model.compiled;
  const bool frictional = any_friction(model);
  std::vector<Material> result;
  for (int g = 0; g < m.ngeom; ++g) {
    result.push_back(model.articulated ? of_links(m, g) : of_free_bodies(m, g, frictional));
  }
  return result;
}

}  // namespace manyworlds::mjcf
