#include "tools/report/stability.hpp"
#include "tools/base/interrupt.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <nlohmann/json.hpp>

namespace manyworlds::report {
namespace {

// Looked at so often, s, whatever the steps.
constexpr double kLook = 1.0 / 60;

// In those that the case or the plan gives.
Setting with_substeps(const char* name, double factor) {
  Setting out{name, Precision::f32};
  out.substeps = factor;
  return out;
}
// A solver of hard rows; springs that the case gives to contacts and joints are left out.
Setting with_solver(const char* name, Solver solver, bool split = false) {
  return {name, Precision::f32, 1, 1, [solver, split](Options& o) {
            o.solver.method = solver, o.solver.split_impulse = split;
            o.substeps = 1, o.solver.iterations = 20;
            o.joint.frequency.reset();
          }};
}

std::vector<Setting> settings(bool quick) {
  std::vector<Setting> out = {{"default, f32", Precision::f32},
                              {"default, f64", Precision::f64},
                              with_substeps("twice the substeps, f32", 2)};
  if (quick) return out;
  out.push_back(with_substeps("a quarter of the substeps, f32", 0.25));
  out.push_back({"two sweeps per substep, f32", Precision::f32, 1, 1,
                 [](Options& o) { o.solver.iterations = 2; }});
  out.push_back({"a quarter of the step, f32", Precision::f32, 4});
  out.push_back({"swept joints, f32", Precision::f32, 1, 1,
                 [](Options& o) { o.joint.method = JointMethod::sweep; }});
  out.push_back(with_solver("sequential-impulse, 20 sweeps, f32", Solver::sequential_impulse));
  out.push_back(with_solver("split impulses, 20 sweeps, f32", Solver::sequential_impulse, true));
  out.push_back(with_solver("sor 1.3, 20 sweeps, f32", Solver::sor));
  out.push_back(with_solver("nncg, 20 sweeps, f32", Solver::nncg));
  out.push_back({"penalty, 16 substeps, f32", Precision::f32, 1, 1,
                 [](Options& o) { o.solver.method = Solver::penalty, o.substeps = 16; }});
  return out;
}

Verdict verdict_of(const Trial& trial, const Setting& setting) {
  return {trial.id,    trial.title,
          trial.group, trial.criterion,
          trial.unit,  setting.name,
          trial.note,  trial.limit,
          0,           0,
          false};
}

Verdict run_trial(const Trial& trial, const Setting& setting, int worlds) {
  Scene scene = trial.scene();
  Options& o = scene.options;
  o.dt = trial.dt / setting.finer;
  setting.choose(o);
  if (setting.substeps != 1) {
    const int given = *compile(scene).resolved().substeps;
    o.substeps = std::clamp(static_cast<int>(given * setting.substeps), 1, 64);
  }
  BatchOptions options;
  options.worlds = worlds, options.precision = setting.precision, options.seed = 1;
  const Plan plan = compile(scene);
  if (trial.whole) {
    Verdict out = verdict_of(trial, setting);
    out.value = trial.whole(plan, options);
    tools::stop_if_interrupted();
    out.passed = out.value <= trial.limit;
    return out;
  }
  Batch batch(plan, options);
  Seen seen(batch);
  std::vector<double> value(static_cast<std::size_t>(worlds), 0.0);
  const int steps = static_cast<int>(trial.seconds / o.dt + 0.5);
  const int between = std::max(1, static_cast<int>(kLook / o.dt + 0.5));
  for (int i = 1; i <= steps; ++i) {
    if (trial.act) trial.act(batch, (i - 1) * o.dt);
    batch.step();
    tools::stop_if_interrupted();
    if (i < steps && (trial.at_end || i % between != 0 || i * o.dt < trial.from)) continue;
    seen.look(i * o.dt);
    for (int w = 0; w < worlds; ++w) {
      double& worst = value[static_cast<std::size_t>(w)];
      const double now = trial.value(seen, w);
      worst = std::isfinite(now) ? std::max(worst, now) : std::numeric_limits<double>::infinity();
    }
  }
  Verdict out = verdict_of(trial, setting);
  out.value = *std::max_element(value.begin(), value.end());
  for (int w = 0; w < worlds; ++w) out.lost += batch.status(w) == Status::ok ? 0 : 1;
  out.passed = out.lost == 0 && out.value <= trial.limit;
  return out;
}

}  // namespace

void Seen::look(double time) {
  time_ = time;
  bodies_ = batch_->bodies(0);
  for (auto& [field, out] : {std::pair(Field::position, &x_),
                             {Field::orientation, &q_},
                             {Field::linear_velocity, &v_},
                             {Field::angular_velocity, &w_}}) {
    out->resize(batch_->size(field));
    batch_->read(field, *out);
  }
  if (!start_.empty()) return;
  start_ = x_;
  for (int w = 0; w < batch_->worlds(); ++w) start_energy_.push_back(energy(w));
}

Vec3 Seen::vector(const std::vector<double>& all, int world, int body) const {
  const std::size_t items = static_cast<std::size_t>(batch_->worlds() * bodies_);
  const std::size_t n = all.size() / items;
  const double* from = all.data() + static_cast<std::size_t>(world * bodies_ + body) * n;
  if (n == 1) return {0, 0, from[0]};
  return {from[0], from[1], n == 3 ? from[2] : 0.0};
}
Quat Seen::rotation(int world, int body) const {
  const std::size_t items = static_cast<std::size_t>(batch_->worlds() * bodies_);
  const std::size_t n = q_.size() / items;
  const double* q = q_.data() + static_cast<std::size_t>(world * bodies_ + body) * n;
  if (n == 4) return Quat(q[0], q[1], q[2], q[3]);
  return Quat(Eigen::AngleAxisd(std::atan2(q[1], q[0]), Vec3::UnitZ()));
}
double Seen::worst_gap(int world) const {
  const Scene& scene = batch_->plan().scene();
  double most = 0;
  for (const Joint& j : scene.joints) {
    const bool slides =
        std::holds_alternative<SliderJoint>(j.type) || std::holds_alternative<WheelJoint>(j.type);
    if (slides) continue;
    const auto anchor = [&](BodyId body, const Frame& frame) {
      if (!body || scene.at(body).motion == Motion::fixed) {
        return frame_in_world(scene, body, frame).position;
      }
      const int row = batch_->row(body);
      return Vec3(position(world, row) + rotation(world, row) * frame.position);
    };
    most = std::max(most, (anchor(j.body_a, j.frame_a) - anchor(j.body_b, j.frame_b)).norm());
  }
  return most;
}
double Seen::energy(int world) const {
  const Energy e = batch_->energy(world);
  return e.kinetic + e.potential;
}
Vec3 Seen::moved(int world, int body) const {
  return vector(x_, world, body) - vector(start_, world, body);
}
double Seen::fastest(int world) const {
  double most = 0;
  for (int b = 0; b < bodies_; ++b) most = std::max(most, velocity(world, b).norm());
  return most;
}

std::vector<Trial> stability_trials() {
  std::vector<Trial> out;
  const auto add = [&](const char* group, std::vector<Trial> trials) {
    for (Trial& t : trials) {
      t.group = group;
      out.push_back(std::move(t));
    }
  };
  add("contacts", contact_trials());
  add("joints", joint_trials());
  add("trees of joints", tree_trials());
  add("motion", motion_trials());
  add("structures", structure_trials());
  add("laws", law_trials());
  add("sizes", size_trials());
  add("impacts", impact_trials());
  return out;
}

std::vector<Verdict> run_stability(const StabilityOptions& options,
                                   const std::function<void(const std::string&, double)>& tell) {
  std::vector<Trial> trials;
  for (const Trial& t : stability_trials()) {
    const auto& ids = options.cases;
    if (ids.empty() || std::count(ids.begin(), ids.end(), t.id) > 0) trials.push_back(t);
  }
  std::vector<Verdict> out;
  const std::vector<Setting> all = settings(options.quick);
  for (const Trial& t : trials) {
    for (const Setting& s : all) {
      tell(t.id + ' ' + s.name,
           static_cast<double>(out.size()) / static_cast<double>(trials.size() * all.size()));
      try {
        out.push_back(run_trial(t, s, options.quick ? 16 : 64));
      } catch (const tools::Interrupted&) {
        return out;
      }
    }
  }
  return out;
}

nlohmann::ordered_json to_json(const std::vector<Verdict>& verdicts) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Verdict& v : verdicts) {
    out.push_back({{"id", v.id},
                   {"title", v.title},
                   {"group", v.group},
                   {"criterion", v.criterion},
                   {"unit", v.unit},
                   {"limit", v.limit},
                   {"setting", v.setting},
                   {"value", std::isfinite(v.value) ? nlohmann::ordered_json(v.value) : nullptr},
                   {"lost_worlds", v.lost},
                   {"passed", v.passed},
                   {"note", v.note}});
  }
  return out;
}

}  // namespace manyworlds::report
