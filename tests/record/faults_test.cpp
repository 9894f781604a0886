// The n-th call of the system fails, for every n, while a recording is written or read: no crash,
// not even at exit, and never half a file under the good name.
#include <catch2/catch.hpp>

#include "src/base/output_file.hpp"
#include "tests/record/fault_sweep.hpp"

namespace manyworlds::test {
namespace {

Plan two_balls() {
  Scene scene = empty_scene(Space::planar);
  scene.add(ground(Space::planar));
  scene.add(body_of(shape_of(Circle{0.4}), Vec3(0, 0.6, 0)));
  scene.add(body_of(shape_of(Circle{0.5}), Vec3(0.2, 1.7, 0)));
  return compile(scene);
}

// Four worlds, a few steps and inputs, and a flush after each call if `flushed`.
void record(const Plan& plan, const fs::path& file, bool flushed) {
  Batch batch(plan, batch_options(widest_tables().front(), 4));
  Recorder recorder(batch, file, {.every = 1, .flush_seconds = flushed ? 0.0 : 1e9});
  batch.add_force(1, batch.body_in_row(0), Vec3(20, 0, 0));
  batch.step(2);
  batch.reset(std::vector<std::uint8_t>{0, 1, 0, 0});
  batch.add_impulse(2, batch.body_in_row(1), Vec3(0, 2, 0));
  batch.step();
  recorder.close();
}

// What is wrong with a recording that stands, or stood, where writing it may have failed.
std::string check_recording(const fs::path& file, bool failed) {
  if (read_text(file) == kOld) return failed ? "" : "the file was not written";
  const Recording recording = Recording::open(file);
  if (!recording.finished()) return "not finished, and under the good name";
  return replay(recording).different == 0 ? "" : "another replay";
}

// And with what is left beside it: at most one file, which replays up to a flush.
std::string check_folder(const Folder& folder, const fs::path& file, const std::string& message) {
  for (const std::string& name : folder.files()) {
    if (name == file.filename()) continue;
    const fs::path part = folder / name;
    if (message != kNoWords && message.find(part.string()) == std::string::npos) {
      return "not named: " + name;
    }
    if (unfinished_recordings(file) != std::vector{part}) return "not found: " + name;
    const ReplayResult result = replay(Recording::open(part));
    if (result.different != 0 || result.samples < 1) return "another replay of what is left";
    fs::remove(part);
  }
  return {};
}

std::string sweep_recordings(const Progress& progress, bool flushed, bool memory) {
  const Plan plan = two_balls();
  const Folder folder;
  const fs::path file = folder / "run.h5";
  write_file(file, kOld);
  record(plan, file, flushed);  // HDF5 sets itself up at first
  write_file(file, kOld);
  const auto write = [&] { record(plan, file, flushed); };
  const auto check = [&](const std::string& message) {
    std::string problem = check_recording(file, !message.empty());
    if (problem.empty()) problem = check_folder(folder, file, message);
    write_file(file, kOld);
    return problem;
  };
  return memory ? sweep_memory(progress, file, write, check)
                : sweep_calls(progress, file, write, check);
}

// Opening and replaying: an error or the whole.
std::string sweep_reading(const Progress& progress) {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  record(two_balls(), file, false);
  std::int64_t samples = replay(Recording::open(file)).samples;  // HDF5 sets itself up at first
  const std::int64_t expected = samples;
  const auto read = [&] {
    samples = -1;
    const ReplayResult result = replay(Recording::open(file));
    samples = result.different == 0 ? result.samples : -2;
  };
  const auto check = [&](const std::string& message) -> std::string {
    return samples == (message.empty() ? expected : -1) ? "" : "read what is not there";
  };
  return sweep_calls(progress, file, read, check);
}

}  // namespace

TEST_CASE("whatever fails while a recording is written, nothing crashes and nothing is half there",
          "[fast][record][faults]") {
  const bool flushed = GENERATE(false, true);
  CHECK(in_child([&](const Progress& say) { return sweep_recordings(say, flushed, false); }) == "");
}

TEST_CASE("wherever memory runs out while recording, nothing crashes", "[fast][record][faults]") {
  if (!kAllocationsFail) return;
  const bool flushed = GENERATE(false, true);
  CHECK(in_child([&](const Progress& say) { return sweep_recordings(say, flushed, true); }) == "");
}

TEST_CASE("whatever fails while a recording is read, it is an error or the whole of it",
          "[fast][record][faults]") {
  CHECK(in_child([](const Progress& say) { return sweep_reading(say); }) == "");
}

}  // namespace manyworlds::test
