// Batch: tells its listeners what happens to the worlds.
#include <array>
#include <utility>

#include "src/api/batch_data.hpp"

namespace manyworlds {

namespace {

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

void Batch::Impl::tell(const Batch& batch, Input input, int world, BodyId body,
                       std::initializer_list<Vec3> vectors) const {
  if (listeners.empty()) return;
  std::array<double, 6> values{};
  std::size_t n = 0;
  for (const Vec3& v : vectors) {
    for (int c = 0; c < 3; ++c) values[n++] = v[c];
  }
  call(listeners, batch,
       {.input = input, .world = world, .body = body, .values = {values.data(), n}});
}
void Batch::Impl::tell(const Batch& batch, Input input, int world, JointId joint) const {
  call(listeners, batch, {.input = input, .world = world, .joint = joint});
}

template <class Number>
void Batch::Impl::tell_write(const Batch& batch, Field field, std::span<const Number> in) const {
  if (listeners.empty()) return;
  std::vector<double> values;
  for_each_world(field, [&](int kind, int world, std::size_t at) {
    const auto begin = in.begin() + static_cast<std::ptrdiff_t>(at);
    values.assign(begin, begin + static_cast<std::ptrdiff_t>(world_size(field, kind)));
    call(listeners, batch,
         {.input = write_of(field),
          .world = first_world[static_cast<std::size_t>(kind)] + world,
          .values = values});
  });
}
template void Batch::Impl::tell_write(const Batch&, Field, std::span<const float>) const;
template void Batch::Impl::tell_write(const Batch&, Field, std::span<const double>) const;

void Batch::Impl::tell_write(const Batch& batch, Field field, int world,
                             std::span<const double> in) const {
  call(listeners, batch, {.input = write_of(field), .world = world, .values = in});
}

void Batch::Impl::tell_spawn(const Batch& batch, int world, BodyId body,
                             const BodyState& state) const {
  const auto& [x, q, v, w] = state;
  const std::array<double, 13> values = {x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z(),
                                         v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  call(listeners, batch, {.input = Input::spawn, .world = world, .body = body, .values = values});
}

void Batch::Impl::tell_controls(const Batch& batch, int world, std::span<const double> in) const {
  call(listeners, batch, {.input = Input::set_controls, .world = world, .values = in});
}

void Batch::Impl::tell_step(const Batch& batch, int n) const {
  for (const auto& weak : listeners) {
    if (const auto listener = weak.lock()) listener->on_step(batch, n);
  }
}

}  // namespace manyworlds
