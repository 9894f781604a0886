#include "report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/base/joint_gap.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::hex, tools::max_joint_gap;

double total_bodies(const Batch& batch) {
  double bodies = 0;
  for (int world = 0; world < batch.worlds(); ++world) bodies += batch.bodies(world);
  return bodies;
}

Energy mean_energy(const Batch& batch) {
  Energy sum;
  for (int world = 0; world < batch.worlds(); ++world) {
    const Energy energy = batch.energy(world);
    sum.kinetic += energy.kinetic;
    sum.potential += energy.potential;
  }
  return {sum.kinetic / batch.worlds(), sum.potential / batch.worlds()};
}

}  // namespace

Report measure(const Batch& batch, const Job& job, int steps, int steps_per_call, double seconds) {
  const Options& options = job.plan.scene().options;
  const ContactSummary contacts = batch.measure_contacts();

  Report report;
  report.scene = job.scene;
  report.worlds = batch.worlds();
  report.steps = steps;
  report.steps_per_call = steps_per_call;
  report.threads = batch.threads();
  report.isa = batch.isa();
  report.precision = batch.precision();
  report.dt = options.dt;
  report.substeps = *batch.plan().resolved().substeps;
  report.solver = options.solver.method;
  report.iterations = iterations_of(options.solver);
  const double steps_per_s = seconds > 0 ? steps / seconds : 0;
  report.world_steps_per_s = steps_per_s * batch.worlds();
  report.body_steps_per_s = steps_per_s * total_bodies(batch);
  report.contacts_per_world = contacts.points_per_world;
  report.manifolds_per_world = contacts.manifolds_per_world;
  report.max_penetration = contacts.max_penetration;
  report.max_joint_gap = max_joint_gap(batch);
  report.mean_energy = mean_energy(batch);
  report.bytes_per_world = batch.bytes_per_world();
  report.sleep = batch.sleeps();
  report.awake_fraction = batch.awake_fraction();
  report.lost_worlds = batch.lost_worlds();
  for (int world = 0; world < batch.worlds(); ++world) {
    const Status status = batch.status(world);
    report.diverged_worlds += has(status, Status::diverged) && !lost(status) ? 1 : 0;
  }
  report.hash = batch.hash();
  return report;
}

std::vector<Report::StageShare> profile_stages(Batch& batch, int steps, int steps_per_call,
                                               const RandomControls& controls) {
  batch.profile(true);
  timed_steps(batch, steps, steps_per_call, nullptr, controls);
  const std::vector<StageTime> times = batch.take_stage_times();
  batch.profile(false);

  double total = 0;
  for (const StageTime& time : times) total += time.seconds;
  std::vector<Report::StageShare> shares;
  for (const StageTime& time : times) {
    shares.push_back({time.stage, total > 0 ? time.seconds / total : 0});
  }
  return shares;
}

std::string solver_text(Solver solver, int iterations) {
  const std::string name = to_string(solver);
  return iterations == 1 ? name : fmt::format("{} with {} iterations", name, iterations);
}

nlohmann::ordered_json to_json(const Report& report) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const Report::StageShare& share : report.stage_split) stages[share.stage] = share.fraction;
  nlohmann::ordered_json json = {
      {"scene", report.scene},
      {"worlds", report.worlds},
      {"steps", report.steps},
      {"steps_per_call", report.steps_per_call},
      {"threads", report.threads},
      {"isa", to_string(report.isa)},
      {"precision", to_string(report.precision)},
      {"solver", to_string(report.solver)},
      {"dt", report.dt},
      {"substeps", report.substeps},
      {"iterations", report.iterations},
      {"sleep", report.sleep},
      {"world_steps_per_s", report.world_steps_per_s},
      {"body_steps_per_s", report.body_steps_per_s},
      {"contacts_per_world", report.contacts_per_world},
      {"max_penetration_m", report.max_penetration},
      {"max_joint_gap_m", report.max_joint_gap},
      {"energy_j", report.mean_energy.kinetic + report.mean_energy.potential},
      {"bytes_per_world", report.bytes_per_world},
      {"awake_fraction", report.awake_fraction},
      {"lost_worlds", report.lost_worlds},
      {"diverged_worlds", report.diverged_worlds},
      {"stage_split", stages},
      {"hash", hex(report.hash)},
  };
  if (!report.interrupted.empty()) json["interrupted"] = report.interrupted;
  return json;
}

}  // namespace manyworlds::cli
