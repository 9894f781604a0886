#include "manyworlds/snapshot.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>
#include <system_error>
#include <utility>

#include "src/base/float_mode.hpp"
#include "src/base/hash.hpp"
#include "src/base/machine_memory.hpp"
#include "src/base/output_file.hpp"
#include "src/state/snapshot_format.hpp"

namespace manyworlds {

static_assert(std::endian::native == std::endian::little, "snapshots are little endian");

namespace {

constexpr char kMagic[8] = {'M', 'W', 'S', 'N', 'A', 'P', '\r', '\n'};
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

std::size_t entry_size(const SnapshotHeader& header) {
  return has_seeds(header) ? sizeof(SnapshotEntry) : offsetof(SnapshotEntry, seed);
}
std::size_t entry_at(const SnapshotHeader& header, std::size_t index) {
  return sizeof(SnapshotHeader) + index * entry_size(header);
}
SnapshotEntry read_entry(const std::vector<std::byte>& bytes, const SnapshotHeader& header,
                         std::size_t index) {
  SnapshotEntry entry{};
  std::memcpy(&entry, bytes.data() + entry_at(header, index), entry_size(header));
  return entry;
}

// What tells a snapshot from other files before anything of its size is allocated or read.
void check_header(const SnapshotHeader& header, std::uint64_t size) {
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
    refuse("is not a manyworlds snapshot");
  }
  if (header.version < kOldestSnapshotVersion || header.version > kSnapshotVersion) {
    refuse("has format version " + std::to_string(header.version) + ", must be " +
           std::to_string(kOldestSnapshotVersion) + " to " + std::to_string(kSnapshotVersion));
  }
  if (header.size != size) {
    refuse("is " + std::to_string(size) + " bytes long, its header says " +
           std::to_string(header.size));
  }
  if (header.real_bytes != 4 && header.real_bytes != 8) {
    refuse("has values of " + std::to_string(header.real_bytes) + " bytes, must be 4 or 8");
  }
}

void check_size(std::uint64_t size) {
  if (size < sizeof(SnapshotHeader) + kChecksum) {
    refuse("is " + std::to_string(size) + " bytes long, must have at least " +
           std::to_string(sizeof(SnapshotHeader) + kChecksum));
  }
}

// Everything that reading a world relies on.
void check(const std::vector<std::byte>& bytes) {
  const FloatMode mode;
  const std::size_t size = bytes.size();
  check_size(size);
  const auto header = read_at<SnapshotHeader>(bytes, 0);
  check_header(header, size);
  const std::uint64_t expected = checksum(bytes);
  if (read_at<std::uint64_t>(bytes, size - kChecksum) != expected) {
    refuse("is corrupted: its checksum does not match");
  }
  if (!std::isfinite(header.clock)) {
    refuse("has a clock that is not finite");
  }
  // Beyond it, time is no longer told apart step by step.
  constexpr std::int64_t kMaxSteps = std::int64_t{1} << 53;
  if (header.steps < 0 || header.steps > kMaxSteps) {
    refuse("has taken " + std::to_string(header.steps) + " steps, must be 0 to " +
           std::to_string(kMaxSteps));
  }
  const std::size_t room = size - sizeof(SnapshotHeader) - kChecksum;
  if (header.worlds == 0 || header.worlds > room / entry_size(header) ||
      header.worlds > static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
    refuse("is too short for the " + std::to_string(header.worlds) + " worlds in its header");
  }
  const std::size_t first = entry_at(header, header.worlds), end = size - kChecksum;
  for (std::size_t i = 0; i < header.worlds; ++i) {
    const SnapshotEntry entry = read_entry(bytes, header, i);
    if (entry.offset < first || entry.offset > end || entry.size > end - entry.offset) {
      refuse("world " + std::to_string(i) + " is stored outside of it");
    }
  }
}

std::string last_error() { return std::generic_category().message(errno); }

void read_from(const Descriptor& file, std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t n = ::read(file.get(), to.data(), to.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse("cannot be read: " + last_error());
    if (n == 0) refuse("was shortened while it was read");
    to = to.subspan(static_cast<std::size_t>(n));
  }
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a FIFO";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

// The header is looked at before there is memory for what it says.
std::vector<std::byte> read_file(const std::filesystem::path& file) {
  // Without waiting: opening a FIFO does not depend on who writes to it.
  const Descriptor in(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (in.get() < 0 || fstat(in.get(), &status) != 0) refuse("cannot be read: " + last_error());
  if (!S_ISREG(status.st_mode)) {
    refuse(std::string("is ") + kind_of(status.st_mode) + ", must be a file");
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  check_size(size);
  SnapshotHeader header;
  read_from(in, std::as_writable_bytes(std::span(&header, 1)));
  check_header(header, size);
  if (static_cast<double>(size) > machine_memory()) {
    refuse("is " + gigabytes(static_cast<double>(size)) + ", the machine has " +
           gigabytes(machine_memory()) + " of memory");
  }
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), &header, sizeof header);
  read_from(in, std::span(bytes).subspan(sizeof header));
  return bytes;
}

}  // namespace

Snapshot SnapshotAccess::prepare(const SnapshotHeader& counts, std::vector<SnapshotEntry> entries) {
  SnapshotHeader header = counts;
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.version = kSnapshotVersion;
  header.worlds = entries.size();
  std::size_t at = entry_at(header, entries.size());
  for (SnapshotEntry& entry : entries) {
    entry.offset = at;
    at += entry.size;
  }
  header.size = at + kChecksum;
  Snapshot snapshot;
  snapshot.bytes_.resize(header.size);
  write_at(snapshot.bytes_, 0, header);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    write_at(snapshot.bytes_, entry_at(header, i), entries[i]);
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
  return read_entry(snapshot.bytes_, header(snapshot), index);
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
  try {
    write_file(file, std::span(bytes_));
  } catch (const FileError& error) {
    refuse("cannot write " + std::string(error.what()));
  }
}

Snapshot Snapshot::load(const std::filesystem::path& file) {
  try {
    return from_bytes(read_file(file));
  } catch (const SnapshotError& error) {
    throw SnapshotError("'" + file.string() + "': " + error.what());
  }
}

}  // namespace manyworlds
