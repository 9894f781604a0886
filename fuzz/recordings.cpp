#include "fuzz/recordings.hpp"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "fuzz/check.hpp"
#include "fuzz/inputs.hpp"
#include "manyworlds/record.hpp"
#include "tests/support/crowd.hpp"

namespace manyworlds::fuzz {

namespace {

Scene scene_of(Space space, bool varies) {
  Scene scene = test::crowd(space, 3);
  scene.bodies[2].shapes.front().geometry = Capsule{0.3, 0.2};
  scene.options.sleep.speed = 10;
  scene.options.sleep.time = 0.05;
  if (!varies) return scene;
  scene.variations.push_back(vary(Parameter::friction, 0.1, 0.9));
  scene.variations.push_back(vary(Parameter::density, 500, 2000, Draw::log_uniform));
  return scene;
}

Batch batch_of(int index) {
  const Space space = index % 2 == 0 ? Space::planar : Space::spatial;
  std::vector<Batch::Kind> kinds = {{compile(scene_of(space, index == 2)), 2}};
  if (index == 4) {
    Scene nothing = test::empty_scene(space);  // that has a state
    nothing.add(test::ground(space));
    kinds.push_back({compile(nothing), 1});
    PlanOptions options;
    options.broad_phase = BroadPhase::sort_and_sweep;
    kinds.push_back({compile(scene_of(space, true), options), 1});
  }
  BatchOptions options;
  options.threads = 1;
  options.sleep = index == 1 || index == 4;
  return Batch(std::move(kinds), options);
}

// Every call that changes a world, one after the other.
void disturb(Batch& batch, int round) {
  Input in;
  in.kind = round % 14;
  in.world = round % 2;
  in.body = in.kind == 11 ? 1 - in.world : round;
  in.value = batch.plan().scene().space == Space::planar ? Vec3(3, 50, 0) : Vec3(3, 4, 50);
  in.point = Vec3(0.1, 1, 0);
  in.number = round % 28 < 14 ? -0.5 : 0.5;
  if (in.kind == 0) return batch.restore(batch.save(std::array{in.world}), 0, 1 - in.world);
  apply(in, batch);
}

std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto raw = std::as_bytes(std::span(text));
  return {raw.begin(), raw.end()};
}

std::vector<std::byte> make(int index) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("manyworlds_fuzz_" + std::to_string(getpid()) + "_" + std::to_string(index) + ".h5");
  Batch batch = batch_of(index);
  batch.step(3);
  // The first writes samples as it goes, the others when told, in much smaller files.
  Recorder recorder(batch, file, {.every = index == 0 ? 3 : 0});
  for (int round = 0; round < 28; ++round) {
    disturb(batch, round);
    batch.step(round % 3);
    if (round % 7 == 0) recorder.sample(batch);
  }
  recorder.sample(batch);
  recorder.close();
  std::vector<std::byte> bytes = bytes_of(file);
  std::filesystem::remove(file);
  const ReplayResult result = replay(Recording::from_bytes(bytes), {.threads = 1});
  require(result.different == 0 && result.compared > 0, "an honest recording is not replayed");
  return bytes;
}

}  // namespace

const std::vector<std::byte>& recording(int index) {
  static std::array<std::vector<std::byte>, kRecordings> made;
  auto& out = made[static_cast<std::size_t>(index)];
  if (out.empty()) out = make(index);
  return out;
}

}  // namespace manyworlds::fuzz
