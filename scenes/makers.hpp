// The makers behind the catalogue, one per scene; each returns the scene that has its name.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds::scenes {

// standard_planar.cpp
Scene bin2d();
Scene pyramid2d();
Scene ball2d();

// standard_spatial.cpp
Scene bin_spheres();
Scene bin_boxes();
Scene stack10();
Scene ball3d();

// chains.cpp
Scene chain2d();
Scene chain3d();

// one file each
Scene free_flight();
Scene billiards();
Scene domino();
Scene mixed_pile();
Scene mixed_pile2d();

}  // namespace manyworlds::scenes
