// Reading and writing fields of a world in the user's frame. The kernels hold the centre of mass
// and the principal axes; for bodies whose own frame is just that, and for all other fields, bits
// are copied.
#include <algorithm>
#include <cmath>

#include "src/state/worlds.hpp"

namespace manyworlds {

namespace {

// A rotation as the components of Field::orientation, and back.
Quat rotation_of(const double* q, Space space) {
  if (space == Space::planar) {
    return Quat(Eigen::AngleAxisd(std::atan2(q[1], q[0]), Vec3::UnitZ()));
  }
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}
std::array<double, 4> components_of(const Quat& q, Space space) {
  if (space == Space::spatial) return {q.w(), q.x(), q.y(), q.z()};
  const Mat3 r = q.toRotationMatrix();
  return {r(0, 0), r(1, 0), 0, 0};
}

// Whether what the kernels hold of a body is what the user sees.
bool is_copied(Field field, const PlanBody& b, bool has_orientation, bool writes) {
  if (field == Field::position) return b.aligned;
  if (field == Field::orientation) {
    return has_orientation && (writes ? b.aligned : b.principal.vec().isZero(0));
  }
  return true;
}

}  // namespace

template <class Real>
Quat Worlds<Real>::internal_rotation(int world, int body) const {
  if (!layout_.has(Field::orientation)) return Quat::Identity();
  const Space space = plan_.scene().space;
  std::array<double, 4> q{};
  for (int c = 0; c < components(Field::orientation, space); ++c) {
    q[static_cast<std::size_t>(c)] =
        static_cast<double>(number(Field::orientation, world, body, c));
  }
  return rotation_of(q.data(), space);
}

template <class Real>
Quat Worlds<Real>::rotation(int world, int body) const {
  const PlanBody& b = body_of(world, static_cast<std::size_t>(body));
  return internal_rotation(world, body) * b.principal.conjugate();
}

template <class Real>
void Worlds<Real>::set_rotation(int world, int body, const Quat& rotation) {
  const Space space = plan_.scene().space;
  const auto q = components_of(rotation, space);
  for (int c = 0; c < components(Field::orientation, space); ++c) {
    number(Field::orientation, world, body, c) = static_cast<Real>(q[static_cast<std::size_t>(c)]);
  }
}

template <class Real>
void Worlds<Real>::set_origin(int world, int body, const Vec3& origin, const Quat& rotation) {
  const Vec3 x = origin + rotation * body_of(world, static_cast<std::size_t>(body)).center;
  for (int c = 0; c < components(Field::position, plan_.scene().space); ++c) {
    number(Field::position, world, body, c) = static_cast<Real>(x[c]);
  }
}

template <class Real>
template <class Out>
void Worlds<Real>::read_as(Field field, int world, Out* out) const {
  const Space space = plan_.scene().space;
  const FieldInfo& about = info(field);
  const int n = components(field, space), items = layout_.items[static_cast<int>(about.item)];
  for (int i = 0; i < items; ++i, out += n) {
    if (about.item != ItemKind::body ||
        is_copied(field, body_of(world, static_cast<std::size_t>(i)),
                  layout_.has(Field::orientation), false)) {
      for (int c = 0; c < n; ++c) out[c] = static_cast<Out>(number(field, world, i, c));
    } else if (field == Field::position) {
      const Vec3 x = center_of_mass(world, i) -
                     rotation(world, i) * body_of(world, static_cast<std::size_t>(i)).center;
      for (int c = 0; c < n; ++c) out[c] = static_cast<Out>(x[c]);
    } else {  // an orientation that was left out reads as the identity
      const auto q = space == Space::planar ? std::array<double, 4>{1, 0}
                                            : components_of(rotation(world, i), space);
      for (int c = 0; c < n; ++c) out[c] = static_cast<Out>(q[static_cast<std::size_t>(c)]);
    }
  }
}

template <class Real>
template <class In>
void Worlds<Real>::write_as(Field field, int world, const In* in) {
  const Space space = plan_.scene().space;
  const FieldInfo& about = info(field);
  const int n = components(field, space), items = layout_.items[static_cast<int>(about.item)];
  // Impulses of the old pose would act on the new one.
  const bool moves = field == Field::position || field == Field::orientation;
  if (moves) storage_.clear_contacts(lane_index_of(world));
  if (moves) storage_.clear_joints(lane_index_of(world));
  storage_.wake(lane_index_of(world));
  if (!layout_.has(field)) return;
  for (int i = 0; i < items; ++i, in += n) {
    if (about.item != ItemKind::body ||
        is_copied(field, body_of(world, static_cast<std::size_t>(i)), true, true)) {
      for (int c = 0; c < n; ++c) number(field, world, i, c) = static_cast<Real>(in[c]);
      continue;
    }
    std::array<double, 4> x{};
    std::transform(in, in + n, x.begin(), [](In value) { return static_cast<double>(value); });
    if (field == Field::position) {
      set_origin(world, i, Vec3(x[0], x[1], x[2]), rotation(world, i));
    } else {
      // The body rotates about its own origin, so the centre of mass moves.
      const PlanBody& b = body_of(world, static_cast<std::size_t>(i));
      const Vec3 origin = center_of_mass(world, i) - rotation(world, i) * b.center;
      const Quat q = rotation_of(x.data(), space);
      set_rotation(world, i, q * b.principal);
      set_origin(world, i, origin, q);
    }
  }
  if (field == Field::generalized_position || field == Field::generalized_velocity)
    place_links(world);
}

template <class Real>
LaneBlocks Worlds<Real>::lane_blocks(Field field) const {
  const auto kind = static_cast<int>(info(field).item);
  LaneBlocks blocks;
  blocks.groups = storage_.groups();
  blocks.items = layout_.items[kind];
  blocks.components = components(field, plan_.scene().space);
  blocks.lanes = storage_.lanes();
  blocks.component_stride = static_cast<std::size_t>(blocks.lanes);
  blocks.item_stride = static_cast<std::size_t>(layout_.stride[kind]) * blocks.component_stride;
  blocks.group_stride = static_cast<std::size_t>(layout_.rows) * blocks.component_stride;
  if (!layout_.has(field) || blocks.items == 0) return blocks;
  blocks.data = &storage_.number(0, layout_.row_of(field, 0));
  return blocks;
}

template <class Real>
void Worlds<Real>::set_initial(Field field, int world, const double* in) {
  auto& values = initial_[static_cast<std::size_t>(field)];
  if (in == nullptr) return values.clear();
  const std::size_t numbers = plan_.numbers(field);
  values.resize(static_cast<std::size_t>(worlds_) * numbers);
  std::copy_n(
      in, numbers,
      values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(world) * numbers));
}

#define MW_INSTANTIATE(Real)                                               \
  template void Worlds<Real>::read_as<float>(Field, int, float*) const;    \
  template void Worlds<Real>::read_as<double>(Field, int, double*) const;  \
  template void Worlds<Real>::write_as<float>(Field, int, const float*);   \
  template void Worlds<Real>::write_as<double>(Field, int, const double*); \
  template LaneBlocks Worlds<Real>::lane_blocks(Field) const;              \
  template void Worlds<Real>::set_initial(Field, int, const double*);      \
  template Quat Worlds<Real>::internal_rotation(int, int) const;           \
  template void Worlds<Real>::set_rotation(int, int, const Quat&);
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
