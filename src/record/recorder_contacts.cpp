// The contacts of a recording: those that bore a force, the strongest where there are too many.
#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>

#include "src/record/recorder.hpp"

namespace manyworlds {

using record::ContactTables, record::KindTables, record::Table;

namespace {

constexpr std::size_t kManyPoints = std::size_t{1} << 16;  // bytes
constexpr std::size_t kFewPoints = 256;                    // bytes; where there are few samples

// Of `all` the points that bore a force, `most` of them; in their order.
std::vector<std::size_t> kept(const std::vector<StepContact>& all, int most, int& found) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].normal_impulse > 0) out.push_back(i);
  }
  found = static_cast<int>(out.size());
  if (found <= most) return out;
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) {
    return all[a].normal_impulse > all[b].normal_impulse;
  });
  out.resize(static_cast<std::size_t>(most));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

namespace record {

std::array<Table*, 7> tables_of(ContactTables& c) {
  return {&c.end, &c.found, &c.body_a, &c.body_b, &c.point, &c.normal, &c.force};
}

void check_contacts(const Batch& batch, const RecordOptions& options) {
  if (options.contacts < 0 || options.contacts > kMaxContactsRecorded) {
    throw std::invalid_argument("record: contacts is " + std::to_string(options.contacts) +
                                ", must be 0 to " + std::to_string(kMaxContactsRecorded));
  }
  if (options.contacts == 0) return;
  try {
    (void)batch.step_contacts(0);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(
        "record: the batch does not observe contacts; choose "
        "Observer::contacts in BatchOptions::observe");
  }
}

}  // namespace record

void Recorder::Listener::make_contacts(const Batch& batch, KindTables& kind, Space space) {
  const std::size_t chunk = options_.every == 0 ? kFewPoints : kManyPoints;
  const hsize_t worlds = kind.worlds.size(), width = space == Space::planar ? 2 : 3;
  kind.contacts_group = record::create_group(kind.group, "contacts");
  const hid_t to = kind.contacts_group;
  const bool f32 = batch.precision() == Precision::f32;
  const auto numbers = [&](const char* name, const record::Dims& row, const char* unit) {
    Table out = f32 ? Table::create<float>(to, name, row, chunk)
                    : Table::create<double>(to, name, row, chunk);
    record::write_text(out.dataset(), "unit", unit);
    return out;
  };
  ContactTables& c = kind.contacts;
  c.end = Table::create<std::int64_t>(to, "end", {worlds}, chunk);
  c.found = Table::create<std::int32_t>(to, "found", {worlds}, chunk);
  c.body_a = Table::create<std::int32_t>(to, "body_a", {}, chunk);
  c.body_b = Table::create<std::int32_t>(to, "body_b", {}, chunk);
  c.point = numbers("point", {width}, "m");
  c.normal = numbers("normal", {width}, "1");
  c.force = numbers("force", {}, "N");
  record::write_number(to, "most", std::int32_t{options_.contacts});
}

template <class Real>
void Recorder::Listener::add_contacts(const Batch& batch, KindTables& kind) {
  ContactTables& c = kind.contacts;
  std::vector<std::int64_t> ends;  // rows of [sample][world] are added whole
  std::vector<std::int32_t> counts;
  for (const int world : kind.worlds) {
    const Scene& scene = batch.plan(batch.kind_of(world)).scene();
    const int width = scene.space == Space::planar ? 2 : 3;
    const std::vector<StepContact> all = batch.step_contacts(world);
    int found = 0;
    for (const std::size_t i : kept(all, options_.contacts, found)) {
      const StepContact& one = all[i];
      c.body_a.add(static_cast<std::int32_t>(one.body_a.index()));
      c.body_b.add(static_cast<std::int32_t>(one.body_b.index()));
      std::array<Real, 3> point{}, normal{};
      for (int k = 0; k < width; ++k) {
        point[static_cast<std::size_t>(k)] = static_cast<Real>(one.point[k]);
        normal[static_cast<std::size_t>(k)] = static_cast<Real>(one.normal[k]);
      }
      const auto row = [&](const std::array<Real, 3>& v) {
        return std::as_bytes(std::span(v).first(static_cast<std::size_t>(width)));
      };
      c.point.add_bytes(row(point));
      c.normal.add_bytes(row(normal));
      c.force.add(static_cast<Real>(one.normal_impulse / scene.options.dt));
      ++c.points;
    }
    ends.push_back(c.points);
    counts.push_back(found);
  }
  c.end.add(ends);
  c.found.add(counts);
}

template void Recorder::Listener::add_contacts<float>(const Batch&, KindTables&);
template void Recorder::Listener::add_contacts<double>(const Batch&, KindTables&);

}  // namespace manyworlds
