// What we need of HDF5: handles that close themselves, errors that are exceptions, tables that
// grow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "manyworlds/record.hpp"
#include "src/base/float_mode.hpp"
#include "src/record/frame.hpp"

namespace manyworlds::record {

// Throws RecordError. What HDF5 itself says is forgotten: it tells of its own insides.
[[noreturn]] void fail(const std::string& what);

// Throws std::bad_alloc unless there is free memory for a call of HDF5, and `more` bytes besides.
// Called before each HDF5 call that allocates. HDF5 1.10 does not survive a failed allocation: it
// ends the program (H5I_register calls exit), frees memory twice, or follows a null pointer.
void need_room(std::size_t more = 0);

// While one lives, its thread is the only one of ours in HDF5, which may not be built for more than
// one; and HDF5 prints no errors, as it otherwise does, for the whole program. May be nested. It
// computes in the library's floating-point mode: HDF5 finds out by computing what numbers are like.
// The first one starts HDF5. It throws std::bad_alloc if there is no memory for that, RecordError
// if HDF5 fails.
class UsingHdf5 {
 public:
  UsingHdf5();
  ~UsingHdf5();
  UsingHdf5(const UsingHdf5&) = delete;
  UsingHdf5& operator=(const UsingHdf5&) = delete;

 private:
  FloatMode mode_;
  std::unique_lock<std::recursive_mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

class Handle {
 public:
  Handle() = default;
  // The words are put together only if there is no id: where memory runs out, an id is not lost.
  Handle(hid_t id, herr_t (*close)(hid_t), std::string_view what, std::string_view name = {})
      : id_(id), close_(close) {
    if (id >= 0) return;
    fail(std::string(what) + (name.empty() ? "" : " '" + std::string(name) + "'"));
  }
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  // At once, and with a look at whether that works.
  void close_now(const std::string& what) {
    if (id_ >= 0 && close_(std::exchange(id_, -1)) < 0) fail(what);
  }
  operator hid_t() const { return id_; }  // NOLINT: stands for it in calls

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

inline void check(herr_t result, const std::string& what) {
  if (result < 0) fail(what);
}

// How a number is stored, little endian, and what it is in memory.
template <class T>
struct NumberType;
#define MW_NUMBER_TYPE(T, name, file, memory)   \
  template <>                                   \
  struct NumberType<T> {                        \
    static hid_t in_file() { return file; }     \
    static hid_t in_memory() { return memory; } \
    static constexpr const char* kName = name;  \
  };
MW_NUMBER_TYPE(float, "float32", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT)
MW_NUMBER_TYPE(double, "float64", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE)
MW_NUMBER_TYPE(std::uint8_t, "uint8", H5T_STD_U8LE, H5T_NATIVE_UINT8)
MW_NUMBER_TYPE(std::int32_t, "int32", H5T_STD_I32LE, H5T_NATIVE_INT32)
MW_NUMBER_TYPE(std::uint32_t, "uint32", H5T_STD_U32LE, H5T_NATIVE_UINT32)
MW_NUMBER_TYPE(std::int64_t, "int64", H5T_STD_I64LE, H5T_NATIVE_INT64)
MW_NUMBER_TYPE(std::uint64_t, "uint64", H5T_STD_U64LE, H5T_NATIVE_UINT64)
#undef MW_NUMBER_TYPE

// Of any stored type, in the same words.
std::string type_name(hid_t type);

using Dims = std::vector<hsize_t>;

class Storage;  // storage.hpp
Handle create_file(const std::shared_ptr<Storage>& storage);
Handle open_file(const std::shared_ptr<Storage>& storage);
Handle open_bytes(std::span<const std::byte> bytes);

// Of a file's access properties: what it lies on. It has to live until the file is open.
void set_storage(hid_t access, const std::shared_ptr<Storage>& storage);

Handle create_group(hid_t parent, const std::string& name);
// Of what lies in this file, as it is: not behind a link to another file or in raw data elsewhere,
// and not compressed, so that what is there says how much is there.
Handle open_dataset(hid_t parent, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);
bool has_link(hid_t parent, const std::string& name);

void write_text(hid_t object, const std::string& attribute, const std::string& text);
std::string read_text(hid_t object, const std::string& attribute);
template <class T>
void write_number(hid_t object, const std::string& attribute, T value);
template <class T>
T read_number(hid_t object, const std::string& attribute);

// One string as a dataset: attributes hold 64 kB at most.
void write_text_table(hid_t parent, const std::string& name, const std::string& text);
std::string read_text_table(hid_t parent, const std::string& name);

// A dataset [row][...] that grows by rows. They are collected and written a chunk at a time.
class Table {
 public:
  Table() = default;
  // `row`: the dimensions after the first. Chunks have about `chunk_bytes`.
  template <class T>
  static Table create(hid_t parent, const std::string& name, const Dims& row,
                      std::size_t chunk_bytes) {
    return Table(parent, name, NumberType<T>::in_file(), NumberType<T>::in_memory(), sizeof(T), row,
                 chunk_bytes);
  }
  // Any whole number of rows, of the type that it was made for.
  template <class T>
  void add(const std::vector<T>& numbers) {
    add_bytes(std::as_bytes(std::span(numbers)));
  }
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T number) { add_bytes(std::as_bytes(std::span(&number, 1))); }
  void add_bytes(std::span<const std::byte> bytes);  // of whole rows
  void flush();
  hsize_t rows() const { return rows_ + buffer_.size() / row_bytes_; }
  hid_t dataset() const { return dataset_; }

 private:
  Table(hid_t parent, const std::string& name, hid_t in_file, hid_t in_memory, std::size_t size,
        const Dims& row, std::size_t chunk_bytes);

  Handle dataset_;
  hid_t in_memory_ = -1;
  Dims row_;
  std::size_t row_bytes_ = 1, chunk_rows_ = 1;
  hsize_t rows_ = 0;  // written
  std::vector<std::byte> buffer_;
  std::string name_;
};

// A dataset of exactly this type and, but for its first, these dimensions, all of which are there.
class TableReader {
 public:
  TableReader() = default;
  template <class T>
  static TableReader open(hid_t parent, const std::string& name, const Dims& row) {
    return TableReader(parent, name, NumberType<T>::in_file(), NumberType<T>::in_memory(),
                       NumberType<T>::kName, row);
  }
  hsize_t rows() const { return rows_; }
  void expect_rows(hsize_t rows) const;
  // Numbers of `count` rows from `first`, the second dimension restricted to one index if
  // `at` is not negative.
  template <class T>
  std::vector<T> read(hsize_t first, hsize_t count, std::int64_t at = -1) const {
    std::vector<T> out(numbers(count, at));
    if (!out.empty()) read_into(first, count, at, out.data());
    return out;
  }
  template <class T>
  std::vector<T> read_all() const {
    return read<T>(0, rows_);
  }

 private:
  TableReader(hid_t parent, const std::string& name, hid_t in_file, hid_t in_memory,
              const char* type, const Dims& row);
  std::size_t numbers(hsize_t count, std::int64_t at) const;
  void read_into(hsize_t first, hsize_t count, std::int64_t at, void* out) const;

  Handle dataset_;
  hid_t in_memory_ = -1;
  Dims row_;
  hsize_t rows_ = 0;
  std::string name_;
};

}  // namespace manyworlds::record
