// Opens recordings: nothing in the file is used before it was checked.
#include "src/record/recording.hpp"

#include <array>
#include <limits>
#include <system_error>
#include <utility>

#include "src/base/enum_names.hpp"
#include "src/base/index_check.hpp"
#include "src/base/printable.hpp"
#include "src/record/described.hpp"
#include "src/record/frame.hpp"
#include "src/record/storage.hpp"

namespace manyworlds {

namespace {

using record::described, record::TableReader;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// Where the system could not read the file, what HDF5 made of that is of no interest.
template <class Make>
auto sound(const record::Storage* storage, Make&& make) {
  const auto check = [&] {
    const int error = storage == nullptr ? 0 : storage->read_error();
    if (error != 0) throw RecordError("cannot be read: " + reason_of(error));
  };
  try {
    auto made = make();
    check();
    return made;
  } catch (const RecordError&) {
    check();
    throw;
  }
}

std::string label_of(const std::filesystem::path& file) { return "'" + file.string() + "': "; }

}  // namespace

RecordError::RecordError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

Recording::Impl::Impl(record::Handle file, std::string called,
                      std::shared_ptr<record::Storage> lies_on)
    : storage(std::move(lies_on)), h5(std::move(file)), label(std::move(called)) {
  read_head();
  const record::Handle root = record::open_group(h5, "kinds");
  H5G_info_t about{};
  record::check(H5Gget_info(root, &about), "is damaged: cannot read 'kinds'");
  if (about.nlinks < 1 || about.nlinks > 4096) {
    record::fail("has " + std::to_string(about.nlinks) + " kinds, must have 1 to 4096");
  }
  read_samples();
  first_world.push_back(0);
  for (int k = 0; k < static_cast<int>(about.nlinks); ++k) {
    described("kind " + std::to_string(k) + ": ", [&] { read_kind(root, k); });
  }
  const auto bytes = TableReader::open<std::uint8_t>(h5, "start", {}).read_all<std::uint8_t>();
  const auto raw = std::as_bytes(std::span(bytes));
  start = Snapshot::from_bytes({raw.begin(), raw.end()});
  if (start.worlds() != worlds()) {
    record::fail("the snapshot has " + std::to_string(start.worlds()) + " worlds, must have " +
                 std::to_string(worlds()));
  }
  read_inputs();
  check_order();
}

void Recording::Impl::read_head() {
  const std::string format = record::read_text(h5, "format");
  if (format != record::kFormat) {
    record::fail("has format '" + format + "', must be '" + record::kFormat + "'");
  }
  const auto version = record::read_number<std::int32_t>(h5, "format_version");
  if (version != record::kFormatVersion) {
    record::fail("has format version " + std::to_string(version) + ", must be " +
                 std::to_string(record::kFormatVersion));
  }
  const std::string numbers = record::read_text(h5, "precision");
  if (numbers != "f32" && numbers != "f64") {
    record::fail("has precision '" + numbers + "', must be f32 or f64");
  }
  precision = numbers == "f32" ? Precision::f32 : Precision::f64;
  const auto sleeps = record::read_number<std::uint8_t>(h5, "sleep");
  if (sleeps > 1) record::fail("sleep is " + std::to_string(sleeps) + ", must be 0 or 1");
  sleep = sleeps == 1;
  const auto threads = record::read_number<std::int32_t>(h5, "threads");
  const auto word = [&](const char* name) { return printable(record::read_text(h5, name), 40); };
  origin = "manyworlds " + word("program_version") + ", " + word("isa") + " " + numbers + ", " +
           std::to_string(threads) + (threads == 1 ? " thread" : " threads") + ", seed " +
           std::to_string(record::read_number<std::uint64_t>(h5, "seed")) + ", sleep " +
           (sleep ? "on" : "off");
}

void Recording::Impl::read_samples() {
  const auto table = TableReader::open<std::int64_t>(h5, "step", {});
  steps = table.read_all<std::int64_t>();
  if (steps.empty()) record::fail("has no samples, must have at least 1");
  const auto before = TableReader::open<std::int64_t>(h5, "inputs_before", {});
  before.expect_rows(table.rows());
  inputs_before = before.read_all<std::int64_t>();
  TableReader::open<double>(h5, "time", {}).expect_rows(table.rows());
}

void Recording::Impl::read_kind(hid_t parent, int index) {
  const record::Handle group = record::open_group(parent, std::to_string(index));
  const Scene scene = described(
      "scene: ", [&] { return scene_from_json(record::read_text_table(group, "scene")); });
  const PlanOptions options = described("plan_options: ", [&] {
    return plan_options_from_json(record::read_text_table(group, "plan_options"));
  });
  Kind kind{described("scene: ", [&] { return compile(scene, options); }), {}, {}, {}, {}, {}};
  if (kind.plan.fingerprint() != record::read_number<std::uint64_t>(group, "fingerprint")) {
    record::fail(
        "this program compiles the scene to another plan than the program that recorded it");
  }
  const Options& first = kinds.empty() ? scene.options : kinds.front().plan.scene().options;
  if ((!kinds.empty() && scene.space != space()) || scene.options.dt != first.dt) {
    record::fail("has another space or dt than kind 0");
  }
  kind.worlds = TableReader::open<std::int64_t>(group, "world", {}).read_all<std::int64_t>();
  const std::size_t count = kind.worlds.size();
  const auto room = static_cast<std::size_t>(std::numeric_limits<int>::max() - worlds());
  if (count == 0 || count > room) {
    record::fail("has " + std::to_string(count) + " worlds, must have 1 to " +
                 std::to_string(room));
  }
  const auto hashes = TableReader::open<std::uint64_t>(group, "hash", {count});
  const auto statuses = TableReader::open<std::uint32_t>(group, "status", {count});
  hashes.expect_rows(steps.size());
  statuses.expect_rows(steps.size());
  kind.hashes = hashes.read_all<std::uint64_t>();
  kind.statuses = statuses.read_all<std::uint32_t>();
  for (const Field field : kFields) {
    const auto items = static_cast<hsize_t>(kind.plan.items(info(field).item));
    if (items == 0) continue;
    const auto width = static_cast<hsize_t>(components(field, scene.space));
    const record::Dims row = {count, items, width};
    TableReader& table = kind.fields[static_cast<std::size_t>(field)];
    table = precision == Precision::f32 ? TableReader::open<float>(group, info(field).name, row)
                                        : TableReader::open<double>(group, info(field).name, row);
    table.expect_rows(steps.size());
  }
  if (record::has_link(group, "contacts")) {
    described("contacts: ", [&] { open_contacts(record::open_group(group, "contacts"), kind); });
  }
  first_world.push_back(worlds() + static_cast<int>(count));
  kinds.push_back(std::move(kind));
}

Recording::Impl::Place Recording::Impl::place(int world) const {
  check_index("world", world, static_cast<std::size_t>(worlds()));
  std::size_t kind = 0;
  while (world >= first_world[kind + 1]) ++kind;
  return {kind, static_cast<std::size_t>(world - first_world[kind])};
}

std::vector<double> Recording::Impl::read(Field field, std::size_t kind, std::int64_t sample,
                                          std::int64_t world) const {
  const Kind& k = kinds[kind];
  if (k.plan.numbers(field) == 0) return {};
  const TableReader& table = k.fields[static_cast<std::size_t>(field)];
  const auto row = static_cast<hsize_t>(sample);
  return sound(storage.get(), [&]() -> std::vector<double> {
    if (precision == Precision::f64) return table.read<double>(row, 1, world);
    const std::vector<float> values = table.read<float>(row, 1, world);
    return {values.begin(), values.end()};
  });
}

// ---- the public face ---------------------------------------------------------------------------

namespace {

template <class Item>
const Item& at(const std::vector<Item>& items, const char* what, std::int64_t index) {
  check_index(what, index, items.size());
  return items[static_cast<std::size_t>(index)];
}

}  // namespace

Recording::Recording(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}
Recording::~Recording() {
  if (!impl_) return;
  const record::UsingHdf5 hdf5;
  impl_.reset();
}

const Recording::Impl& Recording::impl() const {
  if (!impl_)
    throw std::invalid_argument(
        "Recording was moved from: it can only be assigned to or destroyed");
  return *impl_;
}

Recording Recording::open(const std::filesystem::path& file) {
  const std::string label = label_of(file);
  return described(label, [&] {
    const record::UsingHdf5 hdf5;
    std::error_code ignored;  // what cannot be looked at cannot be read either, and is said below
    const std::filesystem::file_status kind = std::filesystem::status(file, ignored);
    if (std::filesystem::is_directory(kind)) throw RecordError("is a directory");
    if (std::filesystem::exists(kind) && !std::filesystem::is_regular_file(kind)) {
      throw RecordError("is not a regular file; expected a recording");
    }
    const bool part = record::is_part(file);
    std::shared_ptr<record::Storage> storage;
    if (part) {
      storage = std::make_shared<record::PartImage>(file);
    } else {
      record::check_frame(file);
      storage = std::make_shared<record::FinishedFile>(file);
    }
    return sound(storage.get(), [&] {
      auto impl = std::make_unique<Impl>(record::open_file(storage), label, storage);
      impl->finished = !part;
      return Recording(std::move(impl));
    });
  });
}

Recording Recording::from_bytes(std::span<const std::byte> bytes) {
  const std::string label = "recording: ";
  return described(label, [&] {
    const record::UsingHdf5 hdf5;
    record::check_frame(bytes);
    return Recording(std::make_unique<Impl>(record::open_bytes(bytes), label));
  });
}

std::vector<std::filesystem::path> unfinished_recordings(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> found;
  try {
    found = leftover_parts(file);
  } catch (const FileError& error) {
    throw RecordError(error.what());
  }
  std::erase_if(found, [](const auto& part) { return !record::is_part_or_finished(part); });
  return found;
}

bool Recording::finished() const { return impl().finished; }
int Recording::worlds() const { return impl().worlds(); }
int Recording::kinds() const { return static_cast<int>(impl().kinds.size()); }
const Plan& Recording::plan(int kind) const { return at(impl().kinds, "kind", kind).plan; }
int Recording::worlds_of(int kind) const {
  return static_cast<int>(at(impl().kinds, "kind", kind).worlds.size());
}
std::int64_t Recording::name_of(int world) const {
  const auto p = impl().place(world);
  return impl().kinds[p.kind].worlds[p.world];
}
std::int64_t Recording::samples() const { return static_cast<std::int64_t>(impl().steps.size()); }
std::int64_t Recording::step(std::int64_t sample) const {
  return at(impl().steps, "sample", sample);
}
std::int64_t Recording::inputs() const { return static_cast<std::int64_t>(impl().inputs.size()); }
Precision Recording::precision() const { return impl().precision; }
bool Recording::sleep() const { return impl().sleep; }
std::uint64_t Recording::hash(std::int64_t sample, int world) const {
  const auto p = impl().place(world);
  const auto& kind = impl().kinds[p.kind];
  check_index("sample", sample, impl().steps.size());
  return kind.hashes[static_cast<std::size_t>(sample) * kind.worlds.size() + p.world];
}
Status Recording::status(std::int64_t sample, int world) const {
  const auto p = impl().place(world);
  const auto& kind = impl().kinds[p.kind];
  const std::size_t at = static_cast<std::size_t>(sample) * kind.worlds.size() + p.world;
  check_index("sample", sample, impl().steps.size());
  return static_cast<Status>(kind.statuses[at]);
}
std::vector<double> Recording::read(Field field, std::int64_t sample, int world) const {
  checked_enum(field);
  check_index("sample", sample, impl().steps.size());
  const record::UsingHdf5 hdf5;
  const auto p = impl().place(world);
  return described(impl().label, [&] {
    return impl().read(field, p.kind, sample, static_cast<std::int64_t>(p.world));
  });
}
bool Recording::has_contacts() const { return !impl().kinds.front().contacts.end.empty(); }
std::vector<RecordedContact> Recording::contacts(std::int64_t sample, int world) const {
  check_index("sample", sample, impl().steps.size());
  const record::UsingHdf5 hdf5;
  const auto p = impl().place(world);
  return described(impl().label, [&] {
    return sound(impl().storage.get(),
                 [&] { return impl().read_contacts(p.kind, sample, p.world, 1); });
  });
}
int Recording::contacts_found(std::int64_t sample, int world) const {
  check_index("sample", sample, impl().steps.size());
  const auto p = impl().place(world);
  const auto& kind = impl().kinds[p.kind];
  if (kind.contacts.end.empty()) return 0;
  return kind.contacts.found[static_cast<std::size_t>(sample) * kind.worlds.size() + p.world];
}
std::string Recording::origin() const { return impl().origin; }

}  // namespace manyworlds
