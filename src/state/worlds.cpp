// How worlds begin, inputs and the results of single worlds; fields are read and written in
// field_access.cpp, worlds move in packing.cpp.
#include "src/state/worlds.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/hash.hpp"

namespace manyworlds {

template <class Real>
Worlds<Real>::Worlds(Plan plan, int worlds, int first, const BatchOptions& options, int lanes)
    : plan_(std::move(plan)),
      layout_(state_layout(plan_.data())),
      tables_(std::make_unique<TablesOf<Real>>(plan_.data(), options, lanes)),
      storage_(tables(), (worlds + lanes - 1) / lanes, lanes),
      worlds_(worlds),
      first_(first),
      seed_(static_cast<std::size_t>(worlds)),
      episode_(static_cast<std::size_t>(worlds), 0),
      world_in_(static_cast<std::size_t>(storage_.lane_count()), -1),
      by_count_(static_cast<std::size_t>(storage_.groups())) {
  for (int w = 0; w < worlds_; ++w) {
    lane_index_.push_back(w);
    seed_[static_cast<std::size_t>(w)] = options.seed + static_cast<std::uint64_t>(first_ + w);
    world_in_[static_cast<std::size_t>(w)] = w;
  }
  const auto& bodies = plan_.scene().bodies;
  if (std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return !b.enabled; })) {
    storage_.make_activity();
  }
  make_parameters();
  restart();
}

// Puts a body where the user wants it; what the kernels hold is its centre of mass and its
// principal axes.
template <class Real>
void Worlds<Real>::place(int world, int body, const BodyState& s) {
  const PlanBody& b = body_of(world, static_cast<std::size_t>(body));
  const bool planar = plan_.scene().space == Space::planar;
  const Vec3 x = s.position + s.rotation * b.center;
  for (int c = 0; c < (planar ? 2 : 3); ++c) {
    number(Field::position, world, body, c) = static_cast<Real>(x[c]);
    number(Field::linear_velocity, world, body, c) = static_cast<Real>(s.linear_velocity[c]);
  }
  for (int c = 0; c < (planar ? 1 : 3); ++c) {
    number(Field::angular_velocity, world, body, c) =
        static_cast<Real>(s.angular_velocity[planar ? 2 : c]);
  }
  if (tables().has_orientation) set_rotation(world, body, s.rotation * b.principal);
}

// Where a body of the scene begins in this world, whose numbers have just been applied.
template <class Real>
BodyState Worlds<Real>::drawn_state(int world, int scene_body, const Draws& draws) const {
  const Scene& scene = data().varies.starts ? own_->scene : plan_.scene();
  return draw_initial_state(scene, scene_body, draws, [&](int body) {
    return body_of(world, static_cast<std::size_t>(plan_.row(BodyId(body)))).center;
  });
}

template <class Real>
void Worlds<Real>::initialise(int world) {
  const Draws draws(seed_[static_cast<std::size_t>(world)],
                    episode_[static_cast<std::size_t>(world)]);
  const int lane_index = lane_index_of(world);
  if (own_) {
    draw_values(world, draws);
    apply_values(world);
  }
  // What the scene says nothing of begins at 0.
  for (int row = 0; row < layout_.rows; ++row) storage_.number(lane_index, row) = Real(0);
  for (std::size_t b = 0; b < data().bodies.size(); ++b) {
    const int scene_body = data().bodies[b].scene_body, body = static_cast<int>(b);
    const Body& described = plan_.scene().bodies[static_cast<std::size_t>(scene_body)];
    if (!data().has_trees()) {
      place(world, body, drawn_state(world, scene_body, draws));
    }
    if (storage_.has_activity()) storage_.set_absent(lane_index, body, !described.enabled);
  }
  if (data().has_trees()) begin_trees(world, draws);
  const auto write_initial = [&](Field field) {
    const auto& values = initial_[static_cast<std::size_t>(field)];
    const std::size_t numbers = values.size() / static_cast<std::size_t>(worlds_);
    if (numbers > 0) write(field, world, values.data() + static_cast<std::size_t>(world) * numbers);
  };
  // A body rotates about its own origin, so orientations come first.
  write_initial(Field::orientation);
  for (const Field field : kFields) {
    if (field != Field::orientation) write_initial(field);
  }
  if (storage_.has_activity()) storage_.find_idle(lane_index);
  // When its energy is audited does not change: worlds that begin anew would else be audited in
  // turns, and each audit is one of the whole group.
  std::uint32_t& status = storage_.status(lane_index);
  status = (status & kernels::kFrozen) != 0 ? 0 : status & kernels::kAuditCount;
  storage_.clear_contacts(lane_index);
  storage_.clear_joints(lane_index);
  storage_.enable_all_joints(lane_index);
  const auto& controls = plan_.scene().controls;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    storage_.controls(lane_index)[i * static_cast<std::size_t>(storage_.lanes())] =
        static_cast<Real>(controls[i].initial);
  }
  storage_.clear_forces(lane_index);
  storage_.wake(lane_index);
}

template <class Real>
void Worlds<Real>::restart() {
  std::fill(episode_.begin(), episode_.end(), 0u);
  clear_forces();
  for (int w = 0; w < worlds_; ++w) {
    storage_.status(lane_index_of(w)) = 0;
    initialise(w);
  }
  // Lanes without a world repeat the last one; where looking for pairs goes lane by lane, nothing
  // is there in them.
  for (int lane_index = 0; lane_index < storage_.lane_count(); ++lane_index) {
    if (world_in_[static_cast<std::size_t>(lane_index)] >= 0) continue;
    if (tables().sparse) storage_.make_activity();
    storage_.copy(lane_index_of(worlds_ - 1), lane_index);
    for (int b = 0; tables().sparse && b < tables().bodies; ++b)
      storage_.set_absent(lane_index, b, true);
    if (tables().sparse) storage_.find_idle(lane_index);
    storage_.rest(lane_index);
  }
}

template <class Real>
void Worlds<Real>::begin(int world) {
  std::unique_lock<std::mutex> lock(own_plan_, std::defer_lock);
  if (own_) lock.lock();
  initialise(world);
}
template <class Real>
void Worlds<Real>::reset(int world) {
  ++episode_[static_cast<std::size_t>(world)];
  begin(world);
}
template <class Real>
void Worlds<Real>::reset(int world, std::uint64_t seed) {
  seed_[static_cast<std::size_t>(world)] = seed;
  episode_[static_cast<std::size_t>(world)] = 0;
  begin(world);
}

template <class Real>
void Worlds<Real>::add_force(int world, int body, const Vec3& force, const Vec3& torque) {
  if (data().bodies[static_cast<std::size_t>(body)].inv_mass == 0) return;
  if (!(force.isZero(0) && torque.isZero(0))) storage_.wake_island(lane_index_of(world), body);
  storage_.add_force(lane_index_of(world), body, force, torque);
}

template <class Real>
void Worlds<Real>::set_enabled(int world, int body, bool enabled) {
  const int lane_index = lane_index_of(world);
  storage_.make_activity();
  if (storage_.absent(lane_index, body) != enabled) return;
  // A body that lies on a kinematic body does not share its island.
  const bool kinematic = data().bodies[static_cast<std::size_t>(body)].inv_mass == 0;
  kinematic ? storage_.wake(lane_index) : storage_.wake_island(lane_index, body);
  if (!enabled) storage_.drop_impulses(lane_index, body);
  storage_.set_absent(lane_index, body, !enabled);
  storage_.find_idle(lane_index);
}

template <class Real>
void Worlds<Real>::set_joint_enabled(int world, int joint, bool enabled) {
  const int lane_index = lane_index_of(world);
  if (joint_enabled(world, joint) == enabled) return;
  storage_.make_disabled_joints();
  for (int i = 0; i < tables().parts; ++i) {
    const kernels::JointPart& part = tables().part[i];
    if (part.joint != joint) continue;
    for (const int body : {part.body_a, part.body_b}) {
      if (body == tables().bodies) continue;
      // A body that is joined to a kinematic body does not share its island.
      tables().body[body].kinematic ? storage_.wake(lane_index)
                                    : storage_.wake_island(lane_index, body);
      if (!enabled) storage_.drop_impulses(lane_index, body);
    }
  }
  storage_.set_joint_disabled(lane_index, joint, !enabled);
  if (storage_.has_activity()) storage_.find_idle(lane_index);
}

template <class Real>
void Worlds<Real>::spawn(int world, int body, const BodyState& state) {
  set_enabled(world, body, false);
  BodyState s = state;
  s.rotation.normalize();
  place(world, body, s);
  set_enabled(world, body, true);
}

template <class Real>
bool Worlds<Real>::asleep(int world, int body) const {
  const bool kinematic = data().bodies[static_cast<std::size_t>(body)].inv_mass == 0;
  return !kinematic && storage_.asleep(lane_index_of(world), body);
}

template <class Real>
Vec3 Worlds<Real>::center_of_mass(int world, int body) const {
  Vec3 x = Vec3::Zero();
  const int dim = plan_.scene().space == Space::planar ? 2 : 3;
  for (int c = 0; c < dim; ++c) {
    x[c] = static_cast<double>(number(Field::position, world, body, c));
  }
  return x;
}

template <class Real>
void Worlds<Real>::add_impulse(int world, int body, const Vec3& impulse, const Vec3& angular) {
  const PlanBody& b = body_of(world, static_cast<std::size_t>(body));
  if (b.inv_mass == 0) return;
  if (!(impulse.isZero(0) && angular.isZero(0))) storage_.wake_island(lane_index_of(world), body);
  const auto add = [&](Field field, int c, double x) {
    Real& value = number(field, world, body, c);
    value = static_cast<Real>(static_cast<double>(value) + x);
  };
  if (plan_.scene().space == Space::planar) {
    for (int c = 0; c < 2; ++c) add(Field::linear_velocity, c, impulse[c] * b.inv_mass);
    add(Field::angular_velocity, 0, angular.z() * b.inv_inertia.z());
    return;
  }
  const Quat q = internal_rotation(world, body);
  const Vec3 spin = q * b.inv_inertia.cwiseProduct(q.conjugate() * angular);
  for (int c = 0; c < 3; ++c) {
    add(Field::linear_velocity, c, impulse[c] * b.inv_mass);
    add(Field::angular_velocity, c, spin[c]);
  }
}

template <class Real>
Status Worlds<Real>::status(int world) const {
  return static_cast<Status>(storage_.status(lane_index_of(world)) & kernels::kPublicStatus);
}

template <class Real>
std::uint64_t Worlds<Real>::hash(int world) const {
  Hasher hasher;
  const int lane_index = lane_index_of(world);
  for (int row = 0; row < layout_.rows; ++row) hasher.add(storage_.number(lane_index, row));
  return hasher.value();
}

template <class Real>
Energy Worlds<Real>::energy(int world) const {
  const bool planar = plan_.scene().space == Space::planar;
  const Vec3 g(gravity(world, 0), gravity(world, 1), gravity(world, 2));
  Energy e;
  for (std::size_t i = 0; i < data().bodies.size(); ++i) {
    const PlanBody& b = body_of(world, i);
    const int body = static_cast<int>(i);
    if (b.inv_mass == 0 || !enabled(world, body)) continue;
    const auto value = [&](Field field, int c) {
      return static_cast<double>(number(field, world, body, c));
    };
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
    for (int c = 0; c < (planar ? 2 : 3); ++c) v[c] = value(Field::linear_velocity, c);
    if (planar) {
      w.z() = value(Field::angular_velocity, 0);
    } else {
      for (int c = 0; c < 3; ++c) w[c] = value(Field::angular_velocity, c);
      w = internal_rotation(world, body).conjugate() * w;
    }
    e.kinetic += 0.5 * b.mass * v.squaredNorm() + 0.5 * w.dot(b.inertia.cwiseProduct(w));
    const Vec3 x = center_of_mass(world, body);
    double height = g.dot(x);
    for (std::size_t k = 0; k < plan_.scene().attractors.size(); ++k) {
      const Attractor a = attractor_of(world, k);
      height += a.strength / std::hypot((a.position - x).norm(), std::max(a.softening, 1e-12));
    }
    e.potential -= b.mass * gravity_scale(world, body) * height;
  }
  return e;
}

template class Worlds<float>;
template class Worlds<double>;

}  // namespace manyworlds
