// Any bytes as a snapshot: refused, and nothing has changed, or taken, and the batch steps on.
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>

#include "fuzz/check.hpp"
#include "fuzz/inputs.hpp"
#include "fuzz/snapshot_batches.hpp"
#include "src/state/snapshot_format.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace manyworlds::fuzz {
namespace {

struct Target {
  Batch batch = make_batch(0);
  Snapshot before;
};

Target& target(int index) {
  static std::array<std::optional<Target>, kBatches> targets;
  auto& out = targets[static_cast<std::size_t>(index)];
  if (!out) {
    out.emplace(Target{make_batch(index), {}});
    out->before = out->batch.save();
  }
  return *out;
}

void run(int index, std::vector<std::byte> bytes) {
  Target& t = target(index);
  std::optional<Snapshot> snapshot;
  try {
    snapshot = Snapshot::from_bytes(std::move(bytes));
  } catch (const SnapshotError&) {
    return;
  }
  bool all = true, one = true;
  try {
    t.batch.restore(*snapshot);
  } catch (const SnapshotError&) {
    all = false;
  }
  require(all || t.batch.save().bytes() == t.before.bytes(),
          "a snapshot was refused and something has changed");
  if (!all) {
    try {
      t.batch.restore(*snapshot, 0, 1);
    } catch (const SnapshotError&) {
      one = false;
    }
    require(one || t.batch.save().bytes() == t.before.bytes(),
            "a world was refused and something has changed");
    if (!one) return;
  }
  // What was taken is a snapshot like any other.
  const Snapshot again = Snapshot::from_bytes(t.batch.save().bytes());
  step_and_look(t.batch, 2);
  const std::uint64_t hash = t.batch.hash();
  t.batch.restore(again);
  t.batch.step(2);
  require(t.batch.hash() == hash, "a restored batch has gone on with other bits");
  t.batch.step_to(t.batch.time() + 0.05);
  t.batch.set_enabled(0, t.batch.body_in_row(0), false);
  t.batch.add_impulse(1, t.batch.body_in_row(1), Vec3(0, 5, 5));
  t.batch.copy_world(1, 2);
  step_and_look(t.batch, 4);
  t.batch.restore(t.before);
  require(t.batch.save().bytes() == t.before.bytes(), "the batch did not come back");
}

// The first byte chooses the batch, the rest is the snapshot.
std::vector<std::byte> snapshot_of(const std::uint8_t* data, std::size_t size) {
  const auto* first = reinterpret_cast<const std::byte*>(data);
  return {first, first + size};
}

}  // namespace
}  // namespace manyworlds::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (size < 2 || seed % 8 == 7) return size;  // now and then the frame is wrong, too
  auto bytes = manyworlds::fuzz::snapshot_of(data + 1, size - 1);
  if (bytes.size() >= sizeof(manyworlds::SnapshotHeader) && seed % 32 < 2) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::int64_t last = std::numeric_limits<std::int64_t>::max();
    if (seed % 32 == 0) {
      std::memcpy(bytes.data() + offsetof(manyworlds::SnapshotHeader, clock), &nan, sizeof nan);
    } else {
      std::memcpy(bytes.data() + offsetof(manyworlds::SnapshotHeader, steps), &last, sizeof last);
    }
  }
  manyworlds::fuzz::frame(bytes);
  std::memcpy(data + 1, bytes.data(), bytes.size());
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  manyworlds::fuzz::run(data[0] % manyworlds::fuzz::kBatches,
                        manyworlds::fuzz::snapshot_of(data + 1, size - 1));
  return 0;
}
