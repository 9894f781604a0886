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
      task.most_steps = 13;
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

}  // namespace manyworlds::test
