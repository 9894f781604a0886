#include "fuzz/recording_edit.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "fuzz/file_image.hpp"
#include "fuzz/json_edit.hpp"
#include "fuzz/snapshot_batches.hpp"
#include "src/record/frame.hpp"
#include "src/state/snapshot_format.hpp"

namespace manyworlds::fuzz {

namespace {

using record::check;
using record::Handle;
using Bytes = std::vector<std::byte>;

constexpr const char* kWhat = "edit";
constexpr std::size_t kMaxBytes = std::size_t{1} << 22;

// A dataset or an attribute, and all its numbers as they are stored.
class Data {
 public:
  Data(hid_t file, const std::string& object, const std::string& attribute)
      : in_object_(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose, kWhat),
        is_attribute_(!attribute.empty()) {
    if (is_attribute_) {
      attribute_ = Handle(H5Aopen(in_object_, attribute.c_str(), H5P_DEFAULT), H5Aclose, kWhat);
    } else if (H5Iget_type(in_object_) != H5I_DATASET) {
      record::fail(kWhat);
    }
    type =
        Handle(is_attribute_ ? H5Aget_type(attribute_) : H5Dget_type(in_object_), H5Tclose, kWhat);
    const Handle space(is_attribute_ ? H5Aget_space(attribute_) : H5Dget_space(in_object_),
                       H5Sclose, kWhat);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    is_text = H5Tget_class(type) == H5T_STRING;
    size = H5Tget_size(type);
    if (count < 1 || size == 0 || static_cast<std::size_t>(count) > kMaxBytes / size ||
        H5Tis_variable_str(type) > 0 || H5Tdetect_class(type, H5T_VLEN) > 0) {
      record::fail(kWhat);
    }
    bytes.resize(static_cast<std::size_t>(count) * size);
    check(is_attribute_ ? H5Aread(attribute_, type, bytes.data())
                        : H5Dread(in_object_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()),
          kWhat);
  }
  void put() const {
    check(is_attribute_ ? H5Awrite(attribute_, type, bytes.data())
                        : H5Dwrite(in_object_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()),
          kWhat);
  }

  Handle type;
  bool is_text = false;
  std::size_t size = 1;  // of a number or text, bytes
  Bytes bytes;

 private:
  Handle in_object_, attribute_;
  bool is_attribute_;
};

// The snapshots that lie one after the other in these bytes get right frames.
void frame_all(Bytes& bytes) {
  for (std::size_t at = 0; at + sizeof(SnapshotHeader) < bytes.size();) {
    SnapshotHeader header;
    std::memcpy(&header, bytes.data() + at, sizeof header);
    const std::size_t size = std::min<std::size_t>(header.size, bytes.size() - at);
    if (size < sizeof header) return;
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    Bytes one(first, first + static_cast<std::ptrdiff_t>(size));
    frame(one);
    std::copy(one.begin(), one.end(), first);
    at += size;
  }
}

constexpr std::array kNumbers = {std::int64_t{0},
                                 std::int64_t{1},
                                 std::int64_t{-1},
                                 std::int64_t{255},
                                 std::int64_t{65536},
                                 std::int64_t{0x7fffffff},
                                 -std::int64_t{0x80000000},
                                 std::int64_t{1} << 40,
                                 std::numeric_limits<std::int64_t>::max(),
                                 std::numeric_limits<std::int64_t>::min(),
                                 std::int64_t{0x7ff0000000000000},   // inf
                                 std::int64_t{0x7ff8000000000000},   // nan
                                 std::int64_t{0x7fc000007fc00000},   // nan of 4 bytes
                                 std::int64_t{0x7f8000007f800000}};  // inf of 4 bytes

int add_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}
int add_link(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

}  // namespace

RecordingEdit::RecordingEdit(std::span<const std::byte> bytes) : h5_(open_image(bytes)) {
  std::vector<std::string> objects = {"."};
  check(H5Lvisit(h5_, H5_INDEX_NAME, H5_ITER_INC, add_link, &objects), kWhat);
  for (const std::string& object : objects) {
    if (object != ".") targets_.push_back({object, ""});
    std::vector<std::string> attributes;
    const Handle handle(H5Oopen(h5_, object.c_str(), H5P_DEFAULT), H5Oclose, kWhat);
    check(H5Aiterate2(handle, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &attributes),
          kWhat);
    for (const std::string& attribute : attributes) targets_.push_back({object, attribute});
  }
}

std::vector<std::byte> RecordingEdit::close() {
  h5_ = {};
  Bytes bytes = take_closed_image();
  record::seal(std::span(bytes));
  return bytes;
}

void RecordingEdit::edit(FuzzedDataProvider& in) {
  try {
    change(targets_[in.ConsumeIntegralInRange<std::size_t>(0, targets_.size() - 1)], in);
  } catch (const RecordError&) {  // there is no such thing any more, or it cannot be so
  }
}

void RecordingEdit::change(const Target& target, FuzzedDataProvider& in) {
  const int what = in.ConsumeIntegralInRange(0, 31);
  const auto other = [&]() -> const Target& {
    return targets_[in.ConsumeIntegralInRange<std::size_t>(0, targets_.size() - 1)];
  };
  if (what < 16) return change_numbers(target, in);
  if (what < 22) return change_text(target, in);
  if (what < 25) return resize(target, in);
  if (what < 27) return remake(target, in);
  switch (what) {
    case 27: return remove(target);
    case 28: return rename(target, other());
    case 29: return link(target, other(), false);
    case 30: return link(target, other(), true);
    default: return mend_fingerprint(target);
  }
}

void RecordingEdit::change_numbers(const Target& target, FuzzedDataProvider& in) {
  Data data(h5_, target.object, target.attribute);
  const std::size_t size = data.is_text ? 1 : data.size;
  std::byte* at = data.bytes.data() +
                  size * in.ConsumeIntegralInRange<std::size_t>(0, data.bytes.size() / size - 1);
  const std::size_t room = std::min<std::size_t>(size, sizeof(std::int64_t));
  std::int64_t number = 0;
  std::memcpy(&number, at, room);
  switch (in.ConsumeIntegralInRange(0, 3)) {
    case 0: number = in.ConsumeIntegral<std::int64_t>(); break;
    case 1: number = in.PickValueInArray(kNumbers); break;
    default:
      number =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(number) +
                                    static_cast<std::uint64_t>(in.ConsumeIntegral<std::int8_t>()));
  }
  std::memcpy(at, &number, room);
  if (data.size == 1 && !data.is_text && in.ConsumeBool()) frame_all(data.bytes);
  data.put();
}

void RecordingEdit::change_text(const Target& target, FuzzedDataProvider& in) {
  std::string text;
  {
    const Data data(h5_, target.object, target.attribute);
    if (!data.is_text) record::fail(kWhat);
    text.assign(reinterpret_cast<const char*>(data.bytes.data()), data.bytes.size());
  }
  text = edit_json(text, in);
  remove(target);
  if (target.attribute.empty()) {
    record::write_text_table(h5_, target.object, text);
  } else {
    const Handle object(H5Oopen(h5_, target.object.c_str(), H5P_DEFAULT), H5Oclose, kWhat);
    record::write_text(object, target.attribute, text);
  }
}

void RecordingEdit::resize(const Target& target, FuzzedDataProvider& in) {
  const Handle data(H5Dopen2(h5_, target.object.c_str(), H5P_DEFAULT), H5Dclose, kWhat);
  const Handle space(H5Dget_space(data), H5Sclose, kWhat);
  hsize_t dims[H5S_MAX_RANK] = {};
  if (H5Sget_simple_extent_dims(space, dims, nullptr) < 1) record::fail(kWhat);
  // HDF5 looks at every chunk that there could be when it makes a table shorter.
  constexpr hsize_t kMaxToShrink = hsize_t{1} << 20;
  if (dims[0] > kMaxToShrink) return;
  switch (in.ConsumeIntegralInRange(0, 3)) {
    case 0: dims[0] += 1; break;
    case 1: dims[0] -= std::min<hsize_t>(dims[0], 1); break;
    case 2: dims[0] = in.ConsumeIntegralInRange<hsize_t>(0, 5000); break;
    default: dims[0] = hsize_t{1} << in.ConsumeIntegralInRange(0, 60);
  }
  check(H5Dset_extent(data, dims), kWhat);
}

void RecordingEdit::remove(const Target& target) {
  check(target.attribute.empty()
            ? H5Ldelete(h5_, target.object.c_str(), H5P_DEFAULT)
            : H5Adelete_by_name(h5_, target.object.c_str(), target.attribute.c_str(), H5P_DEFAULT),
        kWhat);
}

void RecordingEdit::rename(const Target& target, const Target& to) {
  if (target.attribute.empty()) {
    const std::string name = to.attribute.empty() ? to.object : to.attribute;
    H5Ldelete(h5_, name.c_str(), H5P_DEFAULT);
    check(H5Lmove(h5_, target.object.c_str(), h5_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), kWhat);
  } else {
    const std::string& name = to.attribute.empty() ? "renamed" : to.attribute;
    H5Adelete_by_name(h5_, target.object.c_str(), name.c_str(), H5P_DEFAULT);
    check(H5Arename_by_name(h5_, target.object.c_str(), target.attribute.c_str(), name.c_str(),
                            H5P_DEFAULT),
          kWhat);
  }
}

void RecordingEdit::link(const Target& target, const Target& to, bool soft) {
  if (!target.attribute.empty() || target.object == to.object) record::fail(kWhat);
  const std::string from = "/" + to.object;
  check(H5Ldelete(h5_, target.object.c_str(), H5P_DEFAULT), kWhat);
  check(soft ? H5Lcreate_soft(from.c_str(), h5_, target.object.c_str(), H5P_DEFAULT, H5P_DEFAULT)
             : H5Lcreate_hard(h5_, from.c_str(), h5_, target.object.c_str(), H5P_DEFAULT,
                              H5P_DEFAULT),
        kWhat);
}

// Of any type and dimensions, written or not.
void RecordingEdit::remake(const Target& target, FuzzedDataProvider& in) {
  Handle type(
      H5Tcopy(in.PickValueInArray({H5T_STD_I8LE, H5T_STD_U8LE, H5T_STD_I32LE, H5T_STD_U32LE,
                                   H5T_STD_I64LE, H5T_STD_U64LE, H5T_STD_I64BE, H5T_IEEE_F32LE,
                                   H5T_IEEE_F64LE, H5T_C_S1, H5T_STD_REF_OBJ, H5T_STD_U16LE})),
      H5Tclose, kWhat);
  if (H5Tget_class(type) == H5T_STRING) {
    const auto size = in.ConsumeIntegralInRange<std::size_t>(0, 70000);
    check(H5Tset_size(type, size == 0 ? H5T_VARIABLE : size), kWhat);
  } else if (in.ConsumeIntegralInRange(0, 7) == 7) {
    type = Handle(H5Tvlen_create(type), H5Tclose, kWhat);
  }
  // An attribute of any size is HDF5's to make in one piece.
  const int rank = in.ConsumeIntegralInRange(0, target.attribute.empty() ? 4 : 1);
  hsize_t dims[4] = {}, most[4] = {};
  for (int i = 0; i < rank; ++i) {
    dims[i] = in.ConsumeIntegralInRange<hsize_t>(0, rank == 1 ? 40 : 5);
    most[i] = H5S_UNLIMITED;
  }
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, kWhat);
  const int layout = in.ConsumeIntegralInRange(0, 3);
  if (layout >= 2 && rank > 0) {
    const hsize_t chunk[4] = {2, 3, 2, 2};
    check(H5Pset_chunk(creation, rank, chunk), kWhat);
    if (layout == 3) check(H5Pset_shuffle(creation), kWhat);
  } else if (layout == 1) {
    check(H5Pset_layout(creation, H5D_COMPACT), kWhat);
  }
  if (in.ConsumeBool()) check(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY), kWhat);
  const bool grows = layout >= 2 && rank > 0;
  const Handle space(rank == 0 ? H5Screate(in.ConsumeBool() ? H5S_SCALAR : H5S_NULL)
                               : H5Screate_simple(rank, dims, grows ? most : nullptr),
                     H5Sclose, kWhat);
  remove(target);
  if (target.attribute.empty()) {
    const Handle made(
        H5Dcreate2(h5_, target.object.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
        H5Dclose, kWhat);
  } else {
    const Handle made(H5Acreate_by_name(h5_, target.object.c_str(), target.attribute.c_str(), type,
                                        space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose, kWhat);
  }
}

// A scene that was changed and is still one is let through by the check of its plan.
void RecordingEdit::mend_fingerprint(const Target& target) {
  const std::string path = target.object.substr(0, target.object.rfind('/'));
  const Handle kind = record::open_group(h5_, path);
  try {
    const Plan plan =
        compile(scene_from_json(record::read_text_table(kind, "scene")),
                plan_options_from_json(record::read_text_table(kind, "plan_options")));
    check(H5Adelete(kind, "fingerprint"), kWhat);
    record::write_number(kind, "fingerprint", plan.fingerprint());
  } catch (const SceneError&) {
  }
}

}  // namespace manyworlds::fuzz
