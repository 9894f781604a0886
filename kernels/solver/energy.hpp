// Restitution gives no energy that was not there.
//
// Newton's rule, contact after contact, can add energy where several contacts share an impact: a
// contact takes its impulse back while a neighbour keeps the answer to it, one is struck by what
// another has just thrown, and friction pulls at what both have moved. So every island of bodies
// that act on each other compares its energy before the step, plus the work of forces and kinematic
// bodies in it, with that after. Where there is more, the island keeps a share x of what
// restitution has changed, v = v_found + x (v_bounced - v_found), as large as it can pay for.
// A mean of two admissible sets of impulses is one: they do not pull, keep to their friction cones,
// and leave momentum as it was. At x = 1, nearly always, nothing is touched.
#pragma once

#include "kernels/motion/finish.hpp"
#include "kernels/solver/restitution.hpp"
#include "kernels/work/half_turn.hpp"
#include "kernels/work/union_find.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kEnergySlack = Real(1e-5);  // relative, for rounding

// Of each body, twice energies; [body][Account][lane] in the memory of impulse_part, which is
// unused after the last substep. With v = v_found + x d: 2 E = found + 2 x cross + x^2 change.
enum Account { kAllowed, kFound, kCross, kChange, kAccounts };
inline constexpr Account kShare = kAllowed;  // x, in the end

MW_INLINE Real* account(const Work& w, int body, int which) {
  return w.impulse_part + (body * kAccounts + which) * kLanes;
}

// a . M b of velocities whose angular parts own() has rotated to the body's axes.
template <class S>
struct KineticForm {
  Float mass;
  Vec3 inertia;  // principal; planar: z
  Quat q;        // where inertia is a tensor

  MW_INLINE KineticForm(const Constants& t, const Group& g, const Work& w, int body) {
    const auto& b = constants_of_body(g, body);
    mass = Float(Real(1)) / b.inv_mass;
    inertia = {b.inertia[0], b.inertia[1], b.inertia[2]};
    if constexpr (std::is_same_v<S, Tensor>) {
      q = orientation_ahead(t, w, load_quat(state_of(t, g, body, kState<S>.orientation)),
                            load_vec3(state_of(t, g, body, kState<S>.angular)));
    }
  }
  MW_INLINE Velocity<S> own(Velocity<S> a) const {
    if constexpr (std::is_same_v<S, Tensor>) a.w = rotate_back(q, a.w);
    return a;
  }
  MW_INLINE Float operator()(const Velocity<S>& a, const Velocity<S>& b) const {
    const Float linear = mass * dot(a.v, b.v);
    if constexpr (std::is_same_v<S, Tensor>) {
      const Vec3 l{inertia.x * a.w.x, inertia.y * a.w.y, inertia.z * a.w.z};
      return linear + dot(l, b.w);
    } else {
      return fma(inertia.z, dot(a.w, b.w), linear);
    }
  }
};

// What gravity and forces do along the way of a body in this step, twice.
template <class S, bool kDense>
MW_INLINE Float work_of_delta_v(const Constants& t, const Group& g, const Work& w,
                                const KineticForm<S>& form, int body) {
  Velocity<S> way = form.own(get_velocity<S, kDense>(w, w.displacement, body));
  const Mask free = mask_from_bits(~w.touched[body] & kAllLanes);
  way.v = select(free, way.v - drift_excess<S, kDense>(t, g, w, body), way.v);
  Velocity<S> delta_v;
  if (w.delta_v) {
    delta_v = form.own(get_velocity<S, kDense>(w, w.delta_v, body));
  } else {
    const Real* p = t.delta_v_rows + body * S::kRow;
    delta_v.v.x = p[0], delta_v.v.y = p[1];
    if constexpr (S::kDim == 3) delta_v.v.z = p[2];
    delta_v.w = zero_of<typename S::Ang>();
  }
  return form(delta_v, way) * (t.inv_h + t.inv_h);
}

// Fills the accounts; `warmed` holds the velocities that the substeps found.
template <class S, bool kDense>
void weigh_bodies(const Constants& t, const Group& g, const Work& w) {
  const Float zero(Real(0)), slack(kEnergySlack);
  const Float least(t.restitution_threshold), time(t.restitution_time);
  for (int b = 0; b < t.bodies; ++b) {
    if (t.body[b].kinematic) {
      for (int i = 0; i < kAccounts; ++i) zero.store(account(w, b, i));
      continue;
    }
    const KineticForm<S> form(t, g, w, b);
    const Velocity<S> start =
        form.own({load_as<typename S::Vec>(state_of(t, g, b, kState<S>.linear)),
                  load_as<typename S::Ang>(state_of(t, g, b, kState<S>.angular))});
    const Velocity<S> found = form.own(get_velocity<S, kDense>(w, w.warmed, b));
    const Velocity<S> after = form.own(get_velocity<S, kDense>(w, w.velocity, b));
    const Velocity<S> change{after.v - found.v, after.w - found.w};
    const Float before = form(start, start), work = work_of_delta_v<S, kDense>(t, g, w, form, b);
    Float slow2 = least * least;
    for (int c = 0; c < S::kDim; ++c) {
      slow2 = slow2 + square(time * Float(constants_of_body(g, b).gravity[c]));
    }
    const Float rounding = slack * fma(form.mass, slow2, before);
    (before + work + rounding).store(account(w, b, kAllowed));
    form(found, found).store(account(w, b, kFound));
    form(found, change).store(account(w, b, kCross));
    form(change, change).store(account(w, b, kChange));
  }
}

// Lanes in which a body has gained: elsewhere no island has.
inline unsigned lanes_that_gained(const Constants& t, const Work& w) {
  Mask gained = mask_from_bits(0);
  for (int b = 0; b < t.bodies; ++b) {
    const Float cross = Float::load(account(w, b, kCross));
    const Float after =
        Float::load(account(w, b, kFound)) + (cross + cross) + Float::load(account(w, b, kChange));
    gained = gained | (Float::load(account(w, b, kAllowed)) < after);
  }
  return bits(gained);
}

// Joins the bodies of a block that act on each other in this lane.
template <class S, int N>
MW_INLINE void join_bodies(const Constants& t, const Work& w, const ContactBlock<S, N>& s,
                           const Bounce<S, N>& bounce, int lane) {
  if (!((s.mask >> lane) & 1u)) return;
  bool active = false;  // before or after restitution
  for (int i = 0; i < N; ++i) active |= bounce.total[i][lane] > 0 || bounce.found[i][lane] > 0;
  // Friction may have been left where the last round has taken the normal impulse back.
  for (int c = 0; t.has_friction && c < S::kTangents; ++c) {
    active |= bounce.total_tangent[c][lane] != 0 || bounce.found_tangent[c][lane] != 0;
  }
  const int a = body_a_of(w, s, lane), b = body_b_of(w, s, lane);
  if (!active || t.body[a].kinematic || t.body[b].kinematic) return;
  unite(w.parent, a, b);
}

// Work that kinematic bodies do at a block by normal impulses, with friction at its centre.
template <class S, int N>
MW_INLINE Float work_of_driver(const Constants& t, const SidedBlock<S, N, Free>& s,
                               const SideVelocities<S, Free>& v, const Real (*total)[kLanes],
                               const Real (*tangent)[kLanes], const Real* twist) {
  Float speed[N], work(Real(0));
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) work = fnma(Float::load(total[i]), speed[i], work);
  if (t.has_friction) {
    const auto slip = slip_of(s, v);
    work = fnma(Float::load(tangent[0]), along_tangent(s, 0, slip), work);
    if constexpr (S::kTangents == 2) {
      work = fnma(Float::load(tangent[1]), along_tangent(s, 1, slip), work);
      if constexpr (ContactBlock<S, N>::kTwist) {
        const auto n = load_as<typename S::Vec>(s.normal[0]);
        work = fnma(Float::load(twist), dot(n, relative_spin(v.a, v.b)), work);
      }
    }
  }
  return work;
}

// Credits the work of kinematic bodies to those that they act on.
template <bool kDense, class S, int N>
MW_INLINE void credit_driver(const Constants& t, Work& w, const SidedBlock<S, N, Free>& s,
                             const Bounce<S, N>& bounce) {
  const Float zero(Real(0));
  const Mask drives_a = Float::load(s.a.inv_mass) == zero;
  const Mask drives_b = Float::load(s.b.inv_mass) == zero;
  if (!any((drives_a | drives_b) & mask_from_bits(s.mask))) return;
  RowVelocities<S, Free, kDense> v(w, s);
  const Velocity<S> still{zero_of<typename S::Vec>(), zero_of<typename S::Ang>()};
  v.a = select(drives_a, v.a, still);
  v.b = select(drives_b, v.b, still);
  alignas(64) Real found[kLanes], more[kLanes];
  const Float before =
      work_of_driver(t, s, v, bounce.found, bounce.found_tangent, bounce.found_twist);
  const Float after =
      work_of_driver(t, s, v, bounce.total, bounce.total_tangent, bounce.total_twist);
  (before + before).store(found);
  (after - before).store(more);
  for (int l = 0; l < kLanes; ++l) {
    if (!((s.mask >> l) & 1u)) continue;
    const int a = body_a_of(w, s, l), b = body_b_of(w, s, l);
    const int driven = t.body[a].kinematic ? b : a;
    if (!(t.body[a].kinematic || t.body[b].kinematic)) continue;
    account(w, driven, kAllowed)[l] += found[l];
    account(w, driven, kCross)[l] -= more[l];
  }
}

// The largest x up to 1 with found + 2 x cross + x^2 change <= allowed.
MW_INLINE Float affordable_share(Float allowed, Float found, Float cross, Float change) {
  const Float zero(Real(0)), one(Real(1));
  const Float spare = max(allowed - found, zero);
  const Float root = sqrt(fma(change, spare, cross * cross));
  const Float x = select(zero < cross, spare / (cross + root), (root - cross) / change);
  // change is 0 where restitution has changed nothing, and x then not a number
  const Mask less = (allowed < found + (cross + cross) + change) & (x < one);
  return select(less, x, one);
}

// Converts the accounts of a lane, whose islands are joined, into the share of each body.
inline void share_out(const Constants& t, const Work& w, int lane) {
  for (int b = 0; b < t.bodies; ++b) {
    const int root = root_of(w.parent, b);  // not after b
    if (root == b) continue;
    for (int i = 0; i < kAccounts; ++i) account(w, root, i)[lane] += account(w, b, i)[lane];
  }
  for (int b = 0; b < t.bodies; ++b) {
    const int root = root_of(w.parent, b);
    alignas(64) LaneNumber x{};
    const auto sum = [&](Account which) { return Float::load(account(w, root, which)); };
    // The roots come before their bodies.
    if (root == b) {
      affordable_share(sum(kAllowed), sum(kFound), sum(kCross), sum(kChange)).store(x.lane);
    }
    account(w, b, kShare)[lane] = root == b ? x.lane[lane] : account(w, root, kShare)[lane];
  }
}

template <class S, bool kDense>
void keep_share_of_bodies(const Constants& t, const Work& w) {
  const Float one(Real(1));
  for (int b = 0; b < t.bodies; ++b) {
    const Float share = Float::load(account(w, b, kShare));
    const Mask less = share < one;
    if (!any(less)) continue;
    const Velocity<S> found = get_velocity<S, kDense>(w, w.warmed, b);
    const Velocity<S> after = get_velocity<S, kDense>(w, w.velocity, b);
    const Velocity<S> kept{found.v + (after.v - found.v) * share,
                           found.w + (after.w - found.w) * share};
    put_velocity<S, kDense>(w, w.velocity, b, select(less, kept, after));
  }
}

// The impulses of a block, as far as its bodies keep what they did.
template <class S, int N, class A>
MW_INLINE void keep_share_of_block(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                                   Bounce<S, N>& bounce) {
  alignas(64) LaneNumber share;
  for (int l = 0; l < kLanes; ++l) {
    share.lane[l] = Real(1);
    if (!((s.mask >> l) & 1u)) continue;
    const int b = body_b_of(w, s, l);
    const int body = A::kMoves && t.body[b].kinematic ? body_a_of(w, s, l) : b;
    share.lane[l] = account(w, body, kShare)[l];
  }
  const Float x = share;
  const Mask less = x < Float(Real(1));
  const auto keep = [&](Real* to, const Real* from) {
    const Float after = Float::load(to), found = Float::load(from);
    select(less, fma(after - found, x, found), after).store(to);
  };
  for (int i = 0; i < N; ++i) keep(bounce.total[i], bounce.found[i]);
  if (t.has_friction) {
    for (int c = 0; c < S::kTangents; ++c) keep(bounce.total_tangent[c], bounce.found_tangent[c]);
    keep(bounce.total_twist, bounce.found_twist);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
