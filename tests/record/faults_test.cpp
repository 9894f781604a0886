// The n-th call of the system fails, for every n, while a recording, a snapshot or a text is
// written: no crash, not even at exit, and never half a file under the good name.
#include <catch2/catch.hpp>

#include <cerrno>
#include <cstring>
#include <new>

#include <hdf5.h>

#include "src/base/output_file.hpp"
#include "tests/record/faults.hpp"
#include "tests/record/support.hpp"

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

std::string read_text(const fs::path& file) {
  const auto bytes = bytes_of(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const std::string kOld = "what was there before";

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
    if (message.find(part.string()) == std::string::npos) return "not named: " + name;
    if (unfinished_recordings(file) != std::vector{part}) return "not found: " + name;
    const ReplayResult result = replay(Recording::open(part));
    if (result.different != 0 || result.samples < 1) return "another replay of what is left";
    fs::remove(part);
  }
  return {};
}

// `write` with the n-th call failing, for every n; `check(message)` says what is wrong then.
template <class Write, class Check>
std::string sweep(Call call, int error, bool all_later, const Progress& progress, Write write,
                  Check check) {
  for (long n = 1;; ++n) {
    const std::string where = std::string(to_string(call)) + " " + std::to_string(n) + ", " +
                              std::strerror(error) + (all_later ? ", and later" : "");
    progress(where);
    std::string message;
    fail_call(call, n, error, all_later);
    try {
      write();
    } catch (const std::bad_alloc&) {
      message = "no memory";
    } catch (const std::exception& thrown) {
      message = thrown.what();
    }
    if (!end_failing()) return message.empty() ? "" : where + ": no fault, but " + message;
    const std::string problem = check(message);
    if (!problem.empty()) return where + ": " + problem + " (" + message + ")";
    if (message.find('\n') != std::string::npos) return where + ": two lines (" + message + ")";
    if (H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL) > 0) {
      return where + ": HDF5 still holds something (" + message + ")";
    }
  }
}

template <class Write, class Check>
std::string sweep_all(const Progress& progress, Write write, Check check) {
  for (const Call call : kFileCalls) {
    for (const bool all_later : {false, true}) {
      const int error = call == Call::write && !all_later ? EIO : ENOSPC;
      const std::string problem = sweep(call, error, all_later, progress, write, check);
      if (!problem.empty()) return problem;
    }
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
  return memory ? sweep(Call::allocate, ENOMEM, false, progress, write, check)
                : sweep_all(progress, write, check);
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

}  // namespace manyworlds::test
