// Dumps of lost worlds: a world that is lost is stepped once more by itself, from the last
// checkpoint and with its inputs, into a recording.
#include <exception>
#include <new>
#include <unordered_set>
#include <utility>

#include "manyworlds/record.hpp"
#include "src/base/output_file.hpp"
#include "src/base/output_folder.hpp"
#include "src/base/pimpl.hpp"
#include "src/record/inputs.hpp"

namespace manyworlds {

struct LostWorldDumps::Listener final : BatchListener {
  Listener(const Batch& batch, std::filesystem::path folder, const Options& options)
      : folder_(std::move(folder)), options_(options) {
    if (options.checkpoint_steps < 1 || options.max_files < 0) {
      throw std::invalid_argument(
          "dumps of lost worlds: checkpoint_steps is " + std::to_string(options.checkpoint_steps) +
          ", must be >= 1; max_files is " + std::to_string(options.max_files) + ", must be >= 0");
    }
    if (batch.forces_pending()) {
      throw std::invalid_argument(
          "dumps of lost worlds: forces are pending for the next step, which dumps would miss; "
          "start them before adding forces");
    }
    try {
      make_folder(folder_);
    } catch (const FileError& error) {
      throw RecordError(error.what());
    }
    for (int w = 0; w < batch.worlds(); ++w) {
      if (lost(batch.status(w))) seen_.insert(w);
    }
    checkpoint(batch);
  }

  void on_input(const Batch& batch, const InputCall& call) noexcept override {
    guarded([&] {
      log_.add(batch, call, call.world, steps_);
      // Where worlds step alone, no step of all may ever come.
      if (log_.rows().size() >= record::kRowsInMemory && !batch.forces_pending()) checkpoint(batch);
    });
  }

  void on_step(const Batch& batch, int n) noexcept override {
    guarded([&] {
      log_.stepped(n);
      steps_ += n;
      for (int w = 0; w < batch.worlds() && !full(); ++w) {
        if (lost(batch.status(w)) && seen_.insert(w).second) dump(batch, w);
      }
      if (steps_ >= options_.checkpoint_steps) checkpoint(batch);
    });
  }

  std::vector<std::filesystem::path> close() {
    try {
      if (failure_) std::rethrow_exception(failure_);
    } catch (const std::bad_alloc&) {
      throw RecordError("dumps of lost worlds: not enough memory");
    } catch (const std::exception& error) {
      throw RecordError(error.what());
    }
    return files_;
  }

 private:
  bool full() const { return static_cast<int>(files_.size()) >= options_.max_files; }

  template <class Do>
  void guarded(Do&& what) noexcept {
    if (failure_ || full()) return;
    try {
      what();
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  void checkpoint(const Batch& batch) {
    start_ = batch.save();
    log_.clear();
    steps_ = 0;
  }

  void dump(const Batch& batch, int world) {
    BatchOptions options;
    options.threads = 1;
    options.seed = batch.seed() + static_cast<std::uint64_t>(world);
    options.precision = batch.precision();
    options.isa = batch.isa();
    options.sleep = batch.sleeps();
    Batch single(batch.plan(batch.kind_of(world)), options);
    single.restore(start_, world, 0);
    const std::int64_t name = options_.first_world + world;
    const auto file = folder_ / ("world_" + std::to_string(name) + ".h5");
    Recorder recorder(single, file, {.every = 0, .first_world = name});
    std::int64_t at = 0;
    int call_steps = 0;
    for (const record::InputRow& row : log_.rows()) {
      if (row.world != world) continue;
      advance_until_lost(single, at, row.step, call_steps);
      if (lost(single.status(0))) break;
      const auto begin = static_cast<std::size_t>(row.begin);
      const auto count = static_cast<std::size_t>(row.count);
      const bool state = record::brings_state(row.input);
      record::apply(
          single, row, 0,
          state ? std::span<const double>() : std::span(log_.values()).subspan(begin, count),
          state ? std::span(log_.states()).subspan(begin, count) : std::span<const std::uint8_t>());
      if (row.call_steps > 0) call_steps = row.call_steps;
    }
    advance_until_lost(single, at, steps_, call_steps);
    recorder.sample(single);
    recorder.close();
    files_.push_back(file);
  }

  static void advance_until_lost(Batch& single, std::int64_t& at, std::int64_t step,
                                 int& call_steps) {
    while (at < step && !lost(single.status(0))) {
      record::advance(single, at, call_steps > 0 ? at + call_steps : at + 1, call_steps);
    }
  }

  std::filesystem::path folder_;
  Options options_;
  Snapshot start_;  // of the last checkpoint
  record::InputLog log_;
  std::int64_t steps_ = 0;        // since then
  std::unordered_set<int> seen_;  // lost before, or dumped
  std::vector<std::filesystem::path> files_;
  std::exception_ptr failure_;  // the first
};

struct LostWorldDumps::Impl {
  static constexpr const char* kName = "LostWorldDumps";

  std::shared_ptr<Listener> listener;  // null: closed

  Impl(Batch& batch, std::filesystem::path folder, const Options& options)
      : listener(std::make_shared<Listener>(batch, std::move(folder), options)) {
    batch.listen(listener);
  }
};

LostWorldDumps::LostWorldDumps(Batch& batch, std::filesystem::path folder, const Options& options)
    : impl_(Pimpl<Impl>::make(batch, std::move(folder), options)) {}
LostWorldDumps::LostWorldDumps(Batch& batch, std::filesystem::path folder)
    : LostWorldDumps(batch, std::move(folder), Options{}) {}
LostWorldDumps::LostWorldDumps(LostWorldDumps&&) noexcept = default;
LostWorldDumps& LostWorldDumps::operator=(LostWorldDumps&&) noexcept = default;
LostWorldDumps::~LostWorldDumps() = default;

std::vector<std::filesystem::path> LostWorldDumps::close() {
  const auto listener = std::exchange(impl_->listener, nullptr);
  return listener ? listener->close() : std::vector<std::filesystem::path>();
}

}  // namespace manyworlds
