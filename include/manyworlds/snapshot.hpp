// Snapshot: the complete state of some worlds of a Batch, from which they continue later, in
// another process or several times.
//
// It contains everything that the next step depends on: state, stored impulses, sleep, disabled
// bodies and status; and what the next reset draws from: each world's seed and episode. It does not
// depend on lanes, threads, instruction sets or the position in the batch, so a restored world
// continues with the same bits. Forces added for the next step are not included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// A snapshot that cannot be read or does not fit; what() names the place, what was found and what
// was expected. Nothing has changed.
class SnapshotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Snapshot {
 public:
  int worlds() const;
  std::int64_t steps() const;                         // steps taken by the batch
  double time() const;                                // s, time simulated by the batch
  std::size_t size() const { return bytes_.size(); }  // bytes

  // Writes a file next to `file` and renames it, so that a partial file is never read.
  // Throws SnapshotError.
  void save(const std::filesystem::path& file) const;
  // Throws SnapshotError when the file cannot be read, is cut, corrupted or something else: a
  // folder, a FIFO, a device, larger than the machine's memory. Reads files of version 0.1, too,
  // which lack the worlds' seeds.
  static Snapshot load(const std::filesystem::path& file);

  // The bytes of a file: magic, version, header, worlds, checksum; little endian.
  const std::vector<std::byte>& bytes() const { return bytes_; }
  static Snapshot from_bytes(std::vector<std::byte> bytes);  // throws SnapshotError

 private:
  friend struct SnapshotAccess;  // src/state/snapshot_format.hpp
  std::vector<std::byte> bytes_;
};

}  // namespace manyworlds
