#include "manyworlds/snapshot.hpp"

#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "src/base/hash.hpp"
#include "src/state/snapshot_format.hpp"

namespace manyworlds {

static_assert(std::endian::native == std::endian::little, "snapshots are little endian");

namespace {

constexpr char kMagic[8] = {'M', 'W', 'S', 'N', 'A', 'P', '\r', '\n'};
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kChecksum = sizeof(std::uint64_t);

[[noreturn]] void refuse(const std::string& what) { throw SnapshotError("snapshot: " + what); }

template <class T>
T read_at(const std::vector<std::byte>& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <class T>
void write_at(std::vector<std::byte>& bytes, std::size_t at, const T& value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::uint64_t checksum(const std::vector<std::byte>& bytes) {
  Hasher hasher;
  const std::size_t end = bytes.size() - kChecksum;
  std::size_t at = 0;
  for (; at + sizeof(std::uint64_t) <= end; at += sizeof(std::uint64_t)) {
    hasher.add(read_at<std::uint64_t>(bytes, at));
  }
  for (; at < end; ++at) hasher.add(static_cast<std::uint64_t>(bytes[at]));
  return hasher.value();
}

std::size_t entry_at(std::size_t index) {
  return sizeof(SnapshotHeader) + index * sizeof(SnapshotEntry);
}

// Everything that reading a world relies on.
void check(const std::vector<std::byte>& bytes) {
  const std::size_t size = bytes.size();
  if (size < sizeof(SnapshotHeader) + kChecksum) {
    refuse("is " + std::to_string(size) + " bytes long, must have at least " +
           std::to_string(sizeof(SnapshotHeader) + kChecksum));
  }
  const auto header = read_at<SnapshotHeader>(bytes, 0);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
    refuse("does not begin like a snapshot of manyworlds");
  }
  if (header.version != kVersion) {
    refuse("has format version " + std::to_string(header.version) + ", must be " +
           std::to_string(kVersion));
  }
  if (header.size != size) {
    refuse("is " + std::to_string(size) + " bytes long, its header says " +
           std::to_string(header.size));
  }
  const std::uint64_t expected = checksum(bytes);
  if (read_at<std::uint64_t>(bytes, size - kChecksum) != expected) {
    refuse("is corrupted: its checksum does not match");
  }
  if (header.real_bytes != 4 && header.real_bytes != 8) {
    refuse("has numbers of " + std::to_string(header.real_bytes) + " bytes, must be 4 or 8");
  }
  if (!std::isfinite(header.clock)) {
    refuse("has a clock that is not finite");
  }
  // Beyond it, time is no longer told apart step by step.
  constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;
  if (header.steps < 0 || header.steps > kMostSteps) {
    refuse("has taken " + std::to_string(header.steps) + " steps, must be 0 to " +
           std::to_string(kMostSteps));
  }
  const std::size_t room = size - sizeof(SnapshotHeader) - kChecksum;
  if (header.worlds == 0 || header.worlds > room / sizeof(SnapshotEntry) ||
      header.worlds > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    refuse("cannot hold the " + std::to_string(header.worlds) + " worlds that its header says");
  }
  const std::size_t first = entry_at(header.worlds), end = size - kChecksum;
  for (std::size_t i = 0; i < header.worlds; ++i) {
    const auto entry = read_at<SnapshotEntry>(bytes, entry_at(i));
    if (entry.offset < first || entry.offset > end || entry.size > end - entry.offset) {
      refuse("world " + std::to_string(i) + " lies outside of it");
    }
  }
}

std::string last_error() { return std::generic_category().message(errno); }

}  // namespace

Snapshot SnapshotAccess::prepare(const SnapshotHeader& counts, std::vector<SnapshotEntry> entries) {
  SnapshotHeader header = counts;
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kVersion;
  header.worlds = entries.size();
  std::size_t at = entry_at(entries.size());
  for (SnapshotEntry& entry : entries) {
    entry.offset = at;
    at += entry.size;
  }
  header.size = at + kChecksum;
  Snapshot snapshot;
  snapshot.bytes_.resize(header.size);
  write_at(snapshot.bytes_, 0, header);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    write_at(snapshot.bytes_, entry_at(i), entries[i]);
  }
  return snapshot;
}
void SnapshotAccess::seal(Snapshot& snapshot) {
  write_at(snapshot.bytes_, snapshot.bytes_.size() - kChecksum, checksum(snapshot.bytes_));
}
std::byte* SnapshotAccess::world(Snapshot& snapshot, std::size_t index) {
  return snapshot.bytes_.data() + entry(snapshot, index).offset;
}
const std::byte* SnapshotAccess::world(const Snapshot& snapshot, std::size_t index) {
  return snapshot.bytes_.data() + entry(snapshot, index).offset;
}
SnapshotHeader SnapshotAccess::header(const Snapshot& snapshot) {
  if (snapshot.bytes_.empty()) refuse("is empty");
  return read_at<SnapshotHeader>(snapshot.bytes_, 0);
}
SnapshotEntry SnapshotAccess::entry(const Snapshot& snapshot, std::size_t index) {
  return read_at<SnapshotEntry>(snapshot.bytes_, entry_at(index));
}

int Snapshot::worlds() const {
  return bytes_.empty() ? 0 : static_cast<int>(SnapshotAccess::header(*this).worlds);
}
std::int64_t Snapshot::steps() const {
  return bytes_.empty() ? 0 : SnapshotAccess::header(*this).steps;
}
double Snapshot::time() const { return bytes_.empty() ? 0 : SnapshotAccess::header(*this).clock; }

Snapshot Snapshot::from_bytes(std::vector<std::byte> bytes) {
  check(bytes);
  Snapshot snapshot;
  snapshot.bytes_ = std::move(bytes);
  return snapshot;
}

void Snapshot::save(const std::filesystem::path& file) const {
  if (bytes_.empty()) refuse("is empty, nothing to save");
  std::filesystem::path part = file;
  part += ".part" + std::to_string(getpid());
  const auto fail = [&](const std::string& why) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    refuse("cannot write '" + file.string() + "': " + why);
  };
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    if (!out) fail(last_error());
    out.write(reinterpret_cast<const char*>(bytes_.data()),
              static_cast<std::streamsize>(bytes_.size()));
    out.close();
    if (!out) fail(last_error());
  }
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) fail(error.message());
}

Snapshot Snapshot::load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) refuse("cannot read '" + file.string() + "': " + last_error());
  const std::streamoff size = in.tellg();
  if (size < 0) refuse("cannot read '" + file.string() + "': " + last_error());
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!in) refuse("cannot read '" + file.string() + "': " + last_error());
  try {
    return from_bytes(std::move(bytes));
  } catch (const SnapshotError& error) {
    throw SnapshotError("'" + file.string() + "': " + error.what());
  }
}

}  // namespace manyworlds
