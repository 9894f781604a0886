// Batch: snapshots of worlds, and worlds from snapshots.
#include <numeric>

#include "src/api/batch_data.hpp"
#include "src/state/snapshot_format.hpp"

namespace manyworlds {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw SnapshotError("snapshot: " + what); }

std::uint32_t real_bytes(const BatchOptions& options) {
  return options.precision == Precision::f32 ? 4 : 8;
}

}  // namespace

Snapshot Batch::save() const {
  std::vector<int> all(static_cast<std::size_t>(worlds()));
  std::iota(all.begin(), all.end(), 0);
  return save(all);
}

Snapshot Batch::save(std::span<const int> worlds) const {
  if (worlds.empty()) reject("save: no worlds are given");
  std::vector<SnapshotEntry> entries;
  for (const int world : worlds) {
    const auto p = impl_->find(world);
    SnapshotEntry entry{};
    entry.fingerprint = impl_->fingerprint[static_cast<std::size_t>(p.kind)];
    entry.size = static_cast<std::uint32_t>(impl_->worlds(p.kind).world_bytes());
    entry.episode = impl_->worlds(p.kind).episode(p.world);
    entry.seed = impl_->worlds(p.kind).seed(p.world);
    entries.push_back(entry);
  }
  SnapshotHeader header{};
  header.real_bytes = real_bytes(impl_->options);
  header.steps = impl_->steps;
  header.clock = impl_->clock;
  Snapshot snapshot = SnapshotAccess::prepare(header, std::move(entries));
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const auto p = impl_->find(worlds[i]);
    impl_->worlds(p.kind).write_world(p.world, SnapshotAccess::world(snapshot, i));
  }
  SnapshotAccess::seal(snapshot);
  return snapshot;
}

// Does world `from` of the snapshot fit this kind of world?
void Batch::Impl::check_snapshot_world(const Snapshot& snapshot, std::size_t from, int kind) const {
  const SnapshotHeader header = SnapshotAccess::header(snapshot);
  const std::string place = "world " + std::to_string(from);
  if (header.real_bytes != real_bytes(options)) {
    refuse("has " + std::string(header.real_bytes == 4 ? "f32" : "f64") + " values, the batch is " +
           to_string(options.precision));
  }
  const SnapshotEntry entry = SnapshotAccess::entry(snapshot, from);
  if (entry.fingerprint != fingerprint[static_cast<std::size_t>(kind)]) {
    refuse(place + " belongs to another plan than '" + plan(kind).scene().name + "'");
  }
  if (entry.size != worlds(kind).world_bytes()) {
    refuse(place + " has " + std::to_string(entry.size) + " bytes, must have " +
           std::to_string(worlds(kind).world_bytes()));
  }
  const std::string problem = worlds(kind).check_world(SnapshotAccess::world(snapshot, from));
  if (!problem.empty()) refuse(place + ": " + problem);
}

void Batch::restore(const Snapshot& snapshot) {
  const SnapshotHeader header = SnapshotAccess::header(snapshot);
  if (snapshot.worlds() != worlds()) {
    refuse("has " + std::to_string(snapshot.worlds()) + " worlds, the batch has " +
           std::to_string(worlds()));
  }
  for (int w = 0; w < worlds(); ++w) {
    impl_->check_snapshot_world(snapshot, static_cast<std::size_t>(w), impl_->find(w).kind);
  }
  impl_->core->look_again();
  for (int w = 0; w < worlds(); ++w) {
    const auto p = impl_->find(w);
    const auto i = static_cast<std::size_t>(w);
    impl_->worlds(p.kind).read_world(p.world, SnapshotAccess::world(snapshot, i));
    const SnapshotEntry entry = SnapshotAccess::entry(snapshot, i);
    impl_->worlds(p.kind).set_episode(p.world, entry.episode);
    if (has_seeds(header)) impl_->worlds(p.kind).set_seed(p.world, entry.seed);
  }
  impl_->steps = header.steps;
  impl_->clock = header.clock;
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::restore, w);
}

void Batch::restore(const Snapshot& snapshot, int from, int to) {
  const auto p = impl_->find(to);
  if (from < 0 || from >= snapshot.worlds()) {
    reject("restore: the snapshot has " + std::to_string(snapshot.worlds()) +
           " worlds, it has no world " + std::to_string(from));
  }
  impl_->check_snapshot_world(snapshot, static_cast<std::size_t>(from), p.kind);
  impl_->core->look_again();
  impl_->worlds(p.kind).read_world(p.world,
                                   SnapshotAccess::world(snapshot, static_cast<std::size_t>(from)));
  impl_->tell(*this, Input::restore, to);
}

void Batch::copy_world(int from, int to) {
  const auto a = impl_->find(from), b = impl_->find(to);
  if (a.kind != b.kind) {
    reject("copy_world: worlds " + std::to_string(from) + " and " + std::to_string(to) +
           " are of different kinds");
  }
  impl_->core->look_again();
  impl_->worlds(a.kind).copy_world(a.world, b.world);
  impl_->tell(*this, Input::restore, to);
}

}  // namespace manyworlds
