// Batch: the state of worlds: fields, bodies and joints that come and go, sleep, and where worlds
// begin.
#include <cmath>

#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

std::size_t Batch::size(Field field) const { return impl_->size(field); }
void Batch::read(Field field, Reals out) const {
  std::visit(
      [&](auto to) {
        impl_->check_size(field, to.size(), size(field));
        impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
          impl_->worlds(kind).read(field, world, to.data() + at);
        });
      },
      out);
}
void Batch::write(Field field, ConstReals in) {
  std::visit(
      [&](auto from) {
        impl_->check_size(field, from.size(), size(field));
        impl_->check_written(field);
        impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
          impl_->worlds(kind).write(field, world, from.data() + at);
        });
        impl_->tell_write(*this, field, from);
      },
      in);
}
void Batch::read(Field field, int world, std::span<double> out) const {
  const auto p = impl_->find(world);
  impl_->check_size(field, out.size(), impl_->world_size(field, p.kind));
  impl_->worlds(p.kind).read(field, p.world, out.data());
}
void Batch::write(Field field, int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  impl_->check_size(field, in.size(), impl_->world_size(field, p.kind));
  impl_->check_written(field, p.kind);
  impl_->worlds(p.kind).write(field, p.world, in.data());
  impl_->tell_write(*this, field, world, in);
}

LaneBlocks Batch::lane_blocks(Field field, int kind) {
  impl_->check_kind(kind);
  checked_enum(field);
  return impl_->worlds(kind).lane_blocks(field);
}
int Batch::lane_index(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).lane_index_of(p.world);
}

void Batch::set_enabled(int world, BodyId body, bool enabled) {
  const auto p = impl_->find_body(world, body, "it is always enabled");
  impl_->reject_in_trees(p.kind, "set_enabled");
  impl_->worlds(p.kind).set_enabled(p.world, p.row, enabled);
  impl_->tell(*this, enabled ? Input::enable : Input::disable, world, body);
}
bool Batch::enabled(int world, BodyId body) const {
  const auto p = impl_->find_any_body(world, body);
  return p.row < 0 || impl_->worlds(p.kind).enabled(p.world, p.row);
}
void Batch::spawn(int world, BodyId body, const BodyState& state) {
  const FloatMode mode;
  const auto p = impl_->find_body(world, body, "it keeps the scene's pose");
  impl_->reject_in_trees(p.kind, "spawn");
  const double norm = state.rotation.norm();
  if (!(norm > 0) || !std::isfinite(norm)) {
    reject("spawn: the rotation has length " + std::to_string(norm) + ", must be > 0");
  }
  impl_->worlds(p.kind).spawn(p.world, p.row, state);
  impl_->tell_spawn(*this, world, body, state);
}

void Batch::set_joint_enabled(int world, JointId joint, bool enabled) {
  const auto p = impl_->find_joint(world, joint);
  impl_->reject_in_trees(p.kind, "set_joint_enabled");
  impl_->worlds(p.kind).set_joint_enabled(p.world, joint.index(), enabled);
  impl_->tell(*this, enabled ? Input::enable_joint : Input::disable_joint, world, joint);
}
bool Batch::joint_enabled(int world, JointId joint) const {
  const auto p = impl_->find_joint(world, joint);
  return impl_->worlds(p.kind).joint_enabled(p.world, joint.index());
}

bool Batch::sleeps() const { return impl_->options.sleep; }
bool Batch::asleep(int world, BodyId body) const {
  const auto p = impl_->find_any_body(world, body);
  return p.row >= 0 && impl_->worlds(p.kind).asleep(p.world, p.row);
}
bool Batch::asleep(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).resting(p.world);
}
void Batch::wake(int world) {
  const auto p = impl_->find(world);
  impl_->worlds(p.kind).wake(p.world);
  impl_->tell(*this, Input::wake, world);
}
double Batch::awake_fraction() const {
  const FloatMode mode;
  int awake = 0;
  for (int w = 0; w < worlds(); ++w) awake += asleep(w) ? 0 : 1;
  return FloatMode::done(static_cast<double>(awake) / worlds());
}

void Batch::reset() {
  for (int k = 0; k < kinds(); ++k) impl_->worlds(k).restart();
  impl_->steps = 0;
  impl_->clock = 0;
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::reset, w);
}
void Batch::reset(std::span<const std::uint8_t> mask) {
  impl_->for_each_masked(mask, [this](int kind, int in_kind, int world) {
    impl_->worlds(kind).reset(in_kind);
    impl_->tell(*this, Input::reset, world);
  });
}
void Batch::reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds) {
  if (seeds.size() != static_cast<std::size_t>(worlds())) {
    reject("there are " + std::to_string(seeds.size()) + " seeds, the batch has " +
           std::to_string(worlds()) + " worlds");
  }
  impl_->for_each_masked(mask, [&](int kind, int in_kind, int world) {
    impl_->worlds(kind).reset(in_kind, seeds[static_cast<std::size_t>(world)]);
    impl_->tell(*this, Input::reset, world);
  });
}

void Batch::Impl::begin_at(int kind, int in_kind, KeyframeId keyframe) {
  const Keyframe& from = plan(kind).scene().at(keyframe);
  const auto put = [&](Field field, const std::vector<double>& numbers) {
    if (!numbers.empty()) worlds(kind).write(field, in_kind, numbers.data());
  };
  put(Field::generalized_position, from.generalized_position);
  put(Field::generalized_velocity, from.generalized_velocity);
  if (!from.controls.empty()) worlds(kind).set_controls(in_kind, 1, from.controls.data());
}
void Batch::reset(KeyframeId keyframe) {
  for (int k = 0; k < kinds(); ++k) impl_->check_keyframe(k, keyframe);
  for (int k = 0; k < kinds(); ++k) {
    impl_->worlds(k).restart();
    const int count = impl_->kinds[static_cast<std::size_t>(k)].worlds;
    for (int w = 0; w < count; ++w) impl_->begin_at(k, w, keyframe);
  }
  impl_->steps = 0;
  impl_->clock = 0;
  for (int w = 0; w < worlds(); ++w) impl_->tell(*this, Input::reset, w);
}
void Batch::reset(std::span<const std::uint8_t> mask, KeyframeId keyframe) {
  impl_->for_each_masked(mask, [&](int kind, int, int) { impl_->check_keyframe(kind, keyframe); });
  impl_->for_each_masked(mask, [&](int kind, int in_kind, int world) {
    impl_->worlds(kind).reset(in_kind);
    impl_->begin_at(kind, in_kind, keyframe);
    impl_->tell(*this, Input::reset, world);
  });
}

void Batch::set_initial(Field field, std::span<const double> in) {
  const bool forget = in.empty() && size(field) > 0;
  if (!forget) impl_->check_size(field, in.size(), size(field));
  impl_->check_written(field);
  impl_->for_each_world(field, [&](int kind, int world, std::size_t at) {
    impl_->worlds(kind).set_initial(field, world, forget ? nullptr : in.data() + at);
  });
}

}  // namespace manyworlds
