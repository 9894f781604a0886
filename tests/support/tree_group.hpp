// A group of trees that its kernels step without a Batch: every lane has a state of its own.
#pragma once

#include "src/base/aligned_buffer.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/state/constants.hpp"
#include "src/state/tree_tables.hpp"
#include "tests/support/tree_twin.hpp"

namespace manyworlds::test {

// Newton steps by links or in joint space (kernels/tree/link_space.hpp, joint_space.hpp).
inline PlanTrees trees_of(const std::vector<TwinLink>& links, double dt, bool by_links = true) {
  TreeBuilder builder;
  for (const TwinLink& link : links) {
    builder.add(link.frame);
    for (const NewTreeJoint& joint : link.joints) builder.add(joint);
  }
  PlanTrees trees = builder.finish(dt, {100, 50, 1e-26, 1e-6, 0});
  trees.by_links = by_links;
  return trees;
}

template <class Real>
class TreeGroup {
 public:
  TreeGroup(const kernels::Kernels<Real>& kernels, const std::vector<TwinLink>& links,
            const Vec3& gravity, double dt, bool by_links = true)
      : kernels_(kernels),
        lanes_(kernels.lanes),
        bodies_(static_cast<int>(links.size())),
        trees_(trees_of(links, dt, by_links)),
        tables_(trees_, first(), first() + coordinates()),
        rows_(first() + coordinates() + 2 * dofs()),
        state_(count(rows_)),
        numbers_(plan_of(trees_), {false, false, false, false}, 1, lanes_),
        body_constants_(count(bodies_) * sizeof(kernels::BodyConstants<Real>) / sizeof(Real)),
        force_(count(bodies_ * 6)),
        status_(static_cast<std::size_t>(lanes_)) {
    bodies_table_.resize(links.size());
    constants_.dimension = kernels::Dimension::spatial;
    constants_.inertia_kind = kernels::InertiaKind::tensor;
    constants_.has_orientation = true;
    constants_.bodies = bodies_;
    constants_.substeps = 1;
    constants_.state_stride = kBodyRows, constants_.state_size = rows_;
    constants_.dt = constants_.h = static_cast<Real>(dt);
    constants_.body = bodies_table_.data();
    constants_.tree = tables_.get();
    for (const TwinLink& link : links) put_constants(link, gravity);
    for (int lane = 0; lane < lanes_; ++lane) numbers_.fill(plan_of(trees_), lane);
    constants_.constants = numbers_.group(0);
    constants_.constants.body = body_constants_.data();
    scratch_ = AlignedBuffer<unsigned char>(kernels.scratch_bytes(constants_));
    made_ = kernels.make_scratch(constants_, scratch_.data());
  }

  int lanes() const { return lanes_; }
  void set(int lane, const TreeTwin::Numbers& q, const TreeTwin::Numbers& v) {
    for (int c = 0; c < q.size(); ++c) at(lane, first() + c) = static_cast<Real>(q[c]);
    for (int k = 0; k < v.size(); ++k)
      at(lane, first() + coordinates() + 2 * k) = static_cast<Real>(v[k]);
  }
  TreeTwin::Numbers position(int lane) const { return numbers(lane, first(), coordinates()); }
  TreeTwin::Numbers velocity(int lane) const { return every_other(lane, first() + coordinates()); }
  const PlanTrees& trees() const { return trees_; }
  // Of the last step, before dampers.
  TreeTwin::Numbers acceleration(int lane) const {
    return every_other(lane, first() + coordinates() + 1);
  }
  // A field of a body, as the state has it.
  TreeTwin::Numbers body(int lane, int body, int row, int rows) const {
    return numbers(lane, body * kBodyRows + row, rows);
  }
  std::uint32_t status(int lane) const { return status_[static_cast<std::size_t>(lane)]; }

  void step(int steps) {
    const auto view = group();
    kernels_.tree.steps(constants_, view, made_, steps);
  }
  void place() {
    const auto view = group();
    kernels_.tree.place(constants_, view, made_);
  }

 private:
  static constexpr int kBodyRows = 13;
  static PlanData plan_of(const PlanTrees& trees) {
    PlanData out;
    out.trees = trees;
    return out;
  }
  std::size_t count(int rows) const { return static_cast<std::size_t>(rows * lanes_); }
  int first() const { return bodies_ * kBodyRows; }
  int coordinates() const { return trees_.coordinates; }
  int dofs() const { return static_cast<int>(trees_.dofs.size()); }
  Real& at(int lane, int row) { return state_[static_cast<std::size_t>(row * lanes_ + lane)]; }
  TreeTwin::Numbers numbers(int lane, int row, int rows) const {
    TreeTwin::Numbers out(rows);
    for (int i = 0; i < rows; ++i) {
      out[i] = static_cast<double>(state_[static_cast<std::size_t>((row + i) * lanes_ + lane)]);
    }
    return out;
  }
  TreeTwin::Numbers every_other(int lane, int row) const {
    const TreeTwin::Numbers all = numbers(lane, row, 2 * dofs() - 1);
    return all(Eigen::seqN(0, dofs(), 2));
  }
  kernels::GroupView<Real> group() {
    kernels::GroupView<Real> view{};
    view.state = state_.data(), view.status = status_.data(), view.force = force_.data();
    view.constants = constants_.constants;
    return view;
  }
  void put_constants(const TwinLink& link, const Vec3& gravity) {
    kernels::BodyConstants<Real> c{};
    c.mass = static_cast<Real>(link.frame.mass),
    c.inv_mass = static_cast<Real>(1 / link.frame.mass);
    for (int i = 0; i < 3; ++i) {
      c.inertia[i] = static_cast<Real>(link.frame.moments[i]);
      c.gravity[i] = static_cast<Real>(gravity[i]);
    }
    constexpr std::size_t kMembers = sizeof c / sizeof(Real);
    Real members[kMembers];
    std::memcpy(members, &c, sizeof c);
    const auto body = static_cast<std::size_t>(link.frame.body),
               lanes = static_cast<std::size_t>(lanes_);
    for (std::size_t m = 0; m < kMembers; ++m) {
      std::fill_n(body_constants_.data() + (body * kMembers + m) * lanes, lanes, members[m]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      std::fill_n(force_.data() + (body * 6 + i) * lanes, lanes,
                  static_cast<Real>(link.force[row]));
      std::fill_n(force_.data() + (body * 6 + 3 + i) * lanes, lanes,
                  static_cast<Real>(link.torque[row]));
    }
  }

  const kernels::Kernels<Real>& kernels_;
  int lanes_, bodies_;
  PlanTrees trees_;
  TreeTables<Real> tables_;
  int rows_;
  AlignedBuffer<Real> state_;
  Constants<Real> numbers_;
  AlignedBuffer<Real> body_constants_, force_;
  AlignedBuffer<std::uint32_t> status_;
  std::vector<kernels::BodyTable> bodies_table_;
  kernels::SceneConstants<Real> constants_{};
  AlignedBuffer<unsigned char> scratch_;
  kernels::Scratch* made_ = nullptr;
};

}  // namespace manyworlds::test
