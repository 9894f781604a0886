// What was seen of a world, in the order and the names of the scene.
#include <algorithm>
#include <stdexcept>

#include "src/api/batch_data.hpp"
#include "src/api/observations.hpp"

namespace manyworlds {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The kernels' row of what a world reads of its motion.
int motion_row(Observed what, bool planar) {
  switch (what) {
    case Observed::kinetic_energy: return kernels::kKinetic;
    case Observed::potential_energy: return kernels::kPotential;
    case Observed::mass: return kernels::kMass;
    case Observed::momentum: return kernels::kMomentum;
    case Observed::angular_momentum: return kernels::kAngular + (planar ? 2 : 0);
    default: return kernels::kCentre;
  }
}

struct ShapeName {
  int body = -1, shape = -1;
};
// Of a shape as rays count them: fixed shapes, then those of bodies.
ShapeName shape_name(const PlanData& plan, int shape) {
  if (shape < 0) return {};
  const int fixed = static_cast<int>(plan.fixed.size());
  if (shape < fixed) return {plan.fixed[at(shape)].scene_body, plan.fixed[at(shape)].shape};
  const PlanCollider& c = plan.colliders[at(shape - fixed)];
  return {c.scene_body, c.shape};
}

[[noreturn]] void not_observed(Observed what, const std::string& by) {
  reject(std::string(to_string(what)) + " is not observed: give " + by +
         " in BatchOptions::observe");
}

}  // namespace

template <class Real>
template <class Out>
void ObservationsOf<Real>::read_loads(Observed what, const Kind& kind, const PlanData& plan,
                                      std::size_t world, Out* out) {
  const bool planar = plan.scene.space == Space::planar, torque = what == Observed::joint_torque;
  const std::size_t joints = plan.scene.joints.size();
  if (joints == 0) return;
  const std::size_t first = torque ? (planar ? 5 : 3) : 0, dim = planar ? (torque ? 1 : 2) : 3;
  const Real* from = kind.joint_rows.data() + world * joints * kernels::kJointRows + first;
  for (std::size_t i = 0; i < joints; ++i) {
    for (std::size_t c = 0; c < dim; ++c) {
      out[i * dim + c] = static_cast<Out>(from[i * kernels::kJointRows + c]);
    }
  }
}

template <class Real>
template <class Out>
void ObservationsOf<Real>::read_world(Observed what, int k, int world, Out* out) const {
  const Kind& kind = kinds_[at(k)];
  const PlanData& plan = worlds_[at(k)]->data();
  const bool planar = plan.scene.space == Space::planar;
  const std::size_t w = at(world), rays = kind.rays.size();
  const std::size_t size = observed_size(what, plan, rays);
  const auto copy = [&](const auto* from) {
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<Out>(from[i]);
  };
  const auto need = [&](Observer observer) {
    if (!has(observer)) not_observed(what, std::string("Observer::") + to_string(observer));
  };
  switch (what) {
    case Observed::penetration: need(Observer::penetration); return copy(&kind.penetration[w]);
    case Observed::residual: need(Observer::residual); return copy(&kind.residual[w * size]);
    case Observed::contact_count: need(Observer::contacts); return copy(&kind.count[w]);
    case Observed::touching: need(Observer::touching); return copy(kind.touching.data() + w * size);
    case Observed::joint_force:
    case Observed::joint_torque:
      need(Observer::joint_loads);
      return read_loads(what, kind, plan, w, out);
    case Observed::ray_distance:
    case Observed::ray_normal:
    case Observed::ray_body:
    case Observed::ray_shape: break;
    default:
      need(Observer::motion);
      return copy(&kind.motion[w * kernels::kMotionRows + at(motion_row(what, planar))]);
  }
  if (rays == 0) not_observed(what, "rays");
  const std::size_t dim = planar ? 2 : 3;
  for (std::size_t i = 0; i < rays; ++i) {
    const Real* hit = &kind.hit_rows[(w * rays + i) * kernels::kHitRows];
    const ShapeName name = shape_name(plan, kind.hit_shape[w * rays + i]);
    if (what == Observed::ray_distance) out[i] = static_cast<Out>(hit[0]);
    if (what == Observed::ray_body) out[i] = static_cast<Out>(name.body);
    if (what == Observed::ray_shape) out[i] = static_cast<Out>(name.shape);
    for (std::size_t c = 0; what == Observed::ray_normal && c < dim; ++c) {
      out[i * dim + c] = static_cast<Out>(hit[1 + c]);
    }
  }
}

template <class Real>
template <class Out>
void ObservationsOf<Real>::read_worlds(Observed what, int k, int first, int count, Out* out) const {
  const Kind& kind = kinds_[at(k)];
  const PlanData& plan = worlds_[at(k)]->data();
  const std::size_t size = observed_size(what, plan, kind.rays.size());
  const bool speed = what == Observed::joint_speed;
  if (speed || what == Observed::joint_position) {  // of all worlds in one go: read in every step
    if (!has(Observer::joints)) not_observed(what, "Observer::joints");
    const Real* from = kind.coordinate_rows.data() + at(first) * size * kernels::kCoordinateRows;
    for (std::size_t i = 0; i < at(count) * size; ++i) {
      out[i] = static_cast<Out>(from[i * kernels::kCoordinateRows + speed]);
    }
    return;
  }
  for (int w = first; w < first + count; ++w, out += size) read_world(what, k, w, out);
}
template <class Real>
void ObservationsOf<Real>::read(Observed what, int k, int first, int count, float* out) const {
  read_worlds(what, k, first, count, out);
}
template <class Real>
void ObservationsOf<Real>::read(Observed what, int k, int first, int count, double* out) const {
  read_worlds(what, k, first, count, out);
}

template <class Real>
std::vector<StepContact> ObservationsOf<Real>::contacts(int k, int world) const {
  if (!has(Observer::contacts)) not_observed(Observed::contact_count, "Observer::contacts");
  const Kind& kind = kinds_[at(k)];
  const std::size_t w = at(world);
  std::vector<StepContact> out(at(std::min(kind.count[w], kind.room)));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& from = kind.contacts[w * at(kind.room) + i];
    StepContact& to = out[i];
    const PairNames names = names_of(worlds_[at(k)]->data(), worlds_[at(k)]->tables(), from.key);
    to.body_a = names.a.body(), to.shape_a = names.a;
    to.body_b = names.b.body(), to.shape_b = names.b;
    for (int c = 0; c < 3; ++c) {
      to.normal[c] = static_cast<double>(from.normal[c]);
      to.point[c] = static_cast<double>(from.point[c]);
      to.friction_impulse[c] = static_cast<double>(from.friction[c]);
    }
    to.separation = static_cast<double>(from.separation);
    to.feature = from.feature;
    to.normal_impulse = static_cast<double>(from.impulse);
    to.twist_impulse = static_cast<double>(from.twist);
  }
  return out;
}

#define MW_INSTANTIATE(Real)                                                        \
  template void ObservationsOf<Real>::read(Observed, int, int, int, float*) const;  \
  template void ObservationsOf<Real>::read(Observed, int, int, int, double*) const; \
  template std::vector<StepContact> ObservationsOf<Real>::contacts(int, int) const;
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
