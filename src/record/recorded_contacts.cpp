// The contacts of a recording that has some: checked, then read as they are asked for.
#include <algorithm>
#include <string>

#include "src/record/recording.hpp"

namespace manyworlds {

using record::TableReader;

namespace {

constexpr hsize_t kBlock = hsize_t{1} << 16;  // rows that are looked at together

void check_bodies(const TableReader& table, const char* name, std::int32_t bodies) {
  for (hsize_t first = 0; first < table.rows(); first += kBlock) {
    const hsize_t count = std::min(kBlock, table.rows() - first);
    for (const std::int32_t body : table.read<std::int32_t>(first, count)) {
      if (body >= 0 && body < bodies) continue;
      record::fail(std::string("'") + name + "' has body " + std::to_string(body) +
                   ", must be 0 to " + std::to_string(bodies - 1));
    }
  }
}

}  // namespace

void Recording::Impl::open_contacts(hid_t group, Kind& kind) const {
  const std::size_t worlds = kind.worlds.size();
  const auto width = static_cast<hsize_t>(components(Field::position, kind.plan.scene().space));
  Contacts& c = kind.contacts;
  const auto end = TableReader::open<std::int64_t>(group, "end", {worlds});
  const auto found = TableReader::open<std::int32_t>(group, "found", {worlds});
  end.expect_rows(steps.size());
  found.expect_rows(steps.size());
  c.end = end.read_all<std::int64_t>();
  c.found = found.read_all<std::int32_t>();
  std::int64_t before = 0;
  for (std::size_t i = 0; i < c.end.size(); ++i) {
    const std::int64_t count = c.end[i] < before ? -1 : c.end[i] - before;
    if (count < 0 || count > kMaxContactsRecorded || c.found[i] < count) {
      record::fail("'end' of sample " + std::to_string(i / worlds) + ", world " +
                   std::to_string(i % worlds) + " is " + std::to_string(c.end[i]) +
                   ", must be at least " + std::to_string(before) + ", and at most " +
                   std::to_string(std::min(c.found[i], kMaxContactsRecorded)) + " more");
    }
    before = c.end[i];
  }
  const auto numbers = [&](const char* name, const record::Dims& row) {
    return precision == Precision::f32 ? TableReader::open<float>(group, name, row)
                                       : TableReader::open<double>(group, name, row);
  };
  c.body_a = TableReader::open<std::int32_t>(group, "body_a", {});
  c.body_b = TableReader::open<std::int32_t>(group, "body_b", {});
  c.point = numbers("point", {width});
  c.normal = numbers("normal", {width});
  c.force = numbers("force", {});
  for (const TableReader* table : {&c.body_a, &c.body_b, &c.point, &c.normal, &c.force}) {
    table->expect_rows(static_cast<hsize_t>(before));
  }
  const auto bodies = static_cast<std::int32_t>(kind.plan.scene().bodies.size());
  check_bodies(c.body_a, "body_a", bodies);
  check_bodies(c.body_b, "body_b", bodies);
}

std::vector<RecordedContact> Recording::Impl::read_contacts(std::size_t of, std::int64_t sample,
                                                            std::size_t world,
                                                            std::size_t worlds) const {
  const Kind& kind = kinds[of];
  const Contacts& c = kind.contacts;
  if (c.end.empty() || worlds == 0) return {};
  const std::size_t i = static_cast<std::size_t>(sample) * kind.worlds.size() + world;
  const std::int64_t begin = i == 0 ? 0 : c.end[i - 1];
  const auto first = static_cast<hsize_t>(begin);
  const auto count = static_cast<hsize_t>(c.end[i + worlds - 1] - begin);
  std::vector<RecordedContact> out(count);
  if (count == 0) return out;
  const auto a = c.body_a.read<std::int32_t>(first, count);
  const auto b = c.body_b.read<std::int32_t>(first, count);
  const auto numbers = [&](const TableReader& table) -> std::vector<double> {
    if (precision == Precision::f64) return table.read<double>(first, count);
    const std::vector<float> values = table.read<float>(first, count);
    return {values.begin(), values.end()};
  };
  const auto point = numbers(c.point), normal = numbers(c.normal), force = numbers(c.force);
  const std::size_t width = point.size() / out.size();
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].body_a = BodyId(a[k]), out[k].body_b = BodyId(b[k]);
    for (std::size_t d = 0; d < width; ++d) {
      out[k].point[static_cast<Eigen::Index>(d)] = point[k * width + d];
      out[k].normal[static_cast<Eigen::Index>(d)] = normal[k * width + d];
    }
    out[k].force = force[k];
  }
  return out;
}

}  // namespace manyworlds
