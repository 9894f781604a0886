#include "src/record/h5.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include "src/base/thread_room.hpp"

namespace manyworlds::record {

namespace {

// Words of errors: of what is there and cannot be read, though all checksums are right.
constexpr const char* kDamaged = "is damaged: cannot read";
constexpr const char* kNotOpened = "is damaged: its contents cannot be opened";
constexpr const char* kDamagedAttribute = "is damaged: cannot read attribute";

Handle file_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot make file properties");
  // Small files, and every HDF5 since 2016 reads them.
  check(H5Pset_libver_bounds(properties, H5F_LIBVER_V110, H5F_LIBVER_V110),
        "cannot set the library's version");
  return properties;
}

Handle one_number_space() { return {H5Screate(H5S_SCALAR), H5Sclose, "cannot describe a number"}; }

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot describe a text");
  check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "cannot describe a text");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "cannot describe a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "cannot describe a text");
  return type;
}

// The length of a stored string type of ours; 0 for another type.
std::size_t text_size(hid_t type) {
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return 0;
  return H5Tget_size(type);
}

std::string trimmed(std::string text) {
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

Handle open_attribute(hid_t object, const std::string& name) {
  need_room();
  if (H5Aexists(object, name.c_str()) <= 0) fail("has no attribute '" + name + "'");
  Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, kDamagedAttribute, name);
  const Handle space(H5Aget_space(attribute), H5Sclose, kDamagedAttribute, name);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR) {
    fail("attribute '" + name + "' has " + std::to_string(H5Sget_simple_extent_ndims(space)) +
         " dimensions, must have none");
  }
  return attribute;
}

herr_t refuse_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) {
  return -1;
}

std::recursive_mutex hdf5_mutex;

// How to open what is in this file: a link to another one is not followed.
Handle inside_only(hid_t sort) {
  Handle access(H5Pcreate(sort), H5Pclose, "cannot make access properties");
  check(H5Pset_elink_cb(access, refuse_link, nullptr), "cannot make access properties");
  return access;
}

}  // namespace

void fail(const std::string& what) {
  H5Eclear2(H5E_DEFAULT);
  throw RecordError(what);
}

void need_room(std::size_t more) {
  // Several times the growth of HDF5's caches in one call.
  constexpr std::size_t kRoom = 8 << 20;
  if (!has_room(kRoom + more)) throw std::bad_alloc();
}

namespace {

// Returns false if HDF5 cannot be started. HDF5 must not be called then: every call would try to
// start it again, from a half-initialized state.
bool start_hdf5() {
  need_room();
  if (H5open() < 0) return false;
  // After a damaged file HDF5 has something left that it cannot close, and says so at the program's
  // exit, unless it is told before not to print errors.
  std::atexit([] { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); });
  return true;
}

}  // namespace

UsingHdf5::UsingHdf5() : lock_(hdf5_mutex) {
  static const bool started = start_hdf5();
  if (!started) throw RecordError("HDF5 cannot be started");
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
UsingHdf5::~UsingHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Handle create_file(const std::shared_ptr<Storage>& storage) {
  need_room();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "cannot make file properties");
  check(H5Pset_userblock(creation, kFrameSize), "cannot leave room for the frame");
  check(H5Pset_obj_track_times(creation, false), "cannot make file properties");  // equal bytes
  const Handle access = file_properties();
  set_storage(access, storage);
  return {H5Fcreate("recording", H5F_ACC_TRUNC, creation, access), H5Fclose, "cannot be created"};
}

Handle open_file(const std::shared_ptr<Storage>& storage) {
  need_room();
  const Handle access = file_properties();
  set_storage(access, storage);
  return {H5Fopen("recording", H5F_ACC_RDONLY, access), H5Fclose, kNotOpened};
}

Handle open_bytes(std::span<const std::byte> bytes) {
  need_room(3 * bytes.size());  // its copies
  const Handle access = file_properties();
  check(H5Pset_fapl_core(access, std::size_t{1} << 20, false), "cannot open what is in memory");
  // HDF5 copies the bytes; it only reads them.
  check(H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), bytes.size()),
        "cannot open what is in memory");
  // HDF5 takes two of one name for the same.
  static std::atomic<std::uint64_t> count = 0;
  const std::string name = "recording in memory " + std::to_string(count++);
  return {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access), H5Fclose, kNotOpened};
}

Handle create_group(hid_t parent, const std::string& name) {
  need_room();
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "cannot create group", name);
  check(H5Pset_obj_track_times(creation, false), "cannot create group '" + name + "'");
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose,
          "cannot create group", name};
}
bool has_link(hid_t parent, const std::string& name) {
  need_room();
  return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0;
}

namespace {

const char* sort_name(H5I_type_t sort) {
  return sort == H5I_GROUP ? "group" : sort == H5I_DATASET ? "dataset" : "type";
}

Handle open_object(hid_t parent, const std::string& name, H5I_type_t sort) {
  if (!has_link(parent, name)) fail("has no '" + name + "'");
  H5L_info_t link{};
  check(H5Lget_info(parent, name.c_str(), &link, H5P_DEFAULT),
        std::string(kDamaged) + " '" + name + "'");
  if (link.type >= H5L_TYPE_UD_MIN) {
    fail("'" + name + "' is a link to another file, must be in this one");
  }
  Handle object(H5Oopen(parent, name.c_str(), inside_only(H5P_LINK_ACCESS)), H5Oclose,
                link.type == H5L_TYPE_HARD ? kDamaged : "has a broken link,", name);
  const H5I_type_t found = H5Iget_type(object);
  if (found != sort) {
    fail("'" + name + "' is a " + sort_name(found) + ", must be a " + sort_name(sort));
  }
  return object;
}

}  // namespace

Handle open_group(hid_t parent, const std::string& name) {
  return open_object(parent, name, H5I_GROUP);
}
Handle open_dataset(hid_t parent, const std::string& name) {
  Handle dataset = open_object(parent, name, H5I_DATASET);
  need_room();
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, kDamaged, name);
  if (H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_nfilters(creation) != 0 ||
      H5Pget_external_count(creation) != 0) {
    fail("'" + name + "' is compressed or stored outside the file");
  }
  return dataset;
}

std::string type_name(hid_t type) {
  const H5T_class_t sort = H5Tget_class(type);
  if (sort == H5T_STRING) {
    return H5Tis_variable_str(type) > 0 ? "text of variable length" : "text";
  }
  if (sort != H5T_INTEGER && sort != H5T_FLOAT) return "neither numbers nor text";
  const std::string word = sort == H5T_FLOAT                   ? "float"
                           : H5Tget_sign(type) == H5T_SGN_NONE ? "uint"
                                                               : "int";
  return word + std::to_string(8 * H5Tget_size(type)) +
         (H5Tget_order(type) == H5T_ORDER_BE ? " (big endian)" : "");
}

void write_text(hid_t object, const std::string& name, const std::string& text) {
  need_room();
  const Handle type = text_type(text.size());
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type, one_number_space(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "cannot write attribute", name);
  check(H5Awrite(attribute, type, text.empty() ? "" : text.data()),
        "cannot write attribute '" + name + "'");
}

std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, kDamagedAttribute, name);
  const std::size_t size = text_size(type);
  if (size == 0 || size > 65536) {
    fail("attribute '" + name + "' is " + type_name(type) + ", must be text of at most 64 kB");
  }
  std::string text(size, '\0');
  check(H5Aread(attribute, type, text.data()), kDamagedAttribute + (" '" + name + "'"));
  return trimmed(text);
}

template <class T>
void write_number(hid_t object, const std::string& name, T value) {
  need_room();
  const Handle attribute(H5Acreate2(object, name.c_str(), NumberType<T>::in_file(),
                                    one_number_space(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "cannot write attribute", name);
  check(H5Awrite(attribute, NumberType<T>::in_memory(), &value),
        "cannot write attribute '" + name + "'");
}

template <class T>
T read_number(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, kDamagedAttribute, name);
  if (H5Tequal(type, NumberType<T>::in_file()) <= 0) {
    fail("attribute '" + name + "' is " + type_name(type) + ", must be " + NumberType<T>::kName);
  }
  T value{};
  check(H5Aread(attribute, NumberType<T>::in_memory(), &value),
        kDamagedAttribute + (" '" + name + "'"));
  return value;
}

#define MW_INSTANTIATE(T)                                      \
  template void write_number<T>(hid_t, const std::string&, T); \
  template T read_number<T>(hid_t, const std::string&);
MW_INSTANTIATE(double)
MW_INSTANTIATE(std::uint8_t)
MW_INSTANTIATE(std::int32_t)
MW_INSTANTIATE(std::int64_t)
MW_INSTANTIATE(std::uint64_t)
#undef MW_INSTANTIATE

void write_text_table(hid_t parent, const std::string& name, const std::string& text) {
  need_room(text.size());
  const Handle type = text_type(text.size());
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "cannot create", name);
  check(H5Pset_obj_track_times(creation, false), "cannot create '" + name + "'");
  const Handle dataset(H5Dcreate2(parent, name.c_str(), type, one_number_space(), H5P_DEFAULT,
                                  creation, H5P_DEFAULT),
                       H5Dclose, "cannot create", name);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.empty() ? "" : text.data()),
        "cannot write '" + name + "'");
}

std::string read_text_table(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Handle type(H5Dget_type(dataset), H5Tclose, kDamaged, name),
      space(H5Dget_space(dataset), H5Sclose, kDamaged, name);
  const std::size_t size = text_size(type);
  if (size == 0) fail("'" + name + "' is " + type_name(type) + ", must be text");
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR) {
    fail("'" + name + "' has " + std::to_string(H5Sget_simple_extent_ndims(space)) +
         " dimensions, must have none");
  }
  if (const hsize_t present = H5Dget_storage_size(dataset); present != size) {
    fail("'" + name + "' is incomplete: it has " + std::to_string(present) + " of " +
         std::to_string(size) + " bytes");
  }
  std::string text(size, '\0');
  need_room(size);
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()),
        kDamaged + (" '" + name + "'"));
  return trimmed(text);
}

}  // namespace manyworlds::record
