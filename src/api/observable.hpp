// What worlds of a scene do not have, and what to observe instead.
#pragma once

#include <string>

#include "manyworlds/observe.hpp"

namespace manyworlds {

// Why the worlds of a scene do not have it, and what to use instead: for observable() false.
std::string why_not_observable(Observer observer, const Scene& scene);
std::string why_not_observable(Observed what, const Scene& scene);
// The same of generalised coordinates or speeds, `instead` of which there is this.
std::string needs_newton(const Scene& scene, const std::string& instead);

}  // namespace manyworlds
