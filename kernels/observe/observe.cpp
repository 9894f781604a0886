// The observers' table of this instruction set and precision.
#include "kernels/observe/observe.hpp"

#include "kernels/observe/acceleration.hpp"
#include "kernels/observe/contacts.hpp"
#include "kernels/observe/joints.hpp"
#include "kernels/observe/motion.hpp"
#include "kernels/observe/points.hpp"
#include "kernels/observe/residual.hpp"
#include "kernels/observe/tree_contacts.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Blocks of a list times reals of a block: `several` for those of several points, `one` for the
// others.
std::size_t reals(kernels::Scratch* scratch, int list, int several, int one) {
  const int rows = is_multi(static_cast<ListId>(list)) ? several : one;
  return static_cast<std::size_t>(work_of(scratch).blocks[list].max_blocks) *
         static_cast<std::size_t>(rows * kLanes);
}
std::size_t place_reals(const Constants& t, kernels::Scratch* scratch, int list) {
  return t.dimension == kernels::Dimension::planar
             ? reals(scratch, list, kPlaces<Planar, 2>, kPlaces<Planar, 1>)
             : reals(scratch, list, kPlaces<Tensor, 4>, kPlaces<Tensor, 1>);
}
std::size_t total_reals(const Constants& t, kernels::Scratch* scratch, int list) {
  return t.dimension == kernels::Dimension::planar
             ? reals(scratch, list, kTotals<Planar, 2>, kTotals<Planar, 1>)
             : reals(scratch, list, kTotals<Tensor, 4>, kTotals<Tensor, 1>);
}

void watch(kernels::Scratch* scratch, Real* const* places) {
  Work& w = work_of(scratch);
  w.recorder_storage = {nullptr, 0, 0, 0, places};
  w.recorder = places ? &w.recorder_storage : nullptr;
}

void clear(const Constants&, const Group&, kernels::Scratch*, const ObserverView& o) {
  for (int k = 0; k < kObserverCount; ++k) {
    if (!o.rows[k] || kObserverInfo[k].of != ObservedOf::step) continue;
    const int rows = o.items[k] * kernels::kObserverRows.of_item[k];
    for (int i = 0; i < rows; ++i) Float(Real(0)).store(o.rows[k] + i * kLanes);
  }
}

kernels::Observe<Real>* look(kernels::ObserverTable<Real>& out, Observer observer) {
  return out.look[static_cast<int>(observer)];
}
kernels::Observe<Real>* begin(kernels::ObserverTable<Real>& out, Observer observer) {
  return out.begin[static_cast<int>(observer)];
}

template <class S>
void fill(kernels::ObserverTable<Real>& out) {
  const int kind = static_cast<int>(S::kKind);
  out.accumulate[kind] = accumulate_totals<S>;
  out.awake[kind] = observe_contacts<S, false>;
  out.asleep[kind] = observe_contacts<S, true>;
  out.compare[kind] = compare<S>;
  look(out, Observer::motion)[kind] = observe_motion<S>;
  look(out, Observer::rays)[kind] = observe_rays;
  look(out, Observer::points)[kind] = observe_points<S>;
  look(out, Observer::acceleration)[kind] = observe_acceleration<S>;
  begin(out, Observer::acceleration)[kind] = begin_acceleration<S>;
}

// Plans with joints have full tensors.
template <class S>
void fill_joints(kernels::ObserverTable<Real>& out) {
  const int kind = static_cast<int>(S::kKind);
  look(out, Observer::joints)[kind] = observe_joints<S>;
  look(out, Observer::joint_loads)[kind] = observe_loads<S>;
}

kernels::ObserverTable<Real> make_table() {
  kernels::ObserverTable<Real> out{};
  out.place_reals = place_reals;
  out.total_reals = total_reals;
  out.watch = watch;
  out.clear = clear;
  out.aside_bytes = aside_bytes;
  out.set_aside = set_aside;
  fill<Planar>(out);
  fill<Isotropic>(out);
  fill<Tensor>(out);
  fill_joints<Planar>(out);
  fill_joints<Tensor>(out);
  out.of_trees = observe_tree_contacts;
  out.run_program = run_program;
  out.cast = cast_one;
  return out;
}

}  // namespace

const kernels::ObserverTable<Real>* observer_table() {
  static const kernels::ObserverTable<Real> kTable = make_table();
  return &kTable;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
