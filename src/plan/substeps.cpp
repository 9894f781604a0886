#include "src/plan/substeps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

struct Need {
  double substeps = 0;
  std::string why;
};
void at_least(Need& need, double substeps, const std::string& why) {
  if (substeps > need.substeps) need = {substeps, why};
}

// The number of substeps whose contacts are as stiff as w, rad/s.
double substeps_of(double w, double dt) { return w * dt / (2 * kPi * kContactShare); }

// Friction holds, and what rests is still, when a body falls by little of its size in a substep:
// grips of 6 cm hold from 6 substeps of 1/60 s on, dominoes of 4.8 cm keep their speed from 8 on.
Need need_of_sizes(const Scene& scene, double length_unit) {
  constexpr double kFourSubsteps = 0.0255;  // g dt^2 / L that four substeps are good for
  const Options& o = scene.options;
  const double fall = o.gravity.norm() * o.dt * o.dt / length_unit;
  return {kLeastSubsteps * std::cbrt(fall / kFourSubsteps), "bodies of " + short_text(length_unit) +
                                                                " m fall by " + short_text(fall) +
                                                                " of that in a step"};
}

Need need_of_standing(const Scene& scene) {
  const ColumnNeed need = need_of_columns(scene);
  if (need.bodies == 0) return {};
  return {substeps_of(need.w, scene.options.dt),
          std::to_string(need.bodies) + " bodies up to " + body_text(scene, need.top) +
              " stand on one another and would " + (need.leans ? "lean" : "sag")};
}

// What joints carry, as a spring of a quarter of the substeps' rate: of a joint that parts a tree
// the lighter side, of one between a tree and the world all of it.
class Carried {
 public:
  explicit Carried(const Scene& scene) : scene_(scene), jointed_(scene.bodies.size()) {
    for (const Body& body : scene.bodies) {
      mass_.push_back(body.motion == Motion::dynamic ? mass_properties(scene, body).mass : 0);
    }
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
      const Joint& joint = scene.joints[j];
      for (const BodyId body : {joint.body_a, joint.body_b}) {
        if (moves(body)) jointed_[at(body)].push_back(static_cast<int>(j));
      }
    }
  }
  // kg, and the lightest of the two bodies, kg.
  std::pair<double, double> of(int j) const {
    const Joint& joint = scene_.joints[static_cast<std::size_t>(j)];
    double carried = 1e300, lightest = 1e300;
    for (const BodyId body : {joint.body_a, joint.body_b}) {
      if (!moves(body)) continue;
      lightest = std::min(lightest, mass_[at(body)]);
      carried = std::min(carried, side(body, j));
    }
    return {carried < 1e300 ? carried : 0, lightest};
  }

 private:
  static std::size_t at(BodyId body) { return static_cast<std::size_t>(body.index()); }
  bool moves(BodyId body) const { return body && mass_[at(body)] > 0; }
  // All that hangs together with a body but for a joint; infinite where that is held elsewhere.
  double side(BodyId from, int without) const {
    std::vector<char> seen(scene_.bodies.size(), 0);
    std::vector<BodyId> open{from};
    seen[at(from)] = 1;
    double sum = 0;
    while (!open.empty()) {
      const BodyId body = open.back();
      open.pop_back();
      sum += mass_[at(body)];
      for (const int j : jointed_[at(body)]) {
        if (j == without) continue;
        const Joint& joint = scene_.joints[static_cast<std::size_t>(j)];
        const BodyId other = joint.body_a == body ? joint.body_b : joint.body_a;
        if (!moves(other)) return 1e300;
        if (!seen[at(other)]) seen[at(other)] = 1, open.push_back(other);
      }
    }
    return sum;
  }

  const Scene& scene_;
  std::vector<double> mass_;
  std::vector<std::vector<int>> jointed_;
};

// The gap of a joint under its load stays below a hundredth of a body's size. Loads of more than
// some thousand times the lighter body want more than substeps.
Need need_of_joints(const Scene& scene, double length_unit) {
  constexpr double kGap = 0.01;  // of the length unit
  constexpr std::size_t kMostJoints = 4096;
  Need out;
  if (scene.joints.empty() || scene.joints.size() > kMostJoints) return out;
  const Carried carried(scene);
  for (int j = 0; j < static_cast<int>(scene.joints.size()); ++j) {
    const auto [load, lightest] = carried.of(j);
    if (!(load > 0) || !(lightest < 1e300)) continue;
    const double w2 = 2 * load / lightest * scene.options.gravity.norm() / (kGap * length_unit);
    at_least(out, substeps_of(std::sqrt(w2), scene.options.dt),
             "joint " + std::to_string(j) + " carries " + short_text(load / lightest) +
                 " times its lighter body");
  }
  return out;
}

// Gauss-Seidel brings a load down through light bodies in as many sweeps as the ratio of masses
// asks for; stiffer contacts do not help. Measured: ratios of 300 hold from 8 substeps on, of 400
// from 11 on.
Need need_of_ratios(const Scene& scene) {
  constexpr double kFourSubsteps = 50;      // ratio that four substeps are good for
  constexpr std::size_t kMostPairs = 2048;  // bodies of which every pair is looked at
  struct Weight {
    int body;
    double mass;
  };
  std::vector<Weight> weights;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    const bool collides = std::any_of(body.shapes.begin(), body.shapes.end(),
                                      [](const Shape& s) { return s.filter.mask != 0; });
    if (body.motion != Motion::dynamic || !collides) continue;
    weights.push_back({static_cast<int>(i), mass_properties(scene, body).mass});
  }
  std::sort(weights.begin(), weights.end(),
            [](const Weight& a, const Weight& b) { return a.mass < b.mass; });
  const auto joined = joined_bodies(scene);
  double ratio = 0;
  Weight light{}, heavy{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    for (std::size_t j = weights.size(); j-- > i + 1;) {
      const double here = weights[j].mass / weights[i].mass;
      if (here <= ratio) break;
      const auto pair = std::minmax(weights[i].body, weights[j].body);
      if (weights.size() <= kMostPairs && joined.count({pair.first, pair.second}) > 0) continue;
      ratio = here, light = weights[i], heavy = weights[j];
      break;
    }
  }
  if (ratio <= kFourSubsteps) return {};
  return {kLeastSubsteps * std::sqrt(ratio / kFourSubsteps),
          body_text(scene, BodyId(heavy.body)) + " has " + short_text(ratio) +
              " times the mass of " + body_text(scene, BodyId(light.body))};
}

// A frequency that is given keeps its share.
Need need_of_frequency(const Options& o) {
  if (!o.contact.frequency) return {};
  return {*o.contact.frequency * o.dt / kContactShare,
          "contacts of " + short_text(*o.contact.frequency) + " Hz"};
}

int rounded_up(double substeps) {
  const double slack = 1e-6;  // what is meant to be exact may be off by rounding
  return static_cast<int>(
      std::clamp(std::ceil(substeps - slack), double{kLeastSubsteps}, double{kMostSubsteps}));
}

}  // namespace

SubstepChoice choose_substeps(const Scene& scene, double length_unit) {
  SubstepChoice out;
  out.why = "the least; nothing asks for more";
  const Options& o = scene.options;
  if (o.solver.method != Solver::tgs_soft) {
    out.why = "as for every solver but tgs-soft";
    return out;
  }
  Need need{kLeastSubsteps, out.why};
  if (!o.gravity.isZero(0)) {
    for (const Need& of : {need_of_sizes(scene, length_unit), need_of_standing(scene),
                           need_of_joints(scene, length_unit)}) {
      at_least(need, of.substeps, of.why);
    }
  }
  const Need frequency = need_of_frequency(o);
  at_least(need, frequency.substeps, frequency.why);
  out.stiff = rounded_up(need.substeps);
  if (!o.gravity.isZero(0)) {
    const Need ratios = need_of_ratios(scene);
    at_least(need, ratios.substeps, ratios.why);
  }
  out.substeps = rounded_up(need.substeps), out.why = need.why;
  if (need.substeps > kMostSubsteps) {
    out.why += "; " + short_text(std::ceil(need.substeps)) + " would do, there are no more than " +
               std::to_string(kMostSubsteps);
  }
  return out;
}

}  // namespace manyworlds
