// Geometric stiffness: a joint's impulse keeps its direction while the arm that it acts on turns.
// With heavy loads on light arms that is a stiff spring of the rotation, and explicit: transverse
// motions are unstable once h sqrt(4 T / (m l)) > 2. So it is made implicit, and positive
// semi-definite, as an inertia of the body. For an impulse p of a substep at an arm r, with
// u = |p| r + |r| p:
//   G = h (g E - u u' / (4 |p| |r|)),  g = (|p| |r| + p . r) / 2
// which is 0 in compression. A cone's impulse p turns with the plane in which its joint leans by
// theta: the second derivatives of p theta, by how both z axes move out of that plane, are at most
//   G = h g a a',  g = p / tan(theta / 2)
// of each body, a its axis of that motion. It damps what it holds, so bodies that do not need it
// have none: with s the sum of g and m of their transverse moments, G is scaled by max(0, 1 - (m /
// 2) / (h s)).
#pragma once

#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr double kLeastLean = 0.01;      // rad
inline constexpr Real kStiffShare = Real(0.5);  // below that share of a body's moments it has none

MW_INLINE Sym3 scaled(const Sym3& a, Float s) {
  return {a.xx * s, a.xy * s, a.xz * s, a.yy * s, a.yz * s, a.zz * s};
}
MW_INLINE Float scaled(Float a, Float s) { return a * s; }
// Half the trace: what turns a rod across itself. In the plane there is one moment.
MW_INLINE Float transverse(const Sym3& a) { return (a.xx + (a.yy + a.zz)) * Float(Real(0.5)); }
MW_INLINE Float transverse(Float a) { return a; }

// Without the factor h.
struct ArmStiffness {
  Float arm2, scale, sum;  // |r|^2, |p| |r|, g
  template <class V>
  MW_INLINE ArmStiffness(V r, V p) {
    arm2 = dot(r, r);
    scale = sqrt(arm2 * dot(p, p));
    sum = max((scale + dot(p, r)) * Float(Real(0.5)), Real(0));
  }
};
MW_INLINE Float stiffness_of(Vec2 r, Vec2 p) { return ArmStiffness(r, p).sum; }
MW_INLINE Sym3 stiffness_of(Vec3 r, Vec3 p) {
  const ArmStiffness k(r, p);
  const Vec3 u = fma(p, sqrt(k.arm2), r * sqrt(dot(p, p)));
  const Vec3 v = u * (Float(Real(0.25)) * inverse_or_zero(k.scale));
  const Float zero(Real(0));
  return {fnma(u.x, v.x, k.sum), fnma(u.x, v.y, zero), fnma(u.x, v.z, zero),
          fnma(u.y, v.y, k.sum), fnma(u.y, v.z, zero), fnma(u.z, v.z, k.sum)};
}

// Puts the moments of inertia with the stiffness of the last impulses into Work::direct.stiffened.
template <class S>
class GeometricStiffness {
 public:
  using Vec = typename S::Vec;
  GeometricStiffness(const Constants& t, const Group& g, const Work& w)
      : t_(t), g_(g), w_(w), d_(w.direct) {}

  // Returns whether some body has any.
  bool find() const {
    for_each_tree_body(t_, [&](int b) {
      const Float zero(Real(0));
      zero.store(sums(b)), zero.store(sums(b) + kLanes);
      store(rotary(d_.stiffened, b), load_as<MomentsOf<S>>(rotary(d_.rotary, b)));
    });
    for_each_arm([&](int b, Vec r, Vec p) {
      const ArmStiffness k(r, p);
      add_to(sums(b), 0, k.sum), add_to(sums(b), 1, k.sum * k.arm2);
    });
    for_each_cone([&](int b, auto, Float g) { add_to(sums(b), 0, g); });
    std::uint32_t stiff = 0;
    for_each_tree_body(t_, [&](int b) {
      const Float share = share_of(b);
      stiff |= bits(Float(Real(0)) < share);
      share.store(sums(b));
    });
    if (stiff == 0) return false;
    for_each_arm([&](int b, Vec r, Vec p) {
      const Float share = Float::load(sums(b)) * Float(t_.h);
      const auto own = load_as<MomentsOf<S>>(rotary(d_.stiffened, b));
      // Lanes without any keep the sign of their zeros, whatever others have.
      store(rotary(d_.stiffened, b),
            select(Float(Real(0)) < share, own + scaled(stiffness_of(r, p), share), own));
    });
    for_each_cone([&](int b, auto axis, Float g) {
      const Float share = Float::load(sums(b)) * Float(t_.h);
      const auto own = load_as<Sym3>(rotary(d_.stiffened, b));
      store(rotary(d_.stiffened, b),
            select(Float(Real(0)) < share, fnma(axis, axis * -(share * g), own), own));
    });
    return true;
  }

 private:
  MW_INLINE Float share_of(int b) const {
    const Float zero(Real(0)), one(Real(1));
    const Float sum = Float::load(sums(b)) * Float(t_.h), by_sum = inverse_or_zero(sum);
    const Float mass = one / Float(constants_of_body(g_, b).inv_mass);
    const Float arms = mass * Float::load(sums(b) + kLanes) * Float(t_.h) * by_sum;
    const Float moment = arms + transverse(load_as<MomentsOf<S>>(rotary(d_.rotary, b)));
    return select(zero < sum, max(zero, fnma(Float(kStiffShare) * moment, by_sum, one)), zero);
  }
  // visit(body, arm, impulse on it) for both sides of every edge.
  template <class Visit>
  MW_INLINE void for_each_arm(Visit visit) const {
    for (int i = 0; i < t_.joint_trees.edges + t_.joint_trees.closures; ++i) {
      const kernels::TreeEdge& edge = t_.joint_trees.edge[i];
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      const auto& part = part_rows<S, PartBodies<S>>(w_, edge.hold);
      Vec p = load_as<Vec>(part.impulse[0]);
      if (edge.reversed) p = -p;
      p = select(mask_from_bits(s.lanes), p, zero_of<Vec>());
      visit(edge.child, load_as<Vec>(s.arm_child[0]), p);
      if (!edge.prescribed) visit(edge.parent, load_as<Vec>(s.arm_parent[0]), -p);
    }
  }
  // visit(body, axis, g) for both sides of every cone.
  template <class Visit>
  MW_INLINE void for_each_cone(Visit visit) const {
    if constexpr (S::kDim == 3) {
      if (!t_.joint_trees.bounded) return;
      for (int i = 0; i < t_.joint_trees.edges; ++i) {
        const kernels::TreeEdge& edge = t_.joint_trees.edge[i];
        if (edge.cone < 0) continue;
        const auto& row = part_rows<S, Row<S>>(w_, edge.cone);
        const Float lean = max(Float::load(row.value), Float(Real(kLeastLean)));
        const Float half = lean * half_tangent_ratio(lean * lean);  // its tangent
        Float g = Float::load(row.impulse[2]) * inverse_or_zero(half);
        g = select(mask_from_bits(edge_rows<S>(w_, i).lanes), g, Float(Real(0)));
        const auto n = load_vec3(row.angular_b[0]);
        const Vec3 a = cross(load_vec3(row.start_axis[0]), n);
        const Vec3 b = cross(load_vec3(row.start_axis_b[0]), n);
        visit(edge.child, edge.reversed ? a : b, g);
        if (!edge.prescribed) visit(edge.parent, edge.reversed ? b : a, g);
      }
    }
  }
  MW_INLINE Real* sums(int body) const { return d_.stiffness + body * 2 * kLanes; }
  static MW_INLINE Real* rotary(Real* of, int body) { return of + body * S::kInertia * kLanes; }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  const DirectWork& d_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
