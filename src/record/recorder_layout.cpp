// What a recording holds from its beginning: attributes, scenes, and the empty tables.
#include <algorithm>
#include <utility>

#include "src/record/frame.hpp"
#include "src/record/recorder.hpp"

namespace manyworlds {

using record::KindTables, record::Table;

namespace {

constexpr std::size_t kFieldChunk = std::size_t{1} << 16;   // bytes
constexpr std::size_t kColumnChunk = std::size_t{1} << 12;  // bytes
constexpr std::size_t kSmallChunk = 256;                    // bytes; where there are few samples

}  // namespace

void Recorder::Listener::describe(const Batch& batch) {
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

void Recorder::Listener::make_kind(const Batch& batch, int index, std::vector<int> worlds) {
  KindTables kind;
  kind.group = record::create_group(root_kinds_, std::to_string(kinds_.size()));
  const Plan& plan = batch.plan(index);
  record::write_text(kind.group, "name", plan.scene().name);
  record::write_number(kind.group, "fingerprint", plan.fingerprint());
  record::write_text_table(kind.group, "scene", scene_to_json(plan.scene()));
  record::write_text_table(kind.group, "plan_options", plan_options_to_json(plan.options()));
  const Space space = plan.scene().space;

  const hsize_t count = worlds.size();
  Table names = Table::create<std::int64_t>(kind.group, "world", {}, count * sizeof(std::int64_t));
  for (const int world : worlds) names.add(options_.first_world + world);
  names.flush();
  // Without regular samples there are two.
  const std::size_t chunk = options_.every == 0 ? 1 : kFieldChunk;
  kind.hash = Table::create<std::uint64_t>(kind.group, "hash", {count}, chunk);
  kind.status = Table::create<std::uint32_t>(kind.group, "status", {count}, chunk);
  for (const Field field : kFields) {
    const FieldInfo& about = info(field);
    kind.numbers[static_cast<std::size_t>(field)] = plan.numbers(field);
    const auto items = static_cast<hsize_t>(plan.items(about.item));
    if (items == 0) continue;
    const record::Dims row = {count, items, static_cast<hsize_t>(components(field, space))};
    Table& table = kind.fields[static_cast<std::size_t>(field)];
    table = batch.precision() == Precision::f32
                ? Table::create<float>(kind.group, about.name, row, chunk)
                : Table::create<double>(kind.group, about.name, row, chunk);
    record::write_text(table.dataset(), "unit", about.unit);
    record::write_text(table.dataset(), "frame", about.meaning);
    record::write_text(table.dataset(), "axes",
                       std::string("sample world ") + to_string(about.item) + " component");
    record::write_text(table.dataset(), "components", component_names(field, space));
  }
  kind.worlds = std::move(worlds);
  if (options_.contacts > 0) make_contacts(batch, kind, space);
  kinds_.push_back(std::move(kind));
}

void Recorder::Listener::make_inputs() {
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

}  // namespace manyworlds
