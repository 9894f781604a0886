// Reading and writing fields of a world in the user's frame. The kernels hold the centre of mass
// and the principal axes; for bodies whose own frame is just that, bits are copied.
#include <algorithm>
#include <cmath>

#include "src/state/worlds.hpp"

namespace manyworlds {

namespace {

int planar_or_spatial(const Plan& plan, int planar, int spatial) {
  return plan.scene().space == Space::planar ? planar : spatial;
}

}  // namespace

template <class Real>
Quat Worlds<Real>::internal_rotation(int world, int body) const {
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  if (!tables().has_orientation) {
    return Quat::Identity();
  }
  const auto value = [&](int c) {
    return static_cast<double>(component(world, body, at.orientation + c));
  };
  if (plan_.scene().space == Space::planar) {
    return Quat(Eigen::AngleAxisd(std::atan2(value(1), value(0)), Vec3::UnitZ()));
  }
  return Quat(value(0), value(1), value(2), value(3)).normalized();
}

template <class Real>
void Worlds<Real>::set_rotation(int world, int body, const Quat& rotation) {
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  const auto put = [&](int c, double x) {
    component(world, body, at.orientation + c) = static_cast<Real>(x);
  };
  if (plan_.scene().space == Space::planar) {
    const Mat3 r = rotation.toRotationMatrix();
    put(0, r(0, 0));
    put(1, r(1, 0));
    return;
  }
  put(0, rotation.w());
  put(1, rotation.x());
  put(2, rotation.y());
  put(3, rotation.z());
}

template <class Real>
template <class Out>
void Worlds<Real>::read(Field field, int world, Out* out) const {
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  const int n = components(field, plan_.scene().space);
  for (std::size_t i = 0; i < data().bodies.size(); ++i) {
    const PlanBody& b = body_of(world, i);
    const int body = static_cast<int>(i);
    Out* to = out + i * static_cast<std::size_t>(n);
    const auto copy = [&](int from) {
      for (int c = 0; c < n; ++c) to[c] = static_cast<Out>(component(world, body, from + c));
    };
    switch (field) {
      case Field::linear_velocity: copy(at.linear); break;
      case Field::angular_velocity: copy(at.angular); break;
      case Field::position:
        if (b.aligned) {
          copy(at.position);
        } else {
          const Quat q = internal_rotation(world, body) * b.principal.conjugate();
          const Vec3 x = center_of_mass(world, body) - q * b.center;
          for (int c = 0; c < n; ++c) to[c] = static_cast<Out>(x[c]);
        }
        break;
      case Field::orientation:
        if (tables().has_orientation && b.principal.vec().isZero(0)) {
          copy(at.orientation);
        } else if (plan_.scene().space == Space::planar) {
          to[0] = Out(1), to[1] = Out(0);  // left out: reads as the identity
        } else {
          const Quat q = internal_rotation(world, body) * b.principal.conjugate();
          to[0] = static_cast<Out>(q.w()), to[1] = static_cast<Out>(q.x());
          to[2] = static_cast<Out>(q.y()), to[3] = static_cast<Out>(q.z());
        }
        break;
    }
  }
}

template <class Real>
template <class In>
void Worlds<Real>::write(Field field, int world, const In* in) {
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  const int n = components(field, plan_.scene().space);
  // Impulses of the old pose would push at the new one.
  const bool moves = field == Field::position || field == Field::orientation;
  if (moves) storage_.clear_contacts(slot_of(world));
  if (moves) storage_.clear_joints(slot_of(world));
  storage_.wake(slot_of(world));
  for (std::size_t i = 0; i < data().bodies.size(); ++i) {
    const PlanBody& b = body_of(world, i);
    const int body = static_cast<int>(i);
    const In* from = in + i * static_cast<std::size_t>(n);
    const auto copy = [&](int to) {
      for (int c = 0; c < n; ++c) component(world, body, to + c) = static_cast<Real>(from[c]);
    };
    const auto place_origin = [&](const Vec3& origin, const Quat& q) {
      const Vec3 x = origin + q * b.center;
      for (int c = 0; c < planar_or_spatial(plan_, 2, 3); ++c) {
        component(world, body, at.position + c) = static_cast<Real>(x[c]);
      }
    };
    switch (field) {
      case Field::linear_velocity: copy(at.linear); break;
      case Field::angular_velocity: copy(at.angular); break;
      case Field::position:
        if (b.aligned) {
          copy(at.position);
        } else {
          Vec3 origin = Vec3::Zero();
          for (int c = 0; c < n; ++c) origin[c] = static_cast<double>(from[c]);
          place_origin(origin, internal_rotation(world, body) * b.principal.conjugate());
        }
        break;
      case Field::orientation: {
        if (!tables().has_orientation) break;
        if (b.aligned) {
          copy(at.orientation);
          break;
        }
        // The body turns about its own origin, so the centre of mass moves.
        const Quat before = internal_rotation(world, body) * b.principal.conjugate();
        const Vec3 origin = center_of_mass(world, body) - before * b.center;
        const auto x = [&](int c) { return static_cast<double>(from[c]); };
        Quat q;
        if (n == 2) {
          q = Quat(Eigen::AngleAxisd(std::atan2(x(1), x(0)), Vec3::UnitZ()));
        } else {
          q = Quat(x(0), x(1), x(2), x(3)).normalized();
        }
        set_rotation(world, body, q * b.principal);
        place_origin(origin, q);
        break;
      }
    }
  }
}

template <class Real>
LaneBlocks Worlds<Real>::lane_blocks(Field field) const {
  const auto at = kernels::state_offsets(tables().dimension, tables().has_orientation);
  LaneBlocks blocks;
  blocks.groups = storage_.groups();
  blocks.bodies = tables().bodies;
  blocks.components = components(field, plan_.scene().space);
  blocks.lanes = storage_.lanes();
  blocks.component_stride = static_cast<std::size_t>(blocks.lanes);
  blocks.body_stride = static_cast<std::size_t>(at.components) * blocks.component_stride;
  blocks.group_stride = static_cast<std::size_t>(blocks.bodies) * blocks.body_stride;
  int first = at.position;
  switch (field) {
    case Field::position: break;
    case Field::orientation:
      if (!tables().has_orientation) return blocks;
      first = at.orientation;
      break;
    case Field::linear_velocity: first = at.linear; break;
    case Field::angular_velocity: first = at.angular; break;
  }
  blocks.data = storage_.group(0).state + static_cast<std::ptrdiff_t>(first) * blocks.lanes;
  return blocks;
}

template <class Real>
void Worlds<Real>::set_initial(Field field, int world, const double* in) {
  auto& values = initial_[static_cast<std::size_t>(field)];
  if (in == nullptr) return values.clear();
  const std::size_t numbers =
      data().bodies.size() * static_cast<std::size_t>(components(field, plan_.scene().space));
  values.resize(static_cast<std::size_t>(worlds_) * numbers);
  std::copy_n(
      in, numbers,
      values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(world) * numbers));
}

#define MW_INSTANTIATE(Real)                                            \
  template void Worlds<Real>::read<float>(Field, int, float*) const;    \
  template void Worlds<Real>::read<double>(Field, int, double*) const;  \
  template void Worlds<Real>::write<float>(Field, int, const float*);   \
  template void Worlds<Real>::write<double>(Field, int, const double*); \
  template LaneBlocks Worlds<Real>::lane_blocks(Field) const;           \
  template void Worlds<Real>::set_initial(Field, int, const double*);   \
  template Quat Worlds<Real>::internal_rotation(int, int) const;        \
  template void Worlds<Real>::set_rotation(int, int, const Quat&);
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
