// The length that what the contact model takes for small follows. Used inside src only.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds {

// m: of a shape the cube root of its volume (planar: the square root of its area). Precondition: it
// has a sound size.
double size_of(const Shape& shape, Space space);

// Options::length_unit, or its default; ContactOptions::slop, or its default, m.
double length_unit_of(const Scene& scene);
double slop_of(const Scene& scene);
// The speed V of options.hpp, m/s. Precondition: the options have a length unit.
double speed_unit(const Options& options);

}  // namespace manyworlds
