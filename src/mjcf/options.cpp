#include "src/mjcf/options.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "src/mjcf/material.hpp"
#include "src/mjcf/pose.hpp"

namespace manyworlds::mjcf {
namespace {

const char* integrator_name(int integrator) {
  switch (integrator) {
    case mjINT_EULER: return "Euler";
    case mjINT_RK4: return "RK4";
    case mjINT_IMPLICIT: return "implicit";
    case mjINT_IMPLICITFAST: return "implicitfast";
    case mjINT_DISCRETE: return "discrete";
    default: return "of unknown type";
  }
}

bool is_disabled(const mjModel& m, int flag) { return (m.opt.disableflags & flag) != 0; }

// Whether a limit or a contact asks for a time constant that the flag refsafe makes longer.
bool any_quick_constraint(const Model& model) {
  const mjModel& m = *model.compiled;
  const auto quick = [&](const mjtNum* solref) {
    return solref[0] > 0 && solref[0] < 2 * m.opt.timestep;
  };
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_limited[j] && quick(m.jnt_solref + mjNREF * j)) return true;
  }
  for (int t = 0; t < m.ntendon; ++t) {
    if (m.tendon_limited[t] && quick(m.tendon_solref_lim + mjNREF * t)) return true;
  }
  for (int g = 0; g < m.ngeom; ++g) {
    if (model.collides(g) && quick(m.geom_solref + mjNREF * g)) return true;
  }
  return false;
}

void check_flags(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  const auto refuse = [&](bool found, const std::string& flag, const char* state) {
    if (!found) return;
    problems.push_back("option: flag " + flag + "='" + state +
                       "' is not simulated with joints yet; expected " +
                       (std::string(state) == "enable" ? "disable" : "enable"));
  };
  refuse(is_disabled(m, mjDSBL_ACTUATION) && m.nactuator > 0, "actuation", "disable");
  refuse(is_disabled(m, mjDSBL_REFSAFE) && any_quick_constraint(model), "refsafe", "disable");
  const std::pair<const char*, int> added[] = {{"override", mjENBL_OVERRIDE},
                                               {"sleep", mjENBL_SLEEP},
                                               {"diagexact", mjENBL_DIAGEXACT},
                                               {"ipc", mjENBL_IPC},
                                               {"speculative", mjENBL_SPECULATIVE}};
  for (const auto& [flag, bit] : added) refuse((m.opt.enableflags & bit) != 0, flag, "enable");
}

}  // namespace

bool has_passive_forces(const mjModel& m) {
  return !is_disabled(m, mjDSBL_SPRING) || !is_disabled(m, mjDSBL_DAMPER);
}
bool has_medium(const mjModel& m) {
  return has_passive_forces(m) && (m.opt.density != 0 || m.opt.viscosity != 0);
}

void check_options(const Model& model, std::vector<std::string>& problems) {
  if (!model.articulated) return;
  const mjOption& option = model.compiled->opt;
  const auto refuse = [&](bool found, const std::string& what, const char* expected) {
    if (!found) return;
    problems.push_back("option: " + what + " is not simulated with joints yet; expected " +
                       expected);
  };
  const int integrators[] = {mjINT_EULER, mjINT_RK4, mjINT_IMPLICITFAST};
  refuse(std::find(std::begin(integrators), std::end(integrators), option.integrator) ==
             std::end(integrators),
         std::string("integrator ") + integrator_name(option.integrator),
         "Euler, implicitfast or RK4");
  refuse(option.integrator == mjINT_IMPLICITFAST && has_medium(*model.compiled),
         "integrator implicitfast in a medium", "Euler or RK4, or density and viscosity 0");
  refuse(option.noslip_iterations > 0, "noslip_iterations", "0");
  check_flags(model, problems);
}

void compare_options(const Model& model, std::vector<std::string>& warnings) {
  const mjOption& option = model.compiled->opt;
  mjOption defaults;
  mj_defaultOption(&defaults);
  const auto differs = [&](auto member) { return option.*member != defaults.*member; };
  // What steers MuJoCo's solver for free bodies only shapes how well it solves.
  const std::pair<const char*, bool> attributes[] = {
      {"integrator", !model.articulated && differs(&mjOption::integrator)},
      {"cone", !model.articulated && differs(&mjOption::cone)},
      {"jacobian", differs(&mjOption::jacobian)},
      {"solver", !model.articulated && differs(&mjOption::solver)},
      {"iterations", !model.articulated && differs(&mjOption::iterations)},
      {"tolerance", !model.articulated && differs(&mjOption::tolerance)},
      {"ls_iterations", !model.articulated && differs(&mjOption::ls_iterations)},
      {"ls_tolerance", !model.articulated && differs(&mjOption::ls_tolerance)},
      {"noslip_iterations", differs(&mjOption::noslip_iterations)},
      {"noslip_tolerance", differs(&mjOption::noslip_tolerance)},
      {"ccd_iterations", differs(&mjOption::ccd_iterations)},
      {"ccd_tolerance", differs(&mjOption::ccd_tolerance)},
      {"impratio", !model.articulated && differs(&mjOption::impratio)},
  };
  std::string found;
  for (const auto& [attribute, ignored] : attributes) {
    if (ignored) found += (found.empty() ? "" : ", ") + std::string(attribute);
  }
  if (!found.empty()) {
    warnings.push_back("option: " + found +
                       " configure MuJoCo's solver and are ignored; use Options instead");
  }
  if (model.articulated && option.solver != mjSOL_NEWTON) {
    warnings.push_back(std::string("option: solver ") + (option.solver == mjSOL_CG ? "CG" : "PGS") +
                       " and its iterations are ignored; Newton's method finds the same minimum");
  }
}

void set_options(const Model& model, Options& options) {
  const mjModel& m = *model.compiled;
  options.dt = m.opt.timestep;
  options.gravity = is_disabled(m, mjDSBL_GRAVITY) ? Vec3::Zero().eval() : vec3(m.opt.gravity);
  if (!model.articulated) return;
  options.substeps = 1;
  SolverOptions& solver = options.solver;
  solver.method = Solver::newton;
  // Another solver needs other numbers of them.
  if (m.opt.solver == mjSOL_NEWTON) solver.iterations = m.opt.iterations;
  solver.tolerance = m.opt.tolerance;
  solver.line_search_iterations = m.opt.ls_iterations;
  solver.line_search_tolerance = m.opt.ls_tolerance;
  solver.impedance_ratio = m.opt.impratio;
  solver.implicit_damping = !is_disabled(m, mjDSBL_EULERDAMP);
  if (m.opt.cone == mjCONE_ELLIPTIC) solver.cone = FrictionCone::elliptic;
  if (m.opt.integrator == mjINT_RK4) options.integrator = Integrator::runge_kutta4;
  if (m.opt.integrator == mjINT_IMPLICITFAST) options.integrator = Integrator::implicit_fast;
  if (!has_medium(m)) return;
  options.medium = {m.opt.density, m.opt.viscosity};
  options.wind = vec3(m.opt.wind);
}

}  // namespace manyworlds::mjcf
