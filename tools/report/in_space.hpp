// A planar scene as a spatial one, to see what the plane is worth.
#pragma once

#include <optional>

#include "manyworlds/scene.hpp"

namespace manyworlds::report {

// Boxes a metre deep for rectangles, spheres for circles, in the plane of x and y. Nothing if the
// scene has shapes or mass properties that are of the plane only.
std::optional<Scene> in_space(const Scene& planar);

}  // namespace manyworlds::report
