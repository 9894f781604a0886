// The public Batch: checks arguments, finds the kind of a world, and hands over to its core.
#include "manyworlds/batch.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

#include "src/api/batch_data.hpp"
#include "src/api/memory.hpp"
#include "src/base/hash.hpp"
#include "src/base/machine_memory.hpp"

namespace manyworlds {

namespace {

void check_steps(const char* what, int n) {
  if (n < 0) reject(std::string(what) + " is " + std::to_string(n) + ", must be >= 0");
}

}  // namespace

void Batch::Impl::make_core_within_memory() {
  const Isa isa = checked_isa(options);
  const int threads = executor->threads();
  const auto needed = [&] { return memory_of(kinds, options, isa, threads); };
  if (may_be_large(kinds, options, threads)) {
    const double bytes = needed(), present = machine_memory();
    if (bytes > present) {
      reject(memory_text(kinds, bytes) + ", the machine has " + gigabytes(present));
    }
  }
  try {
    core = make_core(kinds, options, isa, threads);
  } catch (const std::bad_alloc&) {
    reject(memory_text(kinds, needed()) + ", which the machine does not give");
  }
}

Batch::Batch(Plan plan, const BatchOptions& options)
    : Batch(std::vector<Kind>{{std::move(plan), options.worlds}}, options) {}
Batch::Batch(std::vector<Kind> kinds, const BatchOptions& options)
    : impl_(Pimpl<Impl>::make(std::move(kinds), options)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

int Batch::worlds() const { return impl_->first_world.back(); }
int Batch::kinds() const { return static_cast<int>(impl_->kinds.size()); }
const Plan& Batch::plan(int kind) const {
  impl_->check_kind(kind);
  return impl_->plan(kind);
}
int Batch::kind_of(int world) const { return impl_->find(world).kind; }
int Batch::bodies(int world) const { return impl_->plan(kind_of(world)).bodies(); }
int Batch::threads() const { return impl_->executor->threads(); }
Isa Batch::isa() const { return impl_->core->isa(); }
Precision Batch::precision() const { return impl_->options.precision; }
std::uint64_t Batch::seed() const { return impl_->options.seed; }
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
  check_steps("n", n);
  if (n == 0) return;
  impl_->core->step(*impl_->executor, n);
  impl_->core->end_steps();
  impl_->steps += n;
  impl_->tell_step(*this, n);
}

void Batch::step(std::span<const std::uint8_t> mask, int n) {
  impl_->check_mask(mask);
  check_steps("n", n);
  if (n == 0) return;
  impl_->core->step(*impl_->executor, n, {}, mask);
  impl_->core->end_steps(mask);
  impl_->for_each_masked(mask,
                         [this](int, int, int world) { impl_->tell(*this, Input::reset, world); });
}

int Batch::step(int n, const GoOn& go_on) {
  check_steps("n", n);
  if (n == 0) return 0;
  const int taken = impl_->step(n, {}, go_on);
  impl_->steps += taken;
  impl_->tell_step(*this, taken);
  return taken;
}

int Batch::step(std::span<const std::uint8_t> mask, int n, const GoOn& go_on) {
  impl_->check_mask(mask);
  check_steps("n", n);
  if (n == 0) return 0;
  const int taken = impl_->step(n, mask, go_on);
  impl_->for_each_masked(mask,
                         [this](int, int, int world) { impl_->tell(*this, Input::reset, world); });
  return taken;
}

int Batch::step_to(double clock, int max_steps) {
  return step_to(clock, max_steps, [] { return true; });
}
int Batch::step_to(double clock, int max_steps, const GoOn& go_on) {
  const FloatMode mode;
  if (!std::isfinite(clock)) reject("clock is " + std::to_string(clock) + " s, must be finite");
  check_steps("max_steps", max_steps);
  // The accumulator: host time that no step has used up yet.
  const double due = clock - impl_->clock;
  const double slack = 1e-9 * impl_->dt;
  const double whole = std::floor((due + slack) / impl_->dt);
  if (whole < 1) return 0;
  const int n = static_cast<int>(std::min(whole, static_cast<double>(max_steps)));
  const int taken = step(n, go_on);
  // Time beyond max_steps is dropped, but for the fraction of a step that is still to come.
  impl_->clock += (taken < n ? taken : whole) * impl_->dt;
  return taken;
}

double Batch::time() const {
  const FloatMode mode;
  return FloatMode::done(static_cast<double>(impl_->steps) * impl_->dt);
}
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
  impl_->tell_write(*this, field, in);
}
void Batch::write(Field field, std::span<const double> in) {
  impl_->check_size(field, in.size(), size(field));
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->core->write(field, kind, world, in.data() + at);
  });
  impl_->tell_write(*this, field, in);
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
  impl_->tell_write(*this, field, world, in);
}

LaneBlocks Batch::lane_blocks(Field field, int kind) {
  impl_->check_kind(kind);
  checked_enum(field);
  return impl_->core->lane_blocks(field, kind);
}
int Batch::slot(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->slot(p.kind, p.world);
}

namespace {
constexpr const char* kNoForce = "no force or impulse moves it";
}  // namespace

void Batch::add_force(int world, BodyId body, const Vec3& force) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->core->add_force(p.kind, p.world, p.row, force, Vec3::Zero());
  impl_->tell(*this, Input::force, world, body, {force});
}
void Batch::add_torque(int world, BodyId body, const Vec3& torque) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->core->add_force(p.kind, p.world, p.row, Vec3::Zero(), torque);
  impl_->tell(*this, Input::torque, world, body, {torque});
}
void Batch::add_force_at(int world, BodyId body, const Vec3& force, const Vec3& point_world) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, kNoForce);
  const Vec3 arm = point_world - impl_->core->center_of_mass(p.kind, p.world, p.row);
  impl_->core->add_force(p.kind, p.world, p.row, force, arm.cross(force));
  impl_->tell(*this, Input::force_at, world, body, {force, point_world});
}
void Batch::add_impulse(int world, BodyId body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->core->add_impulse(p.kind, p.world, p.row, impulse, Vec3::Zero());
  impl_->tell(*this, Input::impulse, world, body, {impulse});
}
void Batch::add_angular_impulse(int world, BodyId body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->core->add_impulse(p.kind, p.world, p.row, Vec3::Zero(), impulse);
  impl_->tell(*this, Input::angular_impulse, world, body, {impulse});
}
void Batch::add_impulse_at(int world, BodyId body, const Vec3& impulse, const Vec3& point_world) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, kNoForce);
  const Vec3 arm = point_world - impl_->core->center_of_mass(p.kind, p.world, p.row);
  impl_->core->add_impulse(p.kind, p.world, p.row, impulse, arm.cross(impulse));
  impl_->tell(*this, Input::impulse_at, world, body, {impulse, point_world});
}

void Batch::set_enabled(int world, BodyId body, bool enabled) {
  const auto p = impl_->find_body(world, body, "it is always there");
  impl_->core->set_enabled(p.kind, p.world, p.row, enabled);
  impl_->tell(*this, enabled ? Input::enable : Input::disable, world, body);
}
bool Batch::enabled(int world, BodyId body) const {
  const auto p = impl_->find_any_body(world, body);
  return p.row < 0 || impl_->core->enabled(p.kind, p.world, p.row);
}
void Batch::spawn(int world, BodyId body, const BodyState& state) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, "it stays where the scene has it");
  const double norm = state.rotation.norm();
  if (!(norm > 0) || !std::isfinite(norm)) {
    reject("spawn: the rotation has length " + std::to_string(norm) + ", must be > 0");
  }
  impl_->core->spawn(p.kind, p.world, p.row, state);
  impl_->tell_spawn(*this, world, body, state);
}

void Batch::set_joint_enabled(int world, JointId joint, bool enabled) {
  const auto p = impl_->find_joint(world, joint);
  impl_->core->set_joint_enabled(p.kind, p.world, joint.index(), enabled);
  impl_->tell(*this, enabled ? Input::enable_joint : Input::disable_joint, world, joint);
}
bool Batch::joint_enabled(int world, JointId joint) const {
  const auto p = impl_->find_joint(world, joint);
  return impl_->core->joint_enabled(p.kind, p.world, joint.index());
}

bool Batch::sleeps() const { return impl_->options.sleep; }
bool Batch::asleep(int world, BodyId body) const {
  const auto p = impl_->find_any_body(world, body);
  return p.row >= 0 && impl_->core->asleep(p.kind, p.world, p.row);
}
bool Batch::asleep(int world) const {
  const auto p = impl_->find(world);
  return impl_->core->resting(p.kind, p.world);
}
void Batch::wake(int world) {
  const auto p = impl_->find(world);
  impl_->core->wake(p.kind, p.world);
  impl_->tell(*this, Input::wake, world);
}
double Batch::awake_fraction() const {
  const FloatMode mode;
  int awake = 0;
  for (int w = 0; w < worlds(); ++w) awake += asleep(w) ? 0 : 1;
  return FloatMode::done(static_cast<double>(awake) / worlds());
}
std::int64_t Batch::group_steps() const { return impl_->core->group_steps(); }

void Batch::reset() {
  impl_->core->restart();
  impl_->steps = 0;
  impl_->clock = 0;
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::reset, w);
}
void Batch::reset(std::span<const std::uint8_t> mask) {
  impl_->for_each_masked(mask, [this](int kind, int in_kind, int world) {
    impl_->core->reset(kind, in_kind);
    impl_->tell(*this, Input::reset, world);
  });
}
void Batch::reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds) {
  if (seeds.size() != static_cast<std::size_t>(worlds())) {
    reject("there are " + std::to_string(seeds.size()) + " seeds, the batch has " +
           std::to_string(worlds()) + " worlds");
  }
  impl_->for_each_masked(mask, [&](int kind, int in_kind, int world) {
    impl_->core->reset(kind, in_kind, seeds[static_cast<std::size_t>(world)]);
    impl_->tell(*this, Input::reset, world);
  });
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
  return measure_contacts([] { return true; });
}

ContactSummary Batch::measure_contacts(const GoOn& go_on) const {
  const FloatMode mode;
  ContactSummary out;
  bool ended = false;
  const GoOn asked = [&] { return !(ended = ended || !go_on()); };
  double points = 0, manifolds = 0;
  for (int w = 0; w < worlds() && asked(); ++w) {
    const Options& o = impl_->plan(kind_of(w)).scene().options;
    const double margin = 4 * o.slop * o.length_unit;
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

void Batch::profile(bool on) { impl_->core->profile(on); }
std::vector<StageTime> Batch::take_stage_times() { return impl_->core->take_stage_times(); }
bool Batch::forces_pending() const { return impl_->core->forced(); }

}  // namespace manyworlds
