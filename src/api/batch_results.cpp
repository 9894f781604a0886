// Batch: what the worlds have come to.
#include <algorithm>

#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"
#include "src/base/hash.hpp"

namespace manyworlds {

Status Batch::status(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).status(p.world);
}
int Batch::lost_worlds() const {
  int n = 0;
  for (int w = 0; w < worlds(); ++w) n += lost(status(w)) ? 1 : 0;
  return n;
}
std::uint64_t Batch::hash(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).hash(p.world);
}
std::uint64_t Batch::hash() const {
  Hasher hasher;
  for (int w = 0; w < worlds(); ++w) hasher.add(hash(w));
  return hasher.value();
}
Energy Batch::energy(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).energy(p.world);
}
std::vector<Contact> Batch::contacts(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->contacts(p.kind, p.world);
}

ContactSummary Batch::measure_contacts(const GoOn& go_on) const {
  const FloatMode mode;
  ContactSummary out;
  bool ended = false;
  const GoOn asked = [&] { return !(ended = ended || (go_on && !go_on())); };
  double points = 0, manifolds = 0;
  for (int w = 0; w < worlds() && asked(); ++w) {
    const double margin = 4 * *impl_->plan(kind_of(w)).resolved().contact.slop;
    std::vector<std::pair<ShapeId, ShapeId>> pairs;
    for (const Contact& c : contacts(w)) {
      if (c.separation >= margin) continue;
      ++points;
      pairs.push_back({c.shape_a, c.shape_b});
      out.max_penetration = std::max(out.max_penetration, -c.separation);
    }
    std::sort(pairs.begin(), pairs.end());
    manifolds += static_cast<double>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
  }
  out.points_per_world = points / worlds();
  out.manifolds_per_world = manifolds / worlds();
  for (int k = 0; k < kinds(); ++k) {
    out.mean_occupancy += impl_->core->occupancy(k, asked) / static_cast<double>(kinds());
  }
  return ended ? ContactSummary{} : out;
}

}  // namespace manyworlds
