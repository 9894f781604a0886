// What lies under an HDF5 file of ours instead of the file system: the bytes that HDF5 reads and
// writes through its driver (h5_driver.cpp). HDF5 does not survive a write that fails: a file that
// it could not close is closed once more at the program's exit, and that crashes. So nothing here
// fails towards HDF5; the first error is kept for the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>

#include "src/base/output_file.hpp"
#include "src/record/overlay.hpp"

namespace manyworlds::record {

class Storage {
 public:
  virtual ~Storage() = default;
  virtual void write(std::uint64_t at, std::span<const std::byte> bytes, bool data) noexcept = 0;
  virtual bool read(std::uint64_t at, std::span<std::byte> bytes) noexcept = 0;
  // Where the file ends; what HDF5 has not yet written before that is 0.
  virtual std::uint64_t end() const noexcept = 0;
  virtual void set_end(std::uint64_t end) noexcept = 0;
  // Of what was read: the number of the system's first error, 0 if there was none.
  virtual int read_error() const noexcept { return 0; }
};

// The part file of a recording that is being written. What programs read of it, should this one be
// cut off, is what it was at the last checkpoint:
//
// Data of the tables go to the file at once, to places that nothing refers to yet. What refers to
// them, HDF5's own headers and indices, stays in memory until a checkpoint. It is then written as a
// journal behind the end of the file, and synced; then the head says where the journal is, and is
// synced; then the journal's pieces are written to their places, and synced, and the journal is cut
// off. Whenever this is interrupted, either the head's journal is whole, and its pieces count
// wherever the file has others, or the head is the older one, or all pieces are in place.
class RecordingFile final : public Storage {
 public:
  explicit RecordingFile(const std::filesystem::path& file) : file_(file) {}  // throws FileError

  void write(std::uint64_t at, std::span<const std::byte> bytes, bool data) noexcept override;
  bool read(std::uint64_t at, std::span<std::byte> bytes) noexcept override;
  std::uint64_t end() const noexcept override { return end_; }
  void set_end(std::uint64_t end) noexcept override { end_ = end; }

  // Throw what has failed first, now or before. HDF5 must have written all that it holds
  // (H5Fflush), and for finish() have closed the file.
  void checkpoint();
  void finish();  // checksum, and the file gets its name
  // Whether the part file can be read, and whether it is all that finish() makes but for its name.
  bool has_checkpoint() const { return checkpoints_ > 0 || sealed_; }
  bool sealed() const { return sealed_; }
  std::exception_ptr failure() const { return failure_; }
  // Of the part file, that it stays.
  void keep() noexcept { file_.keep(); }
  const OutputFile& file() const { return file_; }

 private:
  template <class Do>
  void guarded(Do&& what);
  void put_in_place();

  OutputFile file_;
  Overlay held_;
  std::uint64_t end_ = 0;
  int checkpoints_ = 0;
  bool sealed_ = false;
  std::exception_ptr failure_;
};

// What can only be read. What cannot be read is 0 for HDF5, and an error for the caller.
class ReadStorage : public Storage {
 public:
  void write(std::uint64_t, std::span<const std::byte>, bool) noexcept override {}
  std::uint64_t end() const noexcept override { return end_; }
  void set_end(std::uint64_t) noexcept override {}
  int read_error() const noexcept override { return error_; }

 protected:
  explicit ReadStorage(const std::filesystem::path& file);  // throws RecordError
  // How many there are before the file ends; the others are 0.
  std::size_t fill(std::uint64_t at, std::span<std::byte> bytes) noexcept;

  Descriptor file_;
  std::uint64_t end_ = 0;  // at first, of the file
  int error_ = 0;
};

// A finished file. HDF5's own driver would not do: where closing a file fails it keeps it, and
// crashes at the program's exit.
class FinishedFile final : public ReadStorage {
 public:
  explicit FinishedFile(const std::filesystem::path& file) : ReadStorage(file) {}
  bool read(std::uint64_t at, std::span<std::byte> bytes) noexcept override;
};

// A part file that was left over, as it was at its last checkpoint.
class PartImage final : public ReadStorage {
 public:
  explicit PartImage(const std::filesystem::path& file);  // throws RecordError
  bool read(std::uint64_t at, std::span<std::byte> bytes) noexcept override;

 private:
  Overlay journal_;
};

// Whether a file begins like a part file that has had a checkpoint.
bool is_part(const std::filesystem::path& file);
// Or like a finished recording, which a part file is until it gets its name.
bool is_part_or_finished(const std::filesystem::path& file);

}  // namespace manyworlds::record
