#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "src/mjcf/equality.hpp"
#include "src/mjcf/keyframes.hpp"
#include "src/mjcf/options.hpp"
#include "src/mjcf/support.hpp"

namespace manyworlds::mjcf {
namespace {

// Our friction coefficient of a pair is the geometric mean, MuJoCo's the larger of the two: they
// agree where all are equal.
void compare_friction(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  if ((m.opt.enableflags & mjENBL_OVERRIDE) != 0) return;  // one coefficient for all
  double low = 0, high = 0;
  bool first = true;
  for (int g = 0; g < m.ngeom; ++g) {
    if (!model.collides(g)) continue;
    const double friction = m.geom_friction[3 * g];
    low = first ? friction : std::min(low, friction);
    high = first ? friction : std::max(high, friction);
    first = false;
  }
  if (low == high) return;
  char range[64];
  std::snprintf(range, sizeof range, "%g to %g", low, high);
  warnings.push_back(std::string("geoms have different sliding friction (") + range +
                     "): a pair uses the geometric mean here, the larger one in MuJoCo");
}

void compare_softness(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  mjsGeom defaults;
  mjs_defaultGeom(&defaults);

  const auto warn_where = [&](const char* attribute, const char* instead, auto differs) {
    int first = -1, count = 0;
    for (int g = 0; g < m.ngeom; ++g) {
      if (!model.collides(g) || !differs(g)) continue;
      if (count++ == 0) first = g;
    }
    if (count == 0) return;
    std::string text = model.geom_place(first);
    if (count > 1) text += " and " + std::to_string(count - 1) + " more";
    warnings.push_back(text + ": " + attribute + " is ignored; " + instead);
  };
  const char* softness = "contact stiffness follows ContactOptions::frequency";
  const char* margin = "contact margins follow ContactOptions::slop";
  const char* dimension = "contacts are frictional with one sliding coefficient (condim 3)";

  warn_where("solref", softness, [&](int g) {
    return !std::equal(m.geom_solref + mjNREF * g, m.geom_solref + mjNREF * (g + 1),
                       defaults.solref);
  });
  warn_where("solimp", softness, [&](int g) {
    return !std::equal(m.geom_solimp + mjNIMP * g, m.geom_solimp + mjNIMP * (g + 1),
                       defaults.solimp);
  });
  warn_where("solmix", softness, [&](int g) { return m.geom_solmix[g] != defaults.solmix; });
  warn_where("margin", margin, [&](int g) { return m.geom_margin[g] != defaults.margin; });
  warn_where("gap", margin, [&](int g) { return m.geom_gap[g] != defaults.gap; });
  warn_where("condim", dimension, [&](int g) { return m.geom_condim[g] != defaults.condim; });
  warn_where("priority", "a pair mixes the friction of both geoms",
             [&](int g) { return m.geom_priority[g] != defaults.priority; });
  warn_where("torsional friction", dimension,
             [&](int g) { return m.geom_friction[3 * g + 1] != defaults.friction[1]; });
  warn_where("rolling friction", dimension,
             [&](int g) { return m.geom_friction[3 * g + 2] != defaults.friction[2]; });
  if ((m.opt.enableflags & mjENBL_OVERRIDE) != 0) {
    warnings.push_back("option: o_margin, o_solref and o_solimp are ignored; " +
                       std::string(softness));
  }
}

void compare_height_fields(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_type[g] != mjGEOM_HFIELD || !model.collides(g)) continue;
    char base[32];
    std::snprintf(base, sizeof base, "%g m", m.hfield_size[4 * m.geom_dataid[g] + 3]);
    warnings.push_back(model.geom_place(g) +
                       ": is solid to any depth below its surface, in MuJoCo " + "no deeper than " +
                       base + " below its origin");
  }
}

void note_ignored(const Model& model, std::vector<std::string>& warnings) {
  const mjModel& m = *model.compiled;
  const auto note = [&](mjtObj type, mjtSize count, const char* why) {
    if (count == 0) return;
    std::string text = model.place(type, 0);
    if (count > 1) text += " and " + std::to_string(count - 1) + " more";
    warnings.push_back(text + ": ignored; " + why);
  };
  note(mjOBJ_SENSOR, m.nsensor, "sensors are not computed");
}

}  // namespace

std::vector<std::string> differences(const Model& model) {
  std::vector<std::string> warnings;
  if (!model.articulated) {
    compare_friction(model, warnings);
    compare_softness(model, warnings);
  }
  compare_height_fields(model, warnings);
  compare_equalities(model, warnings);
  compare_options(model, warnings);
  note_ignored(model, warnings);
  compare_keyframes(model, warnings);
  return warnings;
}

}  // namespace manyworlds::mjcf
