#include "tools/report/accuracy.hpp"
#include "tools/base/interrupt.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

namespace manyworlds::report {
namespace {

constexpr double kLost = std::numeric_limits<double>::infinity();
// A point is timed until it has run for so long, and this often at most; the fastest run counts.
constexpr double kTimedSeconds = 0.05;
constexpr int kMaxRuns = 5;

Batch make_batch(const Case& c, const Method& method, Precision precision, double step) {
  Scene scene = c.scene();
  scene.options.dt = step;
  method.choose(scene.options);
  BatchOptions options;
  options.threads = 1;
  options.precision = precision;
  options.observe.what = c.observe;
  Batch one(compile(scene), options);
  options.worlds = one.lanes();  // a whole group: what a world costs in a large batch
  return Batch(compile(scene), options);
}

double error_of(const Case& c, Batch& batch, double step, int steps) {
  double sum = 0, largest = 0, last = 0;
  for (int i = 1; i <= steps; ++i) {
    if (c.before_step) c.before_step(batch);
    batch.step();
    if (c.over == Over::end && i < steps) continue;
    last = c.error(batch, i * step);
    sum += last, largest = std::max(largest, last);
  }
  if (frozen(batch.status(0)) || !std::isfinite(last)) return kLost;
  return c.over == Over::end ? last : c.over == Over::largest ? largest : sum / steps;
}

double seconds_of(const Case& c, Batch& batch, int steps) {
  using Clock = std::chrono::steady_clock;
  double best = kLost, total = 0;
  for (int run = 0; run < kMaxRuns && total < kTimedSeconds; ++run) {
    batch.reset();
    const auto start = Clock::now();
    if (c.before_step) {
      for (int i = 0; i < steps; ++i) c.before_step(batch), batch.step();
    } else {
      batch.step(steps);
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, seconds), total += seconds;
    tools::stop_if_interrupted();
  }
  return best;
}

}  // namespace

std::vector<Method> all_integrators() {
  std::vector<Method> out;
  for (const Integrator i :
       {Integrator::explicit_euler, Integrator::symplectic_euler, Integrator::implicit_euler,
        Integrator::verlet, Integrator::velocity_verlet, Integrator::runge_kutta4}) {
    out.push_back({to_string(i), [i](Options& o) { o.integrator = i, o.substeps = 1; }});
  }
  out.insert(out.begin() + 1, {"symplectic-euler, quaternion", [](Options& o) {
                                 o.rotation = Rotation::quaternion, o.substeps = 1;
                               }});
  return out;
}

std::vector<Method> substeps(const std::vector<int>& counts) {
  std::vector<Method> out;
  for (const int n : counts) {
    out.push_back({std::to_string(n) + (n == 1 ? " substep" : " substeps"),
                   [n](Options& o) { o.substeps = n; }});
  }
  return out;
}

std::vector<Method> other_solvers(bool contacts) {
  const auto method = [](const char* name, Solver solver, bool split) {
    return Method{name, [=](Options& o) {
                    o.solver.method = solver, o.solver.split_impulse = split, o.substeps = 1;
                    if (solver != Solver::penalty) o.solver.iterations = 10;
                  }};
  };
  std::vector<Method> out = {
      method("sequential-impulse, 10 sweeps", Solver::sequential_impulse, false),
      method("sor 1.3, 10 sweeps", Solver::sor, false),
      method("nncg, 10 sweeps", Solver::nncg, false), method("penalty", Solver::penalty, false)};
  if (contacts)
    out.push_back(method("split impulses, 10 sweeps", Solver::sequential_impulse, true));
  return out;
}

std::vector<double> halvings(double first, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(first / (1 << i));
  return out;
}

std::vector<Case> accuracy_cases() {
  std::vector<Case> out = free_cases();
  for (const auto& more : {joint_cases(), contact_cases(), robot_cases()}) {
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

std::vector<Point> CaseResult::reached() const {
  std::vector<Point> out;
  for (const Point& p : points) {
    if (!(p.error <= of.level)) continue;
    const auto same = std::find_if(out.begin(), out.end(), [&](const Point& o) {
      return o.method == p.method && o.precision == p.precision;
    });
    if (same == out.end()) {
      out.push_back(p);
    } else if (p.microseconds < same->microseconds) {
      *same = p;
    }
  }
  return out;
}

std::vector<CaseResult> run_accuracy(const AccuracyOptions& options,
                                     const std::function<void(const std::string&, double)>& tell) {
  std::vector<CaseResult> out;
  std::size_t total = 0, done = 0;
  for (const Case& c : accuracy_cases()) {
    const auto& ids = options.cases;
    if (!ids.empty() && std::count(ids.begin(), ids.end(), c.id) == 0) continue;
    out.push_back({c, options.quick ? c.quick_seconds : c.seconds, {}});
    total += c.methods.size() * options.precisions.size() *
             (options.quick ? c.quick_steps : c.steps).size();
  }
  for (CaseResult& result : out) {
    const Case& c = result.of;
    for (const Method& method : c.methods) {
      for (const Precision precision : options.precisions) {
        for (const double step : options.quick ? c.quick_steps : c.steps) {
          tell(c.id + ' ' + method.name, static_cast<double>(done++) / static_cast<double>(total));
          const int steps = std::max(1, static_cast<int>(result.seconds / step + 0.5));
          Batch batch = make_batch(c, method, precision, step);
          Point p{method.name, precision, step, kLost, 0, 0};
          double seconds = 0;
          try {
            p.error = error_of(c, batch, step, steps);
            seconds = seconds_of(c, batch, steps) / batch.worlds();
          } catch (const tools::Interrupted&) {
            std::erase_if(out, [](const CaseResult& r) { return r.points.empty(); });
            return out;
          }
          p.microseconds = 1e6 * seconds, p.steps_per_s = steps / seconds;
          result.points.push_back(p);
        }
      }
    }
  }
  return out;
}

nlohmann::ordered_json to_json(const std::vector<CaseResult>& results) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  const auto to_object = [&](const Point& p) {
    return Json{{"method", p.method},
                {"precision", to_string(p.precision)},
                {"step_s", p.step},
                {"error", number(p.error)},
                {"us_per_world", p.microseconds},
                {"steps_per_s", p.steps_per_s}};
  };
  Json cases = Json::array();
  for (const CaseResult& r : results) {
    Json points = Json::array(), reached = Json::array(), published = Json::array();
    for (const Point& p : r.points) points.push_back(to_object(p));
    for (const Point& p : r.reached()) reached.push_back(to_object(p));
    for (const Published& p : r.of.published) {
      published.push_back({{"engine", p.engine},
                           {"step_s", p.step},
                           {"error", number(p.error)},
                           {"seconds", number(p.seconds)}});
    }
    cases.push_back({{"id", r.of.id},
                     {"title", r.of.title},
                     {"metric", r.of.metric},
                     {"unit", r.of.unit},
                     {"level", r.of.level},
                     {"simulated_s", r.seconds},
                     {"points", points},
                     {"cheapest_at_level", reached},
                     {"published", published}});
  }
  return cases;
}

}  // namespace manyworlds::report
