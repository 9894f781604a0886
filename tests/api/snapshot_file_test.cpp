// Snapshots in files: whole ones come back, of other versions and kinds of file what is said.
#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "src/base/hash.hpp"
#include "src/base/machine_memory.hpp"
#include "src/state/snapshot_format.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::filesystem::path temporary(const char* name) {
  return std::filesystem::temp_directory_path() / (std::string("manyworlds_") + name);
}

}  // namespace

TEST_CASE("a snapshot goes through a file unchanged", "[fast][snapshot]") {
  const Plan plan = compile(crowd(Space::spatial));
  Batch batch(plan, options_of(widest_tables().front(), 9));
  batch.step(20);
  const Snapshot saved = batch.save();
  const auto file = temporary("snapshot_test.mws");
  saved.save(file);
  saved.save(file);  // over an old one
  const Snapshot loaded = Snapshot::load(file);
  CHECK(loaded.bytes() == saved.bytes());
  CHECK(loaded.time() == saved.time());
  int files = 0;  // nothing is left beside it
  for (const auto& entry : std::filesystem::directory_iterator(file.parent_path())) {
    if (entry.path().string().find("manyworlds_snapshot_test") != std::string::npos) ++files;
  }
  CHECK(files == 1);
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(Snapshot::load(file),
                    Catch::Contains("cannot be read") && Catch::Contains("No such file"));
  CHECK_THROWS_WITH(saved.save("/nowhere/at/all.mws"), Catch::Contains("cannot write"));
  CHECK_THROWS_AS(Snapshot().save(file), SnapshotError);
}

// Version 2 had entries of 24 bytes, without a seed.
TEST_CASE("a snapshot of version 0.1 is read, and leaves the seeds alone",
          "[fast][snapshot][seeds]") {
  const Plan plan = compile(crowd(Space::planar));
  const BatchOptions options = options_of(widest_tables().front(), 3);
  Batch batch(plan, options);
  batch.step(5);
  const Snapshot saved = batch.save();
  constexpr std::size_t kOld = 24, kSum = sizeof(std::uint64_t);
  std::vector<std::byte> old(saved.bytes().begin(), saved.bytes().begin() + sizeof(SnapshotHeader));
  SnapshotHeader header = SnapshotAccess::header(saved);
  for (std::size_t i = 0; i < 3; ++i) {
    SnapshotEntry entry = SnapshotAccess::entry(saved, i);
    entry.offset -= 3 * (sizeof entry - kOld);
    const auto* first = reinterpret_cast<const std::byte*>(&entry);
    old.insert(old.end(), first, first + kOld);
  }
  const auto worlds = saved.bytes().begin() + sizeof(SnapshotHeader) + 3 * sizeof(SnapshotEntry);
  old.insert(old.end(), worlds, saved.bytes().end());
  header.version = 2;
  header.size = old.size();
  const auto seal = [&old](const SnapshotHeader& with) {
    std::memcpy(old.data(), &with, sizeof with);
    Hasher hasher;
    std::size_t at = 0;
    const std::size_t end = old.size() - kSum;
    for (; at + kSum <= end; at += kSum) {
      std::uint64_t word = 0;
      std::memcpy(&word, old.data() + at, kSum);
      hasher.add(word);
    }
    for (; at < end; ++at) hasher.add(static_cast<std::uint64_t>(old[at]));
    const std::uint64_t sum = hasher.value();
    std::memcpy(old.data() + end, &sum, kSum);
  };
  seal(header);

  BatchOptions elsewhere = options;
  elsewhere.seed = options.seed + 5;
  Batch other(plan, elsewhere), twin(plan, elsewhere);
  other.restore(Snapshot::from_bytes(old));
  CHECK(hashes(other) == hashes(batch));
  CHECK(other.steps() == 5);
  other.reset();
  CHECK(hashes(other) == hashes(twin));

  for (const std::uint32_t version : {1u, 4u}) {
    header.version = version;
    seal(header);
    CHECK_THROWS_WITH(
        Snapshot::from_bytes(old),
        Catch::Contains("has format version " + std::to_string(version) + ", must be 2 to 3"));
  }
}

TEST_CASE("a file is judged by its kind and header before its size is believed",
          "[fast][snapshot]") {
  const auto folder = temporary("snapshot_kinds");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  const auto refused = [](const std::filesystem::path& file, const std::string& why) {
    CHECK_THROWS_WITH(Snapshot::load(file), Catch::Contains(file.string()) && Catch::Contains(why));
  };
  refused(folder, "is a folder, must be a file");
  const auto fifo = folder / "fifo";
  REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
  refused(fifo, "is a FIFO, must be a file");
  refused("/dev/zero", "is a device, must be a file");
  std::filesystem::create_symlink(fifo, folder / "link");
  refused(folder / "link", "is a FIFO, must be a file");

  constexpr std::uint64_t kHuge = std::uint64_t{1} << 40;
  const auto sparse = folder / "sparse";
  std::ofstream(sparse).put('M');
  std::filesystem::resize_file(sparse, kHuge);
  refused(sparse, "is not a manyworlds snapshot");
  Batch batch(compile(crowd(Space::planar)), options_of(widest_tables().front(), 2));
  batch.save().save(sparse);
  std::filesystem::resize_file(sparse, kHuge);
  refused(sparse, "is 1099511627776 bytes long, its header says");
  SnapshotHeader header = SnapshotAccess::header(batch.save());
  header.size = kHuge;
  std::fstream(sparse, std::ios::in | std::ios::out | std::ios::binary)
      .write(reinterpret_cast<const char*>(&header), sizeof header);
  if (machine_memory() < static_cast<double>(kHuge))
    refused(sparse, "is 1099.5 GB, the machine has");
  std::filesystem::resize_file(sparse, 20);
  refused(sparse, "is 20 bytes long, must have at least 56");
  std::filesystem::remove_all(folder);
}

}  // namespace manyworlds::test
