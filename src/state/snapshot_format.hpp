// The bytes of a Snapshot:
//   Header | WorldEntry [worlds] | the worlds' bytes (Storage::write_world) | checksum
// all little endian, without padding. The checksum is Hasher's over the words before it. Version 2
// had no seeds in its entries; it is read as what it was, and leaves the seeds of a batch as they
// are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "manyworlds/snapshot.hpp"

namespace manyworlds {

struct SnapshotHeader {
  char magic[8];
  std::uint32_t version;
  std::uint32_t real_bytes;  // 4 or 8
  std::uint64_t size;        // of everything, bytes
  std::uint64_t worlds;
  std::int64_t steps;
  double clock;  // s
};
struct SnapshotEntry {
  std::uint64_t fingerprint;  // of the plan
  std::uint64_t offset;       // of the world, from the start
  std::uint32_t size;         // of the world, bytes
  std::uint32_t episode;
  std::uint64_t seed;  // of the world's draws; not in version 2
};
static_assert(sizeof(SnapshotHeader) == 48 && sizeof(SnapshotEntry) == 32);
inline constexpr std::uint32_t kSnapshotVersion = 3, kOldestSnapshotVersion = 2;
inline bool has_seeds(const SnapshotHeader& header) { return header.version >= 3; }

struct SnapshotAccess {
  // Room for worlds of these sizes, with header and entries filled in; fill the worlds, then seal.
  static Snapshot prepare(const SnapshotHeader& counts, std::vector<SnapshotEntry> entries);
  static void seal(Snapshot& snapshot);
  static std::byte* world(Snapshot& snapshot, std::size_t index);

  static SnapshotHeader header(const Snapshot& snapshot);
  static SnapshotEntry entry(const Snapshot& snapshot, std::size_t index);
  static const std::byte* world(const Snapshot& snapshot, std::size_t index);
};

}  // namespace manyworlds
