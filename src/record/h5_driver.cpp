// HDF5's virtual file driver over a Storage.
#include <memory>
#include <new>
#include <utility>

#include "src/record/h5.hpp"
#include "src/record/storage.hpp"
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace manyworlds::record {

namespace {

// HDF5 may hold a file longer than we do: one that it could not close stays open to the end.
struct File : H5FD_t {
  std::shared_ptr<Storage> storage;
  haddr_t allocated = 0;
};

// How a file is told, through its access properties, what to lie on.
struct Access {
  const std::shared_ptr<Storage>* storage;
};

File& of(H5FD_t* file) { return *static_cast<File*>(file); }
const File& of(const H5FD_t* file) { return *static_cast<const File*>(file); }

H5FD_t* open_storage(const char*, unsigned, hid_t properties, haddr_t) {
  const auto* access = static_cast<const Access*>(H5Pget_driver_info(properties));
  if (access == nullptr) return nullptr;
  File* file = new (std::nothrow) File{};
  if (file != nullptr) file->storage = *access->storage;
  return file;
}

herr_t close_storage(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA |
             H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  }
  return 0;
}

// Up to where HDF5 has given room away.
haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t) { return of(file).allocated; }
herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).allocated = end;
  return 0;
}
haddr_t get_end(const H5FD_t* file, H5FD_mem_t) { return of(file).storage->end(); }
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  of(file).storage->set_end(of(file).allocated);
  return 0;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
  return of(file).storage->read(at, {static_cast<std::byte*>(to), size}) ? 0 : -1;
}
herr_t write(H5FD_t* file, H5FD_mem_t type, hid_t, haddr_t at, std::size_t size, const void* from) {
  of(file).storage->write(at, {static_cast<const std::byte*>(from), size}, type == H5FD_MEM_DRAW);
  return 0;
}

constexpr H5FD_class_t make_driver() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
  driver.version = H5FD_CLASS_VERSION;
#ifdef H5_VFD_RESERVED
  driver.value = H5_VFD_RESERVED;  // its name since 1.13
#else
  driver.value = H5FD_RESERVED;
#endif
#endif
  driver.name = "manyworlds";
  driver.maxaddr = haddr_t{1} << 62;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(Access);
  driver.open = open_storage;
  driver.close = close_storage;
  driver.query = query;
  driver.get_eoa = get_allocated;
  driver.set_eoa = set_allocated;
  driver.get_eof = get_end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  // Room of data is never used for headers, nor the other way round.
  constexpr H5FD_mem_t kApart[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  for (int i = 0; i < H5FD_MEM_NTYPES; ++i) driver.fl_map[i] = kApart[i];
  return driver;
}

constexpr H5FD_class_t kDriver = make_driver();

// HDF5 forgets drivers where a program has closed the whole library.
hid_t driver() {
  static hid_t id = -1;
  if (id < 0 || H5Iget_type(id) != H5I_VFL) id = H5FDregister(&kDriver);
  if (id < 0) fail("cannot choose how files are read and written");
  return id;
}

}  // namespace

void set_storage(hid_t access, const std::shared_ptr<Storage>& storage) {
  const Access info{&storage};
  check(H5Pset_driver(access, driver(), &info), "cannot choose how files are read and written");
}

}  // namespace manyworlds::record
