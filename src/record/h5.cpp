#include "src/record/h5.hpp"

#include <algorithm>
#include <atomic>

namespace manyworlds::record {

namespace {

// The innermost entry of the error stack says most.
herr_t take_reason(unsigned n, const H5E_error2_t* error, void* reason) {
  if (n == 0 && error->desc) *static_cast<std::string*>(reason) = error->desc;
  return 0;
}

Handle file_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file properties");
  // Small files, and every HDF5 since 2016 reads them.
  check(H5Pset_libver_bounds(properties, H5F_LIBVER_V110, H5F_LIBVER_V110), "library version");
  return properties;
}

Handle one_number_space() { return {H5Screate(H5S_SCALAR), H5Sclose, "a scalar"}; }

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a string type");
  check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "the length of a string");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "the padding of a string");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "the characters of a string");
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
  if (H5Aexists(object, name.c_str()) <= 0) fail("has no attribute '" + name + "'");
  Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "attribute", name);
  const Handle space(H5Aget_space(attribute), H5Sclose, "attribute", name);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR) fail("attribute " + name + " is no scalar");
  return attribute;
}

herr_t refuse_link(const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) {
  return -1;
}

std::recursive_mutex hdf5_mutex;

// How to open what is in this file: a link to another one is not followed.
Handle inside_only(hid_t sort) {
  Handle access(H5Pcreate(sort), H5Pclose, "access properties");
  check(H5Pset_elink_cb(access, refuse_link, nullptr), "access properties");
  return access;
}

}  // namespace

void fail(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw RecordError(what + (reason.empty() ? "" : " (HDF5: " + reason + ")"));
}

UsingHdf5::UsingHdf5() : lock_(hdf5_mutex) {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
UsingHdf5::~UsingHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Handle create_file(const std::shared_ptr<Storage>& storage) {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "file properties");
  check(H5Pset_userblock(creation, kFrameSize), "the user block");
  check(H5Pset_obj_track_times(creation, false), "the times of the file");  // equal bytes
  const Handle access = file_properties();
  set_storage(access, storage);
  return {H5Fcreate("recording", H5F_ACC_TRUNC, creation, access), H5Fclose, "cannot be created"};
}

Handle open_file(const std::shared_ptr<Storage>& storage) {
  const Handle access = file_properties();
  set_storage(access, storage);
  return {H5Fopen("recording", H5F_ACC_RDONLY, access), H5Fclose, "cannot be opened"};
}

Handle open_file(const std::filesystem::path& path) {
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_properties()), H5Fclose, "cannot be opened"};
}

Handle open_bytes(std::span<const std::byte> bytes) {
  const Handle access = file_properties();
  check(H5Pset_fapl_core(access, std::size_t{1} << 20, false), "a file in memory");
  // HDF5 copies the bytes; it only reads them.
  check(H5Pset_file_image(access, const_cast<std::byte*>(bytes.data()), bytes.size()),
        "a file in memory");
  // HDF5 takes two of one name for the same.
  static std::atomic<std::uint64_t> count = 0;
  const std::string name = "recording in memory " + std::to_string(count++);
  return {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "cannot be opened"};
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, name);
  check(H5Pset_obj_track_times(creation, false), "the times of '" + name + "'");
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose,
          "cannot create group", name};
}
bool has_link(hid_t parent, const std::string& name) {
  return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0;
}
Handle open_group(hid_t parent, const std::string& name) {
  if (!has_link(parent, name)) fail("has no '" + name + "'");
  return {H5Gopen2(parent, name.c_str(), inside_only(H5P_GROUP_ACCESS)), H5Gclose, "cannot open",
          name};
}
Handle open_dataset(hid_t parent, const std::string& name) {
  if (!has_link(parent, name)) fail("has no '" + name + "'");
  Handle dataset(H5Dopen2(parent, name.c_str(), inside_only(H5P_DATASET_ACCESS)), H5Dclose,
                 "cannot open", name);
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose, name);
  if (H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_nfilters(creation) != 0 ||
      H5Pget_external_count(creation) != 0) {
    fail("'" + name + "' is compressed or lies outside of the file");
  }
  return dataset;
}

void write_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type, one_number_space(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, "attribute", name);
  check(H5Awrite(attribute, type, text.empty() ? "" : text.data()), "attribute " + name);
}

std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "attribute", name);
  const std::size_t size = text_size(type);
  if (size == 0 || size > 65536) fail("attribute " + name + " is not a text");
  std::string text(size, '\0');
  check(H5Aread(attribute, type, text.data()), "attribute " + name);
  return trimmed(text);
}

template <class T>
void write_number(hid_t object, const std::string& name, T value) {
  const Handle attribute(H5Acreate2(object, name.c_str(), NumberType<T>::in_file(),
                                    one_number_space(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "attribute", name);
  check(H5Awrite(attribute, NumberType<T>::in_memory(), &value), "attribute " + name);
}

template <class T>
T read_number(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "attribute", name);
  if (H5Tequal(type, NumberType<T>::in_file()) <= 0) {
    fail("attribute " + name + " is not of type " + NumberType<T>::kName);
  }
  T value{};
  check(H5Aread(attribute, NumberType<T>::in_memory(), &value), "attribute " + name);
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
  const Handle type = text_type(text.size());
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
  check(H5Pset_obj_track_times(creation, false), "the times of '" + name + "'");
  const Handle dataset(H5Dcreate2(parent, name.c_str(), type, one_number_space(), H5P_DEFAULT,
                                  creation, H5P_DEFAULT),
                       H5Dclose, "cannot create", name);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.empty() ? "" : text.data()),
        "cannot write '" + name + "'");
}

std::string read_text_table(hid_t parent, const std::string& name) {
  const Handle dataset = open_dataset(parent, name);
  const Handle type(H5Dget_type(dataset), H5Tclose, name),
      space(H5Dget_space(dataset), H5Sclose, name);
  const std::size_t size = text_size(type);
  if (size == 0 || H5Sget_simple_extent_type(space) != H5S_SCALAR) fail(name + " is not a text");
  if (H5Dget_storage_size(dataset) != size) fail(name + " is not all there");
  std::string text(size, '\0');
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "cannot read " + name);
  return trimmed(text);
}

}  // namespace manyworlds::record
