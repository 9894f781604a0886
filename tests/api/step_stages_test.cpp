// The stages that a plan says it runs are those that a step runs.
#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <string>

#include "manyworlds/scenes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::set<std::string> planned(const Plan& plan) {
  std::set<std::string> out;
  for (const auto& stage : plan.report().stages) {
    if (stage.in) out.insert(stage.name);
  }
  return out;
}

std::set<std::string> timed(const Plan& plan, const BatchOptions& options) {
  Batch batch(plan, options);
  batch.profile(true);
  batch.step(20);
  std::set<std::string> out;
  for (const StageTime& t : batch.take_stage_times()) out.insert(t.stage);
  return out;
}

}  // namespace

TEST_CASE("a step runs the stages of its plan and no other", "[fast][plan]") {
  const Table table = widest_tables().front();
  for (const scenes::Entry& entry : scenes::all()) {
    Scene scene = entry.make();
    const bool robot = scene.options.solver.method == Solver::newton;
    for (const Solver solver :
         {robot ? Solver::newton : Solver::tgs_soft, Solver::nncg, Solver::penalty}) {
      if (robot && solver != Solver::newton) continue;
      scene.options.solver.method = solver;
      const Plan plan = compile(scene);
      INFO(entry.name << ' ' << to_string(solver));
      BatchOptions options = options_of(table);
      options.audit_every = 0;
      // Where nothing touches yet, passes over contacts are left out unless a layout is chosen.
      const std::set<std::string> stages = planned(plan), some = timed(plan, options);
      CHECK(std::includes(stages.begin(), stages.end(), some.begin(), some.end()));
      options.layout = ContactLayout::dense;
      CHECK(timed(plan, options) == stages);
    }
  }
}

TEST_CASE("sleep, audits and observers add stages that a plan does not decide about",
          "[fast][plan]") {
  const Plan plan = compile(scenes::find("stack10")->make());
  BatchOptions options = options_of(widest_tables().front());
  options.sleep = true;
  options.observe.what = {Observer::motion};
  std::set<std::string> expected = planned(plan);
  expected.insert({"settle", "audit", "observe"});
  CHECK(timed(plan, options) == expected);
}

TEST_CASE("a body on which only a control acts goes by substeps", "[fast][plan]") {
  Scene scene = empty_scene(Space::planar);
  const BodyId body = scene.add(body_of(shape_of(Circle{0.5}), Vec3::Zero()));
  Control thrust;
  thrust.kind = ControlKind::thrust;
  thrust.body = body;
  thrust.low = 0, thrust.high = 1;
  scene.add(thrust);
  const Plan plan = compile(scene);
  CHECK(planned(plan) == std::set<std::string>{"begin", "warm_start", "advance", "finish"});
  CHECK(timed(plan, options_of(widest_tables().front())) == planned(plan));
}

}  // namespace manyworlds::test
