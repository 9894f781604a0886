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

const Frame& frame_on(const Joint& joint, BodyId body) {
  return joint.body_a == body ? joint.frame_a : joint.frame_b;
}

// m, from a joint to the farthest other one on its body, of all that are on it.
double length_of(const Scene& scene, std::size_t joint, BodyId body,
                 const std::vector<std::size_t>& on_it) {
  const Vec3 from = frame_on(scene.joints[joint], body).position;
  double out = 0;
  for (const std::size_t other : on_it) {
    out = std::max(out, (frame_on(scene.joints[other], body).position - from).norm());
  }
  return out;
}

}  // namespace

std::vector<LightRow> light_rows(const Scene& scene, const SceneTrees& trees) {
  constexpr double kLoad = 5;  // times the lighter body of a joint, and the lightest of all
  constexpr int kRow = 5;      // joints
  struct Range {
    double least = std::numeric_limits<double>::infinity(), most = 0;  // kg
  };
  std::map<int, Range> hanging;  // of what hangs together
  std::map<int, LightRow> all;   // of trees
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (trees.hangs_with[b] < 0 || scene.bodies[b].motion != Motion::dynamic) continue;
    Range& range = hanging[trees.hangs_with[b]];
    const double mass = mass_properties(scene, scene.bodies[b]).mass;
    range.least = std::min(range.least, mass), range.most = std::max(range.most, mass);
  }
  std::vector<std::vector<std::size_t>> joints_on(scene.bodies.size());
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    for (const BodyId body : {scene.joints[j].body_a, scene.joints[j].body_b}) {
      if (body) joints_on[static_cast<std::size_t>(body.index())].push_back(j);
    }
  }
  const std::vector<double> carried = carried_masses(scene);
  for (std::size_t j = 0; j < carried.size(); ++j) {
    if (!trees.has_joint[j] || carried[j] == 0) continue;
    const BodyId lighter = lighter_body(scene, scene.joints[j]);
    if (carried[j] < kLoad * mass_properties(scene, scene.at(lighter)).mass) continue;
    const auto of = static_cast<std::size_t>(lighter.index());
    LightRow& row = all[trees.of_body[of]];
    const Range& range = hanging[trees.hangs_with[of]];
    row.ratio = range.most / range.least;
    ++row.joints, row.length += length_of(scene, j, lighter, joints_on[of]);
  }
  std::vector<LightRow> out;
  for (const auto& [first, row] : all) {
    if (row.joints >= kRow && row.ratio >= kLoad) out.push_back(row);
  }
  return out;
}

// Ten links of 0.5 m under 5 to 60 times a link, let fall from the horizontal: joints open by less
// than a hundredth of a link from 12 substeps of 1/60 s on; loads from 100 times a link on are not
// thrown up, and want no more than four.
SubstepNeed need_of_light_rows(const Scene& scene) {
  constexpr double kThrown = 100;    // times a link
  constexpr double kPerRadian = 35;  // substeps for each radian that the fall turns a link by
  SubstepNeed out;
  for (const LightRow& row : light_rows(scene, trees_of(scene))) {
    if (row.ratio >= kThrown || row.length == 0) continue;
    const double speed = std::sqrt(2 * scene.options.gravity.norm() * row.length);  // m/s
    const double turn = speed * row.joints / row.length * scene.options.dt;         // rad
    if (kPerRadian * turn <= out.substeps) continue;
    out = {kPerRadian * turn, "a row of " + std::to_string(row.joints) +
                                  " light joints whips when it throws its load up"};
  }
  return out;
}

}  // namespace manyworlds
