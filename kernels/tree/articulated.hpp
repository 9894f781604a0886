// Articulated bodies: (M + diagonal + J' D J of contacts with the world) x = load, without any of
// these matrices (Featherstone 2008, 7.3). A link is felt by its parent as an inertia of its own
// and of all links beyond it, which give way along their dofs; a contact with the world is a
// stiffness that is added to the inertia of its link. Time and memory grow with the number of
// links.
#pragma once

#include "kernels/tree/dynamics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A symmetric 6 x 6 matrix: of a twist the moment `rotary` w + `mixed` v, and the force `mixed`' w
// + `linear` v.
struct ArticulatedInertia {
  Sym3 rotary;
  Mat3 mixed;
  Sym3 linear;
};

MW_INLINE ArticulatedInertia load_articulated(const Real* p) {
  return {load_as<Sym3>(p),
          {load_vec3(p + 6 * kLanes), load_vec3(p + 9 * kLanes), load_vec3(p + 12 * kLanes)},
          load_as<Sym3>(p + 15 * kLanes)};
}
MW_INLINE void store(Real* p, const ArticulatedInertia& a) {
  store(p, a.rotary), store(p + 15 * kLanes, a.linear);
  store(p + 6 * kLanes, a.mixed.x), store(p + 9 * kLanes, a.mixed.y);
  store(p + 12 * kLanes, a.mixed.z);
}
MW_INLINE ArticulatedInertia operator+(const ArticulatedInertia& a, const ArticulatedInertia& b) {
  return {a.rotary + b.rotary,
          {a.mixed.x + b.mixed.x, a.mixed.y + b.mixed.y, a.mixed.z + b.mixed.z},
          a.linear + b.linear};
}
MW_INLINE Wrench mul(const ArticulatedInertia& a, const Twist& x) {
  return {mul(a.rotary, x.w) + mul(a.mixed, x.v),
          mul_transposed(a.mixed, x.w) + mul(a.linear, x.v)};
}
MW_INLINE Sym3 fnma(Vec3 a, Vec3 b, const Sym3& c) {
  return {fnma(a.x, b.x, c.xx), fnma(a.x, b.y, c.xy), fnma(a.x, b.z, c.xz),
          fnma(a.y, b.y, c.yy), fnma(a.y, b.z, c.yz), fnma(a.z, b.z, c.zz)};
}
// a - f f' scale.
MW_INLINE ArticulatedInertia without(const ArticulatedInertia& a, const Wrench& f, Float scale) {
  const Vec3 n = f.n * scale, l = f.f * scale;
  return {fnma(f.n, n, a.rotary),
          {fnma(f.n, l.x, a.mixed.x), fnma(f.n, l.y, a.mixed.y), fnma(f.n, l.z, a.mixed.z)},
          fnma(f.f, l, a.linear)};
}
// Of a rigid body. No entry is -0: adding the +0 of other lanes' contacts changes nothing.
MW_INLINE ArticulatedInertia articulated(const SpatialInertia& i) {
  const Float zero(Real(0));
  const Vec3 h{i.moment.x + zero, i.moment.y + zero, i.moment.z + zero};
  const Vec3 minus{zero - h.x, zero - h.y, zero - h.z};
  return {{i.rotary.xx, i.rotary.xy + zero, i.rotary.xz + zero, i.rotary.yy, i.rotary.yz + zero,
           i.rotary.zz},
          {{zero, h.z, minus.y}, {minus.z, zero, h.x}, {h.y, minus.x, zero}},
          {i.mass, zero, zero, i.mass, zero, i.mass}};
}
// Of a spring at r that resists displacements of its point by `stiffness`.
MW_INLINE ArticulatedInertia spring_at(Vec3 r, const Sym3& k) {
  const Mat3 mixed{cross(r, {k.xx, k.xy, k.xz}), cross(r, {k.xy, k.yy, k.yz}),
                   cross(r, {k.xz, k.yz, k.zz})};
  const Vec3 x = cross(r, {mixed.x.x, mixed.y.x, mixed.z.x});
  const Vec3 y = cross(r, {mixed.x.y, mixed.y.y, mixed.z.y});
  const Vec3 z = cross(r, {mixed.x.z, mixed.y.z, mixed.z.z});
  return {{x.x, x.y, x.z, y.y, y.z, z.z}, mixed, k};
}

// About a point farther by -o.
MW_INLINE ArticulatedInertia moved_back(const ArticulatedInertia& a, Vec3 o) {
  const Sym3& l = a.linear;
  const Mat3 mixed{a.mixed.x + cross(o, {l.xx, l.xy, l.xz}),
                   a.mixed.y + cross(o, {l.xy, l.yy, l.yz}),
                   a.mixed.z + cross(o, {l.xz, l.yz, l.zz})};
  const auto around = [&](const Mat3& m) {  // its rows
    return Mat3{cross(o, {m.x.x, m.y.x, m.z.x}), cross(o, {m.x.y, m.y.y, m.z.y}),
                cross(o, {m.x.z, m.y.z, m.z.z})};
  };
  const Mat3 p = around(mixed), q = around(a.mixed);
  return {
      {a.rotary.xx + (p.x.x + q.x.x), a.rotary.xy + (p.x.y + q.y.x), a.rotary.xz + (p.x.z + q.z.x),
       a.rotary.yy + (p.y.y + q.y.y), a.rotary.yz + (p.y.z + q.z.y), a.rotary.zz + (p.z.z + q.z.z)},
      mixed,
      l};
}

// A root that moves freely, whose six dofs give way at once: L D L' of its inertia, linear
// accelerations first, and 1 / D.
class FreeRoot {
 public:
  static constexpr int kSize = 6;
  MW_INLINE FreeRoot(Real* factors, Real* inverse) : factors_(factors), inverse_(inverse) {}

  static MW_INLINE bool is(const Constants& t, const TreeLink& link) {
    return link.joints > 0 && t.tree.joint[link.first_joint].kind == TreeJointKind::free;
  }
  MW_INLINE void factorise(const ArticulatedInertia& i) const {
    const Float a[] = {i.linear.xx,                                                      //
                       i.linear.xy, i.linear.yy,                                         //
                       i.linear.xz, i.linear.yz, i.linear.zz,                            //
                       i.mixed.x.x, i.mixed.y.x, i.mixed.z.x, i.rotary.xx,               //
                       i.mixed.x.y, i.mixed.y.y, i.mixed.z.y, i.rotary.xy, i.rotary.yy,  //
                       i.mixed.x.z, i.mixed.y.z, i.mixed.z.z, i.rotary.xz, i.rotary.yz,
                       i.rotary.zz};
    Float whole[kSize], l[kEntries], inverse[kSize];
    for (int r = 0; r < kSize; ++r) {
      Float own = a[at(r, r)];
      for (int c = 0; c < r; ++c) {
        whole[c] = a[at(r, c)];
        for (int k = 0; k < c; ++k) whole[c] = fnma(l[at(c, k)], whole[k], whole[c]);
        l[at(r, c)] = whole[c] * inverse[c];
        own = fnma(l[at(r, c)], whole[c], own);
        l[at(r, c)].store(factors_ + at(r, c) * kLanes);
      }
      inverse[r] = Float(Real(1)) / own;
      inverse[r].store(inverse_ + r * kLanes);
    }
  }
  // L^-1 of a wrench, [6][lane].
  MW_INLINE void reduce(const Wrench& f, Real* out) const {
    Float y[] = {f.f.x, f.f.y, f.f.z, f.n.x, f.n.y, f.n.z};
    for (int r = 0; r < kSize; ++r) {
      for (int c = 0; c < r; ++c) y[r] = fnma(entry(r, c), y[c], y[r]);
      y[r].store(out + r * kLanes);
    }
  }
  // L'^-1 D^-1 of that: its acceleration.
  MW_INLINE Twist expand(const Real* y) const {
    Float a[kSize];
    for (int r = kSize - 1; r >= 0; --r) {
      a[r] = Float::load(y + r * kLanes) * Float::load(inverse_ + r * kLanes);
      for (int k = r + 1; k < kSize; ++k) a[r] = fnma(entry(k, r), a[k], a[r]);
    }
    return {{a[3], a[4], a[5]}, {a[0], a[1], a[2]}};
  }

 private:
  static constexpr int kEntries = 21;
  static constexpr int at(int r, int c) { return r * (r + 1) / 2 + c; }
  MW_INLINE Float entry(int r, int c) const { return Float::load(factors_ + at(r, c) * kLanes); }

  Real *factors_, *inverse_;
};

class ArticulatedBodies {
 public:
  MW_INLINE ArticulatedBodies(const Constants& t, const Work& w) : t_(t), w_(w), x_(w.tree) {}

  void make_stale(bool all) const {
    for (int i = 0; i < t_.tree.links; ++i) x_.stale[i] = all;
  }
  // Eliminates the dofs of all stale links and of those that carry them, the last one first.
  // `diagonal` is added to the armatures; `held`: stiffnesses of links where `is_held`.
  void factorise(const Real* diagonal) const {
    for (int i = t_.tree.links - 1; i >= 0; --i) {
      const TreeLink& link = t_.tree.link[i];
      if (!x_.stale[i]) continue;
      if (link.parent >= 0) x_.stale[link.parent] = true;
      ArticulatedInertia inertia = articulated(load_inertia(rows(x_.inertia, i, kInertiaRows)));
      if (x_.is_held[i]) inertia = inertia + load_articulated(rows(x_.held, i, kArticulatedRows));
      for (int c = link.first_child; c >= 0; c = t_.tree.link[c].next_child) {
        inertia = inertia + load_articulated(rows(x_.beyond, c, kArticulatedRows));
      }
      if (FreeRoot::is(t_, link)) {
        root(i).factorise(with(inertia, link, diagonal));
        continue;
      }
      for (int k = link.first_dof + link.dofs - 1; k >= link.first_dof; --k) {
        const Twist axis = load_twist(axis_of(w_, k));
        const Wrench f = mul(inertia, axis);
        const Float own = Float(t_.tree.dof[k].armature) + Float::load(diagonal + k * kLanes);
        const Float inverse = Float(Real(1)) / (dot(axis, f) + own);
        store(response_of(k), f), inverse.store(x_.inverse + k * kLanes);
        if (t_.tree.dof[k].parent >= 0) inertia = without(inertia, f, inverse);
      }
      if (link.parent < 0) continue;
      store(rows(x_.beyond, i, kArticulatedRows), moved_back(inertia, load_vec3(offset_of(w_, i))));
    }
  }

  // From loads [dof][lane] to what is left of them for each dof when those beyond it have given
  // way.
  void reduce(Real* x) const {
    for (int i = t_.tree.links - 1; i >= 0; --i) {
      const TreeLink& link = t_.tree.link[i];
      Wrench f{zero_of<Vec3>(), zero_of<Vec3>()};
      for (int c = link.first_child; c >= 0; c = t_.tree.link[c].next_child) {
        f = f + load_wrench(rows(x_.force, c, kTwistRows));
      }
      if (FreeRoot::is(t_, link)) {
        Real* at = x + link.first_dof * kLanes;
        const Wrench own{mul(axes_of(link), load_vec3(at + 3 * kLanes)), load_vec3(at)};
        root(i).reduce(own - f, at);
        continue;
      }
      for (int k = link.first_dof + link.dofs - 1; k >= link.first_dof; --k) {
        Real* at = x + k * kLanes;
        const Float load = Float::load(at) - dot(load_twist(axis_of(w_, k)), f);
        load.store(at);
        f = fma(load_wrench(response_of(k)), load * Float::load(x_.inverse + k * kLanes), f);
      }
      if (link.parent >= 0) store(rows(x_.force, i, kTwistRows), to_parent(w_, i, f));
    }
  }
  // From those to the solution, and to the twists of links [link][twist][lane].
  void expand(Real* x, Real* twists) const {
    for (int i = 0; i < t_.tree.links; ++i) {
      const TreeLink& link = t_.tree.link[i];
      Twist v{zero_of<Vec3>(), zero_of<Vec3>()};
      if (link.parent >= 0) {
        v = from_parent(w_, i, load_twist(rows(twists, link.parent, kTwistRows)));
      }
      if (FreeRoot::is(t_, link)) {
        Real* at = x + link.first_dof * kLanes;
        v = root(i).expand(at);
        store(at, v.v), store(at + 3 * kLanes, mul_transposed(axes_of(link), v.w));
        store(rows(twists, i, kTwistRows), v);
        continue;
      }
      for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
        Real* at = x + k * kLanes;
        const Float load = Float::load(at) - dot(v, load_wrench(response_of(k)));
        const Float own = load * Float::load(x_.inverse + k * kLanes);
        own.store(at);
        v = fma(load_twist(axis_of(w_, k)), own, v);
      }
      store(rows(twists, i, kTwistRows), v);
    }
  }

  MW_INLINE FreeRoot root(int link) const {
    return {rows(x_.beyond, link, kArticulatedRows),
            x_.inverse + t_.tree.link[link].first_dof * kLanes};
  }

 private:
  // With armatures and the diagonal of a free joint's dofs.
  MW_INLINE ArticulatedInertia with(ArticulatedInertia inertia, const TreeLink& link,
                                    const Real* diagonal) const {
    Float own[FreeRoot::kSize];
    for (int k = 0; k < FreeRoot::kSize; ++k) {
      const int dof = link.first_dof + k;
      own[k] = Float(t_.tree.dof[dof].armature) + Float::load(diagonal + dof * kLanes);
    }
    inertia.linear.xx = inertia.linear.xx + own[0];
    inertia.linear.yy = inertia.linear.yy + own[1];
    inertia.linear.zz = inertia.linear.zz + own[2];
    inertia.rotary = inertia.rotary + rotate_diagonal(axes_of(link), {own[3], own[4], own[5]});
    return inertia;
  }
  // Of a free joint, whose linear dofs are those of the link's frame.
  MW_INLINE Mat3 axes_of(const TreeLink& link) const {
    const auto axis = [&](int k) { return load_vec3(axis_of(w_, link.first_dof + 3 + k)); };
    return {axis(0), axis(1), axis(2)};
  }
  static MW_INLINE Real* rows(Real* of, int link, int count) { return link_rows(of, link, count); }
  MW_INLINE Real* response_of(int dof) const { return x_.response + dof * kTwistRows * kLanes; }

  const Constants& t_;
  const Work& w_;
  const TreeWork& x_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
