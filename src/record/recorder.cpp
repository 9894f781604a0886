// Writes a recording: the scenes and the snapshot at once, inputs and samples as they come.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <system_error>
#include <utility>

#include "manyworlds/record.hpp"
#include "src/record/frame.hpp"
#include "src/record/h5.hpp"
#include "src/record/inputs.hpp"
#include "src/record/layout.hpp"

namespace manyworlds {

namespace {

using record::Table;

constexpr std::size_t kFieldChunk = std::size_t{1} << 16;  // bytes
constexpr std::size_t kStartChunk = std::size_t{1} << 20;
constexpr std::size_t kColumnChunk = std::size_t{1} << 12;  // bytes
constexpr std::size_t kSmallChunk = 256;                    // bytes; where there are few samples

std::vector<int> checked_worlds(const Batch& batch, const RecordOptions& options) {
  if (options.every < 0) {
    throw std::invalid_argument("record: every is " + std::to_string(options.every) +
                                ", must be >= 0");
  }
  if (batch.forces_pending()) {
    throw std::invalid_argument(
        "record: forces were added for the next step, which the recording would not know of");
  }
  std::vector<int> worlds = options.worlds;
  if (worlds.empty()) {
    worlds.resize(static_cast<std::size_t>(std::min(batch.worlds(), kMostWorldsByDefault)));
    std::iota(worlds.begin(), worlds.end(), 0);
  }
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    if (worlds[i] < 0 || worlds[i] >= batch.worlds()) {
      throw std::invalid_argument("record: world " + std::to_string(worlds[i]) +
                                  " is not one of the batch's " + std::to_string(batch.worlds()));
    }
    if (i > 0 && worlds[i] <= worlds[i - 1]) {
      throw std::invalid_argument("record: worlds must ascend, " + std::to_string(worlds[i]) +
                                  " comes after " + std::to_string(worlds[i - 1]));
    }
  }
  return worlds;
}

// What is recorded of one kind of world.
struct KindTables {
  std::vector<int> worlds;  // of the batch
  int bodies = 0;
  Space space = Space::spatial;
  record::Handle group;
  std::array<Table, kFieldCount> fields;
  Table hash, status;
};

struct InputTables {
  Table step, call_steps, input, world, body, begin, count, values, states;
};

}  // namespace

struct Recorder::Impl final : BatchListener {
  Impl(const Batch& batch, std::filesystem::path path, const RecordOptions& options);
  ~Impl() override { discard(); }
  void on_input(const Batch& batch, const InputCall& call) noexcept override;
  void on_step(const Batch& batch, int n) noexcept override;
  void sample_now(const Batch& batch) noexcept {
    guarded([&] { sample(batch); });
  }
  void close();

 private:
  void sample(const Batch& batch);
  void describe(const Batch& batch);
  void make_kind(const Batch& batch, int kind, std::vector<int> worlds);
  void make_inputs();
  void write_inputs();
  template <class Real>
  void add_fields(const Batch& batch, KindTables& kind);
  template <class Do>
  void guarded(Do&& what) noexcept;
  void close_tables() noexcept;
  void discard() noexcept;

  std::filesystem::path file_, part_;
  RecordOptions options_;
  std::vector<int> place_;  // [world of the batch] in the recording, -1: not in it
  record::Handle h5_, root_kinds_, root_inputs_;
  std::vector<KindTables> kinds_;
  InputTables columns_;
  Table step_, time_, inputs_before_;
  record::InputLog log_;
  std::int64_t numbers_written_ = 0, bytes_written_ = 0, inputs_ = 0;
  std::int64_t steps_ = 0, next_ = 0, sampled_step_ = -1, sampled_inputs_ = -1;
  std::string failure_;

 public:
  std::int64_t samples = 0;
};

Recorder::Impl::Impl(const Batch& batch, std::filesystem::path path, const RecordOptions& options)
    : file_(std::move(path)), part_(file_), options_(options) {
  options_.worlds = checked_worlds(batch, options);
  if (std::filesystem::is_directory(file_)) {
    throw RecordError("'" + file_.string() + "': is a directory");
  }
  static std::atomic<std::uint64_t> count = 0;  // two at a time may write the same file
  part_ += ".part" + std::to_string(getpid()) + "_" + std::to_string(count++);
  const record::UsingHdf5 hdf5;
  try {
    h5_ = record::create_file(part_);
    describe(batch);
    root_kinds_ = record::create_group(h5_, "kinds");
    place_.assign(static_cast<std::size_t>(batch.worlds()), -1);
    std::vector<std::vector<int>> of_kind(static_cast<std::size_t>(batch.kinds()));
    for (std::size_t i = 0; i < options_.worlds.size(); ++i) {
      const int world = options_.worlds[i];
      place_[static_cast<std::size_t>(world)] = static_cast<int>(i);
      of_kind[static_cast<std::size_t>(batch.kind_of(world))].push_back(world);
    }
    for (std::size_t k = 0; k < of_kind.size(); ++k) {
      if (!of_kind[k].empty()) make_kind(batch, static_cast<int>(k), std::move(of_kind[k]));
    }
    const Snapshot snapshot = batch.save(options_.worlds);
    Table start =
        Table::create<std::uint8_t>(h5_, "start", {}, std::min(snapshot.size(), kStartChunk));
    start.add_bytes(snapshot.bytes());
    start.flush();
    make_inputs();
    sample(batch);
  } catch (...) {
    discard();
    throw;
  }
  next_ = options_.every;
}

void Recorder::Impl::describe(const Batch& batch) {
  record::write_text(h5_, "format", record::kFormat);
  record::write_number(h5_, "format_version", record::kFormatVersion);
  record::write_text(h5_, "program_version", MW_VERSION);
  record::write_text(h5_, "precision", to_string(batch.precision()));
  record::write_number(h5_, "sleep", static_cast<std::uint8_t>(batch.sleeps() ? 1 : 0));
  record::write_number(h5_, "seed", batch.seed());
  record::write_number(h5_, "batch_worlds", std::int64_t{batch.worlds()});
  record::write_number(h5_, "dt", batch.plan().scene().options.dt);
  record::write_number(h5_, "every", std::int32_t{options_.every});
  record::write_text(h5_, "isa", to_string(batch.isa()));
  record::write_number(h5_, "threads", std::int32_t{batch.threads()});
}

void Recorder::Impl::make_kind(const Batch& batch, int index, std::vector<int> worlds) {
  KindTables kind;
  kind.group = record::create_group(root_kinds_, std::to_string(kinds_.size()));
  const Plan& plan = batch.plan(index);
  record::write_text(kind.group, "name", plan.scene().name);
  record::write_number(kind.group, "fingerprint", plan.fingerprint());
  record::write_text_table(kind.group, "scene", scene_to_json(plan.scene()));
  record::write_text_table(kind.group, "plan_options", plan_options_to_json(plan.options()));
  kind.bodies = plan.bodies();
  kind.space = plan.scene().space;

  const hsize_t count = worlds.size(), bodies = static_cast<hsize_t>(kind.bodies);
  Table names = Table::create<std::int64_t>(kind.group, "world", {}, count * sizeof(std::int64_t));
  for (const int world : worlds) names.add(options_.first_world + world);
  names.flush();
  // Without regular samples there are two.
  const std::size_t chunk = options_.every == 0 ? 1 : kFieldChunk;
  kind.hash = Table::create<std::uint64_t>(kind.group, "hash", {count}, chunk);
  kind.status = Table::create<std::uint32_t>(kind.group, "status", {count}, chunk);
  for (const Field field : record::kFields) {
    if (bodies == 0) break;
    const FieldInfo& about = info(field);
    const record::Dims row = {count, bodies, static_cast<hsize_t>(components(field, kind.space))};
    Table& table = kind.fields[static_cast<std::size_t>(field)];
    table = batch.precision() == Precision::f32
                ? Table::create<float>(kind.group, about.name, row, chunk)
                : Table::create<double>(kind.group, about.name, row, chunk);
    record::write_text(table.dataset(), "unit", about.unit);
    record::write_text(table.dataset(), "frame", about.meaning);
    record::write_text(table.dataset(), "axes", "sample world body component");
    record::write_text(table.dataset(), "components", record::component_names(field, kind.space));
  }
  kind.worlds = std::move(worlds);
  kinds_.push_back(std::move(kind));
}

void Recorder::Impl::make_inputs() {
  const std::size_t chunk = options_.every == 0 ? kSmallChunk : kColumnChunk;
  step_ = Table::create<std::int64_t>(h5_, "step", {}, chunk);
  time_ = Table::create<double>(h5_, "time", {}, chunk);
  inputs_before_ = Table::create<std::int64_t>(h5_, "inputs_before", {}, chunk);
  record::write_text(time_.dataset(), "unit", "s");
  root_inputs_ = record::create_group(h5_, "inputs");
  std::string words;
  for (int i = 0; i < kInputCount; ++i) {
    words += (i > 0 ? " " : "") + std::string(to_string(static_cast<Input>(i)));
  }
  const auto column = [&]<class T>(T, const char* name) {
    return Table::create<T>(root_inputs_, name, {}, chunk);
  };
  columns_ = {column(std::int64_t{}, "step"),  column(std::int32_t{}, "call_steps"),
              column(std::uint8_t{}, "input"), column(std::int32_t{}, "world"),
              column(std::int32_t{}, "body"),  column(std::int64_t{}, "begin"),
              column(std::int64_t{}, "count"), column(double{}, "values"),
              column(std::uint8_t{}, "states")};
  record::write_text(columns_.input.dataset(), "names", words);
}

void Recorder::Impl::write_inputs() {
  for (const record::InputRow& row : log_.rows()) {
    columns_.step.add(row.step);
    columns_.call_steps.add(row.call_steps);
    columns_.input.add(static_cast<std::uint8_t>(row.input));
    columns_.world.add(row.world);
    columns_.body.add(row.body);
    columns_.begin.add(row.begin +
                       (record::brings_state(row.input) ? bytes_written_ : numbers_written_));
    columns_.count.add(row.count);
  }
  columns_.values.add(log_.values());
  columns_.states.add(log_.states());
  numbers_written_ += static_cast<std::int64_t>(log_.values().size());
  bytes_written_ += static_cast<std::int64_t>(log_.states().size());
  log_.clear();
}

// Nothing may come out of a step. What fails is said by close(); nothing more is written.
template <class Do>
void Recorder::Impl::guarded(Do&& what) noexcept {
  if (!failure_.empty()) return;
  const record::UsingHdf5 hdf5;
  try {
    what();
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

template <class Real>
void Recorder::Impl::add_fields(const Batch& batch, KindTables& kind) {
  std::vector<double> values;
  std::vector<Real> row;
  for (const Field field : record::kFields) {
    values.resize(static_cast<std::size_t>(kind.bodies * components(field, kind.space)));
    for (const int world : kind.worlds) {
      batch.read(field, world, values);
      row.clear();
      for (const double x : values) row.push_back(static_cast<Real>(x));
      kind.fields[static_cast<std::size_t>(field)].add(row);
    }
  }
}

void Recorder::Impl::sample(const Batch& batch) {
  if (sampled_step_ == steps_ && sampled_inputs_ == inputs_) return;
  step_.add(steps_);
  time_.add(batch.time());
  inputs_before_.add(inputs_);
  for (KindTables& kind : kinds_) {
    for (const int world : kind.worlds) {
      kind.hash.add(batch.hash(world));
      kind.status.add(static_cast<std::uint32_t>(batch.status(world)));
    }
    if (kind.bodies == 0) continue;
    batch.precision() == Precision::f32 ? add_fields<float>(batch, kind)
                                        : add_fields<double>(batch, kind);
  }
  sampled_step_ = steps_;
  sampled_inputs_ = inputs_;
  ++samples;
}

void Recorder::Impl::on_input(const Batch& batch, const InputCall& call) noexcept {
  const int place = place_[static_cast<std::size_t>(call.world)];
  if (place < 0) return;
  guarded([&] {
    log_.add(batch, call, place, steps_);
    ++inputs_;
    // Where worlds step alone, no step of all may ever come.
    if (log_.rows().size() < record::kRowsInMemory || batch.forces_pending()) return;
    log_.stepped(0);
    write_inputs();
  });
}

void Recorder::Impl::on_step(const Batch& batch, int n) noexcept {
  guarded([&] {
    log_.stepped(n);
    if (log_.rows().size() >= record::kRowsInMemory) write_inputs();
    steps_ += n;
    if (options_.every == 0 || steps_ < next_) return;
    sample(batch);
    next_ = (steps_ / options_.every + 1) * options_.every;
  });
}

void Recorder::Impl::close() {
  const record::UsingHdf5 hdf5;
  if (!failure_.empty()) throw RecordError("'" + file_.string() + "': " + failure_);
  write_inputs();
  for (Table* table : {&step_, &time_, &inputs_before_, &columns_.step, &columns_.call_steps,
                       &columns_.input, &columns_.world, &columns_.body, &columns_.begin,
                       &columns_.count, &columns_.values, &columns_.states}) {
    table->flush();
  }
  for (KindTables& kind : kinds_) {
    kind.hash.flush();
    kind.status.flush();
    for (Table& table : kind.fields) table.flush();
  }
  close_tables();
  record::check(H5Fflush(h5_, H5F_SCOPE_LOCAL), "cannot write '" + file_.string() + "'");
  h5_ = {};
  record::seal(part_);
  std::error_code error;
  std::filesystem::rename(part_, file_, error);
  if (error) throw RecordError("cannot write '" + file_.string() + "': " + error.message());
}

// A file is closed when all in it is.
void Recorder::Impl::close_tables() noexcept {
  columns_ = {};
  for (Table* table : {&step_, &time_, &inputs_before_}) *table = {};
  kinds_.clear();
  root_kinds_ = {};
  root_inputs_ = {};
}

void Recorder::Impl::discard() noexcept {
  const record::UsingHdf5 hdf5;
  close_tables();
  h5_ = {};
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

Recorder::Recorder(Batch& batch, const std::filesystem::path& file, const RecordOptions& options)
    : impl_(std::make_shared<Impl>(batch, file, options)) {
  batch.listen(impl_);
}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

void Recorder::sample(const Batch& batch) {
  if (impl_) impl_->sample_now(batch);
}

void Recorder::close() {
  // Gone in any case, and with it what was not finished.
  if (const auto impl = std::exchange(impl_, nullptr)) {
    samples_ = impl->samples;
    impl->close();
  }
}
std::int64_t Recorder::samples() const { return impl_ ? impl_->samples : samples_; }

}  // namespace manyworlds
