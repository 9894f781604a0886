// Joints as a page draws them: where they are on their bodies, and what they are.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"
#include "src/page/json.hpp"

namespace manyworlds::page {

// Each joint of a scene: name, type, body_a and body_b (null: the world), its ends a and b
// ({body, position, rotation}), and by type
//   distance  form ("rod", "rope", "spring" or "telescope") and length, m
//   slider, wheel  range, m (null: without end)
//   pulley  grounds, m
// An end is null where it is on no body: within a series of joints (Joint::after).
Json joints_of(const Scene& scene);

// m, where ropes, rods, springs and pulleys are fastened to what does not move.
std::vector<Vec3> fixed_anchors(const Scene& scene);

}  // namespace manyworlds::page
