// Datasets that grow by rows, and the checks before one is read.
#include <algorithm>
#include <cstring>

#include "src/record/h5.hpp"

namespace manyworlds::record {

namespace {

Dims joined(hsize_t first, const Dims& rest) {
  Dims dims = {first};
  dims.insert(dims.end(), rest.begin(), rest.end());
  return dims;
}

std::string text(const Dims& dims) {
  std::string out;
  for (const hsize_t n : dims) out += (out.empty() ? "" : " x ") + std::to_string(n);
  return out;
}

}  // namespace

Table::Table(hid_t parent, const std::string& name, hid_t in_file, hid_t in_memory,
             std::size_t size, const Dims& row, std::size_t chunk_bytes)
    : in_memory_(in_memory), row_(row), row_bytes_(size), name_(name) {
  need_room();
  for (const hsize_t n : row) row_bytes_ *= static_cast<std::size_t>(n);
  chunk_rows_ = std::max<std::size_t>(1, chunk_bytes / row_bytes_);
  const Dims none = joined(0, row), most = joined(H5S_UNLIMITED, row);
  const Dims chunk = joined(chunk_rows_, row);
  const int rank = static_cast<int>(none.size());
  const std::string what = "cannot create '" + name + "'";
  const Handle space(H5Screate_simple(rank, none.data(), most.data()), H5Sclose, what);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check(H5Pset_chunk(creation, rank, chunk.data()), what);
  check(H5Pset_obj_track_times(creation, false), what);  // equal bytes
  // We hand over whole chunks; a cache would only copy them.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, what);
  check(H5Pset_chunk_cache(access, 1, 0, 1), what);
  dataset_ = Handle(H5Dcreate2(parent, name.c_str(), in_file, space, H5P_DEFAULT, creation, access),
                    H5Dclose, what);
}

void Table::add_bytes(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    // A chunk that was written in part is filled first.
    const std::size_t most = (chunk_rows_ - rows_ % chunk_rows_) * row_bytes_;
    const auto part = bytes.first(std::min(most - buffer_.size(), bytes.size()));
    buffer_.insert(buffer_.end(), part.begin(), part.end());
    bytes = bytes.subspan(part.size());
    if (buffer_.size() == most) flush();
  }
}

void Table::flush() {
  if (buffer_.empty()) return;
  need_room(buffer_.size());
  const hsize_t count = buffer_.size() / row_bytes_;
  const std::string what = "cannot write '" + name_ + "'";
  const Dims all = joined(rows_ + count, row_), block = joined(count, row_);
  check(H5Dset_extent(dataset_, all.data()), what);
  const Handle target(H5Dget_space(dataset_), H5Sclose, what);
  Dims start(all.size(), 0);
  start[0] = rows_;
  check(H5Sselect_hyperslab(target, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr),
        what);
  const Handle source(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr),
                      H5Sclose, what);
  check(H5Dwrite(dataset_, in_memory_, source, target, H5P_DEFAULT, buffer_.data()), what);
  rows_ += count;
  buffer_.clear();
}

TableReader::TableReader(hid_t parent, const std::string& name, hid_t in_file, hid_t in_memory,
                         const char* type, const Dims& row)
    : in_memory_(in_memory), row_(row), name_(name) {
  dataset_ = open_dataset(parent, name);
  need_room();
  const std::string what = "is damaged: cannot read '" + name + "'";
  const Handle found(H5Dget_type(dataset_), H5Tclose, what);
  if (H5Tequal(found, in_file) <= 0) {
    fail("'" + name + "' is " + type_name(found) + ", must be " + type);
  }
  const Handle space(H5Dget_space(dataset_), H5Sclose, what);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != static_cast<int>(row.size()) + 1) {
    fail("'" + name + "' has " + std::to_string(rank) + " dimensions, must have " +
         std::to_string(row.size() + 1));
  }
  Dims dims(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, dims.data(), nullptr), what);
  rows_ = dims[0];
  if (!std::equal(row.begin(), row.end(), dims.begin() + 1)) {
    fail("'" + name + "' has rows of " + text({dims.begin() + 1, dims.end()}) + ", must be " +
         text(row));
  }
  // Numbers that were never written would be made up: a few bytes could ask for any memory.
  hsize_t bytes = H5Tget_size(found);
  const hsize_t present = H5Dget_storage_size(dataset_);
  for (const hsize_t n : dims) {
    if (n != 0 && bytes > present / n) {
      fail("'" + name + "' is incomplete: it has " + std::to_string(present) + " bytes for " +
           text(dims) + " numbers of " + std::to_string(H5Tget_size(found)));
    }
    bytes *= n;
  }
}

void TableReader::expect_rows(hsize_t rows) const {
  if (rows_ == rows) return;
  fail("'" + name_ + "' has " + std::to_string(rows_) + " rows, must have " + std::to_string(rows));
}

std::size_t TableReader::numbers(hsize_t count, std::int64_t at) const {
  std::size_t n = static_cast<std::size_t>(count);
  for (std::size_t i = at < 0 ? 0 : 1; i < row_.size(); ++i) n *= static_cast<std::size_t>(row_[i]);
  return n;
}

void TableReader::read_into(hsize_t first, hsize_t count, std::int64_t at, void* out) const {
  const std::string what = "is damaged: cannot read '" + name_ + "'";
  Dims start(row_.size() + 1, 0), block = joined(count, row_);
  start[0] = first;
  if (at >= 0) start[1] = static_cast<hsize_t>(at), block[1] = 1;
  need_room();
  const Handle source(H5Dget_space(dataset_), H5Sclose, what);
  check(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, block.data(), nullptr),
        what);
  const Handle target(H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr),
                      H5Sclose, what);
  check(H5Dread(dataset_, in_memory_, target, source, H5P_DEFAULT, out), what);
}

}  // namespace manyworlds::record
