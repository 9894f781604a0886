// All rows of the newton solver as one set.
#pragma once

#include "kernels/tree/ball_limits.hpp"
#include "kernels/tree/contacts.hpp"
#include "kernels/tree/limits.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// The cost of accelerations without that of rows, along a search: derivatives where it begins.
struct SmoothCost {
  Float slope, curvature;
};

class ConstraintRows {
 public:
  MW_INLINE ConstraintRows(const Constants& t, const Work& w)
      : limits_(t, w), balls_(t, w), contacts_(t, w) {}

  Mask find(const Group& g) const { return limits_.find(g) | balls_.find(g) | contacts_.find(g); }
  // From here on rows that none of these lanes has are left alone.
  void look_at(std::uint32_t lanes) {
    limits_.look_at(lanes), balls_.look_at(lanes), contacts_.look_at(lanes);
  }
  // Of accelerations of dofs, and the twists of links that come of them.
  void start(const Real* a, const Real* twists) const {
    limits_.start(a), balls_.start(a), contacts_.start(twists);
  }
  void search(const Real* direction, const Real* twists) const {
    limits_.search(direction), balls_.search(direction), contacts_.search(twists);
  }
  MW_INLINE void along(Float step, Float& first, Float& second) const {
    limits_.along(step, first, second), balls_.along(step, first, second);
    contacts_.along(step, first, second);
  }
  Mask advance(Float step, Mask done) const {
    return limits_.advance(step, done) | balls_.advance(step, done) | contacts_.advance(step, done);
  }

  // Adds J' times the forces; those of joints alone.
  void add_forces(Real* load) const { add_joint_forces(load), contacts_.add_forces(load); }
  void add_joint_forces(Real* load) const { limits_.add_forces(load), balls_.add_forces(load); }
  const ContactRows& contacts() const { return contacts_; }

  // In joint space: which dofs the rows couple, and J' D J of the active ones.
  void couple(const Stiffness& stiffness) const {
    limits_.couple(stiffness), contacts_.couple(stiffness);
  }
  void add_stiffness(const Stiffness& stiffness) const {
    limits_.add_stiffness(stiffness), balls_.add_stiffness(stiffness);
    contacts_.add_stiffness(stiffness);
  }
  // By links: of single dofs, on a diagonal [dof][lane]; of links; of what couples branches.
  void add_stiffness(Real* diagonal) const { limits_.add_stiffness(diagonal); }
  void hold() const { contacts_.hold(); }
  void add_rows(Couplings& couplings) const {
    limits_.add_rows(couplings), balls_.add_rows(couplings), contacts_.add_rows(couplings);
  }

 private:
  LimitRows limits_;
  BallLimitRows balls_;
  ContactRows contacts_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
