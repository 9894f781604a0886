// The root of a tree that moves freely.
#pragma once

#include "kernels/lane/articulated_inertia.hpp"
#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

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
      const Float reduced = Float::load(y + r * kLanes) + Float(Real(0));  // never -0
      a[r] = reduced * Float::load(inverse_ + r * kLanes);
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

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
