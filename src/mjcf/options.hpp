// MuJoCo's <option>: time step and gravity of every scene, and for articulated models the solver.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/options.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// MuJoCo computes no passive force at all, gravcomp and drag included, where neither springs nor
// dampers act.
bool has_passive_forces(const mjModel& m);
// Whether bodies of models with joints move through something that resists.
bool has_medium(const mjModel& m);

// Appends the options and flags that change the motion and are not simulated.
void check_options(const Model& model, std::vector<std::string>& problems);

// Appends the options that steer MuJoCo's solver and are ignored.
void compare_options(const Model& model, std::vector<std::string>& warnings);

// Precondition: check_options finds nothing.
void set_options(const Model& model, Options& options);

}  // namespace manyworlds::mjcf
