#include <string>
#include <vector>

#include "src/mjcf/actuators.hpp"
#include "src/mjcf/equality.hpp"
#include "src/mjcf/filter.hpp"
#include "src/mjcf/links.hpp"
#include "src/mjcf/material.hpp"
#include "src/mjcf/options.hpp"
#include "src/mjcf/shape.hpp"
#include "src/mjcf/support.hpp"
#include "src/mjcf/tendons.hpp"

namespace manyworlds::mjcf {
namespace {

void check_free_joints(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] != mjJNT_FREE) continue;  // links.hpp
    const int dof = m.jnt_dofadr[j];
    const auto refuse = [&](bool found, const char* attribute) {
      if (found) {
        problems.push_back(model.joint_place(j) + ": " + attribute +
                           " of a free joint is not simulated yet; expected 0");
      }
    };
    refuse(m.jnt_stiffness[j] != 0 || any_nonzero(m.jnt_stiffnesspoly + mjNPOLY * j, mjNPOLY),
           "stiffness");
    refuse(any_nonzero(m.dof_damping + dof, 6) ||
               any_nonzero(m.dof_dampingpoly + mjNPOLY * dof, 6 * mjNPOLY),
           "damping");
    refuse(any_nonzero(m.dof_armature + dof, 6), "armature");
    refuse(any_nonzero(m.dof_frictionloss + dof, 6), "frictionloss");
  }
}

void check_bodies(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_mocapid[b] >= 0) {
      problems.push_back(model.body_place(b) +
                         ": is a mocap body, which is not simulated yet; expected a free or a "
                         "static body");
    }
    // A body welded to a free one becomes part of it, and one body has one gravity scale.
    const int root = m.body_weldid[b];
    if (!model.articulated && root != 0 && m.body_gravcomp[b] != m.body_gravcomp[root]) {
      problems.push_back(model.body_place(b) + ": gravcomp differs from that of " +
                         model.body_place(root) + ", which it is welded to; expected the same");
    }
    if (m.body_plugin[b] >= 0) {
      problems.push_back(model.body_place(b) + ": has a plugin, which is not simulated");
    }
  }
}

// Whether the geom is part of what MuJoCo computes its body's mass from.
bool gives_mass(const Model& model, int geom) {
  const mjModel& m = *model.compiled;
  const int b = m.geom_bodyid[geom];
  if (m.body_weldid[b] == 0) return false;
  const mjsCompiler& compiler = model.spec->compiler;
  const mjsBody* body = model.bodies[static_cast<std::size_t>(b)];
  if (compiler.inertiafromgeom == mjINERTIAFROMGEOM_FALSE) return false;
  if (compiler.inertiafromgeom == mjINERTIAFROMGEOM_AUTO && body != nullptr &&
      body->explicitinertial) {
    return false;
  }
  const int group = m.geom_group[geom];
  if (group < compiler.inertiagrouprange[0] || group > compiler.inertiagrouprange[1]) return false;
  const mjsGeom* written = model.geoms[static_cast<std::size_t>(geom)];
  if (written == nullptr) return true;
  // An unset mass is NaN, which is not 0: then the density decides.
  return written->mass != 0 && (written->mass > 0 || written->density != 0);
}

void check_geoms(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  for (int g = 0; g < m.ngeom; ++g) {
    const int type = m.geom_type[g];
    const std::string kind = geom_type_name(type);
    if (!has_shape(type)) {
      if (model.collides(g)) {
        problems.push_back(model.geom_place(g) + ": is a " + kind +
                           " that can collide, which is not simulated yet; expected " +
                           shape_names() + ", or contype and conaffinity 0");
      } else if (gives_mass(model, g)) {
        problems.push_back(model.geom_place(g) + ": is a " + kind +
                           " that does not collide but gives its body mass, which is not "
                           "simulated yet; expected an inertial element in the body, or mass 0");
      }
    }
    if (!model.collides(g)) continue;
    if (type == mjGEOM_HFIELD && m.body_weldid[m.geom_bodyid[g]] != 0) {
      problems.push_back(model.geom_place(g) + ": is a " + kind +
                         " on a body that moves, which is not simulated; expected a static body");
    }
    if (type == mjGEOM_MESH) {
      if (const auto problem = hull_problem(model, g)) {
        problems.push_back(model.geom_place(g) + ": " + *problem);
      }
    }
    if (any_nonzero(m.geom_surfacevel + 6 * g, 6)) {
      problems.push_back(model.geom_place(g) + ": surfacevel is not simulated yet; expected zeros");
    }
    if (m.geom_adhesion[g] != 0) {
      problems.push_back(model.geom_place(g) + ": adhesion is not simulated; expected 0");
    }
  }
  const int classes = filter_classes(model);
  if (classes > kMaxFilterClasses) {
    problems.push_back("geoms: have " + std::to_string(classes) +
                       " different pairs of contype and conaffinity; expected at most " +
                       std::to_string(kMaxFilterClasses));
  }
}

// Kinds of element that have no counterpart at all.
void check_other_elements(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  const auto refuse = [&](mjtObj type, mjtSize count, const std::string& what) {
    for (int i = 0; i < count; ++i) {
      problems.push_back(model.place(type, i) + ": " + what + " not simulated yet; expected none");
    }
  };
  check_tendons(model, problems);
  if (!model.articulated) refuse(mjOBJ_ACTUATOR, m.nactuator, "actuators are");
  refuse(mjOBJ_PAIR, m.npair, "contact pairs are");
  for (int x = 0; x < m.nexclude; ++x) {
    if (model.articulated || excludes_joined(model, x)) continue;
    problems.push_back(model.place(mjOBJ_EXCLUDE, x) +
                       ": contact excludes are not simulated yet; expected excludes only between "
                       "two free bodies joined by a connect or a weld");
  }
  refuse(mjOBJ_FLEX, m.nflex, "flexes are");
  refuse(mjOBJ_PLUGIN, m.nplugin, "plugins are");
}

void check_medium(const Model& model, std::vector<std::string>& problems) {
  const mjModel& m = *model.compiled;
  const mjOption& option = m.opt;
  if (model.articulated) {
    for (int g = 0; has_medium(m) && g < m.ngeom; ++g) {
      if (m.geom_fluid[mjNFLUID * g] <= 0) continue;
      problems.push_back(model.geom_place(g) +
                         ": fluidshape ellipsoid is not simulated yet; expected none");
    }
    return;
  }
  const auto refuse = [&](bool found, const char* attribute) {
    if (found) {
      problems.push_back(
          std::string("option: ") + attribute +
          " of the medium is not simulated yet in a model of free bodies only; expected 0");
    }
  };
  refuse(option.density != 0, "density");
  refuse(option.viscosity != 0, "viscosity");
  refuse(any_nonzero(option.wind, 3), "wind");
}

}  // namespace

std::vector<std::string> unsupported(const Model& model) {
  std::vector<std::string> problems;
  check_medium(model, problems);
  check_options(model, problems);
  check_bodies(model, problems);
  check_free_joints(model, problems);
  check_links(model, problems);
  check_geoms(model, problems);
  check_materials(model, problems);
  check_equalities(model, problems);
  check_actuators(model, problems);
  check_other_elements(model, problems);
  return problems;
}

}  // namespace manyworlds::mjcf
