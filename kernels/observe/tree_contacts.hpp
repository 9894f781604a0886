// What the contacts of trees tell when the last substep is solved, before links move on: a force,
// as the impulse that it has over a step.
#pragma once

#include "kernels/observe/contacts.hpp"
#include "kernels/tree/contacts.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// `force`: in the contact's frame.
inline void put_tree_contact(const Constants& t, const Work& w, const TreeContact& c, Vec3 force,
                             std::uint32_t lanes, const ObserverView& o) {
  const kernels::TreePair<Real>& pair = t.tree.pair[c.pair];
  const int root = t.tree.link[pair.link_b].root;
  const Vec3 frame = load_vec3(w.tree.origin + 3 * root * kLanes) + load_pose(w, pair.link_b).x;
  const Vec3 place = frame + load_vec3(c.arm_b[0]);
  const Vec3 own = force * (Float(t.h) * Float(static_cast<Real>(t.substeps)));
  alignas(64) Real point[3][kLanes], friction[3][kLanes], impulse[kLanes];
  store(point[0], place), own.x.store(impulse);
  store(friction[0], fma(load_vec3(c.frame[6]), own.z, load_vec3(c.frame[3]) * own.y));
  Real* count = rows_for(o, Observer::contacts);
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    const auto at = static_cast<std::int32_t>(count[l]);
    count[l] += Real(1);
    if (at >= o.room) continue;
    auto& out = o.contacts[l * o.room + at];
    out.key = c.pair;
    out.feature = c.feature;
    for (int k = 0; k < 3; ++k) {
      out.normal[k] = c.frame[k][l];
      out.point[k] = point[k][l];
      out.friction[k] = friction[k][l];
    }
    out.separation = c.distance[l];
    out.impulse = impulse[l];
    out.twist = Real(0);
  }
}

inline void observe_tree_contacts(const Constants& t, const Group& g, kernels::Scratch* scratch,
                                  const ObserverView& o) {
  const Work& w = work_of(scratch);
  const std::uint32_t live = ~frozen_lanes(g) & kAllLanes;
  Real* const penetration = rows_for(o, Observer::penetration);
  Real* const touching = rows_for(o, Observer::touching);
  const ContactRows rows(t, w);
  for (int i = 0; i < w.tree.contact_count; ++i) {
    const TreeContact& c = w.tree.contacts[i];
    const std::uint32_t lanes = c.lanes & live;
    if (lanes == 0) continue;
    const kernels::TreePair<Real>& pair = t.tree.pair[c.pair];
    const Vec3 force = rows.force_of(c, pair);
    if (penetration) {
      const Float deepest = Float::load(penetration), depth = -Float::load(c.distance);
      select(mask_from_bits(lanes), max(deepest, depth), deepest).store(penetration);
    }
    if (touching) {
      const Mask acts = mask_from_bits(lanes) & (Float(Real(0)) < force.x);
      const std::int32_t links[] = {pair.link_a, pair.link_b};
      for (const std::int32_t link : links) {
        if (link < 0) continue;
        Real* to = touching + t.tree.link[link].body * kLanes;
        select(acts, Real(1), Float::load(to)).store(to);
      }
    }
    if (o.contacts) put_tree_contact(t, w, c, force, lanes, o);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
