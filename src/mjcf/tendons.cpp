#include "src/mjcf/tendons.hpp"

#include <cstddef>

#include "src/mjcf/compliance.hpp"
#include "src/mjcf/pose.hpp"
#include "src/mjcf/support.hpp"

namespace manyworlds::mjcf {
namespace {

// Whether it does anything by itself but keep a limit. What acts on it, or holds it, is refused for
// its own sake; models also have tendons to be looked at.
bool pulls(const mjModel& m, int tendon) {
  return m.tendon_stiffness[tendon] != 0 || m.tendon_damping[tendon] != 0 ||
         m.tendon_frictionloss[tendon] != 0 || m.tendon_armature[tendon] != 0 ||
         any_nonzero(m.tendon_stiffnesspoly + mjNPOLY * tendon, mjNPOLY) ||
         any_nonzero(m.tendon_dampingpoly + mjNPOLY * tendon, mjNPOLY);
}
bool is_fixed_tendon(const mjModel& m, int tendon) {
  return m.wrap_type[m.tendon_adr[tendon]] == mjWRAP_JOINT;
}
bool limits(const mjModel& m, int tendon) {
  return m.tendon_limited[tendon] && (m.opt.disableflags & (mjDSBL_LIMIT | mjDSBL_CONSTRAINT)) == 0;
}

std::string problem_of(const Model& model, int t) {
  const mjModel& m = *model.compiled;
  if (!model.articulated) return "tendons are not simulated yet; expected none";
  if (pulls(m, t)) {
    return "has stiffness, damping, friction loss or armature, which are not simulated yet for "
           "tendons; expected none of them";
  }
  if (limits(m, t) && !is_fixed_tendon(m, t)) {
    return "is a spatial tendon with a limit, which is not simulated yet; expected a fixed one";
  }
  return "";
}

Limit limit_of(const mjModel& m, int t) {
  Limit limit;
  limit.low = m.tendon_range[2 * t], limit.high = m.tendon_range[2 * t + 1];
  limit.margin = m.tendon_margin[t];
  limit.compliance = compliance(m.tendon_solref_lim + mjNREF * t, m.tendon_solimp_lim + mjNIMP * t);
  return limit;
}

}  // namespace

void check_tendons(const Model& model, std::vector<std::string>& problems) {
  for (int t = 0; t < model.compiled->ntendon; ++t) {
    const std::string problem = problem_of(model, t);
    if (!problem.empty()) problems.push_back(model.place(mjOBJ_TENDON, t) + ": " + problem);
  }
}

void add_tendons(const Model& model, const std::vector<JointId>& scene_joint, Scene& scene) {
  const mjModel& m = *model.compiled;
  for (int t = 0; t < m.ntendon; ++t) {
    if (!is_fixed_tendon(m, t)) continue;
    Tendon tendon;
    tendon.name = model.name(mjOBJ_TENDON, t);
    for (int i = m.tendon_adr[t]; i < m.tendon_adr[t] + m.tendon_num[t]; ++i) {
      tendon.terms.push_back(
          {scene_joint[static_cast<std::size_t>(m.wrap_objid[i])], m.wrap_prm[i]});
    }
    if (limits(m, t)) tendon.limit = limit_of(m, t);
    scene.tendons.push_back(std::move(tendon));
  }
}

}  // namespace manyworlds::mjcf
