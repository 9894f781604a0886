// What was recorded is what a replay does, on any kernels, threads and layouts, after any input.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

void check_equal(const ReplayResult& result) {
  CHECK(result.compared > 0);
  CHECK(result.different == 0);
  if (result.difference) {
    UNSCOPED_INFO("world " << result.difference->world << ", step " << result.difference->step
                           << ", body " << result.difference->body.index() << ": "
                           << result.difference->what);
    CHECK_FALSE(result.difference);
  }
}

// Records 96 steps of a crowd that is disturbed in every way, by calls of 3 steps.
void record_disturbed(Batch& batch, const fs::path& file, const RecordOptions& options) {
  Recorder recorder(batch, file, options);
  for (int round = 0; round < 32; ++round) {
    disturb(batch, round);
    batch.step(3);
  }
  recorder.close();
}

}  // namespace

TEST_CASE("every named scene is recorded and replayed", "[fast][record]") {
  const Folder folder;
  for (const scenes::Entry& entry : scenes::all()) {
    INFO(entry.name);
    Batch batch(compile(entry.make()), batch_options(widest_tables().front(), 3));
    Recorder recorder(batch, folder / "run.h5", {.every = 10});
    for (int i = 0; i < 4; ++i) batch.step(5);
    recorder.close();
    const Recording recording = Recording::open(folder / "run.h5");
    CHECK(recording.samples() == 3);
    CHECK(recording.step(2) == 20);
    CHECK(recording.hash(2, 1) == batch.hash(1));
    check_equal(replay(recording));
  }
}

TEST_CASE("inputs of every kind are repeated, whatever replays them", "[fast][record][bits]") {
  const Folder folder;
  for (const Space space : {Space::planar, Space::spatial}) {
    Scene scene = crowd(space);
    scene.controls = {
        {"jet", ControlKind::thrust, {}, BodyId(3), Vec3(0.1, 0, 0), Vec3(1, 2, 0), 0, 1e3, 0}};
    const Plan plan = compile(scene);
    for (const Table& table : all_tables()) {
      for (const bool sleep : {false, true}) {
        INFO(name(table) << (space == Space::planar ? " planar" : " spatial") << " sleep "
                         << sleep);
        Batch batch(plan, batch_options(table, 7, sleep));
        batch.step(20);
        record_disturbed(batch, folder / "run.h5", {.every = 7});
        const Recording recording = Recording::open(folder / "run.h5");
        CHECK(recording.inputs() > 32);
        CHECK(recording.worlds() == 7);
        CHECK(recording.samples() == 14);
        CHECK(recording.sleep() == sleep);
        for (const Table& other : all_tables()) {
          if (other.precision != table.precision) continue;
          INFO("replayed on " << name(other));
          for (const int threads : {1, 3}) {
            const ReplayResult result = replay(recording, {.isa = other.isa, .threads = threads});
            check_equal(result);
            CHECK(result.steps == recording.step(recording.samples() - 1));
            CHECK(result.compared == 7 * 14);
          }
        }
        check_equal(replay(recording, {.layout = ContactLayout::rows}));
      }
    }
  }
}

TEST_CASE("threads record, read and replay at a time", "[fast][record]") {
  const Folder folder;
  const Plan plan = compile(crowd(Space::spatial));
  std::atomic<int> same = 0;
  const auto work = [&](int i) {
    for (int round = 0; round < 4; ++round) {
      const fs::path file = folder / (std::to_string(i) + "_" + std::to_string(round) + ".h5");
      BatchOptions options = batch_options(widest_tables().front(), 3);
      options.threads = 1;
      Batch batch(plan, options);
      record_disturbed(batch, file, {.every = 7});
      const ReplayResult result = replay(Recording::open(file), {.threads = 1});
      if (result.compared > 0 && result.different == 0) ++same;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
  CHECK(same == 3 * 4);
}

TEST_CASE("steps of some worlds alone are recorded as what they come to", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::spatial)), batch_options(widest_tables().front(), 5));
  Recorder recorder(batch, folder / "run.h5", {.every = 1});
  const std::vector<std::uint8_t> some = {1, 0, 1, 0, 0};
  for (int round = 0; round < 4; ++round) {
    // World 0 uses its force up alone; world 1 keeps its own for the step of all.
    for (const int world : {0, 1}) batch.add_force(world, batch.body_in_row(2), Vec3(900, 0, 0));
    batch.step(some, 2);
    CHECK(batch.forces_pending());
    batch.step();
  }
  batch.add_force(2, batch.body_in_row(2), Vec3(900, 0, 0));
  batch.step(some);
  CHECK_FALSE(batch.forces_pending());
  for (int i = 0; i < 3000; ++i) batch.step(some);  // more than are kept in memory
  batch.step();
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  CHECK(recording.samples() == 6);
  CHECK(recording.inputs() == 2 * 4 * 2 + 1 + 2 + 3000 * 2);
  check_equal(replay(recording));
}

TEST_CASE("a world that is woken in a recording wakes in the replay", "[fast][record]") {
  const Folder folder;
  Scene scene = crowd(Space::spatial);
  scene.options.sleep.speed = 0.5;
  scene.options.sleep.time = 0.1;
  for (Body& body : scene.bodies) body.linear_drag = body.angular_drag = 1;
  Batch batch(compile(scene), batch_options(widest_tables().front(), 3, true));
  batch.step(400);
  REQUIRE(batch.asleep(1));
  Recorder recorder(batch, folder / "run.h5");
  batch.step(3);
  const std::uint64_t asleep = batch.hash(1);
  batch.wake(1);
  batch.step(3);
  CHECK(batch.hash(1) != asleep);
  recorder.close();
  check_equal(replay(Recording::open(folder / "run.h5")));
}

TEST_CASE("chosen worlds of several kinds are replayed by themselves", "[fast][record]") {
  const Folder folder;
  const Plan crowd_plan = compile(crowd(Space::spatial));
  const Plan other = compile(capsule_crowd(Space::spatial), {BroadPhase::sort_and_sweep, {}});
  BatchOptions options = batch_options(widest_tables().front(), 1);
  Batch batch({{crowd_plan, 9}, {other, 5}, {crowd_plan, 3}}, options);
  batch.step(10);
  record_disturbed(batch, folder / "run.h5",
                   {.worlds = {1, 7, 10, 13, 16}, .every = 5, .first_world = 1000});
  const Recording recording = Recording::open(folder / "run.h5");
  CHECK(recording.worlds() == 5);
  CHECK(recording.kinds() == 3);
  CHECK(recording.name_of(0) == 1001);
  CHECK(recording.name_of(3) == 1013);
  CHECK(recording.plan(1).scene().name == "crowd-capsules");
  const std::int64_t last = recording.samples() - 1;
  CHECK(recording.hash(last, 2) != recording.hash(0, 2));
  check_equal(replay(recording));

  // Kinds of which nothing is recorded are left out.
  Recorder some(batch, folder / "some.h5", {.worlds = {15}});
  batch.step();
  some.close();
  CHECK(Recording::open(folder / "some.h5").kinds() == 1);
  check_equal(replay(Recording::open(folder / "some.h5")));
}

TEST_CASE("a recording has samples where it says, and the fields of the batch", "[fast][record]") {
  const Folder folder;
  for (const Table& table : widest_tables()) {
    Batch batch(compile(crowd(Space::planar)), batch_options(table, 80));
    Recorder recorder(batch, folder / "run.h5", {.every = 4});
    batch.step(3);
    batch.step(6);  // beyond 4 and 8: one sample
    batch.step(3);
    recorder.sample(batch);  // there is one already
    batch.step(1);
    batch.add_impulse(0, batch.body_in_row(0), Vec3(1, 2, 0));
    recorder.sample(batch);
    CHECK(recorder.samples() == 4);
    recorder.close();
    CHECK(recorder.samples() == 4);
    const Recording recording = Recording::open(folder / "run.h5");
    CHECK(recording.worlds() == kMaxWorldsByDefault);
    const std::vector<std::int64_t> steps = {0, 9, 12, 13};
    REQUIRE(recording.samples() == 4);
    for (std::int64_t s = 0; s < 4; ++s) {
      CHECK(recording.step(s) == steps[static_cast<std::size_t>(s)]);
    }
    for (const Field field :
         {Field::position, Field::orientation, Field::linear_velocity, Field::angular_velocity}) {
      CHECK(recording.read(field, 3, 17) == values(batch, field, 17));
    }
    CHECK(recording.hash(3, 17) == batch.hash(17));
    CHECK(recording.status(3, 17) == batch.status(17));
    CHECK(recording.precision() == table.precision);
    check_equal(replay(recording));
  }
}

TEST_CASE("a recording begins in the middle of a run, and ends with its Recorder",
          "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::spatial)), batch_options(widest_tables().front(), 4));
  batch.step(30);
  disturb(batch, 6);
  {
    Recorder forgotten(batch, folder / "never.h5");
    batch.step();
  }
  CHECK(folder.files().empty());
  Recorder first(batch, folder / "first.h5");
  Recorder second(batch, folder / "second.h5", {.worlds = {2}, .every = 3});  // two at a time
  Batch moved = std::move(batch);
  moved.step(4);
  moved.reset();
  moved.step(2);
  first.close();
  moved.add_impulse(2, moved.body_in_row(0), Vec3(0, 0, 5));
  moved.step(2);
  second.close();
  first.close();  // nothing happens
  {
    Recorder again(moved, folder / "first.h5"), twice(moved, folder / "first.h5");
    CHECK(folder.files().size() == 4);
    CHECK(Recording::open(folder / "first.h5").samples() > 0);
  }
  moved.step();
  CHECK(folder.files().size() == 2);
  const Recording one = Recording::open(folder / "first.h5");
  CHECK(one.step(one.samples() - 1) == 6);
  CHECK(one.inputs() == 4);
  check_equal(replay(one));
  const Recording two = Recording::open(folder / "second.h5");
  CHECK(two.step(two.samples() - 1) == 6);
  CHECK(two.inputs() == 2);
  check_equal(replay(two));
}

TEST_CASE("runs that are equal make equal files, whenever they are recorded", "[fast][record]") {
  const Folder folder;
  std::vector<std::vector<std::byte>> files;
  for (const char* name : {"first.h5", "second.h5"}) {
    if (!files.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 2));
    Recorder recorder(batch, folder / name);
    batch.step(3);
    recorder.close();
    files.push_back(bytes_of(folder / name));
  }
  CHECK(files[0] == files[1]);  // HDF5 would put seconds of the clock into groups
}

TEST_CASE("frozen worlds are recorded and replayed", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::spatial)), batch_options(widest_tables().front(), 4));
  Recorder recorder(batch, folder / "run.h5");
  batch.step(5);
  batch.add_force(2, batch.body_in_row(1), Vec3::Constant(std::nan("")));
  batch.step(5);
  recorder.close();
  REQUIRE(frozen(batch.status(2)));
  const Recording recording = Recording::open(folder / "run.h5");
  CHECK(recording.status(recording.samples() - 1, 2) == batch.status(2));
  const ReplayResult result = replay(recording);
  check_equal(result);
  CHECK(result.lost_worlds == 1);
}

TEST_CASE("a Recorder refuses what it cannot record", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::spatial)), batch_options(widest_tables().front(), 4));
  const auto refused = [&](const RecordOptions& options, const char* why) {
    CHECK_THROWS_WITH(Recorder(batch, folder / "run.h5", options), Catch::Contains(why));
  };
  refused({.worlds = {4}}, "world 4 is not in the batch, must be 0 to 3");
  refused({.worlds = {-1}}, "world -1 is not in");
  refused({.worlds = {2, 1}}, "1 comes after 2");
  refused({.every = -1}, "every is -1");
  CHECK_THROWS_AS(Recorder(batch, "/nowhere/at/all.h5"), RecordError);
  batch.add_force(0, batch.body_in_row(0), Vec3(1, 0, 0));
  refused({}, "forces are pending for the next step");
  batch.step();
  CHECK_NOTHROW(Recorder(batch, folder / "run.h5"));
  CHECK(folder.files().empty());
}

TEST_CASE("resets to keyframes are repeated", "[fast][record][bits]") {
  const Folder folder;
  Scene scene = scenes::find("hopper")->make();
  const Plan plain = compile(scene);
  std::vector<double> pose(plain.numbers(Field::generalized_position), 0.1);
  scene.add(
      Keyframe{.name = "crouch", .generalized_position = pose, .controls = {0.5, -0.5, 0.25}});
  const Plan plan = compile(scene);
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(plan, batch_options(table, 5));
    Recorder recorder(batch, folder / "run.h5", {.every = 4});
    batch.step(8);
    batch.reset(std::vector<std::uint8_t>{0, 1, 0, 1, 1}, batch.keyframe("crouch"));
    batch.step(8);
    batch.reset(std::vector<std::uint8_t>{1, 1, 0, 0, 0}, batch.keyframe("crouch"));
    batch.step(8);
    recorder.close();
    const Recording recording = Recording::open(folder / "run.h5");
    CHECK(recording.inputs() == 5);
    check_equal(replay(recording));
    Batch one(plan, batch_options(table, 1));
    one.reset(KeyframeId(0));
    one.step(8);
    CHECK(one.hash(0) == batch.hash(1));
  }
}

}  // namespace manyworlds::test
