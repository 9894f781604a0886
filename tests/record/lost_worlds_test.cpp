// Dumps of lost worlds: small, and a replay loses the world again at the same step.
#include <catch2/catch.hpp>

#include <algorithm>

#include "manyworlds/scenes.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

void check_replays(const fs::path& file, Status status) {
  INFO(file);
  const Recording recording = Recording::open(file);
  CHECK(recording.worlds() == 1);
  CHECK(recording.samples() == 2);
  CHECK_FALSE(lost(recording.status(0, 0)));
  CHECK(recording.status(1, 0) == status);
  const ReplayResult result = replay(recording);
  CHECK(result.different == 0);
  CHECK(result.lost_worlds == 1);
}

}  // namespace

TEST_CASE("a lost world is dumped from the last checkpoint, with its inputs", "[fast][record]") {
  for (const bool sleep : {false, true}) {
    const Folder folder;
    Batch batch(compile(crowd(Space::spatial)),
                batch_options(widest_tables().front(), 12, sleep, 2));
    LostWorldDumps dumps(batch, folder / "lost", {.checkpoint_steps = 20, .first_world = 100});
    for (int round = 0; round < 16; ++round) {
      disturb(batch, round);
      batch.step(3);
      // Worlds that nothing else touches.
      if (round == 1) batch.add_impulse(2, batch.body_in_row(1), Vec3(100, 0, 300));
      if (round == 2) batch.set_enabled(2, batch.body_in_row(3), false);
      if (round == 4) batch.add_force(2, batch.body_in_row(2), Vec3::Constant(std::nan("")));
      if (round == 8) batch.copy_world(0, 5);
      if (round == 9) batch.add_impulse(5, batch.body_in_row(2), Vec3(1e12, 0, 0));
    }
    REQUIRE(batch.lost_worlds() == 2);
    const auto files = dumps.close();
    REQUIRE(files ==
            std::vector<fs::path>{folder / "lost/world_102.h5", folder / "lost/world_105.h5"});
    check_replays(files[0], batch.status(2));
    check_replays(files[1], batch.status(5));
    CHECK(Recording::open(files[0]).name_of(0) == 102);
    // The first began with the run and ends with the call of 3 steps with the force, the second
    // began at the checkpoint after 21 steps and ends after 31.
    CHECK(Recording::open(files[0]).step(1) == 18);
    CHECK(Recording::open(files[0]).inputs() == 3);
    CHECK(Recording::open(files[1]).step(1) == 10);
    CHECK(Recording::open(files[1]).inputs() == 2);
    CHECK(dumps.close().empty());
  }
}

TEST_CASE("dumps of lost worlds are few and small", "[fast][record]") {
  const Folder folder;
  Scene scene = scenes::find("bin-boxes")->make();
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-1e3, -1e3, 0.4), Vec3(1e3, 1e3, 1e3));
  Batch batch(compile(scene), batch_options(widest_tables().front(), 8));
  LostWorldDumps dumps(batch, folder.path(), {.max_files = 3});
  batch.step(100);
  REQUIRE(batch.lost_worlds() > 3);
  const auto files = dumps.close();
  CHECK(files.size() == 3);
  CHECK(folder.files().size() == 3);
  for (const fs::path& file : files) {
    CHECK(fs::file_size(file) < 100'000);
    const Recording recording = Recording::open(file);
    CHECK(lost(recording.status(1, 0)));
    CHECK(recording.step(1) <= 100);
    CHECK(replay(recording).different == 0);
  }
}

TEST_CASE("nothing lost, nothing dumped", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 4));
  LostWorldDumps dumps(batch, folder.path());
  batch.step(30);
  CHECK(dumps.close().empty());
  CHECK(folder.files().empty());
  CHECK_THROWS_WITH(LostWorldDumps(batch, folder.path(), {.checkpoint_steps = 0}),
                    Catch::Contains("checkpoint_steps is 0"));
  CHECK_THROWS_AS(LostWorldDumps(batch, "/proc/nowhere"), RecordError);
  batch.add_force(0, batch.body_in_row(0), Vec3(1, 0, 0));
  CHECK_THROWS_WITH(LostWorldDumps(batch, folder.path()), Catch::Contains("forces are pending"));
}

}  // namespace manyworlds::test
