// Batch: tells its listeners what happens to the worlds.
#include <array>
#include <utility>

#include "src/api/batch_data.hpp"

namespace manyworlds {

namespace {

Input write_of(Field field) {
  return static_cast<Input>(static_cast<int>(Input::write_position) + static_cast<int>(field));
}

void call(const std::vector<std::weak_ptr<BatchListener>>& listeners, const Batch& batch,
          const InputCall& input) {
  for (const auto& weak : listeners) {
    if (const auto listener = weak.lock()) listener->on_input(batch, input);
  }
}

}  // namespace

void Batch::listen(std::weak_ptr<BatchListener> listener) {
  std::erase_if(impl_->listeners, [](const auto& weak) { return weak.expired(); });
  impl_->listeners.push_back(std::move(listener));
}

void Batch::Impl::tell(const Batch& batch, Input input, int world, int body,
                       std::initializer_list<Vec3> vectors) const {
  if (listeners.empty()) return;
  std::array<double, 6> values{};
  std::size_t n = 0;
  for (const Vec3& v : vectors) {
    for (int c = 0; c < 3; ++c) values[n++] = v[c];
  }
  call(listeners, batch, {input, world, body, {values.data(), n}});
}

template <class Number>
void Batch::Impl::tell_write(const Batch& batch, Field field, std::span<const Number> in) const {
  if (listeners.empty()) return;
  std::vector<double> values;
  for_each_world(field, [&](int kind, int world, std::size_t at) {
    const auto begin = in.begin() + static_cast<std::ptrdiff_t>(at);
    values.assign(begin, begin + static_cast<std::ptrdiff_t>(world_size(field, kind)));
    call(listeners, batch,
         {write_of(field), first_world[static_cast<std::size_t>(kind)] + world, -1, values});
  });
}
template void Batch::Impl::tell_write(const Batch&, Field, std::span<const float>) const;
template void Batch::Impl::tell_write(const Batch&, Field, std::span<const double>) const;

void Batch::Impl::tell_write(const Batch& batch, Field field, int world,
                             std::span<const double> in) const {
  call(listeners, batch, {write_of(field), world, -1, in});
}

void Batch::Impl::tell_spawn(const Batch& batch, int world, int body,
                             const BodyState& state) const {
  const auto& [x, q, v, w] = state;
  const std::array<double, 13> values = {x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z(),
                                         v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  call(listeners, batch, {Input::spawn, world, body, values});
}

void Batch::Impl::tell_controls(const Batch& batch, int world, std::span<const double> in) const {
  call(listeners, batch, {Input::set_controls, world, -1, in});
}

void Batch::Impl::tell_step(const Batch& batch, int n) const {
  for (const auto& weak : listeners) {
    if (const auto listener = weak.lock()) listener->on_step(batch, n);
  }
}

const char* to_string(Input input) {
  constexpr const char* kNames[kInputCount] = {"force",
                                               "torque",
                                               "force_at",
                                               "impulse",
                                               "angular_impulse",
                                               "impulse_at",
                                               "enable",
                                               "disable",
                                               "spawn",
                                               "wake",
                                               "write_position",
                                               "write_orientation",
                                               "write_linear_velocity",
                                               "write_angular_velocity",
                                               "reset",
                                               "restore",
                                               "set_controls",
                                               "enable_joint",
                                               "disable_joint"};
  const auto i = static_cast<std::size_t>(input);
  return i < kInputCount ? kNames[i] : "unknown";
}

}  // namespace manyworlds
