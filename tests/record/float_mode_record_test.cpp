// The caller's floating-point mode changes nothing in recordings, replays and JSON.
#include <catch2/catch.hpp>

#include "tests/record/support.hpp"
#include "tests/support/float_modes.hpp"

namespace manyworlds::test {
namespace {

Scene recorded_scene() {
  Scene scene = crowd(Space::spatial);
  scene.options.dt = 1.0 / 59.94;
  scene.bodies[3].linear_velocity.x() = 3e-310;
  return scene;
}

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// Recorded from first to last in the mode, and replayed in it.
StateBytes recorded(const InMode& in_mode) {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  const Plan plan = compile(recorded_scene());
  const Vec3 impulse(0.1, 0.2, 1.0 / 3);
  StateBytes out;
  in_mode([&] {
    Batch batch(plan, {.worlds = 3, .threads = 1});
    Recorder recorder(batch, file, {.worlds = {0, 2}, .every = 2});
    batch.step(3);
    batch.add_impulse(2, BodyId(3), impulse);
    batch.step(4);
    recorder.sample(batch);
    recorder.close();
    const Recording recording = Recording::open(file);
    out.add(recording.samples());
    out.add(recording.hash(1, 1));
    out.add(recording.read(Field::position, 1, 1));
    const ReplayResult same = replay(recording, {.threads = 1});
    out.add(same.compared);
    out.add(same.different);
  });
  out.add(contents(file));
  return out;
}

StateBytes json(const InMode& in_mode) {
  const Scene scene = recorded_scene();
  StateBytes out;
  in_mode([&] {
    const std::string text = scene_to_json(scene);
    out.add(text);
    out.add(scene_to_json(scene_from_json(text)));
    const std::string options = plan_options_to_json({});
    out.add(plan_options_to_json(plan_options_from_json(options)));
  });
  return out;
}

}  // namespace

TEST_CASE("the caller's floating-point mode changes no bit of recordings and JSON",
          "[record][mode]") {
  check_modes({{"recorder, recording, replay", recorded}, {"JSON", json}});
}

TEST_CASE("JSON knows no value that an enumeration does not have", "[record][misuse]") {
  Scene scene = recorded_scene();
  scene.bodies[1].motion = static_cast<Motion>(9);
  CHECK_THROWS_WITH(scene_to_json(scene), "motion is 9, must be dynamic, kinematic or fixed");
  CHECK_THROWS_AS(plan_options_to_json({.keep = {static_cast<Feature>(-1)}}),
                  std::invalid_argument);
}

}  // namespace manyworlds::test
