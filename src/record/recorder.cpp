// Writes a recording: the scenes and the snapshot at once, inputs and samples as they come.
#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <utility>

#include "src/base/pimpl.hpp"
#include "src/record/recorder.hpp"

namespace manyworlds {

using record::KindTables, record::Table;

namespace {

constexpr std::size_t kStartChunk = std::size_t{1} << 20;  // bytes

std::vector<int> checked_worlds(const Batch& batch, const RecordOptions& options) {
  if (options.every < 0) {
    throw std::invalid_argument("record: every is " + std::to_string(options.every) +
                                ", must be >= 0");
  }
  if (!(options.flush_seconds >= 0)) {
    throw std::invalid_argument("record: flush_seconds is " +
                                std::to_string(options.flush_seconds) + ", must be >= 0");
  }
  if (batch.forces_pending()) {
    throw std::invalid_argument(
        "record: forces are pending for the next step, which the recording would miss; start it "
        "before adding forces");
  }
  record::check_contacts(batch, options);
  std::vector<int> worlds = options.worlds;
  if (worlds.empty()) {
    worlds.resize(static_cast<std::size_t>(std::min(batch.worlds(), kMaxWorldsByDefault)));
    std::iota(worlds.begin(), worlds.end(), 0);
  }
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    if (worlds[i] < 0 || worlds[i] >= batch.worlds()) {
      throw std::invalid_argument("record: world " + std::to_string(worlds[i]) +
                                  " is not in the batch, must be 0 to " +
                                  std::to_string(batch.worlds() - 1));
    }
    if (i > 0 && worlds[i] <= worlds[i - 1]) {
      throw std::invalid_argument("record: worlds must ascend, " + std::to_string(worlds[i]) +
                                  " comes after " + std::to_string(worlds[i - 1]));
    }
  }
  return worlds;
}

std::shared_ptr<record::RecordingFile> create(const std::filesystem::path& path) {
  try {
    auto file = std::make_shared<record::RecordingFile>(path);
    const record::UsingHdf5 started;
    return file;
  } catch (const FileError& error) {
    throw RecordError(error.what());
  } catch (const std::bad_alloc&) {
    throw RecordError("'" + path.string() + "': not enough memory");
  }
}

}  // namespace

Recorder::Listener::Listener(const Batch& batch, const std::filesystem::path& path,
                             const RecordOptions& options)
    : options_(options) {
  options_.worlds = checked_worlds(batch, options);
  file_ = create(path);
  const record::UsingHdf5 hdf5;
  try {
    h5_ = record::create_file(file_);
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
    if (file_->failure()) std::rethrow_exception(file_->failure());
  } catch (...) {
    failure_ = file_->failure() ? file_->failure() : std::current_exception();
    discard();
    fail();
  }
  next_ = options_.every;
}

void Recorder::Listener::write_inputs() {
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

// Nothing may come out of a step. What fails is said by close(); nothing more is written. The file
// knows better than HDF5, which only hears of the consequences.
template <class Do>
void Recorder::Listener::guarded(Do&& what) noexcept {
  if (failure_) return;
  const record::UsingHdf5 hdf5;
  try {
    what();
    flush_if_due();
  } catch (...) {
    failure_ = std::current_exception();
  }
  if (file_->failure()) failure_ = file_->failure();
}

// So that what is older than that is not lost with the program. Forces that were added for the
// next step do not yet know how long they act.
void Recorder::Listener::flush_if_due() {
  const auto now = Clock::now();
  if (std::chrono::duration<double>(now - flushed_).count() < options_.flush_seconds) return;
  if (log_.has_open_forces()) return;
  flush_tables();
  record::need_room();
  record::check(H5Fflush(h5_, H5F_SCOPE_LOCAL), "cannot be written");
  file_->checkpoint();
  flushed_ = Clock::now();
  flushed_step_ = sampled_step_;
}

template <class Real>
void Recorder::Listener::add_fields(const Batch& batch, KindTables& kind) {
  std::vector<double> values;
  std::vector<Real> row;
  for (const Field field : kFields) {
    values.resize(kind.numbers[static_cast<std::size_t>(field)]);
    if (values.empty()) continue;
    for (const int world : kind.worlds) {
      batch.read(field, world, values);
      row.clear();
      for (const double x : values) row.push_back(static_cast<Real>(x));
      kind.fields[static_cast<std::size_t>(field)].add(row);
    }
  }
}

void Recorder::Listener::sample(const Batch& batch) {
  if (sampled_step_ == steps_ && sampled_inputs_ == inputs_) return;
  step_.add(steps_);
  time_.add(batch.time());
  inputs_before_.add(inputs_);
  for (KindTables& kind : kinds_) {
    for (const int world : kind.worlds) {
      kind.hash.add(batch.hash(world));
      kind.status.add(static_cast<std::uint32_t>(batch.status(world)));
    }
    batch.precision() == Precision::f32 ? add_fields<float>(batch, kind)
                                        : add_fields<double>(batch, kind);
    if (options_.contacts == 0) continue;
    batch.precision() == Precision::f32 ? add_contacts<float>(batch, kind)
                                        : add_contacts<double>(batch, kind);
  }
  sampled_step_ = steps_;
  sampled_inputs_ = inputs_;
  ++samples;
}

void Recorder::Listener::sample_now(const Batch& batch) noexcept {
  guarded([&] { sample(batch); });
}

void Recorder::Listener::on_input(const Batch& batch, const InputCall& call) noexcept {
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

void Recorder::Listener::on_step(const Batch& batch, int n) noexcept {
  guarded([&] {
    log_.stepped(n);
    if (log_.rows().size() >= record::kRowsInMemory) write_inputs();
    steps_ += n;
    if (options_.every == 0 || steps_ < next_) return;
    sample(batch);
    next_ = (steps_ / options_.every + 1) * options_.every;
  });
}

void Recorder::Listener::flush_tables() {
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
    for (Table* table : record::tables_of(kind.contacts)) table->flush();
  }
}

void Recorder::Listener::finish() {
  flush_tables();
  record::need_room();
  close_tables();
  record::check(H5Fflush(h5_, H5F_SCOPE_LOCAL), "cannot be written");
  h5_.close_now("cannot be closed");
  if (file_->has_checkpoint()) {
    file_->checkpoint();
    flushed_step_ = sampled_step_;
  }
  file_->finish();
}

void Recorder::Listener::close() {
  const record::UsingHdf5 hdf5;
  if (!failure_) {
    try {
      finish();
      return;
    } catch (...) {
      failure_ = file_->failure() ? file_->failure() : std::current_exception();
    }
  }
  if (file_->has_checkpoint()) file_->keep();
  fail();
}

void Recorder::Listener::fail() {
  const std::string file = file_->file().target().string();
  // Where memory ran out there may be none for words.
  std::string what = "'" + file + "': ";
  try {
    std::rethrow_exception(failure_);
  } catch (const FileError& error) {
    what += error.reason();
  } catch (const std::bad_alloc&) {
    what += "not enough memory";
  } catch (const std::exception& error) {
    what += error.what();
  }
  if (file_->has_checkpoint()) {
    const std::int64_t last = file_->sealed() ? sampled_step_ : flushed_step_;
    what += "; '" + file_->file().part().string() + "' holds the recording up to step " +
            std::to_string(last) + " and can be replayed";
  }
  throw RecordError(what);
}

// A file is closed when all in it is.
void Recorder::Listener::close_tables() noexcept {
  columns_ = {};
  for (Table* table : {&step_, &time_, &inputs_before_}) *table = {};
  kinds_.clear();
  root_kinds_ = {};
  root_inputs_ = {};
}

void Recorder::Listener::discard() noexcept {
  const record::UsingHdf5 hdf5;
  close_tables();
  h5_ = {};
}

struct Recorder::Impl {
  static constexpr const char* kName = "Recorder";

  std::shared_ptr<Listener> listener;  // null: closed
  std::int64_t samples = 0;            // by then

  Impl(Batch& batch, const std::filesystem::path& file, const RecordOptions& options)
      : listener(std::make_shared<Listener>(batch, file, options)) {
    batch.listen(listener);
  }
};

Recorder::Recorder(Batch& batch, const std::filesystem::path& file, const RecordOptions& options)
    : impl_(Pimpl<Impl>::make(batch, file, options)) {}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

void Recorder::sample(const Batch& batch) {
  if (const auto& listener = impl_->listener) listener->sample_now(batch);
}

void Recorder::close() {
  // Gone in any case, and with it what was not finished.
  if (const auto listener = std::exchange(impl_->listener, nullptr)) {
    impl_->samples = listener->samples;
    listener->close();
  }
}
std::int64_t Recorder::samples() const {
  return impl_->listener ? impl_->listener->samples : impl_->samples;
}

}  // namespace manyworlds
