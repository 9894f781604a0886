// What an Environment does to its worlds is recorded like any other input: actions, and the resets
// that come with the steps.
#include <catch2/catch.hpp>

#include <limits>

#include "manyworlds/tasks.hpp"
#include "tests/record/support.hpp"
#include "tests/support/policy.hpp"

namespace manyworlds::test {

TEST_CASE("episodes of an environment are recorded and replayed", "[fast][record][task]") {
  const Folder folder;
  for (const char* name : {"LunarLander", "Pusher", "BallBalance"}) {
    for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
      Task task = tasks::find(name)->make();
      task.max_steps = 13;
      Played p(task, {.worlds = 11, .autoreset = autoreset});
      Batch& batch = p.environment.batch();
      Recorder recorder(batch, folder / "run.h5", {.every = task.frame_skip});
      for (int step = 0; step < 40; ++step) {
        p.act_at_random(step);
        if (step == 9 && task.choices == 0) p.actions[3] = std::numeric_limits<float>::quiet_NaN();
        p.step();
      }
      recorder.close();
      const Recording recording = Recording::open(folder / "run.h5");
      INFO(name << ' ' << to_string(autoreset));
      CHECK(recording.samples() == 41);
      const ReplayResult result = replay(recording);
      CHECK(result.compared > 0);
      CHECK(result.different == 0);
      if (result.difference) {
        FAIL_CHECK("world " << result.difference->world << ", step " << result.difference->step
                            << ": " << result.difference->what);
      }
    }
  }
}

TEST_CASE("resets of an environment are recorded with the numbers that its task sets",
          "[fast][record][task]") {
  const Folder folder;
  Task task = tasks::find("Pusher")->make();
  task.max_steps = 7;
  const ShapeId shape(BodyId(0), 0);
  Variation friction = vary(Parameter::friction, 0, 5, Draw::none);
  friction.shape = shape;
  task.scene.variations = {friction};
  task.levels = {{"episodes", 0, terms::level("episodes") + 1}};
  task.initial_parameters = {
      {terms::parameter(Parameter::friction, shape),
       terms::level("episodes") + terms::uniform("friction", Every::episode)}};
  REQUIRE(validate(task).empty());
  Played p(task, {.worlds = 11, .autoreset = Autoreset::same_step});
  Recorder recorder(p.environment.batch(), folder / "run.h5", {.every = task.frame_skip});
  const std::vector<std::uint8_t> some{1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1};
  for (int step = 0; step < 30; ++step) {
    p.act_at_random(step);
    if (step == 4) p.environment.reset(some, p.observations);
    if (step == 19) {
      p.environment.reset(some, std::vector<std::uint64_t>(11, 77), p.observations);
    }
    p.step();
  }
  recorder.close();
  const ReplayResult result = replay(Recording::open(folder / "run.h5"));
  CHECK(result.compared > 0);
  CHECK(result.different == 0);
}

TEST_CASE("a step of a task that is ended early and finished is recorded as both parts",
          "[fast][record][task]") {
  const Folder folder;
  Task task = tasks::find("Pusher")->make();
  task.frame_skip = 200;
  task.max_steps = 2;
  Played p(task, {.worlds = 5, .autoreset = Autoreset::same_step});
  Batch& batch = p.environment.batch();
  Recorder recorder(batch, folder / "run.h5");
  p.act_at_random(0);
  batch.add_force(1, batch.body_in_row(0), Vec3(1, 0, 0));  // acts in the first part
  REQUIRE_FALSE(p.environment.step(p.actions, p.arrays(), [] { return false; }));
  const int taken = static_cast<int>(batch.steps());
  p.environment.finish_step(p.arrays());
  p.act_at_random(1);
  p.step();
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  REQUIRE(recording.samples() == 4);
  CHECK(recording.step(1) == taken);
  CHECK(recording.step(2) == task.frame_skip);
  const ReplayResult result = replay(recording);
  CHECK(result.compared > 0);
  CHECK(result.different == 0);
}

}  // namespace manyworlds::test
