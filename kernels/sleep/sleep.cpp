#include "kernels/sleep/sleep.hpp"

#include "kernels/data/pair_keys.hpp"
#include "kernels/shape/overlap.hpp"
#include "kernels/work/constants.hpp"
#include "kernels/work/stages.hpp"
#include "kernels/work/union_find.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

MW_INLINE Mask pair_overlap(const Constants& t, const Work& w, kernels::PairKind kind, int a,
                            int b) {
  return is_round(kind) ? round_overlap(t, w, a, b) : bounds_overlap(t, w, a, b);
}

// One pass over the pairs; returns whether it woke a body.
bool wake_once(const Constants& t, const Group& g, Work& w, std::uint32_t mixed) {
  bool woke = false;
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (is_fixed(c.list)) continue;
    for (int k = 0; k < c.count; ++k) {
      const int a = t.collider_body[c.a[k]], b = t.collider_body[c.b[k]];
      std::uint32_t lanes = (g.asleep[a] ^ g.asleep[b]) & ~(g.absent[a] | g.absent[b]) & mixed;
      if (t.sweep) lanes &= w.marks[c.first_key + k];
      if (lanes == 0) continue;
      lanes &= bits(pair_overlap(t, w, c.kind, c.a[k], c.b[k]));
      for (; lanes != 0; lanes &= lanes - 1) {
        const int l = __builtin_ctz(lanes);
        const int sleeper = ((g.asleep[a] >> l) & 1u) ? a : b;
        if (t.body[sleeper].kinematic) continue;
        wake_island(t, g, sleeper, l);
        woke = true;
      }
    }
  }
  return woke;
}

// Lanes in which a part holds two moving bodies together.
std::uint32_t joined_lanes(const Constants& t, const Group& g, const kernels::JointPart& part) {
  if (part.body_a == t.bodies) return 0;
  const std::uint32_t disabled = g.disabled_joints ? g.disabled_joints[part.joint] : 0u;
  return kAllLanes & ~(disabled | g.absent[part.body_a] | g.absent[part.body_b]);
}

// Does the stored manifold of this key stay as it is, because neither body is awake?
bool pair_sleeps(const Constants& t, const Group& g, ListId list, std::int32_t key, int lane) {
  const kernels::PairOfKey pair = kernels::pair_of_key(t, key);
  std::uint32_t lanes = g.asleep[t.collider_body[pair.b]];
  if (!is_fixed(list)) lanes &= g.asleep[t.collider_body[pair.a]];
  return ((lanes >> lane) & 1u) != 0;
}

// Lanes in which a slow body may be at rest: what pulls it is held by a contact, and no force acts.
std::uint32_t held_lanes(const Constants& t, const Group& g, const Work& w, int body) {
  std::uint32_t lanes = kAllLanes;
  for (const Float pull : constants_of_body(g, body).acceleration) {
    lanes &= bits(pull == Float(Real(0)));
  }
  if (t.attractors > 0) lanes = 0;
  lanes |= w.touched[body] & kAllLanes;
  const int thrusts = t.first_thrust ? t.first_thrust[body + 1] : 0;
  for (int i = t.first_thrust ? t.first_thrust[body] : 0; i < thrusts; ++i) {
    lanes &= bits(Float::load(g.control + t.thrust[i].control * kLanes) == Float(Real(0)));
  }
  for (int c = 0; g.force && c < 6; ++c) {
    lanes &= bits(Float::load(g.force + (body * 6 + c) * kLanes) == Float(Real(0)));
  }
  return lanes;
}

// Looking for islands is worth it when a body has just become ready, and from time to time for
// those that lost touch with a restless one.
constexpr Real kLookAgain = Real(0.25);  // s

// Lanes of a body.
struct Readiness {
  std::uint32_t ready = 0;  // has rested long enough and is not asleep yet
  std::uint32_t look = 0;   // just became so, or has waited for another kLookAgain
};

// Adds dt to the time at rest of bodies slower than the threshold. Of the bodies of a lane that
// wait, the first looks for all: in the lanes of `waiting` that is another one.
template <class S>
Readiness rest(const Constants& t, const Group& g, const Work& w, int body, std::uint32_t waiting) {
  const auto v = load_as<typename S::Vec>(state_of(t, g, body, kState<S>.linear));
  const auto spin = load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular));
  const Float zero(Real(0));
  if (t.body[body].kinematic) {
    Mask still = (v.x == zero) & (v.y == zero);  // squares could underflow
    if constexpr (S::kDim == 3) {
      still = still & (v.z == zero) & (spin.x == zero) & (spin.y == zero) & (spin.z == zero);
    } else {
      still = still & (spin == zero);
    }
    g.asleep[body] = (bits(still) & ~w.frozen) | (g.asleep[body] & w.frozen);
    return {};
  }
  const Float enough(t.sleep_time);
  const Float speed =
      fma(sqrt(dot(spin, spin)), constants_of_body(g, body).radius, sqrt(dot(v, v)));
  const Mask still = (speed < Float(t.sleep_speed)) & mask_from_bits(held_lanes(t, g, w, body));
  Real* p = g.rest_time + body * kLanes;
  const Float before = Float::load(p);
  Float time = select(still, before + Float(t.step_dt), zero);
  time = select(mask_from_bits(w.frozen), before, time);
  Readiness out;
  out.ready = bits(enough <= time) & ~(idle_lanes(g, body) | w.frozen);
  if (out.ready != 0) {
    const std::uint32_t again = bits(enough + Float(kLookAgain) <= time) & ~waiting;
    time = select(mask_from_bits(again & kAllLanes), enough, time);
    out.look = out.ready & (bits(before < enough) | again);
  }
  time.store(p);
  return out;
}

// Islands of the awake bodies of one lane: parent[] leads to the lowest body of each.
void find_islands(const Constants& t, const Group& g, Work& w, int lane) {
  for (int b = 0; b < t.bodies; ++b) w.parent[b] = b;
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (is_fixed(c.list)) continue;
    const std::uint32_t* masks = w.hit_masks + first_hit(t, w, i);
    for (int k = 0; k < w.hit_count[i]; ++k) {
      if (!((masks[k] >> lane) & 1u)) continue;
      const std::int32_t code = code_of_hit(t, w, i, k);
      const int a = t.collider_body[code & 0xffff], b = t.collider_body[(code >> 16) & 0xffff];
      if ((((g.asleep[a] | g.asleep[b]) >> lane) & 1u) != 0) continue;  // a kinematic at rest
      unite(w.parent, a, b);
    }
  }
  for (int i = 0; i < t.parts; ++i) {
    const kernels::JointPart& part = t.part[i];
    const int a = part.body_a, b = part.body_b;
    const std::uint32_t awake = joined_lanes(t, g, part) & ~(a < t.bodies ? g.asleep[a] : 0);
    if (!(((awake & ~g.asleep[b]) >> lane) & 1u)) continue;
    unite(w.parent, a, b);
  }
}

// Puts to sleep the islands of a lane whose bodies are all ready.
void sleep_islands(const Constants& t, const Group& g, Work& w, int lane) {
  find_islands(t, g, w, lane);
  const auto is = [lane](std::uint32_t lanes) { return ((lanes >> lane) & 1u) != 0; };
  for (int b = 0; b < t.bodies; ++b) w.restless[b] = 0;
  for (int b = 0; b < t.bodies; ++b) {
    if (is(idle_lanes(g, b)) || is(w.ready[b])) continue;
    w.restless[root_of(w.parent, b)] = 1;
  }
  for (int b = 0; b < t.bodies; ++b) {
    if (!is(w.ready[b])) continue;
    const int root = root_of(w.parent, b);
    if (w.restless[root]) continue;
    g.asleep[b] |= 1u << lane;
    g.island[b * kLanes + lane] = root;
  }
}

template <class S>
void settle_bodies(const Constants& t, const Group& g, Work& w) {
  std::uint32_t look = 0, waiting = 0;
  for (int b = 0; b < t.bodies; ++b) {
    const Readiness r = rest<S>(t, g, w, b, waiting);
    w.ready[b] = r.ready;
    look |= r.look;
    waiting |= r.ready;
  }
  // Where candidates were left out islands are not to be told.
  for (look &= kAllLanes & ~w.overflow; look != 0; look &= look - 1) {
    sleep_islands(t, g, w, __builtin_ctz(look));
  }
}

}  // namespace

LaneActivity activity_of(const Constants& t, const Group& g) {
  LaneActivity out;
  for (int b = 0; b < t.bodies; ++b) {
    out.asleep |= g.asleep[b] & ~g.absent[b];
    out.awake |= ~idle_lanes(g, b) & kAllLanes;
    out.idle |= idle_lanes(g, b);
  }
  return out;
}

void wake_island(const Constants& t, const Group& g, int body, int lane) {
  const std::int32_t label = g.island[body * kLanes + lane];
  for (int b = 0; b < t.bodies; ++b) {
    if (!((g.asleep[b] >> lane) & 1u) || t.body[b].kinematic) continue;
    if (g.island[b * kLanes + lane] != label) continue;
    g.asleep[b] &= ~(1u << lane);
    g.rest_time[b * kLanes + lane] = Real(0);
  }
}

void wake_touched(const Constants& t, const Group& g, Work& w) {
  const LaneActivity lanes = activity_of(t, g);
  const std::uint32_t mixed = lanes.asleep & lanes.awake & ~w.frozen;
  if (mixed == 0) return;
  // A body that wakes may lie close to another island.
  while (wake_once(t, g, w, mixed)) {
  }
}

void wake_joined(const Constants& t, const Group& g, const Work& w) {
  for (bool woke = true; woke;) {
    woke = false;
    for (int i = 0; i < t.parts; ++i) {
      const kernels::JointPart& part = t.part[i];
      std::uint32_t lanes = joined_lanes(t, g, part) & ~w.frozen;
      if (lanes != 0) lanes &= g.asleep[part.body_a] ^ g.asleep[part.body_b];
      for (; lanes != 0; lanes &= lanes - 1) {
        const int l = __builtin_ctz(lanes);
        const int sleeper = ((g.asleep[part.body_a] >> l) & 1u) ? part.body_a : part.body_b;
        if (t.body[sleeper].kinematic) continue;
        wake_island(t, g, sleeper, l);
        woke = true;
      }
    }
  }
}

void keep_sleeping_contacts(const Constants& t, const Group& g, Work& w) {
  const LaneActivity lanes = activity_of(t, g);
  w.untouched |= ~lanes.awake & kAllLanes;
  w.partly_asleep = lanes.asleep & lanes.awake & ~w.frozen;
  for (std::uint32_t m = w.partly_asleep; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    for (int id = 0; id < kLists; ++id) {
      const int capacity = t.capacity[id];
      if (capacity == 0) continue;
      const ListId list = static_cast<ListId>(id);
      const int row = kernels::cache_row_size(t, list);
      int kept = 0;
      const std::int32_t* keys = g.cache[id].keys + l;
      const Real* rows = g.cache[id].rows + (kernels::kFirstRow * kLanes + l) * row;
      for (int at = 0; keys[at] != kernels::kEndOfKeys; at += kLanes) {
        if (!pair_sleeps(t, g, list, keys[at], l)) continue;
        w.kept_keys[id][l * capacity + kept] = keys[at];
        for (int i = 0; i < row; ++i) {
          w.kept_rows[id][(l * capacity + kept) * row + i] = rows[at * row + i];
        }
        ++kept;
      }
      w.lane_count[id][l] = w.kept[id][l] = kept;
    }
  }
}

void settle(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  if (t.dimension == kernels::Dimension::planar) {
    settle_bodies<Planar>(t, g, w);
  } else {
    settle_bodies<Isotropic>(t, g, w);
  }
  const LaneActivity lanes = activity_of(t, g);
  *g.idle = lanes.idle;
  const std::uint32_t resting = ~lanes.awake & kAllLanes;
  *g.resting = resting | frozen_lanes(g);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
