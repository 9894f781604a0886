// How much room a world needs on a page.
#pragma once

#include <span>
#include <vector>

#include "manyworlds/plan.hpp"
#include "src/page/look.hpp"

namespace manyworlds::page {

// radii_of, where bodies without a shape that has an end are as large as the largest.
std::vector<double> drawn_radii(const Scene& scene);

// The box in which the moving bodies of a plan are most of the time, with what is fixed near it.
// positions: [any number of worlds and moments][row][component], m.
Room room_of(const Plan& plan, const std::vector<double>& radii, std::span<const double> positions);

}  // namespace manyworlds::page
