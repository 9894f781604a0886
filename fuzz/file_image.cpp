#include "fuzz/file_image.hpp"

#include <cstdlib>
#include <cstring>
#include <utility>

namespace manyworlds::fuzz {

using record::check;
using record::Handle;
using Bytes = std::vector<std::byte>;

namespace {

constexpr const char* kWhat = "file in memory";

// HDF5 hands a file in memory over when it lets go of it, and not before it is whole.
struct Image {
  std::size_t size = 0;
  Bytes closed;
};
Image& image() {
  static Image one;
  return one;
}

void* take(std::size_t size, H5FD_file_image_op_t op, void*) {
  if (op == H5FD_FILE_IMAGE_OP_FILE_OPEN) image().size = size;
  return std::malloc(size);
}
void* copy(void* to, const void* from, std::size_t size, H5FD_file_image_op_t, void*) {
  return std::memcpy(to, from, size);
}
void* retake(void* memory, std::size_t size, H5FD_file_image_op_t op, void*) {
  if (op == H5FD_FILE_IMAGE_OP_FILE_RESIZE) image().size = size;
  return std::realloc(memory, size);
}
herr_t give(void* memory, H5FD_file_image_op_t op, void*) {
  if (op == H5FD_FILE_IMAGE_OP_FILE_CLOSE) {
    const auto* first = static_cast<const std::byte*>(memory);
    image().closed.assign(first, first + image().size);
  }
  std::free(memory);
  return 0;
}

}  // namespace

Handle open_image(std::span<const std::byte> bytes) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, kWhat);
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), kWhat);
  check(H5Pset_fapl_core(access, 4096, false), kWhat);
  H5FD_file_image_callbacks_t calls{take, copy, retake, give, nullptr, nullptr, nullptr};
  check(H5Pset_file_image_callbacks(access, &calls), kWhat);
  check(H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), bytes.size()), kWhat);
  return {H5Fopen("edited", H5F_ACC_RDWR, access), H5Fclose, kWhat};
}

Bytes take_closed_image() { return std::exchange(image().closed, {}); }

}  // namespace manyworlds::fuzz
