// The public Batch: checks arguments, finds the kind of a world, and hands over to its core.
#include "manyworlds/batch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "src/api/batch_impl.hpp"
#include "src/base/hash.hpp"

namespace manyworlds {

namespace {

[[noreturn]] void reject(const std::string& what) { throw std::invalid_argument(what); }

Isa checked_isa(const BatchOptions& options) {
  if (!options.isa) return default_isa();
  const std::vector<Isa> have = available_isas();
  if (std::find(have.begin(), have.end(), *options.isa) == have.end()) {
    reject(std::string("isa ") + to_string(*options.isa) +
           " is not available on this machine or in this build");
  }
  return *options.isa;
}

}  // namespace

struct Batch::Impl {
  std::vector<Kind> kinds;
  std::vector<int> first_world;  // of each kind, and the total
  BatchOptions options;
  std::shared_ptr<Executor> executor;
  std::unique_ptr<BatchCore> core;
  std::int64_t steps = 0;
  double dt = 0;
  double clock = 0;                     // of step_to
  std::vector<std::size_t> first_body;  // of each kind, counted over all worlds before it

  Impl(std::vector<Kind> all, const BatchOptions& o) : kinds(std::move(all)), options(o) {
    if (kinds.empty()) reject("a batch needs at least one kind of world");
    if (options.threads < 0) {
      reject("threads is " + std::to_string(options.threads) + ", must be >= 0");
    }
    if (options.threads != 0 && options.executor) {
      reject("threads is " + std::to_string(options.threads) +
             ", must be 0 where an executor brings its own");
    }
    int worlds = 0;
    std::size_t bodies = 0;
    for (const Kind& k : kinds) {
      if (k.worlds < 1) reject("worlds is " + std::to_string(k.worlds) + ", must be >= 1");
      if (k.plan.scene().space != kinds.front().plan.scene().space) {
        reject("kinds of one batch must be all planar or all spatial");
      }
      if (k.plan.scene().options.dt != kinds.front().plan.scene().options.dt) {
        reject("kinds of one batch must have the same dt");
      }
      first_world.push_back(worlds);
      first_body.push_back(bodies);
      worlds += k.worlds;
      bodies += static_cast<std::size_t>(k.plan.bodies()) * static_cast<std::size_t>(k.worlds);
    }
    first_world.push_back(worlds);
    first_body.push_back(bodies);
    dt = kinds.front().plan.scene().options.dt;
    executor = options.executor ? options.executor : make_executor(options.threads);
    if (executor->threads() < 1) {
      reject("the executor has " + std::to_string(executor->threads()) + " threads, must be >= 1");
    }
    core = make_core(kinds, options, checked_isa(options), executor->threads());
  }

  struct Place {
    int kind, world;
  };
  Place find(int world) const {
    if (world < 0 || world >= first_world.back()) {
      reject("world is " + std::to_string(world) + ", must be 0 to " +
             std::to_string(first_world.back() - 1));
    }
    int kind = 0;
    while (world >= first_world[static_cast<std::size_t>(kind) + 1]) ++kind;
    return {kind, world - first_world[static_cast<std::size_t>(kind)]};
  }
  const Plan& plan(int kind) const { return kinds[static_cast<std::size_t>(kind)].plan; }
  Place find_body(int world, int body) const {
    const Place p = find(world);
    if (body < 0 || body >= plan(p.kind).bodies()) {
      reject("body is " + std::to_string(body) + ", must be 0 to " +
             std::to_string(plan(p.kind).bodies() - 1));
    }
    return p;
  }
  std::size_t world_size(Field field, int kind) const {
    return static_cast<std::size_t>(plan(kind).bodies()) *
           static_cast<std::size_t>(components(field, plan(kind).scene().space));
  }
  void check_size(Field field, std::size_t got, std::size_t wanted) const {
    if (got != wanted) {
      reject(std::string(info(field).name) + " has " + std::to_string(wanted) +
             " numbers, the buffer has " + std::to_string(got));
    }
  }
  // visit(kind, world in kind, offset in the canonical array)
  template <class Visit>
  void for_each_world(Field field, Visit visit) const {
    std::size_t at = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const int kind = static_cast<int>(k);
      for (int w = 0; w < kinds[k].worlds; ++w) {
        visit(kind, w, at);
        at += world_size(field, kind);
      }
    }
  }
};

Batch::Batch(Plan plan, const BatchOptions& options)
    : Batch(std::vector<Kind>{{std::move(plan), options.worlds}}, options) {}
Batch::Batch(std::vector<Kind> kinds, const BatchOptions& options)
    : impl_(std::make_unique<Impl>(std::move(kinds), options)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

int Batch::worlds() const { return impl_->first_world.back(); }
int Batch::kinds() const { return static_cast<int>(impl_->kinds.size()); }
const Plan& Batch::plan(int kind) const {
  return impl_->kinds.at(static_cast<std::size_t>(kind)).plan;
}
int Batch::kind_of(int world) const { return impl_->find(world).kind; }
int Batch::bodies(int world) const { return impl_->plan(kind_of(world)).bodies(); }
int Batch::threads() const { return impl_->executor->threads(); }
Isa Batch::isa() const { return impl_->core->isa(); }
Precision Batch::precision() const { return impl_->options.precision; }
int Batch::lanes() const { return impl_->core->lanes(); }
std::string Batch::kernel_table() const {
  return std::string(to_string(isa())) + " " + to_string(precision()) + " x" +
         std::to_string(lanes());
}
std::size_t Batch::bytes_per_world() const {
  return impl_->core->bytes() / static_cast<std::size_t>(worlds());
}
std::size_t Batch::scratch_bytes() const { return impl_->core->scratch_bytes(); }

void Batch::step(int n) {
  if (n <= 0) return;
  impl_->core->step(*impl_->executor, n);
  impl_->steps += n;
}

int Batch::step_to(double clock, int max_steps) {
  if (!std::isfinite(clock)) return 0;
  // The accumulator: host time that no step has used up yet.
  const double due = clock - impl_->clock;
  const double slack = 1e-9 * impl_->dt;
  const double whole = std::floor((due + slack) / impl_->dt);
  if (whole < 1) return 0;
  const int n = static_cast<int>(std::min(whole, static_cast<double>(std::max(0, max_steps))));
  step(n);
  // Time beyond max_steps is dropped, but for the fraction of a step that is still to come.
  impl_->clock += whole * impl_->dt;
  return n;
}

double Batch::time() const { return static_cast<double>(impl_->steps) * impl_->dt; }
std::int64_t Batch::steps() const { return impl_->steps; }

std::size_t Batch::size(Field field) const {
  return impl_->first_body.back() *
         static_cast<std::size_t>(components(field, plan().scene().space));
}
void Batch::read(Field field, std::span<float> out) const {
  impl_->check_size(field, out.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->read(field, kind, world, out.data() + at);
  });
}
void Batch::read(Field field, std::span<double> out) const {
  impl_->check_size(field, out.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->read(field, kind, world, out.data() + at);
  });
}
void Batch::write(Field field, std::span<const float> in) {
  impl_->check_size(field, in.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->write(field, kind, world, in.data() + at);
  });
}
void Batch::write(Field field, std::span<const double> in) {
  impl_->check_size(field, in.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->write(field, kind, world, in.data() + at);
  });
}
void Batch::read(Field field, int world, std::span<double> out) const {
  const auto p = impl_->find(world);
  impl_->check_size(field, out.size(), impl_->world_size(field, p.kind));
  impl_->core->read(field, p.kind, p.world, out.data());
}
void Batch::write(Field field, int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  impl_->check_size(field, in.size(), impl_->world_size(field, p.kind));
  impl_->core->write(field, p.kind, p.world, in.data());
}

void Batch::add_force(int world, int body, const Vec3& force) {
  const auto p = impl_->find_body(world, body);
  impl_->core->add_force(p.kind, p.world, body, force, Vec3::Zero());
}
void Batch::add_torque(int world, int body, const Vec3& torque) {
  const auto p = impl_->find_body(world, body);
  impl_->core->add_force(p.kind, p.world, body, Vec3::Zero(), torque);
}
void Batch::add_force_at(int world, int body, const Vec3& force, const Vec3& point_world) {
  const auto p = impl_->find_body(world, body);
  const Vec3 arm = point_world - impl_->core->center_of_mass(p.kind, p.world, body);
  impl_->core->add_force(p.kind, p.world, body, force, arm.cross(force));
}
void Batch::add_impulse(int world, int body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body);
  impl_->core->add_impulse(p.kind, p.world, body, impulse, Vec3::Zero());
}
void Batch::add_angular_impulse(int world, int body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body);
  impl_->core->add_impulse(p.kind, p.world, body, Vec3::Zero(), impulse);
}
void Batch::add_impulse_at(int world, int body, const Vec3& impulse, const Vec3& point_world) {
  const auto p = impl_->find_body(world, body);
  const Vec3 arm = point_world - impl_->core->center_of_mass(p.kind, p.world, body);
  impl_->core->add_impulse(p.kind, p.world, body, impulse, arm.cross(impulse));
}

void Batch::set_enabled(int world, int body, bool enabled) {
  const auto p = impl_->find_body(world, body);
  impl_->core->set_enabled(p.kind, p.world, body, enabled);
}
bool Batch::enabled(int world, int body) const {
  const auto p = impl_->find_body(world, body);
  return impl_->core->enabled(p.kind, p.world, body);
}
void Batch::spawn(int world, int body, const BodyState& state) {
  const auto p = impl_->find_body(world, body);
  const double norm = state.rotation.norm();
  if (!(norm > 0) || !std::isfinite(norm)) {
    reject("spawn: the rotation has length " + std::to_string(norm) + ", must be > 0");
  }
  impl_->core->spawn(p.kind, p.world, body, state);
}

bool Batch::sleeps() const { return impl_->options.sleep; }
bool Batch::asleep(int world, int body) const {
  const auto p = impl_->find_body(world, body);
  return impl_->core->asleep(p.kind, p.world, body);
}
bool Batch::asleep(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->resting(p.kind, p.world);
}
void Batch::wake(int world) {
  const auto p = impl_->find(world);
  impl_->core->wake(p.kind, p.world);
}
double Batch::awake_fraction() const {
  int awake = 0;
  for (int w = 0; w < worlds(); ++w) awake += asleep(w) ? 0 : 1;
  return static_cast<double>(awake) / worlds();
}
std::int64_t Batch::group_steps() const { return impl_->core->group_steps(); }

void Batch::reset() {
  impl_->core->restart();
  impl_->steps = 0;
  impl_->clock = 0;
}
void Batch::reset(std::span<const std::uint8_t> mask) {
  if (mask.size() != static_cast<std::size_t>(worlds())) {
    reject("the mask has " + std::to_string(mask.size()) + " entries, the batch " +
           std::to_string(worlds()) + " worlds");
  }
  for (int w = 0; w < worlds(); ++w) {
    if (mask[static_cast<std::size_t>(w)] == 0) continue;
    const auto p = impl_->find(w);
    impl_->core->reset(p.kind, p.world);
  }
}

Status Batch::status(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->status(p.kind, p.world);
}
int Batch::lost_worlds() const {
  int n = 0;
  for (int w = 0; w < worlds(); ++w) n += lost(status(w)) ? 1 : 0;
  return n;
}
std::uint64_t Batch::hash(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->hash(p.kind, p.world);
}
std::uint64_t Batch::hash() const {
  Hasher hasher;
  for (int w = 0; w < worlds(); ++w) hasher.add(hash(w));
  return hasher.value();
}
Energy Batch::energy(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->energy(p.kind, p.world);
}
std::vector<Contact> Batch::contacts(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->contacts(p.kind, p.world);
}

ContactSummary Batch::measure_contacts() const {
  ContactSummary out;
  double points = 0, manifolds = 0;
  for (int w = 0; w < worlds(); ++w) {
    const Options& o = impl_->plan(kind_of(w)).scene().options;
    const double margin = 4 * o.slop * o.length_unit;
    std::vector<std::array<int, 4>> pairs;
    for (const Contact& c : contacts(w)) {
      if (c.separation >= margin) continue;
      ++points;
      pairs.push_back({c.body_a, c.shape_a, c.body_b, c.shape_b});
      out.max_penetration = std::max(out.max_penetration, -c.separation);
    }
    std::sort(pairs.begin(), pairs.end());
    manifolds += static_cast<double>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
  }
  out.points_per_world = points / worlds();
  out.manifolds_per_world = manifolds / worlds();
  for (int k = 0; k < kinds(); ++k) {
    out.mean_occupancy += impl_->core->occupancy(k) / static_cast<double>(kinds());
  }
  return out;
}

void Batch::profile(bool on) { impl_->core->profile(on); }
std::vector<StageTime> Batch::take_stage_times() { return impl_->core->take_stage_times(); }

}  // namespace manyworlds
