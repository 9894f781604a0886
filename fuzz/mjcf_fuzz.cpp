// A model of which something was changed: refused with its problems, or a scene that is valid or
// has issues, and if it is valid, steps under any controls, without an allocation, with the same
// bits on another instruction set.
#include <sanitizer/allocator_interface.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/model_edit.hpp"
#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"

namespace manyworlds::fuzz {
namespace {

bool counting = false;
int allocations = 0;

void count_allocation(const volatile void*, std::size_t) { allocations += counting ? 1 : 0; }
void ignore_free(const volatile void*) {}

// A model may ask for much; what is worth a fuzzer's time is less.
MjcfOptions small() {
  MjcfOptions options;
  options.limits.elements = 2000;
  options.limits.copies = 100;
  options.limits.samples = 10'000;
  options.limits.vertices = 1000;
  return options;
}

std::optional<Scene> scene_of(const std::string& xml) {
  try {
    return load_mjcf_string(xml, small()).scene;
  } catch (const MjcfError& error) {
    require(!error.problems().empty(), "a model was refused without a problem");
    for (const std::string& problem : error.problems()) {
      require(!problem.empty(), "a problem says nothing");
    }
    return std::nullopt;
  }
}

std::optional<Plan> plan_of(Scene scene) {
  // A thousand iterations are a model's right.
  scene.options.solver.iterations = std::min(scene.options.solver.iterations.value_or(10), 10);
  int& searches = scene.options.solver.line_search_iterations;
  searches = std::min(searches, 10);
  const std::vector<Issue> issues = validate(scene);
  try {
    Plan plan = compile(scene);
    require(issues.empty(), "compile() took a scene with issues");
    int candidates = 0;
    for (const auto& c : plan.report().pairs) candidates += c.candidates;
    if (candidates > 2000) return std::nullopt;
    return plan;
  } catch (const SceneError&) {
    require(!issues.empty(), "compile() refused a scene without issues");
    return std::nullopt;
  }
}

void step_counted(Batch& batch) {
  allocations = 0, counting = true;
  batch.step();
  counting = false;
  require(allocations == 0, "a step allocated " + std::to_string(allocations) + " times");
}

void require_finite(const Batch& batch) {
  std::vector<double> values;
  for (int w = 0; w < batch.worlds(); ++w) {
    if (frozen(batch.status(w))) continue;
    for (const Field field :
         {Field::position, Field::generalized_position, Field::generalized_velocity}) {
      values.resize(batch.size(field) / static_cast<std::size_t>(batch.worlds()));
      batch.read(field, w, values);
      for (const double x : values) require(std::isfinite(x), "a world that steps is not finite");
    }
  }
}

void run(FuzzedDataProvider& in) {
  ModelEdit edited(models()[in.ConsumeIntegralInRange<std::size_t>(0, models().size() - 1)]);
  for (int i = in.ConsumeIntegralInRange(0, 8); i > 0 && in.remaining_bytes() > 0; --i) {
    edited.edit(in);
  }
  const std::optional<Scene> scene = scene_of(edited.xml());
  if (!scene) return;
  const std::optional<Plan> plan = plan_of(*scene);
  if (!plan) return;
  BatchOptions options;
  options.worlds = 2;
  options.threads = 1;
  Batch batch(*plan, options);
  options.isa = available_isas().front();
  Batch twin(*plan, options);
  // One world begins as the model says, the other one moves at once, into its limits and contacts.
  std::vector<double> speeds(batch.size(Field::generalized_velocity) / 2);
  for (double& v : speeds) v = in.ConsumeFloatingPointInRange<double>(-9, 9);
  if (!speeds.empty()) {
    batch.write(Field::generalized_velocity, 1, speeds);
    twin.write(Field::generalized_velocity, 1, speeds);
  }
  std::vector<double> controls(2 * plan->scene().controls.size());
  for (int step = 0; step < 10; ++step) {
    for (double& u : controls) u = in.ConsumeFloatingPointInRange<double>(-2, 2);
    batch.set_controls(controls), twin.set_controls(controls);
    step_counted(batch), step_counted(twin);
  }
  require(batch.hash() == twin.hash(), "another instruction set has other bits");
  require_finite(batch);
}

}  // namespace
}  // namespace manyworlds::fuzz

// An error of MuJoCo's is an exception that leaves its frames, and with them what they hold.
extern "C" const char* __lsan_default_suppressions() { return "leak:libmujoco"; }

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  __sanitizer_install_malloc_and_free_hooks(manyworlds::fuzz::count_allocation,
                                            manyworlds::fuzz::ignore_free);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  manyworlds::fuzz::run(in);
  return 0;
}
