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

// hanging.cpp
Scene bridge();
Scene ball_and_chain();
Scene joint_grid();

// machines.cpp
Scene pulley();
Scene elevator();
Scene windmill();
Scene four_bar();

// shapes.cpp
Scene hills();
Scene pebbles();

// one file each
Scene car2d();
Scene lunar_lander();
Scene ragdoll();
Scene free_flight();
Scene billiards();
Scene domino();
Scene mixed_pile();
Scene mixed_pile2d();
Scene bird_sling();
Scene cradle_joints();
Scene crane();
Scene jenga();
Scene car3d();
Scene chain_reaction();

// robots/, one file each
Scene pendulum();
Scene hopper();
Scene cheetah();
Scene ant();
Scene humanoid();

}  // namespace manyworlds::scenes
