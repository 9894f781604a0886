// The passes over all parts of a group, in the order of the joints. One instantiation per space and
// layout fills a JointSolver.
#pragma once

#include <initializer_list>

#include "kernels/joint/breaking.hpp"
#include "kernels/joint/gap_energy.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
inline constexpr std::size_t kPartBytes = [] {
  std::size_t most = sizeof(PointRows<S>);
  for (const std::size_t n : {sizeof(LockRows<S>), sizeof(LineRows<S>), sizeof(Row<S>)}) {
    most = n > most ? n : most;
  }
  if constexpr (S::kDim == 3) most = sizeof(SwingRows<S>) > most ? sizeof(SwingRows<S>) : most;
  return most;
}();

// Calls visit(rows of the part, part, index) for every part.
template <class S, class Visit>
MW_INLINE void for_each_part(const Constants& t, Work& w, int first, int end, Visit visit) {
  for (int i = first; i < end; ++i) {
    const JointPart& part = t.part[i];
    unsigned char* at = w.parts + static_cast<std::size_t>(i) * kPartBytes<S>;
    switch (part.kind) {
      case PartKind::point: visit(*reinterpret_cast<PointRows<S>*>(at), part, i); break;
      case PartKind::lock: visit(*reinterpret_cast<LockRows<S>*>(at), part, i); break;
      case PartKind::line: visit(*reinterpret_cast<LineRows<S>*>(at), part, i); break;
      case PartKind::swing:
        if constexpr (S::kDim == 3) visit(*reinterpret_cast<SwingRows<S>*>(at), part, i);
        break;
      default: visit(*reinterpret_cast<Row<S>*>(at), part, i);
    }
  }
}

template <class S, class Visit>
MW_INLINE void for_each_part(const Constants& t, Work& w, Visit visit) {
  for_each_part<S>(t, w, 0, t.parts, visit);
}

template <class S, bool kDense>
struct JointPasses {
  static void prepare_bodies(const Constants& t, const Group& g, Work& w, const JointPart& part,
                             int index, PartBodies<S>& s) {
    s.mask = active_lanes(t, g, part);
    const int body_a = part.body_a == t.bodies ? world_body(t) : part.body_a;
    s.body_a = body_a, s.body_b = part.body_b;
    for (int l = 0; l < kLanes; ++l) {
      const bool active = ((s.mask >> l) & 1u) != 0;
      s.offset_a[l] = w.velocity_base[l] + (active ? body_a : t.bodies) * S::kRow;
      s.offset_b[l] = w.velocity_base[l] + (active ? part.body_b : t.bodies) * S::kRow;
    }
    put_body(t, g, w, s.body_a, s.a), put_body(t, g, w, s.body_b, s.b);
    const Real* from = g.joint_impulse + index * kernels::kPartImpulses * kLanes;
    for (int i = 0; i < kernels::kPartImpulses; ++i) {
      Float::load(from + i * kLanes).store(s.impulse[i]);
    }
    if (part.force) return;  // bodies without other rows are integrated freely
    w.touched[part.body_a] |= s.mask;
    w.touched[part.body_b] |= s.mask;
  }

  // The state has what each part of a joint does; while they are solved, what a held row makes the
  // other parts do belongs to the row. Adds that to them, `sign` times.
  template <class Rows>
  static void share_reaction(const Constants&, Work&, const JointPart&, int, const Rows&, Real) {}
  static void share_reaction(const Constants& t, Work& w, const JointPart& part, int index,
                             const Row<S>& s, Real sign) {
    if (part.direct || !is_held(part)) return;
    const Float p = along_row(s) * Float(sign);
    const auto add = [p](Real* to, auto change) {
      store(to, load_as<decltype(change)>(to) + change * p);
    };
    for (int i = index + 1; i < t.parts && t.part[i].joint == part.joint; ++i) {
      auto& other =
          *reinterpret_cast<PartBodies<S>*>(w.parts + static_cast<std::size_t>(i) * kPartBytes<S>);
      switch (t.part[i].kind) {
        case PartKind::point:
        case PartKind::line:
          add(other.impulse[0], load_as<typename S::Vec>(s.reaction_force[0]));
          break;
        case PartKind::lock:
        case PartKind::swing:
          add(other.impulse[0], load_as<typename S::Ang>(s.reaction_moment[0]));
          break;
        default: break;
      }
    }
  }

  // A point knows of the rotation, which is the part before it (held_point.hpp).
  static void share_reaction(const Constants&, Work& w, const JointPart& part, int index,
                             const PointRows<S>& s, Real sign) {
    if (!holds_rotation(part)) return;
    using Ang = typename S::Ang;
    const Ang moment = moment_of(s.reaction, load_as<typename S::Vec>(s.impulse[0]));
    Real* to = reinterpret_cast<PartBodies<S>*>(w.parts +
                                                static_cast<std::size_t>(index - 1) * kPartBytes<S>)
                   ->impulse[0];
    store(to, load_as<Ang>(to) + moment * Float(sign));
  }

  // Rows come first in their joint, and the last part first back into the state.
  static void take_reactions(const Constants& t, Work& w) {
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      share_reaction(t, w, part, i, s, Real(-1));
    });
  }
  static void return_reactions(const Constants& t, Work& w) {
    for (int i = t.parts - 1; i >= 0; --i) {
      for_each_part<S>(t, w, i, i + 1, [&](auto& s, const JointPart& part, int) {
        share_reaction(t, w, part, i, s, Real(1));
      });
    }
  }

  // Rows at the start of the step, with the impulses of the last one.
  static void prepare_parts(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    start_rotations<S>(t, g, w);
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      const Joint& constants = constants_of_part(g, i);
      prepare_bodies(t, g, w, part, i, s);
      prepare(t, g, part, constants, s);
      refresh<S, kDense, false>(w, part, constants, s);
    });
    take_reactions(t, w);
  }

  template <Pass kPass>
  static void pass(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      if (s.mask == 0 || part.direct || (kPass != Pass::warm_start && part.attached)) return;
      PartVelocities<S, kDense> v(w, s);
      const bool relaxes = kPass == Pass::bias && t.solver.relaxes && !bounded(part);
      const PartImpulses before = relaxes ? impulses_of(s) : PartImpulses{};
      solve<S, kDense, kPass>(t, g, w, part, constants_of_part(g, i), s, v);
      if (relaxes) relax_change(t, w, before, s, v);
      v.store(w, s);
    });
  }

  // May what it does end at a bound, so that more of it would be too much?
  static bool bounded(const JointPart& part) {
    return part.drive || part.low || part.high || part.spring;
  }
  struct PartImpulses {
    Float of[kernels::kPartImpulses];
  };
  static MW_INLINE PartImpulses impulses_of(const PartBodies<S>& s) {
    PartImpulses out;
    for (int k = 0; k < kernels::kPartImpulses; ++k) out.of[k] = Float::load(s.impulse[k]);
    return out;
  }
  // Multiplies by the relaxation what the pass has changed. Impulses and velocities are linear in
  // each other.
  static MW_INLINE void relax_change(const Constants& t, const Work& w, const PartImpulses& before,
                                     PartBodies<S>& s, PartVelocities<S, kDense>& v) {
    const Float r(t.solver.relaxation);
    for (int k = 0; k < kernels::kPartImpulses; ++k) {
      fma(Float::load(s.impulse[k]) - before.of[k], r, before.of[k]).store(s.impulse[k]);
    }
    const PartVelocities<S, kDense> began(w, s);
    v.a.v = fma(v.a.v - began.a.v, r, began.a.v), v.a.w = fma(v.a.w - began.a.w, r, began.a.w);
    v.b.v = fma(v.b.v - began.b.v, r, began.b.v), v.b.w = fma(v.b.w - began.b.w, r, began.b.w);
  }

  // How the motion of the substep will curve: by the angular velocities with half of the warm
  // start, as they will be on average.
  static void predict(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for (int i = 0; i < t.jointed_bodies; ++i) {
      const int body = t.jointed[i];
      const auto now = get_velocity<S, kDense>(w, w.velocity, body).w,
                 before = get_velocity<S, kDense>(w, w.warmed, body).w;
      Curvature<S>(t, w, body, (now + before) * Float(Real(0.5))).store(w, body);
    }
  }

  static void rotate(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    rotate_jointed_bodies<S, kDense>(t, g, work_of(scratch));
  }

  static void follow(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      refresh<S, kDense, true>(w, part, constants_of_part(g, i), s);
    });
  }

  static void keep(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    return_reactions(t, w);
    for_each_part<S>(t, w, [&](auto& s, const JointPart&, int i) {
      const Mask lanes = mask_from_bits(s.mask & ~w.frozen);
      Real* to = g.joint_impulse + i * kernels::kPartImpulses * kLanes;
      for (int k = 0; k < kernels::kPartImpulses; ++k) {
        select(lanes, Float::load(s.impulse[k]), Float::load(to + k * kLanes))
            .store(to + k * kLanes);
      }
    });
  }

  // Adds what the substep made the joints that may break bear.
  static void bear(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const Float zero(Real(0));
    for (int i = 0; i < t.breakable; ++i) {
      Real* to = w.loads + i * kLoadRows<S>;
      for (int k = 0; w.substep == 0 && k < kLoadRows<S>; k += kLanes) zero.store(to + k);
      const int first = t.breaking[i].first_part;
      for_each_part<S>(t, w, first, first + t.breaking[i].parts, [&](auto& s, auto& part, int) {
        Impulse<S> p = impulse_of(s);
        if constexpr (requires { s.reaction; }) {
          if (holds_rotation(part)) p.angular = p.angular + moment_of(s.reaction, p.linear);
        }
        add_to(to, 0, p.linear);
        add_to(to, S::kDim, p.angular);
      });
    }
  }

  static void drive_work(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      add_drive_work<S, kDense>(t, g, w, part, i, s);
    });
  }

  // Of the state, before or after a step.
  static void gap_energy(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    prepare_parts(t, g, scratch);
    return_reactions(t, w);
    const Float zero(Real(0));
    for_each_part<S>(t, w, [&](auto& s, const JointPart& part, int i) {
      if (s.mask == 0 || part.force) return;
      const Joint& constants = constants_of_part(g, i);
      const bool limit = !part.equality && (part.low || part.high);
      const auto& soft = limit ? constants.limit_soft : constants.soft;
      const Float energy = energy_of(t, soft, gap_of(part, constants, s));
      add_to(w.audit.sums, kGapEnergy, select(mask_from_bits(s.mask), energy, zero));
    });
  }

  static kernels::JointSolver<Real> table() {
    return {prepare_parts, pass<Pass::warm_start>, predict,    pass<Pass::bias>,
            rotate,        pass<Pass::relax>,      follow,     keep,
            bear,          break_joints<S>,        drive_work, gap_energy};
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
