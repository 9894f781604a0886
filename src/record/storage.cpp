#include "src/record/storage.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/record/checksum.hpp"
#include "src/record/frame.hpp"

namespace manyworlds::record {

namespace {

constexpr const char* kPartMagic = "MWPART\r\n";

// What stands where a finished recording has its frame, little endian.
struct Head {
  std::array<char, 8> magic = {'M', 'W', 'P', 'A', 'R', 'T', '\r', '\n'};
  std::uint32_t version = 1;
  std::uint32_t zero = 0;
  std::uint64_t end = 0;  // of the file, without the journal
  std::uint64_t journal = 0, journal_size = 0, journal_checksum = 0;
  std::uint64_t checksum = 0;  // of the head, with 0 here
  std::array<std::byte, 456> rest{};
};
static_assert(sizeof(Head) == kFrameSize);

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.value();
}
std::uint64_t checksum_of(Head head) {
  head.checksum = 0;
  return checksum_of(std::as_bytes(std::span(&head, 1)));
}

// Pieces one after the other: place (8), size (8), bytes.
std::vector<std::byte> journal_of(const Overlay::Pieces& pieces) {
  std::vector<std::byte> out;
  const auto add = [&](std::span<const std::byte> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
  };
  for (const auto& [at, bytes] : pieces) {
    const std::array<std::uint64_t, 2> place = {at, bytes.size()};
    add(std::as_bytes(std::span(place)));
    add(bytes);
  }
  return out;
}
Overlay overlay_of(std::span<const std::byte> journal) {
  Overlay out;
  std::array<std::uint64_t, 2> place{};
  while (journal.size() >= sizeof place) {
    std::memcpy(place.data(), journal.data(), sizeof place);
    journal = journal.subspan(sizeof place);
    if (place[1] > journal.size()) throw RecordError("is damaged: its journal is cut");
    out.put(place[0], journal.first(place[1]));
    journal = journal.subspan(place[1]);
  }
  return out;
}

// Fewer where the file ends, or, with an errno that is not 0, where it cannot be read.
std::size_t read_some(int file, std::uint64_t at, std::span<std::byte> bytes) noexcept {
  std::size_t got = 0;
  errno = 0;
  while (got < bytes.size()) {
    const ssize_t n =
        pread(file, bytes.data() + got, bytes.size() - got, static_cast<off_t>(at + got));
    if (n < 0 && errno == EINTR) {
      errno = 0;
      continue;
    }
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  return got;
}

Descriptor opened(const std::filesystem::path& file) {
  return Descriptor(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
}

}  // namespace

void RecordingFile::write(std::uint64_t at, std::span<const std::byte> bytes, bool data) noexcept {
  try {
    if (data) {
      held_.overwrite(at, bytes);
      if (!failure_) file_.write(bytes, at);
    } else {
      held_.put(at, bytes);
    }
    return;
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
  // HDF5 may ask for it again. A file that will not be read can have it at once; of another the
  // last checkpoint must stay.
  if (data || has_checkpoint()) return;
  try {
    file_.write(bytes, at);
    held_.overwrite(at, bytes);
  } catch (...) {
  }
}

bool RecordingFile::read(std::uint64_t at, std::span<std::byte> bytes) noexcept {
  try {
    file_.read(bytes, at);
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
    return false;
  }
  held_.cover(at, bytes);
  return true;
}

template <class Do>
void RecordingFile::guarded(Do&& what) {
  if (failure_) std::rethrow_exception(failure_);
  try {
    what();
  } catch (...) {
    failure_ = std::current_exception();
    throw;
  }
}

void RecordingFile::put_in_place() {
  for (const auto& [at, bytes] : held_.pieces()) file_.write(bytes, at);
}

void RecordingFile::checkpoint() {
  guarded([&] {
    const std::vector<std::byte> journal = journal_of(held_.pieces());
    Head head;
    head.end = end_;
    head.journal = (end_ + 7) / 8 * 8;
    head.journal_size = journal.size();
    head.journal_checksum = checksum_of(journal);
    head.checksum = checksum_of(head);
    file_.write(journal, head.journal);
    file_.sync();
    file_.write(std::as_bytes(std::span(&head, 1)), 0);
    file_.sync();
    ++checkpoints_;
    put_in_place();
    file_.sync();
    file_.truncate(end_);
    held_.clear();
  });
}

void RecordingFile::finish() {
  // Without an older head the file is not read before it is finished.
  if (checkpoints_ > 0 && !held_.pieces().empty()) checkpoint();
  guarded([&] {
    put_in_place();
    file_.truncate(end_);
    seal(file_, end_);
    sealed_ = true;
    file_.commit();
  });
}

namespace {

bool begins_with(const std::filesystem::path& file, std::initializer_list<const char*> magics) {
  const Descriptor in = opened(file);
  std::array<char, 8> found{};
  if (in.get() < 0 || read_some(in.get(), 0, std::as_writable_bytes(std::span(found))) < 8) {
    return false;
  }
  return std::any_of(magics.begin(), magics.end(), [&](const char* magic) {
    return std::memcmp(found.data(), magic, found.size()) == 0;
  });
}

}  // namespace

bool is_part(const std::filesystem::path& file) { return begins_with(file, {kPartMagic}); }
bool is_part_or_finished(const std::filesystem::path& file) {
  return begins_with(file, {kPartMagic, kFrameMagic});
}

ReadStorage::ReadStorage(const std::filesystem::path& file) : file_(opened(file)) {
  struct stat now {};
  if (file_.get() < 0 || fstat(file_.get(), &now) != 0) {
    throw RecordError("cannot be read: " + reason_of(errno));
  }
  end_ = static_cast<std::uint64_t>(now.st_size);
}

std::size_t ReadStorage::fill(std::uint64_t at, std::span<std::byte> bytes) noexcept {
  const std::size_t got = read_some(file_.get(), at, bytes);
  if (got < bytes.size() && errno != 0 && error_ == 0) error_ = errno;
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(got), bytes.end(), std::byte{0});
  return got;
}

bool FinishedFile::read(std::uint64_t at, std::span<std::byte> bytes) noexcept {
  // It was whole when its checksum was looked at.
  if (fill(at, bytes) < bytes.size() && error_ == 0) error_ = EIO;
  return true;
}

PartImage::PartImage(const std::filesystem::path& file) : ReadStorage(file) {
  Head head;
  const std::size_t got = fill(0, std::as_writable_bytes(std::span(&head, 1)));
  if (error_ != 0) throw RecordError("cannot be read: " + reason_of(error_));
  if (got != sizeof head) {
    throw RecordError("is " + std::to_string(got) + " bytes long, must be at least " +
                      std::to_string(sizeof head));
  }
  if (head.version != Head().version) {
    throw RecordError("has format version " + std::to_string(head.version) +
                      " of part files, must be " + std::to_string(Head().version));
  }
  if (head.magic != Head().magic || head.checksum != checksum_of(head)) {
    throw RecordError("is corrupted: the checksum of its first " + std::to_string(sizeof head) +
                      " bytes does not match");
  }
  const std::uint64_t size = end_;
  end_ = head.end;
  if (end_ > size) {
    throw RecordError("is " + std::to_string(size) + " bytes long, must be at least " +
                      std::to_string(end_));
  }
  // One that is not whole was put in place already, and written over since.
  if (head.journal > size || head.journal_size > size - head.journal) return;
  std::vector<std::byte> journal(head.journal_size);
  const bool whole = fill(head.journal, journal) == journal.size();
  if (error_ != 0) throw RecordError("cannot be read: " + reason_of(error_));
  if (whole && checksum_of(journal) == head.journal_checksum) journal_ = overlay_of(journal);
}

bool PartImage::read(std::uint64_t at, std::span<std::byte> bytes) noexcept {
  if (at > end_ || bytes.size() > end_ - at) return false;
  fill(at, bytes);
  journal_.cover(at, bytes);
  return true;
}

}  // namespace manyworlds::record
