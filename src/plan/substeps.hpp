// How many substeps a scene takes with the default solver. Used inside src/plan only.
//
// Contacts are as stiff as springs of w = pi / (2 h) rad/s between moving bodies (ContactOptions),
// so what sags or leans under a load wants a certain w, and by that a certain h = dt / n. What is
// written at run time is not known, and does not count.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/plan/joint_trees.hpp"
#include "src/scene/checks.hpp"

namespace manyworlds {

inline constexpr int kLeastSubsteps = 4, kMostSubsteps = detail::kMaxSubsteps;
// Of the substeps' rate is the frequency of contacts. By less where bodies stand deep: what pushes
// them out of overlaps adds to the impulses that are carried on, and the passes of a substep take
// it out again the slower, the farther it is to the ground. So the pile sways, unless contacts give
// up a share of their impulses that grows with their softness.
inline constexpr double kContactShare = 0.25;
double contact_share(int depth);

// Of masses, that four substeps of sweeps are good for.
inline constexpr double kRatioOfFourSubsteps = 50;

struct SubstepChoice {
  int substeps = kLeastSubsteps;
  int stiff =
      kLeastSubsteps;  // as many would do were masses alike: contacts are as stiff as these allow
  int depth = 0;       // contacts between what stands at the start and the ground
  std::string why;     // of `substeps`
};

// Substeps that something asks for, and why.
struct SubstepNeed {
  double substeps = 0;
  std::string why = {};
};
// Of sweeps over some of the joints under what these carry, in the worst of the scenes.
SubstepNeed need_of_joints(const std::vector<Scene>& extremes, double length_unit,
                           const std::vector<bool>& joints);

std::string short_text(double x);  // three digits

// Whether some shape of A and some of B may touch.
bool filters_let_touch(const Body& a, const Body& b);

// Of all worlds: `extremes` (plan_data.hpp) are the scene and those of its lowest and highest
// numbers. `length_unit` in m.
SubstepChoice choose_substeps(const std::vector<Scene>& extremes, double length_unit);

// w that what stands in a scene needs, rad/s, and a body of the group that needs most
// (static_estimate.cpp).
struct StandingNeed {
  int depth = 0;  // contacts between a body and the ground, of any group
  double w = 0;
  int bodies = 0;
  BodyId top = {};
  bool leans = false;  // and not sags
};
StandingNeed need_of_standing_bodies(const Scene& scene);

// kg, that each joint carries: of one that parts bodies which hang together the lighter side, of
// one between them and the world all of it. 0 where a load has other ways (carried_mass.cpp).
std::vector<double> carried_masses(const Scene& scene);

// Of a joint that has one: its lighter dynamic body.
BodyId lighter_body(const Scene& scene, const Joint& joint);

// Joints of a tree that carry some times their lighter body and more, where masses of the tree and
// of what hangs on it differ by that, and more than a few of them do (light_rows.cpp).
struct LightRow {
  int joints = 0;
  double length = 0;  // m, of their lighter bodies together
  double ratio = 1;   // of the heaviest body's mass to the lightest one's
};
std::vector<LightRow> light_rows(const Scene& scene, const SceneTrees& trees);
// Of trees that are solved at once.
SubstepNeed need_of_light_rows(const Scene& scene);

}  // namespace manyworlds
