#include "src/plan/substeps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "kernels/data/pair_keys.hpp"
#include "src/plan/joint_trees.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

using Need = SubstepNeed;
void at_least(Need& need, double substeps, const std::string& why) {
  if (substeps > need.substeps) need = {substeps, why};
}

// The number of substeps whose contacts are as stiff as w, rad/s.
double substeps_of(double w, double dt, double share = kContactShare) {
  return w * dt / (2 * std::numbers::pi * share);
}

// Friction holds, and what rests is still, when a body falls by little of its size in a substep:
// grips of 6 cm hold from 6 substeps of 1/60 s on.
Need need_of_sizes(const Scene& scene, double length_unit) {
  constexpr double kFourSubsteps = 0.0255;  // g dt^2 / L that four substeps are good for
  const Options& o = scene.options;
  const double fall = o.gravity.norm() * o.dt * o.dt / length_unit;
  return {kLeastSubsteps * std::cbrt(fall / kFourSubsteps), "bodies of " + short_text(length_unit) +
                                                                " m fall by " + short_text(fall) +
                                                                " of their size in a step"};
}

Need need_of_standing(const Scene& scene, const StandingNeed& need, int depth) {
  if (need.bodies == 0) return {};
  return {substeps_of(need.w, scene.options.dt, contact_share(depth)),
          std::to_string(need.bodies) + " bodies up to " + body_text(scene, need.top) +
              " stand on one another and would " + (need.leans ? "lean" : "sag")};
}

// The gap of a joint under its load stays below a hundredth of a body's size, as a spring of a
// quarter of the substeps' rate. Loads of more than some thousand times the lighter body want more
// than substeps.
Need need_of_loads(const Scene& scene, double length_unit, const std::vector<bool>& joints) {
  constexpr double kGap = 0.01;  // of the length unit
  Need out;
  const std::vector<double> carried = carried_masses(scene);
  for (std::size_t j = 0; j < carried.size(); ++j) {
    if (carried[j] == 0 || !joints[j]) continue;
    const BodyId lighter = lighter_body(scene, scene.joints[j]);
    const double ratio = carried[j] / mass_properties(scene, scene.at(lighter)).mass;
    const double w2 = 2 * ratio * scene.options.gravity.norm() / (kGap * length_unit);
    at_least(out, substeps_of(std::sqrt(w2), scene.options.dt),
             joint_text(j) + " carries " + short_text(ratio) + " times its lighter body");
  }
  return out;
}

// Gauss-Seidel brings a load down through light bodies in as many sweeps as the ratio of masses
// asks for; stiffer contacts do not help. Measured: ratios of 300 hold from 8 substeps on, of 400
// from 11 on. Of numbers that vary, the heaviest upon the lightest. A tree that is solved at once
// stands behind the contacts of its bodies as a whole.
Need need_of_ratios(const std::vector<Scene>& extremes) {
  struct Weight {
    BodyId body;
    double least, most;  // kg
  };
  const Scene& scene = extremes.front();
  std::vector<Weight> by_least;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].motion != Motion::dynamic || scene.bodies[i].shapes.empty()) continue;
    Weight w{BodyId(static_cast<int>(i)), std::numeric_limits<double>::infinity(), 0};
    for (const Scene& extreme : extremes) {
      const double mass = mass_properties(extreme, extreme.bodies[i]).mass;
      w.least = std::min(w.least, mass), w.most = std::max(w.most, mass);
    }
    by_least.push_back(w);
  }
  std::vector<Weight> by_most(by_least);
  const auto sort_by = [](std::vector<Weight>& weights, double Weight::*mass) {
    std::sort(weights.begin(), weights.end(),
              [mass](const Weight& a, const Weight& b) { return a.*mass < b.*mass; });
  };
  sort_by(by_least, &Weight::least), sort_by(by_most, &Weight::most);
  const auto joined = joined_bodies(scene);
  const bool at_once = scene.options.joint.method == JointMethod::tree;
  const std::vector<int> trees =
      at_once ? trees_of(scene).of_body : std::vector<int>(scene.bodies.size(), -1);
  const auto tree_of = [&](BodyId body) { return trees[static_cast<std::size_t>(body.index())]; };
  double ratio = kRatioOfFourSubsteps;
  std::string why;
  for (const Weight& light : by_least) {
    for (std::size_t j = by_most.size(); j-- > 0;) {
      const Weight& heavy = by_most[j];
      const double here = heavy.most / light.least;
      if (here <= ratio) break;
      const bool one_tree = tree_of(light.body) >= 0 && tree_of(light.body) == tree_of(heavy.body);
      const bool apart = heavy.body == light.body || one_tree ||
                         joined.count(std::minmax(light.body.index(), heavy.body.index())) > 0 ||
                         !filters_let_touch(scene.at(light.body), scene.at(heavy.body));
      if (apart) continue;
      ratio = here;
      why = body_text(scene, heavy.body) + " has " + short_text(ratio) + " times the mass of " +
            body_text(scene, light.body);
      break;
    }
  }
  if (why.empty()) return {};
  return {kLeastSubsteps * std::sqrt(ratio / kRatioOfFourSubsteps), why};
}

// A frequency that is given keeps its share.
Need need_of_frequency(const Options& o) {
  if (!o.contact.frequency) return {};
  return {*o.contact.frequency * o.dt / kContactShare,
          "contact.frequency is " + short_text(*o.contact.frequency) + " Hz"};
}

int rounded_up(double substeps) {
  const double slack = 1e-6;  // what is meant to be exact may be off by rounding
  return static_cast<int>(
      std::clamp(std::ceil(substeps - slack), double{kLeastSubsteps}, double{kMostSubsteps}));
}

}  // namespace

double contact_share(int depth) {
  constexpr int kStill = 15;  // deep, that a quarter of the rate holds still
  return kContactShare * (depth > kStill ? std::sqrt(double{kStill} / depth) : 1);
}

std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

bool filters_let_touch(const Body& a, const Body& b) {
  for (const Shape& of_a : a.shapes) {
    for (const Shape& of_b : b.shapes) {
      const Filter &f = of_a.filter, &g = of_b.filter;
      if (kernels::filters_agree(f.category, f.mask, g.category, g.mask)) return true;
    }
  }
  return false;
}

Need need_of_joints(const std::vector<Scene>& extremes, double length_unit,
                    const std::vector<bool>& joints) {
  Need out;
  for (const Scene& scene : extremes) {
    if (scene.options.gravity.isZero(0)) continue;
    const Need of = need_of_loads(scene, length_unit, joints);
    at_least(out, of.substeps, of.why);
  }
  return out;
}

SubstepChoice choose_substeps(const std::vector<Scene>& extremes, double length_unit) {
  SubstepChoice out;
  const Options& o = extremes.front().options;
  if (o.solver.method != Solver::tgs_soft) {
    out.why = "fixed for solvers other than tgs-soft";
    return out;
  }
  Need need{kLeastSubsteps, "the minimum is sufficient"};
  std::vector<bool> swept(extremes.front().joints.size(), true);
  if (o.joint.method == JointMethod::tree) {
    swept = trees_of(extremes.front()).has_joint;
    swept.flip();
  }
  std::vector<StandingNeed> standing;
  for (const Scene& scene : extremes) {
    standing.push_back(need_of_standing_bodies(scene));
    out.depth = std::max(out.depth, standing.back().depth);
  }
  bool weight = false;
  for (std::size_t i = 0; i < extremes.size(); ++i) {
    const Scene& scene = extremes[i];
    if (scene.options.gravity.isZero(0)) continue;
    weight = true;
    for (const Need& of :
         {need_of_sizes(scene, length_unit), need_of_standing(scene, standing[i], out.depth),
          need_of_loads(scene, length_unit, swept)}) {
      at_least(need, of.substeps, of.why);
    }
  }
  const Need frequency = need_of_frequency(o);
  at_least(need, frequency.substeps, frequency.why);
  out.stiff = rounded_up(need.substeps);
  if (weight) {
    const Need ratios = need_of_ratios(extremes);
    at_least(need, ratios.substeps, ratios.why);
  }
  if (o.joint.method == JointMethod::tree) {
    for (const Scene& scene : extremes) {
      const Need of = need_of_light_rows(scene);
      at_least(need, of.substeps, of.why);
    }
  }
  out.substeps = rounded_up(need.substeps), out.why = need.why;
  if (need.substeps > kMostSubsteps) {
    out.why += "; " + short_text(std::ceil(need.substeps)) + " are needed, the maximum is " +
               std::to_string(kMostSubsteps);
  }
  return out;
}

}  // namespace manyworlds
