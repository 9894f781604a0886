// What the integrator implicit_fast takes at the end of the step, but for dampers: forces of
// actuators that depend on velocities, and centrifugal and gyroscopic ones of links that move
// freely with nothing jointed to them (MuJoCo, "Computation", implicitfast and gyroscopic
// derivatives).
#pragma once

#include "kernels/tree/dynamics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Adds to the diagonal, h times, by how much actuator forces fall as their dofs move faster. One at
// an end of its range does not follow.
inline void add_resistance(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.actuators; ++i) {
    const TreeActuator& a = t.tree.actuator[i];
    const auto& own = constants_of_actuator(g, i);
    const Float control = Float::load(g.control + a.control * kLanes), force = force_asked(t, g, i);
    const Float gain = -fma(Float(own.gain[2]), control, Float(own.bias[2]));
    const Mask follows = (Float(own.low) < force) & (force < Float(own.high));
    const Float gear(own.gear);
    const Float less = Float(t.h) * gear * gear * select(follows, gain, Real(0));
    Real* diagonal = w.tree.diagonal + a.dof * kLanes;
    (Float::load(diagonal) + less).store(diagonal);
  }
}

// A link that moves freely, as its six dofs have it: [linear, world axes; angular, its own axes].
class FreeLink {
 public:
  MW_INLINE FreeLink(const Constants& t, const Work& w, int link)
      : t_(t),
        w_(w),
        inertia_(inertia_of(t, w, link)),
        first_(t.tree.link[link].first_dof),
        link_(link) {}

  // Solves (M + h dC/dv) a = load and leaves a in `out`, [dof][lane]. Free joints have neither
  // armatures nor dampers.
  void solve(const Real* load, Real* out) const {
    const Vec3 spin = load_twist(link_rows(w_.tree.velocity, link_, kTwistRows)).w;
    const auto momentum = [&](Vec3 x) { return mul(inertia_.rotary, x); };  // about the joint
    const Vec3 arm = inertia_.moment;  // mass times that of its centre
    const Vec3 own_momentum = momentum(spin), own_speed = cross(spin, arm);
    const Float h(t_.h);
    Vec3 linear[3], angular[3], mixed[3];  // columns of the angular dofs; rows of M
    for (int j = 0; j < 3; ++j) {
      const Vec3 axis = load_twist(axis_of(w_, first_ + 3 + j)).w;
      const Vec3 f = cross(axis, own_speed) + cross(spin, cross(axis, arm));
      const Vec3 n = cross(axis, own_momentum) + cross(spin, momentum(axis));
      mixed[j] = {entry(3 + j, 0), entry(3 + j, 1), entry(3 + j, 2)};
      linear[j] = fma(f, h, mixed[j]);
      const Vec3 moments{dot(axis_at(0), n), dot(axis_at(1), n), dot(axis_at(2), n)};
      angular[j] = fma(moments, h, {entry(3, 3 + j), entry(4, 3 + j), entry(5, 3 + j)});
    }
    // The linear block is a multiple of the unit matrix.
    const Float inverse = Float(Real(1)) / entry(0, 0);
    const Vec3 force = load_vec3(load + first_ * kLanes);
    const auto through = [&](Vec3 v) {
      return Vec3{dot(mixed[0], v), dot(mixed[1], v), dot(mixed[2], v)} * inverse;
    };
    for (int j = 0; j < 3; ++j) angular[j] = angular[j] - through(linear[j]);
    const Vec3 moment = load_vec3(load + (first_ + 3) * kLanes) - through(force);
    const Vec3 x = solve3(angular, moment);
    const Vec3 pull = fma(linear[2], x.z, fma(linear[1], x.y, linear[0] * x.x));
    store(out + first_ * kLanes, (force - pull) * inverse);
    store(out + (first_ + 3) * kLanes, x);
  }

 private:
  // With all that is welded to it, which joint space has added to it.
  static SpatialInertia inertia_of(const Constants& t, const Work& w, int link) {
    SpatialInertia all = load_inertia(link_rows(w.tree.inertia, link, kInertiaRows));
    if (!t.tree.by_links) return all;
    for (int c = t.tree.link[link].first_child; c >= 0; c = t.tree.link[c].next_child) {
      all = all + moved(inertia_of(t, w, c), -load_vec3(offset_of(w, c)));
    }
    return all;
  }
  MW_INLINE Vec3 axis_at(int j) const { return load_twist(axis_of(w_, first_ + 3 + j)).w; }
  MW_INLINE Float entry(int i, int j) const {
    return dot(load_twist(axis_of(w_, first_ + i)),
               mul(inertia_, load_twist(axis_of(w_, first_ + j))));
  }
  // Of a matrix with these columns, by Cramer's rule.
  static MW_INLINE Vec3 solve3(const Vec3 (&c)[3], Vec3 b) {
    const Vec3 yz = cross(c[1], c[2]);
    const Float inverse = Float(Real(1)) / dot(c[0], yz);
    return Vec3{dot(b, yz), dot(b, cross(c[2], c[0])), dot(b, cross(c[0], c[1]))} * inverse;
  }

  const Constants& t_;
  const Work& w_;
  const SpatialInertia inertia_;
  const int first_, link_;
};

// visit(link) of all that move freely with nothing jointed to them.
template <class Visit>
MW_INLINE void for_each_free_link(const Constants& t, Visit visit) {
  for (int i = 0; i < t.tree.links; ++i) {
    if (t.tree.link[i].moves_freely) visit(i);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
