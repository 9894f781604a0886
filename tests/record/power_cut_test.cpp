// A program that is killed, or a machine whose power fails, leaves a recording up to its last
// flush.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include <csignal>
#include <random>

#include "src/base/output_file.hpp"
#include "tests/record/faults.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

// Every few steps a push and a sample, and flushed with every call.
void run(const fs::path& file, int calls, double flush_seconds, bool close) {
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 4));
  Recorder recorder(batch, file, {.worlds = {0, 2}, .every = 2, .flush_seconds = flush_seconds});
  for (int i = 0; i < calls; ++i) {
    batch.add_force(2, batch.body_in_row(0), Vec3(30, 0, 0));
    batch.step(2);
    if (i % 3 == 1) batch.add_impulse(0, batch.body_in_row(1), Vec3(0, 1, 0));
    if (i % 5 == 2) batch.reset(std::vector<std::uint8_t>{1, 0, 0, 1});
  }
  if (close) return recorder.close();
  std::raise(SIGKILL);
}

// The file that is there when the power fails after `done` of what was written: all that was synced
// by then, and some or none of the rest, as the disk liked.
std::vector<std::byte> after_power_cut(const std::vector<Written>& log, std::size_t done,
                                       std::mt19937& random) {
  std::size_t synced = 0;
  for (std::size_t i = 0; i < done; ++i) {
    if (log[i].synced) synced = i;
  }
  const unsigned sort = random() % 4;  // all of the rest, none of it, or some
  std::vector<std::byte> disk;
  for (std::size_t i = 0; i < done; ++i) {
    const Written& w = log[i];
    if (w.synced || (i > synced && sort != 0 && (sort == 1 || random() % 2 == 0))) continue;
    if (w.truncated) {
      disk.resize(w.at);
      continue;
    }
    disk.resize(std::max<std::size_t>(disk.size(), w.at + w.bytes.size()));
    std::copy(w.bytes.begin(), w.bytes.end(), disk.begin() + static_cast<std::ptrdiff_t>(w.at));
  }
  return disk;
}

}  // namespace

TEST_CASE("a recording whose program is killed replays up to the last flush", "[fast][record]") {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  const int calls = GENERATE(1, 7, 40);
  const pid_t child = fork();
  if (child == 0) {
    run(file, calls, 0, false);
    std::_Exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK_FALSE(fs::exists(file));
  const auto left = unfinished_recordings(file);
  REQUIRE(left.size() == 1);
  const Recording recording = Recording::open(left[0]);
  CHECK_FALSE(recording.finished());
  CHECK(recording.samples() == calls + 1);
  CHECK(recording.step(calls) == 2 * calls);
  CHECK(replay(recording).different == 0);
  CHECK(replay(recording).compared == 2 * (calls + 1));
}

TEST_CASE("a recording that had nothing flushed is left, but does not count", "[fast][record]") {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    run(folder / "run.h5", 3, 1e9, false);
    std::_Exit(1);
  }
  waitpid(child, nullptr, 0);
  CHECK(unfinished_recordings(folder / "run.h5").empty());
  REQUIRE(leftover_parts(folder / "run.h5").size() == 1);
  CHECK_THROWS_AS(Recording::open(leftover_parts(folder / "run.h5")[0]), RecordError);
}

TEST_CASE("a recorder's own part file is not left over while it writes", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 2));
  Recorder recorder(batch, folder / "run.h5", {.flush_seconds = 0});
  batch.step();
  CHECK(unfinished_recordings(folder / "run.h5").empty());
  recorder.close();
  CHECK(Recording::open(folder / "run.h5").finished());
  CHECK_THROWS_WITH(Recorder(batch, folder / "run.h5", {.flush_seconds = -1}),
                    Catch::Contains("flush_seconds is -1"));
}

// Whatever a disk had of what was not yet synced. Files are written a page or so at a time, so that
// a write need not get there as a whole; those that matter are one sector, or have a checksum.
TEST_CASE("wherever the power fails, what was flushed replays", "[fast][record]") {
  const Folder folder;
  std::vector<Written> log;
  log_writes(&log);
  run(folder / "run.h5", 12, 0, true);
  log_writes(nullptr);
  REQUIRE(log.size() > 100);
  std::mt19937 random(7);
  const fs::path cut = folder / "cut.h5";
  std::int64_t most = 0;
  int begun = 0;
  for (std::size_t done = 1; done < log.size(); ++done) {
    write_bytes(cut, after_power_cut(log, done, random));
    // The first sync is that of the first flush's journal, the second that of its head.
    begun += log[done - 1].synced ? 1 : 0;
    INFO(done << " of " << log.size() << " writes");
    try {
      const Recording recording = Recording::open(cut);
      CHECK(recording.samples() >= most);
      if (done % 7 == 0) CHECK(replay(recording).different == 0);
      most = std::max(most, log[done - 1].synced ? recording.samples() : 0);
    } catch (const RecordError&) {
      if (begun >= 2) throw;
    }
  }
  CHECK(most == 13);
}

TEST_CASE("a file is synced before it gets its name, and its folder after", "[fast][files]") {
  const Folder folder;
  std::vector<Written> log;
  log_writes(&log);
  write_file(folder / "file", "text");
  log_writes(nullptr);
  std::string order;
  for (const Written& w : log) {
    order += w.renamed ? "rename " : w.synced ? "sync " : w.truncated ? "truncate " : "write ";
  }
  CHECK(order == "write sync rename sync ");
}

}  // namespace manyworlds::test
