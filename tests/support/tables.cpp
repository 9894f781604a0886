#include "tests/support/tables.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

bool runs(const Plan& plan, const Table& table) {
  try {
    const Batch batch(plan, options_of(table));
    return batch.isa() == table.isa && batch.precision() == table.precision;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

std::string name(const Table& table) {
  return std::string(to_string(table.isa)) + " " + to_string(table.precision);
}

const std::vector<Table>& all_tables() {
  static const std::vector<Table> tables = [] {
    Scene scene = empty_scene(Space::spatial);
    scene.add(body_of(shape_of(Sphere{}), Vec3::Zero()));
    const Plan plan = compile(scene);
    std::vector<Table> result;
    for (Isa isa : available_isas()) {
      if (std::getenv("MANYWORLDS_ISA") != nullptr && isa != default_isa()) continue;
      for (Precision precision : {Precision::f32, Precision::f64})
        if (runs(plan, {isa, precision})) result.push_back({isa, precision});
    }
    return result;
  }();
  return tables;
}

bool has_table(const Table& table) {
  return std::any_of(all_tables().begin(), all_tables().end(), [&](const Table& t) {
    return t.isa == table.isa && t.precision == table.precision;
  });
}

std::vector<Table> widest_tables() {
  std::vector<Table> result;
  for (Precision precision : {Precision::f32, Precision::f64}) {
    const Table* widest = nullptr;
    for (const Table& t : all_tables())
      if (t.precision == precision && t.isa <= default_isa()) widest = &t;
    if (widest != nullptr) result.push_back(*widest);
  }
  return result;
}

Isa widest_of(Precision precision) {
  Isa widest = Isa::scalar;
  for (const Table& table : widest_tables()) {
    if (table.precision == precision) widest = table.isa;
  }
  return widest;
}

BatchOptions options_of(const Table& table, int worlds, int threads) {
  BatchOptions o;
  o.worlds = worlds;
  o.threads = threads;
  o.isa = table.isa;
  o.precision = table.precision;
  return o;
}

}  // namespace manyworlds::test
