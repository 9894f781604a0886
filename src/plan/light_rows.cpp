// Rows of light bodies under a load. Each sweep takes a load on by a joint, and where such a row is
// flung about, the load is another one in every substep. A load of few times the links' mass is
// thrown up until the row is slack; drawn taut again, its links turn by a good part of a radian in
// a substep, and joints open by the square of that, however they are solved.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <vector>

#include "src/plan/joint_trees.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"

namespace manyworlds {

namespace {

int tree_of(const Joint& joint, const SceneTrees& trees) {
  for (const BodyId body : {joint.body_a, joint.body_b}) {
    const int tree = body ? trees.of_body[static_cast<std::size_t>(body.index())] : -1;
    if (tree >= 0) return tree;
  }
  return -1;
}

const Frame& frame_on(const Joint& joint, BodyId body) {
  return joint.body_a == body ? joint.frame_a : joint.frame_b;
}

BodyId lighter_of(const Scene& scene, const Joint& joint) {
  BodyId lighter;
  double least = std::numeric_limits<double>::infinity();
  for (const BodyId body : {joint.body_a, joint.body_b}) {
    if (!body || scene.at(body).motion != Motion::dynamic) continue;
    const double mass = mass_properties(scene, scene.at(body)).mass;
    if (mass < least) lighter = body, least = mass;
  }
  return lighter;
}

// m, from a joint to the farthest other one on its body.
double length_of(const Scene& scene, std::size_t joint, BodyId body) {
  const Vec3 from = frame_on(scene.joints[joint], body).position;
  double out = 0;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const Joint& other = scene.joints[j];
    if (j == joint || (other.body_a != body && other.body_b != body)) continue;
    out = std::max(out, (frame_on(other, body).position - from).norm());
  }
  return out;
}

}  // namespace

LightRow light_row_of(const Scene& scene, const SceneTrees& trees) {
  constexpr double kLoad = 5;  // times the lighter body of a joint, and the lightest of the tree
  constexpr int kRow = 5;      // joints
  struct Tree {
    double least = std::numeric_limits<double>::infinity(), most = 0;  // kg
    LightRow row;
  };
  std::map<int, Tree> all;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (trees.of_body[b] < 0) continue;
    Tree& tree = all[trees.of_body[b]];
    const double mass = mass_properties(scene, scene.bodies[b]).mass;
    tree.least = std::min(tree.least, mass), tree.most = std::max(tree.most, mass);
  }
  const std::vector<double> carried = carried_masses(scene);
  for (std::size_t j = 0; j < carried.size(); ++j) {
    if (!trees.has_joint[j] || carried[j] == 0) continue;
    const BodyId lighter = lighter_of(scene, scene.joints[j]);
    if (carried[j] < kLoad * mass_properties(scene, scene.at(lighter)).mass) continue;
    LightRow& row = all[tree_of(scene.joints[j], trees)].row;
    ++row.joints, row.length += length_of(scene, j, lighter);
  }
  LightRow out;
  for (auto& [first, tree] : all) {
    tree.row.ratio = tree.most / tree.least;
    if (tree.row.joints < kRow || tree.row.ratio < kLoad) continue;
    if (tree.row.joints > out.joints) out = tree.row;
  }
  return out;
}

// Ten links of 0.5 m under 5 to 60 times a link, let fall from the horizontal: joints open by less
// than a hundredth of a link from 12 substeps of 1/60 s on; loads from 100 times a link on are not
// thrown up, and want no more than four.
SubstepNeed need_of_light_rows(const Scene& scene) {
  constexpr double kThrown = 100;    // times a link
  constexpr double kPerRadian = 35;  // substeps for each radian that the fall turns a link by
  const LightRow row = light_row_of(scene, trees_of(scene));
  if (row.joints == 0 || row.ratio >= kThrown || row.length == 0) return {};
  const double speed = std::sqrt(2 * scene.options.gravity.norm() * row.length);  // m/s
  const double turn = speed * row.joints / row.length * scene.options.dt;         // rad
  return {kPerRadian * turn, "a row of " + std::to_string(row.joints) +
                                 " light joints lashes when it throws up its load"};
}

}  // namespace manyworlds
