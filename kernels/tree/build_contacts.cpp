// Contact points of trees: the narrow phase hands its manifolds over to here
// (kernels/collide/row_builder.hpp), one pair of shapes in every lane. What the links do there is
// found when the step is solved (contacts.hpp).
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/record.hpp"
#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

constexpr Real kMinFriction = Real(1e-5);

// Tangents of a unit normal as MuJoCo has them: the first is what `along` leaves across the normal,
// or y does, or z where the normal is near y. They matter, since pyramids are not round.
struct ContactFrame {
  Vec3 normal, first, second;
};
MW_INLINE ContactFrame contact_frame(Vec3 normal, Vec3 along) {
  const Float zero(Real(0)), one(Real(1)), half(Real(0.5));
  const Mask near_y = half <= abs(normal.y);
  const Vec3 other{zero, select(near_y, zero, one), select(near_y, one, zero)};
  const Vec3 across = fnma(normal, dot(normal, along), along);
  const Float length2 = dot(across, across);
  const Mask good = Float(Real(1e-12)) * dot(along, along) < length2;
  Vec3 first = select(good, across, fnma(normal, dot(normal, other), other));
  first = first * (one / sqrt(dot(first, first)));
  return {normal, first, cross(normal, first)};
}

MW_INLINE Float friction_of(const Group& g, const kernels::TreePair<Real>& pair) {
  const Material* of = materials(g);
  const Float a = of[pair.material_a].friction, b = of[pair.material_b].friction;
  return max(max(a, b), Float(kMinFriction));
}

// From the link's frame.
MW_INLINE Vec3 arm_of(const Constants& t, const Work& w, int link, Vec3 point) {
  if (link < 0) return zero_of<Vec3>();
  const Vec3 origin = load_vec3(w.tree.origin + 3 * t.tree.link[link].root * kLanes);
  return (point - origin) - load_pose(w, link).x;
}

// Capsules on a plane have their tangent along them.
template <int N>
MW_INLINE Vec3 tangent_of(kernels::PairKind kind, const Manifold<Isotropic, N>& m) {
  using kernels::ShapeKind;
  if constexpr (N > 1) {
    if (kind == kernels::pair_of(ShapeKind::plane, ShapeKind::capsule)) {
      return m.point_b[1] - m.point_b[0];
    }
  }
  return zero_of<Vec3>();
}

template <int N>
void add_contact(const Constants& t, const Group& g, Work& w, ListId list,
                 const kernels::PairClass<Real>& pair_class, Manifold<Isotropic, N>& m, Mask active,
                 const std::int32_t*, const std::int32_t* key, Vec3, Vec3 pose_b) {
  const kernels::TreePair<Real>& pair = t.tree.pair[key[0]];
  const Float margin(pair.margin), zero(Real(0));
  std::uint32_t touching = 0;
  for (int i = 0; i < N; ++i) {
    m.valid[i] = ((m.valid[i] & !m.guard[i]) & active) & (m.separation[i] < margin);
    touching |= bits(m.valid[i]);
  }
  if (touching == 0) return;
  const ContactFrame frame = contact_frame(m.normal, tangent_of<N>(pair_class.kind, m));
  const Float friction = friction_of(g, pair);
  Float none[N];
  for (int i = 0; i < N; ++i) {
    none[i] = zero;
    const Mask near = m.valid[i];
    if (!any(near)) continue;
    TreeContact& c = w.tree.contacts[w.tree.contact_count++];
    const auto put = [&](Real* to, Vec3 v) { store(to, select(near, v, zero_of<Vec3>())); };
    put(c.frame[0], frame.normal), put(c.frame[3], frame.first), put(c.frame[6], frame.second);
    const Float to_middle = max(m.separation[i], zero) * Float(Real(-0.5));
    const Vec3 point = fma(m.normal, to_middle, pose_b + m.point_b[i]);
    put(c.arm_a[0], arm_of(t, w, pair.link_a, point));
    put(c.arm_b[0], arm_of(t, w, pair.link_b, point));
    select(near, m.separation[i], zero).store(c.distance);
    select(near, friction, zero).store(c.friction);
    c.pair = key[0];
    c.feature = i;
    c.lanes = bits(near);
    w.counters.points += static_cast<unsigned>(__builtin_popcount(c.lanes));
  }
  w.counters.manifolds += static_cast<unsigned>(__builtin_popcount(touching));
  if (w.recorder) record_points<Tensor, N>(w, list, m, key, none, pose_b);
}

}  // namespace

RowBuilder<Isotropic> tree_contacts() {
  return {{add_contact<1>, add_contact<1>},
          {add_contact<Isotropic::kMulti>, add_contact<Isotropic::kMulti>}};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
