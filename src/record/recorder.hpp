// What a Recorder consists of while it records.
#pragma once

#include <array>
#include <chrono>
#include <exception>
#include <memory>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/record/h5.hpp"
#include "src/record/inputs.hpp"
#include "src/record/layout.hpp"
#include "src/record/storage.hpp"

namespace manyworlds {

namespace record {

// Points of all worlds and samples, one after the other: those of a world at a sample end at `end`
// and begin where those before it end.
struct ContactTables {
  Table end, found;                            // [sample][world]
  Table body_a, body_b, point, normal, force;  // [point]
  std::int64_t points = 0;
};

// What is recorded of one kind of world.
struct KindTables {
  std::vector<int> worlds;                         // of the batch
  std::array<std::size_t, kFieldCount> numbers{};  // of a world
  record::Handle group;
  std::array<Table, kFieldCount> fields;
  Table hash, status;
  record::Handle contacts_group;
  ContactTables contacts;  // empty where they are not asked for
};

// All of them.
std::array<Table*, 7> tables_of(ContactTables& contacts);
// Throws std::invalid_argument where the batch does not observe what is asked for.
void check_contacts(const Batch& batch, const RecordOptions& options);

struct InputTables {
  Table step, call_steps, input, world, body, begin, count, values, states;
};

}  // namespace record

struct Recorder::Listener final : BatchListener {
  Listener(const Batch& batch, const std::filesystem::path& path, const RecordOptions& options);
  ~Listener() override { discard(); }
  void on_input(const Batch& batch, const InputCall& call) noexcept override;
  void on_step(const Batch& batch, int n) noexcept override;
  void sample_now(const Batch& batch) noexcept;
  void close();

 private:
  void sample(const Batch& batch);
  void describe(const Batch& batch);
  void make_kind(const Batch& batch, int kind, std::vector<int> worlds);
  void make_inputs();
  void make_contacts(const Batch& batch, record::KindTables& kind, Space space);
  void write_inputs();
  void flush_tables();
  void flush_if_due();
  template <class Real>
  void add_fields(const Batch& batch, record::KindTables& kind);
  template <class Real>
  void add_contacts(const Batch& batch, record::KindTables& kind);
  template <class Do>
  void guarded(Do&& what) noexcept;
  void close_tables() noexcept;
  void discard() noexcept;
  void finish();
  [[noreturn]] void fail();

  using Clock = std::chrono::steady_clock;

  std::shared_ptr<record::RecordingFile> file_;
  RecordOptions options_;
  std::vector<int> place_;  // [world of the batch] in the recording, -1: not in it
  record::Handle h5_, root_kinds_, root_inputs_;
  std::vector<record::KindTables> kinds_;
  record::InputTables columns_;
  record::Table step_, time_, inputs_before_;
  record::InputLog log_;
  std::int64_t numbers_written_ = 0, bytes_written_ = 0, inputs_ = 0;
  std::int64_t steps_ = 0, next_ = 0, sampled_step_ = -1, sampled_inputs_ = -1;
  std::int64_t flushed_step_ = 0;  // the last one in what a program that is cut off leaves behind
  Clock::time_point flushed_ = Clock::now();
  std::exception_ptr failure_;  // the first

 public:
  std::int64_t samples = 0;
};

}  // namespace manyworlds
