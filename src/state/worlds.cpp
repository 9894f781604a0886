// Storage, reset and the results of single worlds; fields are read and written in field_access.cpp.
#include "src/state/worlds.hpp"

#include <algorithm>

#include "src/base/hash.hpp"
#include "src/state/initial_state.hpp"

namespace manyworlds {

template <class Real>
Worlds<Real>::Worlds(Plan plan, int worlds, int first, std::uint64_t seed, int lanes)
    : plan_(std::move(plan)),
      tables_(std::make_unique<TablesOf<Real>>(plan_.data())),
      worlds_(worlds),
      first_(first),
      lanes_(lanes),
      groups_((worlds + lanes - 1) / lanes),
      seed_(seed),
      episode_(static_cast<std::size_t>(worlds), 0) {
  const auto& t = tables();
  const auto slots = static_cast<std::size_t>(groups_) * static_cast<std::size_t>(lanes_);
  state_ = AlignedBuffer<Real>(slots * static_cast<std::size_t>(t.state_size));
  status_ = AlignedBuffer<std::uint32_t>(slots);
  for (std::size_t l = 0; t.has_contacts && l < kernels::kLists; ++l) {
    const int capacity = t.capacity[l];
    if (capacity == 0) continue;
    const int row = kernels::cache_row_size(t.dimension, static_cast<kernels::ListId>(l));
    cache_rows_[l] = AlignedBuffer<Real>(slots * static_cast<std::size_t>(capacity + 2) *
                                         static_cast<std::size_t>(row));
    cache_keys_[l] = AlignedBuffer<std::int32_t>(slots * (static_cast<std::size_t>(capacity) + 1));
  }
  restart();
}

template <class Real>
kernels::GroupView<Real> Worlds<Real>::group(int index) const {
  const auto& t = tables();
  const auto lanes = static_cast<std::size_t>(lanes_), g = static_cast<std::size_t>(index);
  kernels::GroupView<Real> view{};
  view.state = state_.data() + g * lanes * static_cast<std::size_t>(t.state_size);
  view.status = status_.data() + g * lanes;
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    const int row = kernels::cache_row_size(t.dimension, static_cast<kernels::ListId>(l));
    view.cache[l].rows = cache_rows_[l].data() + g * lanes *
                                                     static_cast<std::size_t>(t.capacity[l] + 2) *
                                                     static_cast<std::size_t>(row);
    view.cache[l].keys =
        cache_keys_[l].data() + g * lanes * (static_cast<std::size_t>(t.capacity[l]) + 1);
  }
  if (forced_) view.force = force_.data() + g * lanes * static_cast<std::size_t>(t.bodies) * 6;
  return view;
}

template <class Real>
std::size_t Worlds<Real>::bytes() const {
  std::size_t total = state_.size() * sizeof(Real) + status_.size() * sizeof(std::uint32_t);
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    total += cache_rows_[l].size() * sizeof(Real) + cache_keys_[l].size() * sizeof(std::int32_t);
  }
  return total;
}

template <class Real>
Real* Worlds<Real>::component(int world, int body, int component) const {
  const auto& t = tables();
  const auto group = static_cast<std::size_t>(world / lanes_);
  const auto lane = static_cast<std::size_t>(world % lanes_);
  const auto at = static_cast<std::size_t>(body * t.state_stride + component);
  return state_.data() +
         (group * static_cast<std::size_t>(t.state_size) + at) * static_cast<std::size_t>(lanes_) +
         lane;
}

template <class Real>
void Worlds<Real>::clear_contacts(int world) {
  const auto& t = tables();
  const auto w = static_cast<std::size_t>(world);  // lanes of a group lie one after the other
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    const auto stride = (static_cast<std::size_t>(t.capacity[l]) + 1);
    cache_keys_[l][w * stride] = kernels::kEndOfKeys;
  }
}

template <class Real>
void Worlds<Real>::initialise(int world) {
  const Draws draws(seed_ + static_cast<std::uint64_t>(first_ + std::min(world, worlds_ - 1)),
                    episode_[static_cast<std::size_t>(std::min(world, worlds_ - 1))]);
  const Scene& scene = plan_.scene();
  const bool planar = scene.space == Space::planar;
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  for (std::size_t b = 0; b < data().bodies.size(); ++b) {
    const PlanBody& body = data().bodies[b];
    const InitialState s = draw_initial_state(
        scene.bodies[static_cast<std::size_t>(body.scene_body)], body.scene_body, draws);
    const int i = static_cast<int>(b), dim = planar ? 2 : 3;
    const Vec3 x = s.position + s.rotation * body.center;
    for (int c = 0; c < dim; ++c) {
      *component(world, i, at.position + c) = static_cast<Real>(x[c]);
      *component(world, i, at.linear + c) = static_cast<Real>(s.linear_velocity[c]);
    }
    for (int c = 0; c < (planar ? 1 : 3); ++c) {
      *component(world, i, at.angular + c) = static_cast<Real>(s.angular_velocity[planar ? 2 : c]);
    }
    if (tables().has_orientation) set_rotation(world, i, s.rotation * body.principal);
  }
  status_[static_cast<std::size_t>(world)] = 0;
  clear_contacts(world);
}

// The lanes after the last world.
template <class Real>
void Worlds<Real>::fill_padding(int world) {
  if (world != worlds_ - 1) return;
  for (int w = worlds_; w < groups_ * lanes_; ++w) initialise(w);
}

template <class Real>
void Worlds<Real>::restart() {
  std::fill(episode_.begin(), episode_.end(), 0u);
  for (int w = 0; w < worlds_; ++w) initialise(w);
  fill_padding(worlds_ - 1);
  clear_forces();
}

template <class Real>
void Worlds<Real>::reset(int world) {
  ++episode_[static_cast<std::size_t>(world)];
  initialise(world);
  fill_padding(world);
}

template <class Real>
void Worlds<Real>::add_force(int world, int body, const Vec3& force, const Vec3& torque) {
  const auto& t = tables();
  const auto lanes = static_cast<std::size_t>(lanes_);
  if (force_.empty()) {
    force_ = AlignedBuffer<Real>(static_cast<std::size_t>(groups_) * lanes *
                                 static_cast<std::size_t>(t.bodies) * 6);
  }
  forced_ = true;
  const auto group = static_cast<std::size_t>(world / lanes_);
  const auto block = (group * static_cast<std::size_t>(t.bodies) + static_cast<std::size_t>(body));
  Real* p = force_.data() + block * 6 * lanes + static_cast<std::size_t>(world % lanes_);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    p[c * lanes] += static_cast<Real>(force[row]);
    p[(c + 3) * lanes] += static_cast<Real>(torque[row]);
  }
}

template <class Real>
void Worlds<Real>::clear_forces() {
  if (!forced_) return;
  std::fill(force_.data(), force_.data() + force_.size(), Real(0));
  forced_ = false;
}

template <class Real>
Vec3 Worlds<Real>::center_of_mass(int world, int body) const {
  Vec3 x = Vec3::Zero();
  const int dim = plan_.scene().space == Space::planar ? 2 : 3;
  for (int c = 0; c < dim; ++c) x[c] = static_cast<double>(*component(world, body, c));
  return x;
}

template <class Real>
void Worlds<Real>::add_impulse(int world, int body, const Vec3& impulse, const Vec3& angular) {
  const PlanBody& b = data().bodies[static_cast<std::size_t>(body)];
  if (b.inv_mass == 0) return;
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  const auto add = [&](int c, double x) {
    Real* p = component(world, body, c);
    *p = static_cast<Real>(static_cast<double>(*p) + x);
  };
  if (plan_.scene().space == Space::planar) {
    for (int c = 0; c < 2; ++c) add(at.linear + c, impulse[c] * b.inv_mass);
    add(at.angular, angular.z() * b.inv_inertia.z());
    return;
  }
  const Quat q = internal_rotation(world, body);
  const Vec3 spin = q * b.inv_inertia.cwiseProduct(q.conjugate() * angular);
  for (int c = 0; c < 3; ++c) {
    add(at.linear + c, impulse[c] * b.inv_mass);
    add(at.angular + c, spin[c]);
  }
}

template <class Real>
Status Worlds<Real>::status(int world) const {
  return static_cast<Status>(status_[static_cast<std::size_t>(world)]);
}

template <class Real>
std::uint64_t Worlds<Real>::hash(int world) const {
  Hasher hasher;
  const auto& t = tables();
  for (int b = 0; b < t.bodies; ++b) {
    for (int c = 0; c < t.state_stride; ++c) hasher.add(*component(world, b, c));
  }
  return hasher.value();
}

template <class Real>
Energy Worlds<Real>::energy(int world) const {
  const Scene& scene = plan_.scene();
  const bool planar = scene.space == Space::planar;
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  Energy e;
  for (std::size_t i = 0; i < data().bodies.size(); ++i) {
    const PlanBody& b = data().bodies[i];
    if (b.inv_mass == 0) continue;
    const int body = static_cast<int>(i);
    const auto value = [&](int c) { return static_cast<double>(*component(world, body, c)); };
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
    for (int c = 0; c < (planar ? 2 : 3); ++c) v[c] = value(at.linear + c);
    if (planar) {
      w.z() = value(at.angular);
    } else {
      for (int c = 0; c < 3; ++c) w[c] = value(at.angular + c);
      w = internal_rotation(world, body).conjugate() * w;
    }
    e.kinetic += 0.5 * b.mass * v.squaredNorm() + 0.5 * w.dot(b.inertia.cwiseProduct(w));
    const double scale = scene.bodies[static_cast<std::size_t>(b.scene_body)].gravity_scale;
    e.potential -= b.mass * scale * scene.options.gravity.dot(center_of_mass(world, body));
  }
  return e;
}

template class Worlds<float>;
template class Worlds<double>;

}  // namespace manyworlds
