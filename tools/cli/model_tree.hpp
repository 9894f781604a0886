// The bodies of a scene as what hangs on what, with the joints that hold them.
#pragma once

#include <vector>

#include "manyworlds/plan.hpp"

namespace manyworlds::cli {

struct ModelJoint {
  JointId joint = {};
  // Where its numbers begin in generalized_position and generalized_velocity, and how many there
  // are; of Solver::newton only.
  int q = 0, v = 0, positions = 0, velocities = 0;
};
struct ModelBody {
  BodyId body = {};
  int parent = -1;  // of the list; -1: the world
  int depth = 0;
  std::vector<ModelJoint> joints = {};  // in the order in which they move it; none: a free body
  ModelJoint root = {};                 // of a free body: its own numbers
};

// Bodies that move, each before those that hang on it. In the order of generalized_position with
// Solver::newton. With others, a body hangs on what its first joint holds it to.
std::vector<ModelBody> model_tree(const Plan& plan);

}  // namespace manyworlds::cli
