// Batch: inputs: forces, impulses and controls.
#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

constexpr const char* kNoForce = "no force or impulse moves it";

// Calls visit(kind, where its worlds' controls begin in the canonical array, numbers of a world).
template <class Impl, class Visit>
void visit_controls(const Impl& impl, std::size_t numbers, Visit visit) {
  const auto of_world = [&](std::size_t k) { return impl.kinds[k].plan.scene().controls.size(); };
  const auto of_kind = [&](std::size_t k) {
    return of_world(k) * static_cast<std::size_t>(impl.kinds[k].worlds);
  };
  std::size_t total = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) total += of_kind(k);
  if (numbers != total) {
    reject("controls are " + std::to_string(total) + " values, the buffer has " +
           std::to_string(numbers));
  }
  std::size_t at = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) {
    visit(static_cast<int>(k), at, of_world(k));
    at += of_kind(k);
  }
}

}  // namespace

void Batch::add_force(int world, BodyId body, const Vec3& force) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->worlds(p.kind).add_force(p.world, p.row, force, Vec3::Zero());
  impl_->tell(*this, Input::force, world, body, {force});
}
void Batch::add_torque(int world, BodyId body, const Vec3& torque) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->worlds(p.kind).add_force(p.world, p.row, Vec3::Zero(), torque);
  impl_->tell(*this, Input::torque, world, body, {torque});
}
void Batch::add_force_at(int world, BodyId body, const Vec3& force, const Vec3& point_world) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, kNoForce);
  const Vec3 arm = point_world - impl_->worlds(p.kind).center_of_mass(p.world, p.row);
  impl_->worlds(p.kind).add_force(p.world, p.row, force, arm.cross(force));
  impl_->tell(*this, Input::force_at, world, body, {force, point_world});
}
void Batch::add_impulse(int world, BodyId body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->reject_in_trees(p.kind, "add_impulse");
  impl_->worlds(p.kind).add_impulse(p.world, p.row, impulse, Vec3::Zero());
  impl_->tell(*this, Input::impulse, world, body, {impulse});
}
void Batch::add_angular_impulse(int world, BodyId body, const Vec3& impulse) {
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->reject_in_trees(p.kind, "add_angular_impulse");
  impl_->worlds(p.kind).add_impulse(p.world, p.row, Vec3::Zero(), impulse);
  impl_->tell(*this, Input::angular_impulse, world, body, {impulse});
}
void Batch::add_impulse_at(int world, BodyId body, const Vec3& impulse, const Vec3& point_world) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, kNoForce);
  impl_->reject_in_trees(p.kind, "add_impulse_at");
  const Vec3 arm = point_world - impl_->worlds(p.kind).center_of_mass(p.world, p.row);
  impl_->worlds(p.kind).add_impulse(p.world, p.row, impulse, arm.cross(impulse));
  impl_->tell(*this, Input::impulse_at, world, body, {impulse, point_world});
}

bool Batch::forces_pending() const {
  for (int k = 0; k < kinds(); ++k) {
    if (impl_->worlds(k).forced()) return true;
  }
  return false;
}

int Batch::controls(int world) const {
  return static_cast<int>(plan(kind_of(world)).scene().controls.size());
}

template <class Number>
void Batch::Impl::set_controls(const Batch& batch, std::span<const Number> in) {
  const auto worlds_of = [&](int kind) { return kinds[static_cast<std::size_t>(kind)].worlds; };
  visit_controls(*this, in.size(), [&](int kind, std::size_t at, std::size_t) {
    worlds(kind).set_controls(0, worlds_of(kind), in.data() + at);
  });
  if (listeners.empty()) return;
  visit_controls(*this, in.size(), [&](int kind, std::size_t at, std::size_t of_world) {
    for (int w = 0; w < worlds_of(kind); ++w) {
      const auto own = in.subspan(at + static_cast<std::size_t>(w) * of_world, of_world);
      tell_controls(batch, first_world[static_cast<std::size_t>(kind)] + w,
                    std::vector<double>(own.begin(), own.end()));
    }
  });
}
void Batch::set_controls(ConstReals in) {
  std::visit([this](auto from) { impl_->set_controls(*this, from); }, in);
}

void Batch::set_controls(int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  const std::size_t wanted = impl_->plan(p.kind).scene().controls.size();
  if (in.size() != wanted) {
    reject("controls of a world are " + std::to_string(wanted) + " values, the buffer has " +
           std::to_string(in.size()));
  }
  impl_->worlds(p.kind).set_controls(p.world, 1, in.data());
  impl_->tell_controls(*this, world, in);
}

template <class Number>
void Batch::Impl::read_controls(std::span<Number> out) const {
  visit_controls(*this, out.size(), [&](int kind, std::size_t at, std::size_t) {
    worlds(kind).read_controls(0, kinds[static_cast<std::size_t>(kind)].worlds, out.data() + at);
  });
}
void Batch::read_controls(Reals out) const {
  std::visit([this](auto to) { impl_->read_controls(to); }, out);
}

}  // namespace manyworlds
