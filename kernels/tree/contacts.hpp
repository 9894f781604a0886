// Rows of contacts: of a point one along the normal, or four along the edges of a pyramid around
// it, n + mu t and n - mu t for both tangents (MuJoCo, "Computation", pyramidal cones), or the
// normal and two tangents within a round cone (cone.hpp). A set of rows as the newton solver asks
// for it (newton.hpp).
//
// No row is stored: what accelerations do at a point comes from the motions of its links, and what
// its forces do to the dofs from the wrenches on them.
#pragma once

#include "kernels/tree/compliance.hpp"
#include "kernels/tree/cone.hpp"
#include "kernels/tree/couplings.hpp"
#include "kernels/tree/row_force.hpp"
#include "kernels/tree/stiffness.hpp"
#include "kernels/tree/twists.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using TreePair = kernels::TreePair<Real>;
using kernels::ContactCone;

class ContactRows {
 public:
  MW_INLINE ContactRows(const Constants& t, const Work& w) : t_(t), w_(w) {}

  // Rows of the contacts that were found. Returns lanes that have any.
  Mask find(const Group& g) const {
    Mask found = mask_from_bits(0);
    for_each([&](Contact& c, const TreePair& pair) {
      Float inverse_weight(pair.inverse_weight);
      if (pair.cone == ContactCone::pyramidal) {
        const Float mu = Float::load(c.friction), friction_weight(pair.friction_weight);
        inverse_weight = mu * mu * Float(Real(2) / t_.tree.impedance_ratio) *
                         fma(mu * mu, friction_weight, inverse_weight);
      }
      const Compliance& compliance = compliance_of_contact(g, pair.compliance);
      const Float violation = Float::load(c.distance) - Float(pair.margin);
      const Mask near = mask_from_bits(c.lanes);
      const Edges speed = along_edges(pair, c, relative(c, pair, w_.tree.velocity));
      for (int e = 0; e < rows_of(pair); ++e) {
        // The tangents of a round cone have no spring.
        const bool tangent = pair.cone == ContactCone::elliptic && e > 0;
        const SoftRow soft =
            soft_row(compliance, pair.power, inverse_weight, violation, speed.along[e]);
        const Float reference =
            tangent ? -(Float(compliance.damping) * speed.along[e]) : soft.reference;
        select(near, soft.weight, Real(0)).store(c.weight);
        select(near, reference, Real(0)).store(c.reference[e]);
      }
      found = found | near;
    });
    return found;
  }

  void look_at(std::uint32_t lanes) { lanes_ = lanes; }
  // The twists of links by accelerations, or along the search.
  void start(const Real* twists) const {
    find_change(twists, [](Contact& c, int e, Float change) {
      (change - Float::load(c.reference[e])).store(c.residual[e]);
    });
  }
  void search(const Real* twists) const {
    find_change(twists, [](Contact& c, int e, Float change) { change.store(c.change[e]); });
  }

  bool none() const { return w_.tree.contact_count == 0; }
  // Wrenches on links by the forces of rows, [link][wrench][lane].
  void find_contact_wrenches(Real* wrenches) const {
    for (int r = 0; r < t_.tree.links * kTwistRows; ++r) {
      Float(Real(0)).store(wrenches + r * kLanes);
    }
    for_each([&](const Contact& c, const TreePair& pair) {
      const Vec3 own_force = force_of(c, pair);
      Vec3 force = load_vec3(c.frame[0]) * own_force.x;
      if (pair.cone != ContactCone::frictionless) {
        force = fma(load_vec3(c.frame[3]), own_force.y, force);
        force = fma(load_vec3(c.frame[6]), own_force.z, force);
      }
      const Real* const arms[2] = {c.arm_b[0], c.arm_a[0]};
      const int links[2] = {pair.link_b, pair.link_a};
      for (int s = 0; s < 2; ++s) {
        if (links[s] < 0) continue;
        Real* to = link_rows(wrenches, links[s], kTwistRows);
        const Wrench own{cross(load_vec3(arms[s]), force), force};
        store(to, s == 0 ? load_wrench(to) + own : load_wrench(to) - own);
      }
    });
  }
  void add_forces(Real* load) const {
    if (none()) return;
    find_contact_wrenches(w_.tree.force);
    add_wrenches(t_, w_, w_.tree.force, load);
  }

  // On B, in the contact's frame.
  MW_INLINE Vec3 force_of(const TreeContact& c, const TreePair& pair) const {
    const Float zero(Real(0));
    if (pair.cone == ContactCone::frictionless) return {row(c, 0).force(), zero, zero};
    if (pair.cone == ContactCone::elliptic) return cone(c).force();
    Float f[4];
    for (int e = 0; e < 4; ++e) f[e] = row(c, e).force();
    const Float mu = Float::load(c.friction);
    return {(f[0] + f[1]) + (f[2] + f[3]), mu * (f[0] - f[1]), mu * (f[2] - f[3])};
  }

  void couple(const Stiffness& stiffness) const {
    for_each([&](const Contact& c, const TreePair& pair) {
      if (pair.only_link < 0 && is_active(stiffness_of(c, pair))) stiffness.couple(pair.coupled);
    });
  }
  void add_stiffness(const Stiffness& stiffness) const {
    for_each([&](const Contact& c, const TreePair& pair) {
      const PointStiffness k = stiffness_of(c, pair);
      if (!is_active(k)) return;
      const std::int32_t* dofs = t_.tree.pair_dof + pair.first_dof;
      const Mat3 frame{load_vec3(c.frame[0]), load_vec3(c.frame[3]), load_vec3(c.frame[6])};
      for (int i = 0; i < pair.dofs; ++i) {
        const bool moves_a = dofs[i] < 0;
        const int dof = moves_a ? ~dofs[i] : dofs[i];
        const Twist axis = load_twist(axis_of(w_, dof));
        const Vec3 from = load_pose(w_, t_.tree.dof[dof].link).x;
        const Vec3 arm = load_vec3(moves_a ? c.arm_a[0] : c.arm_b[0]);
        const Vec3 to = load_pose(w_, moves_a ? pair.link_a : pair.link_b).x;
        Vec3 v = axis.v + cross(axis.w, arm + (to - from));
        if (moves_a) v = -v;
        const Vec3 own{dot(frame.x, v), dot(frame.y, v), dot(frame.z, v)};
        store(w_.tree.column + i * 3 * kLanes, own);
      }
      for (int i = 0; i < pair.dofs; ++i) {
        const Vec3 pull = pull_of(k, pair.cone, load_vec3(w_.tree.column + i * 3 * kLanes));
        const int row = dofs[i] < 0 ? ~dofs[i] : dofs[i];
        for (int j = i; j < pair.dofs; ++j) {
          const Vec3 other = load_vec3(w_.tree.column + j * 3 * kLanes);
          Real* to = stiffness.entry(row, dofs[j] < 0 ? ~dofs[j] : dofs[j]);
          Float sum = fma(pull.x, other.x, Float::load(to));
          if (pair.cone != ContactCone::frictionless)
            sum = fma(pull.z, other.z, fma(pull.y, other.y, sum));
          sum.store(to);
        }
      }
    });
  }

  // Of links against the world and what is welded to it, where links are stale.
  void hold() const {
    const TreeWork& x = w_.tree;
    for (int i = 0; i < t_.tree.links; ++i) x.is_held[i] = x.is_held[i] && !x.stale[i];
    for_each([&](const Contact& c, const TreePair& pair) {
      const int link = pair.only_link;
      if (link < 0 || !x.stale[link]) return;
      const PointStiffness k = stiffness_of(c, pair);
      if (!is_active(k)) return;
      Real* to = link_rows(x.held, link, kArticulatedRows);
      const Vec3 arm = load_vec3(link == pair.link_b ? c.arm_b[0] : c.arm_a[0]);
      const ArticulatedInertia own = spring_at(arm, in_world(c, pair, k));
      bool& held = x.is_held[link];
      store(to, held ? load_articulated(to) + own : own);
      held = true;
    });
  }
  // Of links against links.
  void add_rows(Couplings& couplings) const {
    for_each([&](const Contact& c, const TreePair& pair) {
      if (pair.only_link >= 0) return;
      for_each_term(c, pair, [&](Vec3 along, Float weight) {
        const Mask acts = Float(Real(0)) < weight;
        if ((bits(acts) & lanes_) == 0) return;
        Vec3 v = load_vec3(c.frame[0]) * along.x;
        if (pair.cone != ContactCone::frictionless) {
          v = fma(load_vec3(c.frame[6]), along.z, fma(load_vec3(c.frame[3]), along.y, v));
        }
        v = select(acts, v, zero_of<Vec3>());
        couplings.add_wrench(pair.link_b, {cross(load_vec3(c.arm_b[0]), v), v});
        couplings.add_wrench(pair.link_a, {cross(v, load_vec3(c.arm_a[0])), -v});
        couplings.finish(weight);
      });
    });
  }

  void along(Float step, Float& first, Float& second) const {
    for_each([&](const Contact& c, const TreePair& pair) {
      if (pair.cone == ContactCone::elliptic) return cone(c).add_along(step, first, second);
      for (int e = 0; e < rows_of(pair); ++e) row(c, e).add_along(step, first, second);
    });
  }
  Mask advance(Float step, Mask done) const {
    Mask changed = mask_from_bits(0);
    for_each([&](Contact& c, const TreePair& pair) {
      Mask own = mask_from_bits(0);
      if (pair.cone == ContactCone::elliptic) {
        own = cone(c).advance(c.residual[0], step, done);
      } else {
        for (int e = 0; e < rows_of(pair); ++e) own = own | row(c, e).advance(step, done);
      }
      if (pair.only_link >= 0 && any(own)) w_.tree.stale[pair.only_link] = true;
      changed = changed | own;
    });
    return changed;
  }

 private:
  using Contact = TreeContact;
  struct Edges {
    Float along[4];
  };
  // Of a motion at the contact, both in its frame.
  static MW_INLINE Vec3 pull_of(const PointStiffness& k, ContactCone cone, Vec3 v) {
    if (cone == ContactCone::frictionless) return {k.normal * v.x, v.y, v.z};
    Vec3 pull{fma(k.normal_2, v.z, fma(k.normal_1, v.y, k.normal * v.x)),
              fma(k.tangent_1, v.y, k.normal_1 * v.x), fma(k.tangent_2, v.z, k.normal_2 * v.x)};
    if (cone == ContactCone::elliptic) {
      pull.y = fma(k.tangents, v.z, pull.y), pull.z = fma(k.tangents, v.y, pull.z);
    }
    return pull;
  }

  template <class Visit>
  MW_INLINE void for_each(Visit visit) const {
    for (int i = 0; i < w_.tree.contact_count; ++i) {
      TreeContact& c = w_.tree.contacts[i];
      if ((c.lanes & lanes_) != 0) visit(c, t_.tree.pair[c.pair]);
    }
  }
  static int rows_of(const TreePair& pair) {
    constexpr int kRows[] = {1, 4, 3};
    return kRows[static_cast<int>(pair.cone)];
  }
  MW_INLINE Cone cone(const Contact& c) const { return {c, t_.tree.impedance_ratio}; }
  static MW_INLINE RowView row(const Contact& c, int e) {
    return {c.weight, const_cast<Real*>(c.residual[e]), c.change[e]};
  }

  // Of B against A at the point, world axes.
  MW_INLINE Vec3 relative(const Contact& c, const TreePair& pair, const Real* twists) const {
    const auto at = [&](int link, const Real* arm) {
      const Twist v = load_twist(twists + link * kTwistRows * kLanes);
      return v.v + cross(v.w, load_vec3(arm));
    };
    Vec3 v = at(pair.link_b, c.arm_b[0]);
    if (pair.link_a >= 0) v = v - at(pair.link_a, c.arm_a[0]);
    return v;
  }
  static MW_INLINE Edges along_edges(const TreePair& pair, const Contact& c, Vec3 v) {
    const Float normal = dot(load_vec3(c.frame[0]), v);
    if (pair.cone == ContactCone::frictionless) return {{normal, normal, normal, normal}};
    Float one = dot(load_vec3(c.frame[3]), v), two = dot(load_vec3(c.frame[6]), v);
    if (pair.cone == ContactCone::elliptic) return {{normal, one, two, two}};
    const Float mu = Float::load(c.friction);
    one = mu * one, two = mu * two;
    return {{normal + one, normal - one, normal + two, normal - two}};
  }
  template <class Put>
  MW_INLINE void find_change(const Real* twists, Put put) const {
    for_each([&](Contact& c, const TreePair& pair) {
      const Edges change = along_edges(pair, c, relative(c, pair, twists));
      for (int e = 0; e < rows_of(pair); ++e) put(c, e, change.along[e]);
    });
  }
  MW_INLINE PointStiffness stiffness_of(const Contact& c, const TreePair& pair) const {
    const Float zero(Real(0));
    if (pair.cone == ContactCone::frictionless) {
      return {row(c, 0).stiffness(), zero, zero, zero, zero, zero};
    }
    if (pair.cone == ContactCone::elliptic) return cone(c).stiffness();
    Float s[4];
    for (int e = 0; e < 4; ++e) s[e] = row(c, e).stiffness();
    const Float mu = Float::load(c.friction), mu2 = mu * mu;
    return {(s[0] + s[1]) + (s[2] + s[3]), mu * (s[0] - s[1]),  mu * (s[2] - s[3]),
            mu2 * (s[0] + s[1]),           mu2 * (s[2] + s[3]), zero};
  }

  // The same in world axes.
  static MW_INLINE Sym3 in_world(const Contact& c, const TreePair& pair, const PointStiffness& k) {
    const Float zero(Real(0)), minus(Real(-1));
    const Vec3 n = load_vec3(c.frame[0]);
    const auto add = [&](Vec3 a, Vec3 b, const Sym3& to) { return fnma(a * minus, b, to); };
    const Sym3 none{zero, zero, zero, zero, zero, zero};
    if (pair.cone == ContactCone::frictionless) return add(n * k.normal, n, none);
    const Vec3 one = load_vec3(c.frame[3]), two = load_vec3(c.frame[6]);
    Vec3 by_one = fma(one, k.tangent_1, n * k.normal_1);
    Vec3 by_two = fma(two, k.tangent_2, n * k.normal_2);
    if (pair.cone == ContactCone::elliptic) {
      by_one = fma(two, k.tangents, by_one), by_two = fma(one, k.tangents, by_two);
    }
    const Vec3 by_n = fma(two, k.normal_2, fma(one, k.normal_1, n * k.normal));
    return add(by_two, two, add(by_one, one, add(by_n, n, none)));
  }
  // visit(direction in the contact's frame, weight) of what J' D J is the sum of.
  template <class Visit>
  MW_INLINE void for_each_term(const Contact& c, const TreePair& pair, Visit visit) const {
    const Float zero(Real(0)), one(Real(1));
    if (pair.cone == ContactCone::frictionless)
      return visit({one, zero, zero}, row(c, 0).stiffness());
    if (pair.cone == ContactCone::elliptic) {
      const ConeTerms terms = cone(c).terms();
      for (int i = 0; i < 3; ++i) visit(terms.along[i], terms.weight[i]);
      return;
    }
    const Float mu = Float::load(c.friction);
    visit({one, mu, zero}, row(c, 0).stiffness()), visit({one, -mu, zero}, row(c, 1).stiffness());
    visit({one, zero, mu}, row(c, 2).stiffness()), visit({one, zero, -mu}, row(c, 3).stiffness());
  }

  MW_INLINE bool is_active(const PointStiffness& k) const {
    return (bits(Float(Real(0)) < k.normal) & lanes_) != 0;
  }

  const Constants& t_;
  std::uint32_t lanes_ = kAllLanes;
  const Work& w_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
