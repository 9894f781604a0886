#include "fuzz/snapshot_batches.hpp"

#include <cstring>

#include "src/base/hash.hpp"
#include "src/state/snapshot_format.hpp"
#include "tests/support/crowd.hpp"

namespace manyworlds::fuzz {

Batch make_batch(int index) {
  const Space space = index % 2 == 0 ? Space::planar : Space::spatial;
  Scene scene = test::crowd(space, 4);
  scene.bodies.back().shapes.front().geometry = Capsule{0.3, 0.2};
  scene.bodies[3].motion = Motion::kinematic;
  const bool sleep = index >= 2;
  scene.options.sleep.speed = sleep ? 10 : 0.05;
  scene.options.sleep.time = 0.05;
  scene.bodies[4].enabled = !sleep;
  BatchOptions options;
  options.worlds = kWorlds;
  options.threads = 1;
  options.sleep = sleep;
  Batch batch(compile(scene), options);
  batch.step(20);
  return batch;
}

void frame(std::vector<std::byte>& bytes) {
  constexpr std::size_t kSum = sizeof(std::uint64_t);
  if (bytes.size() < sizeof(SnapshotHeader) + kSum) return;
  static const SnapshotHeader good = [] {
    const Snapshot snapshot = make_batch(0).save();
    return SnapshotAccess::header(snapshot);
  }();
  SnapshotHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  std::memcpy(header.magic, good.magic, sizeof header.magic);
  if (header.version != kOldestSnapshotVersion) header.version = good.version;
  header.size = bytes.size();
  std::memcpy(bytes.data(), &header, sizeof header);
  const std::size_t end = bytes.size() - kSum;
  Hasher hasher;
  std::size_t at = 0;
  for (; at + sizeof(std::uint64_t) <= end; at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    hasher.add(word);
  }
  for (; at < end; ++at) hasher.add(static_cast<std::uint64_t>(bytes[at]));
  const std::uint64_t sum = hasher.value();
  std::memcpy(bytes.data() + end, &sum, kSum);
}

}  // namespace manyworlds::fuzz
