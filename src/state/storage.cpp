#include "src/state/storage.hpp"

#include <algorithm>
#include <utility>

#include "kernels/data/pair_keys.hpp"

namespace manyworlds {

template <class Real>
Storage<Real>::Storage(const kernels::SceneConstants<Real>& tables, int groups, int lanes)
    : tables_(tables), groups_(groups), lanes_(lanes) {
  const auto& t = tables_;
  state_ = AlignedBuffer<Real>(index(lane_count()) * index(t.state_size));
  status_ = AlignedBuffer<std::uint32_t>(index(lane_count()));
  // The newton solver begins with accelerations, not with impulses.
  const bool stores = t.has_contacts && t.tree.links == 0;
  for (std::size_t l = 0; stores && l < kernels::kLists; ++l) {
    const std::size_t capacity = index(t.capacity[l]);
    if (capacity == 0) continue;
    const int row = kernels::cache_row_size(t, static_cast<kernels::ListId>(l));
    cache_rows_[l] =
        AlignedBuffer<Real>(index(lane_count()) * (capacity + kernels::kFirstRow) * index(row));
    cache_keys_[l] = AlignedBuffer<std::int32_t>(index(lane_count()) * (capacity + 1));
  }
  if (t.has_joints) {
    joint_impulse_ =
        AlignedBuffer<Real>(index(lane_count()) * index(t.parts) * kernels::kPartImpulses);
  }
  if (t.controls > 0) {
    control_ = AlignedBuffer<Real>(index(lane_count()) * index(t.controls));
  }
  if (t.has_sleep) make_activity();
  if (t.breakable > 0) make_disabled_joints();
  reached_.resize(index(t.bodies));
}

template <class Real>
kernels::GroupView<Real> Storage<Real>::group(int g) const {
  const auto& t = tables_;
  const std::size_t lanes = index(lanes_), at = index(g);
  kernels::GroupView<Real> view{};
  view.state = state_.data() + at * lanes * index(t.state_size);
  view.status = status_.data() + at * lanes;
  view.constants = t.constants;
  const kernels::ConstantBlocks<Real> own = constants_.group(g);
  if (own.body) view.constants.body = own.body;
  if (own.shape) view.constants.shape = own.shape;
  if (own.polygon) view.constants.polygon = own.polygon;
  if (own.material) view.constants.material = own.material;
  if (own.joint) view.constants.joint = own.joint;
  if (own.thrust) view.constants.thrust = own.thrust;
  if (own.link) view.constants.link = own.link;
  if (own.drag) view.constants.drag = own.drag;
  if (own.dof) view.constants.dof = own.dof;
  if (own.actuator) view.constants.actuator = own.actuator;
  if (own.limit) view.constants.limit = own.limit;
  if (own.contact) view.constants.contact = own.contact;
  if (own.attractor) view.constants.attractor = own.attractor;
  if (t.controls > 0) view.control = control_.data() + at * lanes * index(t.controls);
  if (t.has_joints) {
    view.joint_impulse =
        joint_impulse_.data() + at * lanes * index(t.parts) * kernels::kPartImpulses;
  }
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    const int row = kernels::cache_row_size(t, static_cast<kernels::ListId>(l));
    view.cache[l].rows =
        cache_rows_[l].data() + at * lanes * index(t.capacity[l] + kernels::kFirstRow) * index(row);
    view.cache[l].keys = cache_keys_[l].data() + at * lanes * index(t.capacity[l] + 1);
  }
  if (!disabled_joints_.empty())
    view.disabled_joints = disabled_joints_.data() + at * index(t.joints);
  if (forced_) view.force = force_.data() + at * lanes * index(t.bodies) * 6;
  if (has_activity()) {
    const std::size_t bodies = index(t.bodies);
    view.asleep = asleep_.data() + at * bodies;
    view.absent = absent_.data() + at * bodies;
    view.idle = idle_.data() + at;
    if (t.has_sleep) {
      view.rest_time = rest_time_.data() + at * bodies * lanes;
      view.island = island_.data() + at * bodies * lanes;
      view.resting = resting_.data() + at;
    }
  }
  return view;
}

template <class Real>
void Storage<Real>::make_constants(const PlanData& plan) {
  const PlanVaries& v = plan.varies;
  constants_ = Constants<Real>(
      plan,
      {v.body_constants(), v.shapes, v.materials, v.shapes || v.joints, v.links, v.dofs,
       v.actuators, v.limits, v.contacts, v.attractors, v.shapes || v.thrusts},
      groups_, lanes_);
}

template <class Real>
std::size_t Storage<Real>::bytes() const {
  std::size_t total =
      constants_.bytes() +
      (state_.size() + joint_impulse_.size() + control_.size() + rest_time_.size()) * sizeof(Real) +
      (status_.size() + asleep_.size() + absent_.size() + resting_.size() + island_.size() +
       disabled_joints_.size()) *
          sizeof(std::uint32_t);
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    total += cache_rows_[l].size() * sizeof(Real) + cache_keys_[l].size() * sizeof(std::int32_t);
  }
  return total;
}

template <class Real>
Real& Storage<Real>::number(int lane_index, int row) const {
  const std::size_t at = group_of(lane_index) * index(tables_.state_size) + index(row);
  return state_[at * index(lanes_) + lane_of(lane_index)];
}

template <class Real>
std::int32_t* Storage<Real>::keys_of(int lane_index, std::size_t list) const {
  const std::size_t rows = index(tables_.capacity[list] + 1);
  return cache_keys_[list].data() + group_of(lane_index) * rows * index(lanes_) +
         lane_of(lane_index);
}

template <class Real>
Real* Storage<Real>::rows_of(int lane_index, std::size_t list) const {
  const std::size_t rows = index(tables_.capacity[list] + kernels::kFirstRow);
  const std::size_t before = group_of(lane_index) * rows + kernels::kFirstRow;
  const auto size = kernels::cache_row_size(tables_, static_cast<kernels::ListId>(list));
  return cache_rows_[list].data() + (before * index(lanes_) + lane_of(lane_index)) * index(size);
}

template <class Real>
void Storage<Real>::clear_contacts(int lane_index) {
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    *keys_of(lane_index, l) = kernels::kEndOfKeys;
  }
}

template <class Real>
void Storage<Real>::clear_joints(int lane_index) {
  for (int i = 0; i < tables_.parts; ++i) clear_part(lane_index, i);
}

template <class Real>
void Storage<Real>::clear_part(int lane_index, int part) {
  const std::size_t lanes = index(lanes_),
                    at = group_of(lane_index) * index(tables_.parts) + index(part);
  Real* p = joint_impulse_.data() + at * kernels::kPartImpulses * lanes + lane_of(lane_index);
  for (std::size_t i = 0; i < kernels::kPartImpulses; ++i) p[i * lanes] = Real(0);
}

template <class Real>
template <class Keep>
void Storage<Real>::keep_contacts(int lane_index, Keep keep) {
  const auto& t = tables_;
  for (std::size_t l = 0; l < kernels::kLists; ++l) {
    if (cache_keys_[l].empty()) continue;
    const auto list = static_cast<kernels::ListId>(l);
    const std::size_t row = index(kernels::cache_row_size(t, list)), lanes = index(lanes_);
    std::int32_t* keys = keys_of(lane_index, l);
    Real* rows = rows_of(lane_index, l);
    std::size_t kept = 0;
    for (std::size_t i = 0; keys[i] != kernels::kEndOfKeys; i += lanes) {
      const kernels::PairOfKey pair = kernels::pair_of_key(t, keys[i]);
      const int a = is_fixed(list) ? -1 : t.collider_body[pair.a];
      if (!keep(a, t.collider_body[pair.b])) continue;
      std::copy_n(rows + i * row, row, rows + kept * row);
      keys[kept] = keys[i];
      kept += lanes;
    }
    keys[kept] = kernels::kEndOfKeys;
  }
}

template <class Real>
void Storage<Real>::drop_impulses(int lane_index, int body) {
  std::fill(reached_.begin(), reached_.end(), false);
  reached_[index(body)] = true;
  // A kinematic body passes no impulse on.
  const auto reached = [&](int b) {
    return b >= 0 && reached_[index(b)] && (b == body || !tables_.body[b].kinematic);
  };
  const auto moving_a = [&](int part) {  // -1: the world
    const int a = tables_.part[part].body_a;
    return a == tables_.bodies ? -1 : a;
  };
  for (bool grows = true; grows;) {
    grows = false;
    const auto reach_on = [&](int a, int b) {
      if (a >= 0 && reached(a) != reached(b)) {
        const int next = reached(a) ? b : a;
        grows = grows || !reached_[index(next)];
        reached_[index(next)] = true;
      }
      return true;
    };
    keep_contacts(lane_index, reach_on);
    for (int i = 0; i < tables_.parts; ++i) {
      if (!joint_disabled(lane_index, tables_.part[i].joint))
        reach_on(moving_a(i), tables_.part[i].body_b);
    }
  }
  keep_contacts(lane_index, [&](int a, int b) { return !reached(a) && !reached(b); });
  for (int i = 0; i < tables_.parts; ++i) {
    if (reached(moving_a(i)) || reached(tables_.part[i].body_b)) clear_part(lane_index, i);
  }
}

template <class Real>
void Storage<Real>::add_force(int lane_index, int body, const Vec3& force, const Vec3& torque) {
  const std::size_t lanes = index(lanes_);
  if (force_.empty()) force_ = AlignedBuffer<Real>(index(lane_count()) * index(tables_.bodies) * 6);
  forced_ = true;
  Real* p = force_.data() + body_at(lane_index, body) * 6 * lanes + lane_of(lane_index);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto row = static_cast<Eigen::Index>(c);
    p[c * lanes] += static_cast<Real>(force[row]);
    p[(c + 3) * lanes] += static_cast<Real>(torque[row]);
  }
}

template <class Real>
void Storage<Real>::clear_forces(int lane_index) {
  if (!forced_) return;
  const std::size_t lanes = index(lanes_);
  Real* p = force_.data() + body_at(lane_index, 0) * 6 * lanes + lane_of(lane_index);
  for (std::size_t i = 0; i < index(tables_.bodies) * 6; ++i) p[i * lanes] = Real(0);
}

template <class Real>
void Storage<Real>::clear_forces() {
  if (!forced_) return;
  std::fill(force_.data(), force_.data() + force_.size(), Real(0));
  forced_ = false;
}

template <class Real>
void Storage<Real>::find_forces() {
  forced_ = forced_ && std::any_of(force_.data(), force_.data() + force_.size(),
                                   [](Real f) { return !(f == Real(0)); });
}

template <class Real>
void Storage<Real>::make_activity() {
  if (has_activity()) return;
  const std::size_t bodies = index(tables_.bodies);
  asleep_ = AlignedBuffer<std::uint32_t>(index(groups_) * bodies);
  absent_ = AlignedBuffer<std::uint32_t>(index(groups_) * bodies);
  idle_ = AlignedBuffer<std::uint32_t>(index(groups_));
  if (!tables_.has_sleep) return;
  resting_ = AlignedBuffer<std::uint32_t>(index(groups_));
  rest_time_ = AlignedBuffer<Real>(index(lane_count()) * bodies);
  island_ = AlignedBuffer<std::int32_t>(index(lane_count()) * bodies);
}

template <class Real>
void Storage<Real>::set_absent(int lane_index, int body, bool absent) {
  put_bit(absent_[body_at(lane_index, body)], lane_of(lane_index), absent);
}

template <class Real>
void Storage<Real>::make_disabled_joints() {
  if (disabled_joints_.empty()) {
    disabled_joints_ = AlignedBuffer<std::uint32_t>(index(groups_) * index(tables_.joints));
  }
}

template <class Real>
void Storage<Real>::set_joint_disabled(int lane_index, int joint, bool disabled) {
  put_bit(disabled_joints_[joint_at(lane_index, joint)], lane_of(lane_index), disabled);
}

template <class Real>
void Storage<Real>::enable_all_joints(int lane_index) {
  for (int j = 0; !disabled_joints_.empty() && j < tables_.joints; ++j)
    set_joint_disabled(lane_index, j, false);
}

template <class Real>
void Storage<Real>::find_idle_in(std::size_t group) {
  const std::size_t bodies = index(tables_.bodies);
  idle_[group] = 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    idle_[group] |= asleep_[group * bodies + b] | absent_[group * bodies + b];
  }
}

template <class Real>
void Storage<Real>::wake(int lane_index) {
  if (!tables_.has_sleep) return;
  const std::size_t lanes = index(lanes_);
  for (int b = 0; b < tables_.bodies; ++b) {
    put_bit(asleep_[body_at(lane_index, b)], lane_of(lane_index), false);
    rest_time_[body_at(lane_index, b) * lanes + lane_of(lane_index)] = Real(0);
  }
  put_bit(resting_[group_of(lane_index)], lane_of(lane_index), false);
}

template <class Real>
void Storage<Real>::wake_island(int lane_index, int body) {
  if (!tables_.has_sleep) return;
  const std::size_t lanes = index(lanes_), lane = lane_of(lane_index);
  const bool slept = asleep(lane_index, body);
  const std::int32_t label = island_[body_at(lane_index, body) * lanes + lane];
  for (int b = 0; b < tables_.bodies; ++b) {
    const std::size_t at = body_at(lane_index, b);
    const bool together = slept && asleep(lane_index, b) && island_[at * lanes + lane] == label &&
                          !tables_.body[b].kinematic;
    if (b != body && !together) continue;
    put_bit(asleep_[at], lane, false);
    rest_time_[at * lanes + lane] = Real(0);
  }
  put_bit(resting_[group_of(lane_index)], lane, false);
}

template <class Real>
void Storage<Real>::rest(int lane_index) {
  if (!tables_.has_sleep) return;
  const auto at = kernels::state_offsets(tables_.dimension);
  const bool planar = tables_.dimension == kernels::Dimension::planar;
  for (int b = 0; b < tables_.bodies; ++b) {
    put_bit(asleep_[body_at(lane_index, b)], lane_of(lane_index), true);
    // Kinematic bodies, too.
    const int body = b * tables_.state_stride;
    for (int c = 0; c < (planar ? 2 : 3); ++c) number(lane_index, body + at.linear + c) = Real(0);
    for (int c = 0; c < (planar ? 1 : 3); ++c) number(lane_index, body + at.angular + c) = Real(0);
  }
  put_bit(resting_[group_of(lane_index)], lane_of(lane_index), true);
  find_idle_in(group_of(lane_index));
}

template class Storage<float>;
template class Storage<double>;

}  // namespace manyworlds
