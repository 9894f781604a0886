// Links of trees as their last forces were found: where they are, their inertias and velocities at
// the mass centre of their tree, and what acts on them from outside (MuJoCo's xpos, xipos, cinert,
// cvel and cfrc_ext); the generalised forces of actuators and of constraints (qfrc_actuator,
// qfrc_constraint); lengths of tendons and places of sites (ten_length, ten_velocity, site_xpos).
#pragma once

#include "kernels/observe/observe.hpp"
#include "kernels/tree/contacts.hpp"
#include "kernels/tree/dynamics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// visit(pair, contact, force on B in the world) of each contact. Where a lane has none the numbers
// are those of no step, and the force is 0.
template <class Visit>
MW_INLINE void for_each_contact_force(const Constants& t, const Work& w, Visit visit) {
  const ContactRows contacts(t, w);
  for (int i = 0; i < w.tree.contact_count; ++i) {
    const TreeContact& c = w.tree.contacts[i];
    const TreePair& pair = t.tree.pair[c.pair];
    const Vec3 own = contacts.force_of(c, pair);
    const Vec3 sum = fma(load_vec3(c.frame[6]), own.z,
                         fma(load_vec3(c.frame[3]), own.y, load_vec3(c.frame[0]) * own.x));
    visit(pair, c, select(mask_from_bits(c.lanes), sum, zero_of<Vec3>()));
  }
}

class TreeLinks {
 public:
  // `state`: in which poses were found; they are in the scratch.
  TreeLinks(const Constants& t, const Group& state, const Work& w, const ObserverView& o)
      : t_(t), g_(state), w_(w), o_(o), live_(mask_from_bits(~frozen_lanes(state) & kAllLanes)) {}

  void put_motion() const {
    if (has(Observer::links)) put_poses();
    if (has(Observer::tendons)) put_tendons();
    if (has(Observer::sites)) put_sites();
    const bool inertias = has(Observer::link_inertias), moves = has(Observer::link_velocities);
    if (!inertias && !moves && !has(Observer::link_forces)) return;
    find_centers();
    if (inertias) put_inertias();
    if (moves) put_velocities();
  }
  // Of a step, after put_motion().
  void put_forces() const {
    if (has(Observer::link_forces)) put_external_forces();
    if (has(Observer::dof_forces)) put_dof_forces();
    if (has(Observer::drives)) put_drives();
  }

 private:
  bool has(Observer observer) const { return rows_for(o_, observer) != nullptr; }
  template <Observer kObserver>
  Real* rows(int link) const {
    constexpr int kRows = kernels::kObserverRows.of_item[static_cast<int>(kObserver)];
    return rows_for(o_, kObserver) + t_.tree.link[link].body * kRows * kLanes;
  }
  void put(Real* to, Vec3 v) const { store(to, select(live_, v, zero_of<Vec3>())); }
  void put(Real* to, Float x) const { select(live_, x, Float(Real(0))).store(to); }

  Vec3 origin(int link) const {
    return load_vec3(w_.tree.origin + 3 * t_.tree.link[link].root * kLanes);
  }
  // Of its centre of mass from its frame.
  Vec3 arm(int link) const {
    return rotate(load_pose(w_, link).q, of_lanes(constants_of_link(g_, link).center));
  }
  const auto& constants(int link) const { return constants_of_body(g_, t_.tree.link[link].body); }

  // Of each root the mass centre of its tree, from its origin.
  Real* center_rows(int link) const {
    return link_rows(w_.tree.force, t_.tree.link[link].root, kTwistRows);
  }
  Vec3 center_of_tree(int link) const { return load_vec3(center_rows(link)); }
  void find_centers() const {
    for (int i = 0; i < t_.tree.links; ++i) {
      Real* const sum = center_rows(i);
      const Float mass(constants(i).mass);
      const Vec3 moment = (load_pose(w_, i).x + arm(i)) * mass;
      const bool first = t_.tree.link[i].root == i;
      store(sum, first ? moment : load_vec3(sum) + moment);
      (first ? mass : Float::load(sum + 3 * kLanes) + mass).store(sum + 3 * kLanes);
    }
    for (int i = 0; i < t_.tree.links; ++i) {
      if (t_.tree.link[i].root != i) continue;
      Real* const sum = center_rows(i);
      store(sum, load_vec3(sum) * (Float(Real(1)) / Float::load(sum + 3 * kLanes)));
    }
  }

  void put_poses() const {
    for (int i = 0; i < t_.tree.links; ++i) {
      Real* to = rows<Observer::links>(i);
      const Vec3 x = origin(i) + load_pose(w_, i).x;
      put(to + row_of(Observed::link_position) * kLanes, x);
      put(to + row_of(Observed::link_center) * kLanes, x + arm(i));
    }
  }
  void put_tendons() const {
    for (int i = 0; i < items_of(o_, Observer::tendons); ++i) {
      const kernels::TendonTable& tendon = o_.tendon[i];
      Float length(Real(0)), velocity(Real(0));
      for (int k = tendon.first_term; k < tendon.first_term + tendon.terms; ++k) {
        const kernels::TreeTerm<Real>& term = o_.tendon_term[k];
        const Float coefficient(term.coefficient);
        length = fma(coefficient, Float::load(coordinate_of(t_, g_, term.coordinate)), length);
        velocity = fma(coefficient, Float::load(velocity_of(t_, g_, term.dof)), velocity);
      }
      Real* to = rows_for(o_, Observer::tendons) + i * rows_of(Observer::tendons) * kLanes;
      put(to + row_of(Observed::tendon_length) * kLanes, length);
      put(to + row_of(Observed::tendon_velocity) * kLanes, velocity);
    }
  }
  void put_sites() const {
    for (int i = 0; i < items_of(o_, Observer::sites); ++i) {
      const kernels::PointTable<Real>& site = o_.site[i];
      Vec3 x = shared(site.position);
      if (site.body >= 0) {
        const FramePose at = load_pose(w_, site.body);
        x = origin(site.body) + (at.x + rotate(at.q, x));
      }
      Real* to = rows_for(o_, Observer::sites) + i * rows_of(Observer::sites) * kLanes;
      put(to + row_of(Observed::site_position) * kLanes, x);
    }
  }
  void put_inertias() const {
    for (int i = 0; i < t_.tree.links; ++i) {
      const auto& body = constants(i);
      const FramePose at = load_pose(w_, i);
      const Vec3 c = (at.x + arm(i)) - center_of_tree(i);
      const Mat3 axes = matrix(mul(at.q, of_lanes(constants_of_link(g_, i).principal)));
      const Sym3 moments =
          rotate_diagonal(axes, {body.inertia[0], body.inertia[1], body.inertia[2]});
      const SpatialInertia inertia = spatial_inertia(body.mass, c, moments);
      const Sym3& s = inertia.rotary;
      Real* to = rows<Observer::link_inertias>(i);
      put(to + row_of(Observed::link_inertia) * kLanes, {s.xx, s.yy, s.zz});
      put(to + row_of(Observed::link_product) * kLanes, {s.xy, s.xz, s.yz});
      put(to + row_of(Observed::link_moment) * kLanes, inertia.moment);
      put(to + row_of(Observed::link_mass) * kLanes, inertia.mass);
    }
  }
  void put_velocities() const {
    find_velocities(t_, g_, w_);
    for (int i = 0; i < t_.tree.links; ++i) {
      const Twist own = load_twist(link_rows(w_.tree.velocity, i, kTwistRows));
      const Twist v = moved(own, center_of_tree(i) - load_pose(w_, i).x);
      Real* to = rows<Observer::link_velocities>(i);
      put(to + row_of(Observed::link_angular_velocity) * kLanes, v.w);
      put(to + row_of(Observed::link_velocity) * kLanes, v.v);
    }
  }

  Wrench external(const Real* own) const {
    return {load_vec3(own + row_of(Observed::external_torque) * kLanes),
            load_vec3(own + row_of(Observed::external_force) * kLanes)};
  }
  // About its frame, of what is applied at `arm` from there.
  void add_force(int link, Vec3 moment, Vec3 force, Vec3 arm) const {
    Real* to = rows<Observer::link_forces>(link);
    const Wrench sum = external(to) + Wrench{moment + cross(arm, force), force};
    store(to + row_of(Observed::external_torque) * kLanes, sum.n);
    store(to + row_of(Observed::external_force) * kLanes, sum.f);
  }
  void put_external_forces() const {
    const Vec3 none = zero_of<Vec3>();
    for (int i = 0; i < t_.tree.links; ++i) {
      Real* to = rows<Observer::link_forces>(i);
      store(to + row_of(Observed::external_torque) * kLanes, none);
      store(to + row_of(Observed::external_force) * kLanes, none);
      if (!g_.force) continue;
      const Real* input = g_.force + t_.tree.link[i].body * 6 * kLanes;
      add_force(i, load_vec3(input + 3 * kLanes), load_vec3(input), arm(i));
    }
    if (t_.has_contacts) {
      for_each_contact_force(t_, w_, [&](const TreePair& pair, const TreeContact& c, Vec3 force) {
        add_force(pair.link_b, none, force, load_vec3(c.arm_b[0]));
        if (pair.link_a >= 0) add_force(pair.link_a, none, -force, load_vec3(c.arm_a[0]));
      });
    }
    for (int i = 0; i < t_.tree.links; ++i) {
      Real* to = rows<Observer::link_forces>(i);
      const Wrench f = moved(external(to), center_of_tree(i) - load_pose(w_, i).x);
      put(to + row_of(Observed::external_torque) * kLanes, f.n);
      put(to + row_of(Observed::external_force) * kLanes, f.f);
    }
  }

  Float force_of(int actuator) const {
    const auto& own = constants_of_actuator(g_, actuator);
    return clamp(force_asked(t_, g_, actuator), Float(own.low), Float(own.high));
  }
  // Ball joints have no actuators.
  void put_drives() const {
    for (int i = 0; i < items_of(o_, Observer::drives); ++i) {
      const kernels::TreeJoint<Real>& joint = t_.tree.joint[o_.coordinate[i].part];
      Float force(Real(0));
      for (int k = 0; k < t_.tree.actuators; ++k) {
        if (joint.kind == TreeJointKind::ball || t_.tree.actuator[k].dof != joint.dof) continue;
        force = fma(Float(constants_of_actuator(g_, k).gear), force_of(k), force);
      }
      put(rows_for(o_, Observer::drives) + i * kLanes, force);
    }
  }
  void put_dof_forces() const {
    Real* const all = rows_for(o_, Observer::dof_forces);
    constexpr int kRows = rows_of(Observer::dof_forces);
    const auto of = [all](int dof, int row) { return all + (dof * kRows + row) * kLanes; };
    constexpr int kActuator = row_of(Observed::actuator_force);
    constexpr int kConstraint = row_of(Observed::constraint_force);
    const Float zero(Real(0));
    for (int k = 0; k < t_.tree.dofs; ++k) {
      zero.store(of(k, kActuator));
      const Float held = t_.tree.has_rows ? Float::load(w_.tree.row_load + k * kLanes) : zero;
      put(of(k, kConstraint), held);
    }
    for (int i = 0; i < t_.tree.actuators; ++i) {
      const TreeActuator& a = t_.tree.actuator[i];
      const auto& own = constants_of_actuator(g_, i);
      const Float force = force_of(i);
      Real* to = of(a.dof, kActuator);
      put(to, fma(Float(own.gear), force, Float::load(to)));
    }
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  const ObserverView& o_;
  Mask live_;
};

// After the last stage of a call, which began with o.before.
inline void observe_tree_links(const Constants& t, const Group& g, kernels::Scratch* scratch,
                               const ObserverView& o) {
  Group before = g;
  before.state = o.before;
  const TreeLinks links(t, before, work_of(scratch), o);
  links.put_motion();
  links.put_forces();
}
// Of a state without a step.
inline void look_at_tree_links(const Constants& t, const Group& g, kernels::Scratch* scratch,
                               const ObserverView& o) {
  const Work& w = work_of(scratch);
  find_poses(t, g, w);
  TreeLinks(t, g, w, o).put_motion();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
