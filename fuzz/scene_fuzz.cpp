// Any scene: validate() lists what is wrong with it, compile() throws exactly then, and what
// compiles steps, whatever the numbers, the same in another layout, broad phase and instruction
// set, and goes on from a snapshot.
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/inputs.hpp"

namespace manyworlds::fuzz {
namespace {

std::optional<Plan> compiled(const Scene& scene, const PlanOptions& options) {
  const std::vector<Issue> issues = validate(scene);
  for (const Issue& issue : issues) {
    require(!issue.place.empty(), "an issue has no place: " + issue.message);
    require(!issue.message.empty(), "an issue has no message: " + issue.place);
  }
  try {
    Plan plan = compile(scene, options);
    require(issues.empty(),
            "compile() took a scene with " + std::to_string(issues.size()) + " issues");
    return plan;
  } catch (const SceneError& error) {
    require(!issues.empty(), "compile() refused a scene without issues");
    require(error.issues().size() == issues.size(), "compile() has other issues than validate()");
    return std::nullopt;
  }
}

ContactLayout other(ContactLayout layout) {
  return layout == ContactLayout::rows ? ContactLayout::dense : ContactLayout::rows;
}

void compare(const Batch& a, const Batch& b, const char* what) {
  for (int w = 0; w < a.worlds(); ++w) {
    require(a.status(w) == b.status(w), std::string(what) + ": world " + std::to_string(w) +
                                            " is " + to_string(a.status(w)) + " and " +
                                            to_string(b.status(w)));
    require(a.hash(w) == b.hash(w),
            std::string(what) + ": world " + std::to_string(w) + " has other bits");
  }
}

void run(SceneBytes& bytes) {
  BatchOptions options = bytes.batch_options();
  PlanOptions plan_options = bytes.plan_options();
  std::vector<Input> inputs;
  for (int i = bytes.integer(0, 6); i > 0; --i) inputs.push_back(input(bytes));
  const Scene scene = bytes.scene();
  const std::optional<Plan> plan = compiled(scene, plan_options);
  if (!plan) return;

  const PlanReport report = plan->report();
  plan_options.broad_phase = report.broad_phase == BroadPhase::sort_and_sweep
                                 ? BroadPhase::all_pairs
                                 : BroadPhase::sort_and_sweep;
  int candidates = 0;
  for (const auto& c : report.pairs) candidates += c.candidates;
  if (candidates > 20000) return;  // too slow to be worth it

  Batch batch(*plan, options);
  options.layout = other(options.layout);
  options.isa = Isa::scalar;
  Batch twin(compile(scene, plan_options), options);
  compare(batch, twin, "at the start");
  for (const Input& in : inputs) {
    apply(in, batch);
    apply(in, twin);
    step_and_look(batch, 1);
    twin.step();
    compare(batch, twin, "in another layout, broad phase and instruction set");
  }
  const Snapshot saved = Snapshot::from_bytes(batch.save().bytes());
  step_and_look(batch, 3);
  twin.step(3);
  compare(batch, twin, "in another layout, broad phase and instruction set");
  batch.restore(saved);
  batch.step(3);
  compare(batch, twin, "from a snapshot");
}

}  // namespace
}  // namespace manyworlds::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  manyworlds::fuzz::SceneBytes bytes(data, size);
  manyworlds::fuzz::run(bytes);
  return 0;
}
