// The solver's passes over a group: each contact list in its fixed order. One instantiation per
// space and layout fills a SolverTable.
#pragma once

#include "kernels/motion/finish.hpp"
#include "kernels/rows/contact_cache.hpp"
#include "kernels/rows/solve_list.hpp"
#include "kernels/solver/energy.hpp"
#include "kernels/solver/resist.hpp"
#include "kernels/solver/strikes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
struct Passes {
  template <Pass kPass>
  static void solve(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    if (kPass == Pass::bias && t.impact_sweeps > 0) begin_strikes<S, kDense>(t, w);
    const bool settles = w.struck != 0;  // then bounces wait for what the sweeps find
    for_each_list<S>(w, [&]<int N, class A>(BlockList& list) {
      const auto finish = [&](int i) {
        if constexpr (kPass == Pass::relax) {
          if (!t.has_restitution || settles) return;
          accumulate_bounce(block_at<SidedBlock<S, N, A>>(list, i), bounce_at<S, N>(list, i),
                            t.has_friction);
        }
      };
      if constexpr (S::kDim == 2 && N == 1) {
        solve_ahead<kDense, kPass, SidedBlock<S, N, A>>(t, w, list, finish);
      } else {
        solve_in_twos<kDense, kPass, SidedBlock<S, N, A>>(t, w, list, finish);
      }
    });
    if constexpr (kPass != Pass::warm_start) {
      if (w.struck == 0) return;
      settle_strikes<S, kDense>(t, w, kPass);
      if constexpr (kPass == Pass::relax) {
        if (t.has_restitution) accumulate_bounces(t, w);
      }
    }
  }
  static void accumulate_bounces(const Constants& t, Work& w) {
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      accumulate_bounce(s, bounce_at<S, N>(list, i), t.has_friction);
    });
  }

  // Velocities after the first delta_v are the base of warm starting.
  static void apply_delta_v(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    apply_first_delta_v<S, kDense>(t, g, work_of(scratch));
  }
  static void open(const Constants& t, const Group&, kernels::Scratch* scratch) {
    begin_substeps<S, kDense>(t, work_of(scratch));
  }

  static void mark(const Constants& t, const Group&, kernels::Scratch* scratch) {
    mark_velocities<S, kDense>(t, work_of(scratch));
  }
  static void gather(const Constants& t, const Group&, kernels::Scratch* scratch) {
    gather_impulses<S, kDense>(t, work_of(scratch));
  }

  static void restitute(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const unsigned active = find_participants<S, kDense>(t, w);
    if (active == 0) return;
    for_each_register<S, kDense>(
        t, w, [&](int at, Float, Float) { Float::load(w.velocity + at).store(w.warmed + at); });
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      take_back<kDense>(t, w, s, bounce_at<S, N>(list, i));
    });
    play_impacts<S, kDense>(t, w, active);
    if (t.has_friction) solve_friction_of_impacts<S, kDense>(t, w, active);
    if (t.has_resistance) ResistancePasses<S, kDense>::resist_impacts(w);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      finish_impact(t, s, bounce_at<S, N>(list, i));
    });
    balance(t, g, w);
  }

  // No island keeps more energy than it had (energy.hpp).
  static void balance(const Constants& t, const Group& g, Work& w) {
    weigh_bodies<S, kDense>(t, g, w);
    bool driven = false;
    for (int b = 0; b < t.bodies; ++b) driven |= t.body[b].kinematic;
    if (driven) {
      for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
        if constexpr (A::kMoves) {
          credit_driver<kDense>(t, w, s, bounce_at<S, N>(list, i));
        }
      });
    }
    const unsigned gained = lanes_that_gained(t, w);
    if (gained == 0) return;
    for (int l = 0; l < kLanes; ++l) {
      if (!((gained >> l) & 1u)) {
        for (int b = 0; b < t.bodies; ++b) account(w, b, kShare)[l] = Real(1);
        continue;
      }
      for (int b = 0; b < t.bodies; ++b) w.parent[b] = b;
      for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
        if constexpr (A::kMoves) join_bodies(t, w, s, bounce_at<S, N>(list, i), l);
      });
      share_out(t, w, l);
    }
    keep_share_of_bodies<S, kDense>(t, w);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      keep_share_of_block(t, w, s, bounce_at<S, N>(list, i));
    });
  }

  static void store(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    CacheWriter writer(t, g, w);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      mark_reached<S, A, kDense>(w, s);
      writer.put(s, t.has_resistance ? &resistance_at<S>(list, i) : nullptr,
                 static_cast<ListId>(&list - w.blocks));
    });
    writer.close();
    report_overflow(g, w);
  }

  static void enter(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    enter_velocities<S, kDense>(t, g, work_of(scratch));
    find_strike_speeds<S>(t, g, work_of(scratch));
  }
  static void advance(const Constants& t, const Group&, kernels::Scratch* scratch) {
    advance_displacement<S, kDense>(t, work_of(scratch));
  }
  static void next(const Constants& t, const Group&, kernels::Scratch* scratch) {
    next_substep<S, kDense>(t, work_of(scratch));
  }
  static void leave(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    leave_state<S, kDense>(t, g, work_of(scratch), NoFlight{});
  }

  static kernels::SolverTable<Real> table() {
    kernels::SolverTable<Real> out{};
    out.enter = enter;
    out.apply_delta_v = apply_delta_v;
    out.warm_start = solve<Pass::warm_start>;
    out.open = open;
    out.mark = mark;
    out.gather = gather;
    out.bias = solve<Pass::bias>;
    out.advance = advance;
    out.relax = solve<Pass::relax>;
    out.warm_start_resistance = ResistancePasses<S, kDense>::warm_start;
    out.resist = ResistancePasses<S, kDense>::solve;
    out.next = next;
    out.restitute = restitute;
    out.store = store;
    out.leave = leave;
    return out;
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
