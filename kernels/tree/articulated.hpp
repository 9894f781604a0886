// Articulated bodies: (M + diagonal + J' D J of contacts with the world) x = load, without any of
// these matrices (Featherstone 2008, 7.3). A link is felt by its parent as an inertia of its own
// and of all links beyond it, which give way along their dofs; a contact with the world is a
// stiffness that is added to the inertia of its link. Time and memory grow with the number of
// links.
#pragma once

#include "kernels/tree/dynamics.hpp"
#include "kernels/tree/free_root.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class ArticulatedBodies {
 public:
  MW_INLINE ArticulatedBodies(const Constants& t, const Group& g, const Work& w)
      : t_(t), g_(g), w_(w), x_(w.tree) {}

  void make_stale(bool all) const {
    for (int i = 0; i < t_.tree.links; ++i) x_.stale[i] = all;
  }
  // Eliminates the dofs of all stale links and of those that carry them, the last one first.
  // `diagonal` is added to the armatures, and contacts of links where they are held.
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
        const Float own = armature_of(k) + Float::load(diagonal + k * kLanes);
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
        // No reduced load is -0 from here on, whether rows of other lanes have been taken off or
        // not.
        const Float reduced = Float::load(at) + Float(Real(0));
        const Float load = reduced - dot(v, load_wrench(response_of(k)));
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
      own[k] = armature_of(dof) + Float::load(diagonal + dof * kLanes);
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
  MW_INLINE Float armature_of(int dof) const { return constants_of_dof(g_, dof).armature; }
  MW_INLINE Real* response_of(int dof) const { return x_.response + dof * kTwistRows * kLanes; }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  const TreeWork& x_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
