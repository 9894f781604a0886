#include "src/record/frame.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/base/printable.hpp"
#include "src/record/checksum.hpp"

namespace manyworlds::record {

namespace {

struct Frame {
  std::array<char, 8> magic = {'M', 'W', 'R', 'E', 'C', 'O', '\r', '\n'};
  std::uint32_t version = kFormatVersion;
  std::uint32_t zero = 0;
  std::uint64_t size = 0;
  std::uint64_t checksum = 0;
  std::array<std::byte, 480> rest{};
};
static_assert(sizeof(Frame) == kFrameSize);

// Of a frame, with 0 for its checksum.
void add(Checksum& sum, Frame frame) {
  frame.checksum = 0;
  sum.add(std::as_bytes(std::span(&frame, 1)));
}

std::string hex(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

[[noreturn]] void refuse_magic(const std::array<char, 8>& found) {
  std::string what = "is not a manyworlds recording: ";
  if (found == std::array<char, 8>{}) {
    what += "it begins with zeros, like a recording that was cut off before its first flush";
  } else if (std::memcmp(found.data(), "\x89HDF\r\n\x1a\n", found.size()) == 0) {
    what += "it is an HDF5 file of another program, or one that was copied by h5repack";
  } else {
    const auto end =
        static_cast<std::size_t>(std::find(found.begin(), found.end(), '\0') - found.begin());
    what += "it begins with '" + printable({found.data(), end}) + "', must begin with 'MWRECO'";
  }
  throw RecordError(what);
}

void check_head(const Frame& frame, std::uint64_t size) {
  if (frame.magic != Frame().magic) refuse_magic(frame.magic);
  if (frame.version != kFormatVersion) {
    throw RecordError("has format version " + std::to_string(frame.version) + ", must be " +
                      std::to_string(kFormatVersion));
  }
  if (frame.size != size) {
    throw RecordError("is " + std::to_string(size) + " bytes long, must be " +
                      std::to_string(frame.size));
  }
}

void require_length(std::uint64_t size) {
  if (size >= sizeof(Frame)) return;
  throw RecordError("is " + std::to_string(size) +
                    " bytes long, too short for a recording, must be at least " +
                    std::to_string(sizeof(Frame)));
}

void check_sum(const Frame& frame, std::uint64_t found) {
  if (frame.checksum != found) {
    throw RecordError("is corrupted: its checksum does not match, it is " + hex(found) +
                      " but the file states " + hex(frame.checksum));
  }
}

[[noreturn]] void fail_to(const char* what) {
  throw RecordError(std::string("cannot be ") + what + ": " + reason_of(errno));
}

Frame read_frame(std::ifstream& in) {
  Frame frame;
  in.seekg(0);
  if (!in.read(reinterpret_cast<char*>(&frame), sizeof frame)) fail_to("read");
  return frame;
}

// Of everything, the frame as given.
std::uint64_t checksum(std::ifstream& in, const Frame& frame) {
  Checksum sum;
  add(sum, frame);
  std::vector<std::byte> block(1 << 20);
  in.seekg(sizeof(Frame));
  while (in) {
    in.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    sum.add(std::span(block).first(static_cast<std::size_t>(in.gcount())));
  }
  if (!in.eof()) fail_to("read");
  in.clear();
  return sum.value();
}

std::uint64_t checksum(std::span<const std::byte> bytes, const Frame& frame) {
  Checksum sum;
  add(sum, frame);
  sum.add(bytes.subspan(sizeof(Frame)));
  return sum.value();
}

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw RecordError("cannot be read: " + error.message());
  return size;
}

}  // namespace

void seal(OutputFile& file, std::uint64_t size) {
  Frame frame;
  frame.size = size;
  Checksum sum;
  add(sum, frame);
  std::vector<std::byte> block(1 << 20);
  for (std::uint64_t at = sizeof frame; at < size; at += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size - at)));
    file.read(block, at);
    sum.add(block);
  }
  frame.checksum = sum.value();
  file.write(std::as_bytes(std::span(&frame, 1)), 0);
}

void seal(std::span<std::byte> bytes) {
  require_length(bytes.size());
  Frame frame;
  frame.size = bytes.size();
  frame.checksum = checksum(bytes, frame);
  std::memcpy(bytes.data(), &frame, sizeof frame);
}

void check_frame(const std::filesystem::path& file) {
  const std::uint64_t size = size_of(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail_to("opened");
  require_length(size);
  const Frame frame = read_frame(stream);
  check_head(frame, size);
  check_sum(frame, checksum(stream, frame));
}

void check_frame(std::span<const std::byte> bytes) {
  require_length(bytes.size());
  Frame frame;
  std::memcpy(&frame, bytes.data(), sizeof frame);
  check_head(frame, bytes.size());
  check_sum(frame, checksum(bytes, frame));
}

}  // namespace manyworlds::record
