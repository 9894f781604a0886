#include "tools/report/plan_worth.hpp"
#include "tools/base/interrupt.hpp"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/scenes.hpp"
#include "tools/base/median.hpp"
#include "tools/report/in_space.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

// What a row steps.
struct Setup {
  Scene scene;
  PlanOptions plan;
  BatchOptions batch;
};
struct Variant {
  std::string scene, name;
  Setup plain, changed;
  int settle = 60;  // steps before the clock starts
  bool must_be_same = true;
};

std::vector<double> moving_parts(const Batch& batch) {
  std::vector<double> out;
  for (const Field f : {Field::position, Field::linear_velocity, Field::angular_velocity}) {
    std::vector<double> part(batch.size(f));
    batch.read(f, part);
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

WorthRow measure_worth(const Variant& v, bool quick) {
  Batch plain(compile(v.plain.scene, v.plain.plan), v.plain.batch);
  Batch changed(compile(v.changed.scene, v.changed.plan), v.changed.batch);
  plain.step(v.settle), changed.step(v.settle);
  const int rounds = quick ? 5 : 15, steps = quick ? 10 : 40;
  std::vector<double> ratios, speeds;
  const auto time_of = [&](Batch& batch) {
    const double start = processor_seconds();
    for (int i = 0; i < steps; ++i) batch.step();
    return processor_seconds() - start;
  };
  for (int i = 0; i < rounds; ++i) {
    // Alternately, and each first half of the time: what drifts on the machine cancels.
    double own = 0, other = 0;
    if (i % 2 == 0) own = time_of(plain), other = time_of(changed);
    if (i % 2 == 1) other = time_of(changed), own = time_of(plain);
    ratios.push_back(other / own);
    speeds.push_back(steps * plain.worlds() / own);
    tools::stop_if_interrupted();
  }
  WorthRow row{v.scene, v.name,        tools::median(speeds), tools::median(ratios),
               false,   v.must_be_same};
  row.bodies = plain.bodies(0);
  const std::vector<double> a = moving_parts(plain), b = moving_parts(changed);
  row.same_bits =
      a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
  return row;
}

Setup plain_setup(const Scene& scene, int worlds) {
  Setup out{scene, {}, {}};
  out.batch.worlds = worlds, out.batch.threads = 1;
  return out;
}

// Stages and rows that the plan left out, switched on again.
void add_kept_variant(const std::string& name, const Setup& plain, std::vector<Variant>& out) {
  const Plan plan = compile(plain.scene);
  std::vector<Feature> missing;
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto f = static_cast<Feature>(i);
    // Nothing is there that could be switched on.
    const bool absent = f == Feature::joints || f == Feature::contacts ||
                        (f == Feature::inertia && plain.scene.space == Space::planar);
    if (!plan.has(f) && !absent) missing.push_back(f);
  }
  const auto keep = [&](const std::string& what, std::vector<Feature> features) {
    Variant v{name, "with " + what, plain, plain};
    // Tensors of equal moments are rounded otherwise than the scalar that they stand for.
    v.must_be_same = std::count(features.begin(), features.end(), Feature::inertia) == 0;
    v.changed.plan.keep = std::move(features);
    out.push_back(v);
  };
  for (const Feature f : missing) keep(to_string(f), {f});
  if (missing.size() > 1) keep("all of these", missing);
}

// The other layouts, ways to find pairs, and numbers of every world's own.
void add_choices(const std::string& name, const Setup& plain, std::vector<Variant>& out) {
  const Plan plan = compile(plain.scene);
  if (plan.has(Feature::contacts)) {
    for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
      Variant v{name, std::string(to_string(layout)) + " layout", plain, plain};
      v.changed.batch.layout = layout;
      out.push_back(v);
    }
    for (const BroadPhase broad :
         {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
      if (broad == plan.report().broad_phase) continue;
      Variant v{name, std::string("pairs by ") + to_string(broad), plain, plain};
      v.changed.plan.broad_phase = broad;
      out.push_back(v);
    }
  }
  if (plain.scene.variations.empty() && plan.bodies() > 0) {
    Variant v{name, "gravity per world", plain, plain};
    Variation gravity;
    gravity.parameter = Parameter::gravity;
    gravity.low = gravity.high = plain.scene.options.gravity;
    v.changed.scene.variations = {gravity};
    out.push_back(v);
  }
}

// What other integrators cost where nothing touches.
void add_integrators(const std::string& name, const Setup& plain, std::vector<Variant>& out) {
  if (compile(plain.scene).has(Feature::contacts) || !plain.scene.joints.empty()) return;
  for (const Integrator i :
       {Integrator::explicit_euler, Integrator::velocity_verlet, Integrator::runge_kutta4}) {
    Variant v{name, to_string(i), plain, plain};
    v.changed.scene.options.integrator = i;
    v.must_be_same = false;
    out.push_back(v);
  }
}

// The third dimension, and a stage for joints: what a plan cannot be told to keep.
void add_enlarged(const std::string& name, const Setup& plain, std::vector<Variant>& out) {
  const auto add = [&](const std::string& what, Scene scene) {
    Variant v{name, what, plain, plain};
    v.changed.scene = std::move(scene);
    v.must_be_same = false;
    out.push_back(v);
  };
  if (plain.scene.space == Space::planar) {
    if (const auto scene = in_space(plain.scene)) add("the same in space", *scene);
  }
  const Plan plan = compile(plain.scene);
  if (plan.has(Feature::joints) || plan.bodies() == 0) return;
  Scene scene = plain.scene;
  TargetJoint pull;  // too weak to be felt
  pull.spring.stiffness = 1e-6, pull.max_force = 1e-6;
  Joint joint;
  joint.type = pull, joint.body_b = plan.body_in_row(0);
  scene.add(joint);
  add("with a joint", scene);
}

void add_sleep(const std::string& name, const Setup& plain, std::vector<Variant>& out) {
  Variant v{name, "at rest, without sleep / with sleep", plain, plain};
  v.plain.batch.sleep = true;
  v.settle = 1200;
  v.must_be_same = false;  // sleeping bodies do not move
  out.push_back(v);
}

// Where finding pairs in other ways begins to pay.
void add_crossover(bool quick, std::vector<Variant>& out) {
  std::vector<std::string> names;
  for (const int bodies :
       quick ? std::vector{16, 64} : std::vector{4, 8, 16, 32, 48, 64, 128, 256, 512}) {
    names.push_back("bin-spheres:" + std::to_string(bodies));
  }
  for (const int base : quick ? std::vector<int>{} : std::vector{7, 10, 12, 16, 22, 31}) {
    names.push_back("pyramid2d:" + std::to_string(base));  // 28 to 496 squares
  }
  for (const std::string& name : names) {
    const Scene scene = *scenes::sized(name);
    Setup listed = plain_setup(scene, std::max(16, 4096 / compile(scene).bodies()));
    listed.plan.broad_phase = BroadPhase::all_pairs;
    for (const BroadPhase broad : {BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
      Variant v{name, std::string(to_string(broad)) + " against all pairs", listed, listed};
      v.changed.plan.broad_phase = broad;
      out.push_back(v);
    }
  }
}

// What it costs to be right: scenes that the plan gives more than four substeps, or joints that are
// solved at once, with four and by sweeps.
void add_substeps(bool quick, std::vector<Variant>& out) {
  const std::vector<std::string> few = {"C2 5 x 1 cm", "B3", "B15", "B16"};
  const std::vector<std::string> all = {
      "C1 1 m x 1000", "C1 1 mm x 30", "C3 rest 10 m", "C2 5 x 1 cm", "C2 20 x 1 m",
      "C2 20 x 10 cm", "C2 20 x 1 cm", "C3 cards",     "C4 50 N",     "C8",
      "C5 rest",       "B2",           "B3",           "B15",         "B16"};
  const auto& wanted = quick ? few : all;
  for (const Trial& trial : stability_trials()) {
    if (std::count(wanted.begin(), wanted.end(), trial.id) == 0) continue;
    const Scene scene = trial.scene();
    Variant v{trial.id, "", plain_setup(scene, 16), plain_setup(scene, 16)};
    const Options chosen = compile(scene).resolved();
    v.name = fmt::format("4 substeps{} instead of {}",
                         chosen.joint.method ? " and swept joints" : "", *chosen.substeps);
    v.changed.scene.options.substeps = 4;
    v.changed.scene.options.joint.method = JointMethod::sweep;
    v.must_be_same = false;
    out.push_back(v);
  }
}

}  // namespace

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<WorthRow> run_worth(const WorthOptions& options,
                                const std::function<void(const std::string&, double)>& tell) {
  std::vector<Variant> variants;
  for (const scenes::Entry& entry : scenes::all()) {
    const auto& names = options.scenes;
    const bool wanted =
        names.empty() ? entry.standard : std::count(names.begin(), names.end(), entry.name) > 0;
    if (!wanted) continue;
    const Setup plain = plain_setup(entry.make(), options.quick ? 128 : 512);
    add_kept_variant(entry.name, plain, variants);
    add_choices(entry.name, plain, variants);
    add_enlarged(entry.name, plain, variants);
    add_integrators(entry.name, plain, variants);
    const bool rests = compile(plain.scene).has(Feature::contacts);
    if (rests && std::string(entry.name).starts_with("stack")) {
      add_sleep(entry.name, plain, variants);
    }
  }
  if (options.scenes.empty()) {
    add_substeps(options.quick, variants);
    add_crossover(options.quick, variants);
  }
  std::vector<WorthRow> out;
  for (const Variant& v : variants) {
    tell(v.scene + ' ' + v.name,
         static_cast<double>(out.size()) / static_cast<double>(variants.size()));
    try {
      out.push_back(measure_worth(v, options.quick));
    } catch (const tools::Interrupted&) {
      break;
    }
  }
  if (options.scenes.empty() && out.size() == variants.size()) {
    tell("trees of joints against sweeps", 1);
    try {
      const std::vector<WorthRow> methods = compare_joint_methods(options.quick);
      out.insert(out.end(), methods.begin(), methods.end());
    } catch (const tools::Interrupted&) {
    }
  }
  return out;
}

nlohmann::ordered_json to_json(const std::vector<WorthRow>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const WorthRow& r : rows) {
    out.push_back({{"scene", r.scene},
                   {"variant", r.variant},
                   {"world_steps_per_s", r.plain},
                   {"time_ratio", r.worth},
                   {"same_bits", r.same_bits},
                   {"must_be_same", r.must_be_same}});
    if (r.bodies > 0) out.back()["bodies"] = r.bodies;
    if (!r.holds.empty()) out.back()["holds"] = r.holds;
  }
  return out;
}

}  // namespace manyworlds::report
