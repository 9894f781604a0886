// The one way in which files are written: whole or not at all, and never over what is no file.
//
// Everything goes into a part file beside the target, "run.h5.part-8c1f03ab5e6d7790". commit()
// syncs it, gives it the target's name and syncs the folder, so that the name stands for the old
// file or for the whole new one at any time, also when the power fails. A target that is a symbolic
// link is followed, and what it points to is replaced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace manyworlds {

// A file that cannot be written; what() is "'run.h5': no space left on device".
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& file, const std::string& reason)
      : std::runtime_error("'" + file.string() + "': " + reason), reason_(reason) {}
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

// Why a call on a file failed, in plain words.
std::string reason_of(int error_number);

// "is a FIFO, not a file" of what is there and no regular file; otherwise empty.
std::string why_no_file(const std::filesystem::path& path);

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  int get() const { return number_; }
  int release();
  bool close();  // false and errno where that fails; it is closed in any case

 private:
  int number_;
};

class OutputFile {
 public:
  // Makes the part file. Throws FileError where the target exists and is no regular file or may not
  // be written, or where its folder takes no file.
  explicit OutputFile(const std::filesystem::path& file);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  // what was neither committed nor kept is removed

  // All throw FileError. Reading beyond the end gives zeros.
  void write(std::span<const std::byte> bytes, std::uint64_t at);
  void read(std::span<std::byte> bytes, std::uint64_t at) const;
  void truncate(std::uint64_t size);
  void sync();
  void commit();  // the part file becomes the target, with the mode and owner of an old one

  // Leaves the part file where it is.
  void keep() noexcept { keep_ = true; }
  const std::filesystem::path& target() const { return file_; }  // as it was given
  const std::filesystem::path& part() const { return part_; }

 private:
  [[noreturn]] void fail(int error_number) const;

  std::filesystem::path file_, part_;
  std::string name_, part_name_;  // in the folder
  Descriptor folder_, part_file_;
  bool keep_ = false, committed_ = false;
};

// A whole file at once. Throws FileError.
void write_file(const std::filesystem::path& file, std::string_view text);
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

// Part files of `file` without a writer, because their program was cut off; in order
// of their names, and in the folder as the path has it.
std::vector<std::filesystem::path> leftover_parts(const std::filesystem::path& file);
// Of all files in a folder.
std::vector<std::filesystem::path> leftover_parts_in(const std::filesystem::path& folder);

}  // namespace manyworlds
