// `manyworlds plan`: what the step of a scene consists of, what was left out, and why.
#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "job.hpp"
#include "pair_table.hpp"
#include "report.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted;

using Json = nlohmann::ordered_json;

Json to_json(const std::vector<PlanReport::Item>& items) {
  Json list = Json::array();
  for (const auto& item : items) {
    list.push_back({{"name", item.name}, {"in", item.in}, {"why", item.why}});
  }
  return list;
}

Json to_json(const std::vector<PlanReport::Choice>& choices) {
  Json list = Json::array();
  for (const auto& c : choices) {
    list.push_back({{"option", c.option},
                    {"value", c.name.empty() ? Json(c.value) : Json(c.name)},
                    {"why", c.why}});
  }
  return list;
}

Json to_json(const Job& job, const PlanReport& report) {
  Json arrays = Json::array();
  for (const auto& array : report.arrays) {
    arrays.push_back(
        {{"name", array.name}, {"shape", array.shape}, {"bytes_per_world", array.bytes_per_world}});
  }
  return {{"scene", job.scene},
          {"bodies", job.plan.bodies()},
          {"choices", to_json(report.choices)},
          {"features", to_json(report.features)},
          {"stages", to_json(report.stages)},
          {"pairs", pairs_json(report.pairs)},
          {"arrays", arrays},
          {"broad_phase", option_name(report.broad_phase)},
          {"pair_capacity", report.pair_capacity},
          {"fixed_capacity", report.fixed_capacity},
          {"bytes_per_world", report.bytes_per_world}};
}

void print_items(const char* title, const std::vector<PlanReport::Item>& items) {
  const std::size_t width = widest(
      items, [](const auto& item) { return item.name; }, 0);
  fmt::print("\n{}\n", title);
  for (const auto& item : items) {
    fmt::print("  {:<3}  {:<{}}  {}\n", item.in ? "in" : "out", item.name, width, item.why);
  }
}

void print_choices(const std::vector<PlanReport::Choice>& choices) {
  if (choices.empty()) return;
  const std::size_t width = widest(
      choices, [](const auto& choice) { return choice.option; }, 0);
  fmt::print("\nchosen by the plan\n");
  for (const auto& c : choices) {
    const std::string value = c.name.empty() ? fmt::format("{:.4g}", c.value) : c.name;
    fmt::print("  {:<{}}  {:<10}  {}\n", c.option, width, value, c.why);
  }
}

void print_arrays(const PlanReport& report) {
  const std::size_t names = widest(
      report.arrays, [](const auto& array) { return array.name; }, 5);
  const std::size_t shapes = widest(
      report.arrays, [](const auto& array) { return array.shape; }, 5);
  fmt::print("\npersistent arrays, float32\n");
  fmt::print("  {:<{}}  {:<{}}{:>17}\n", "array", names, "shape", shapes, "bytes per world");
  for (const auto& array : report.arrays) {
    fmt::print("  {:<{}}  {:<{}}{:>17}\n", array.name, names, array.shape, shapes,
               array.bytes_per_world);
  }
  fmt::print("  {:<{}}  {:<{}}{:>17}\n", "total", names, "", shapes, report.bytes_per_world);
}

}  // namespace

int plan_command(const JobOptions& options) {
  const Job job = prepare(options);
  const PlanReport report = job.plan.report();
  if (options.json) {
    fmt::print("{}\n", to_json(job, report).dump(2));
    return kOk;
  }
  const Scene& scene = job.plan.scene();
  fmt::print(
      "{}: {} ({} with state), {}, dt {:.6g} s, {}, {}\n", job.scene,
      fmt::format("{} {}", scene.bodies.size(), scene.bodies.size() == 1 ? "body" : "bodies"),
      job.plan.bodies(), scene.space == Space::planar ? "planar" : "spatial", scene.options.dt,
      counted(*job.plan.resolved().substeps, "substep"),
      solver_text(scene.options.solver.method, iterations_of(scene.options.solver)));
  print_choices(report.choices);
  print_items("features", report.features);
  print_items("stages, in the order of the step", report.stages);
  print_pairs(report.pairs);
  print_arrays(report);
  fmt::print("\nbroad phase      {}\n", option_name(report.broad_phase));
  fmt::print("capacity         {} between bodies, {} against fixed shapes\n",
             counted(report.pair_capacity, "manifold"), report.fixed_capacity);
  return kOk;
}

}  // namespace manyworlds::cli
