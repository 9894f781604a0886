// What an open recording consists of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "manyworlds/record.hpp"
#include "src/record/h5.hpp"
#include "src/record/inputs.hpp"
#include "src/record/layout.hpp"
#include "src/record/storage.hpp"

namespace manyworlds {

struct Recording::Impl {
  // Of a kind, where they were recorded: see ContactTables.
  struct Contacts {
    std::vector<std::int64_t> end;    // [sample][world]; empty: they were not
    std::vector<std::int32_t> found;  // [sample][world]
    record::TableReader body_a, body_b, point, normal, force;
  };
  struct Kind {
    Plan plan;
    std::vector<std::int64_t> worlds;   // what they were called
    std::vector<std::uint64_t> hashes;  // [sample][world]
    std::vector<std::uint32_t> statuses;
    std::array<record::TableReader, kFieldCount> fields;  // left out where nothing has a state
    Contacts contacts = {};
  };
  struct Place {
    std::size_t kind, world;
  };

  // Checks everything; throws RecordError, SceneError and SnapshotError. `lies_on` may be null.
  Impl(record::Handle file, std::string called, std::shared_ptr<record::Storage> lies_on = nullptr);

  Place place(int world) const;  // throws std::invalid_argument
  Space space() const { return kinds.front().plan.scene().space; }
  int worlds() const { return first_world.back(); }
  // Of one input, as apply() takes them.
  std::span<const double> values(const record::InputRow& row) const;
  std::span<const std::uint8_t> state(const record::InputRow& row) const;
  // Of `worlds` worlds of a kind from `first` on, one after the other.
  std::vector<RecordedContact> read_contacts(std::size_t kind, std::int64_t sample,
                                             std::size_t first, std::size_t worlds) const;
  // One sample of a field of a kind, [world][body][component], or of one world of it.
  std::vector<double> read(Field field, std::size_t kind, std::int64_t sample,
                           std::int64_t world = -1) const;

  std::shared_ptr<record::Storage> storage;
  record::Handle h5;
  std::string label;  // what errors begin with, "'run.h5': "
  bool finished = true;
  Precision precision = Precision::f32;
  bool sleep = false;
  std::string origin;
  std::vector<Kind> kinds;
  std::vector<int> first_world;  // of each kind, and the total
  Snapshot start;
  std::vector<std::int64_t> steps, inputs_before;  // [sample]
  std::vector<record::InputRow> inputs;
  std::vector<double> input_values;
  std::vector<std::uint8_t> input_states;

 private:
  void read_head();
  void read_kind(hid_t parent, int index);
  void read_samples();
  void open_contacts(hid_t group, Kind& kind) const;
  void read_inputs();
  void check_input(std::size_t index, std::int64_t values, std::int64_t states) const;
  void check_order() const;
};

}  // namespace manyworlds
