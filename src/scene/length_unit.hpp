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
// m, by which places that a description has wrong are told from what is meant: 1, or more in scenes
// of larger bodies. Not less in those of small ones, whose unit may be given or left to the plan.
double checked_unit(const Options& options);
// The speed V of options.hpp, m/s. Precondition: the options have a length unit.
double speed_unit(const Options& options);

}  // namespace manyworlds
