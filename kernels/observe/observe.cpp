// The observers' table of this instruction set and precision.
#include "kernels/observe/observe.hpp"

#include "kernels/observe/acceleration.hpp"
#include "kernels/observe/body_forces.hpp"
#include "kernels/observe/contacts.hpp"
#include "kernels/observe/joints.hpp"
#include "kernels/observe/motion.hpp"
#include "kernels/observe/points.hpp"
#include "kernels/observe/residual.hpp"
#include "kernels/observe/tree_contacts.hpp"
#include "kernels/observe/tree_joints.hpp"

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
  look(out, Observer::sites)[kind] = observe_sites<S>;
  look(out, Observer::links)[kind] = observe_bodies<S>;
  begin(out, Observer::link_forces)[kind] = begin_forces;
  look(out, Observer::link_forces)[kind] = add_inputs;
  look(out, Observer::acceleration)[kind] = observe_acceleration<S>;
  begin(out, Observer::acceleration)[kind] = begin_acceleration<S>;
}

// Plans with joints have full tensors, and so have trees.
void look_at_joints(const Constants& t, const Group& g, kernels::Scratch* scratch,
                    const ObserverView& o) {
  if (t.tree.links > 0) return observe_tree_joints(t, g, o);
  observe_joints<Tensor>(t, g, scratch, o);
}
// What joints of trees carry is known in the middle of a step alone; without one it is 0.
void begin_loads(const Constants& t, const Group&, kernels::Scratch*, const ObserverView& o) {
  if (t.tree.links == 0) return;
  Real* rows = rows_for(o, Observer::joint_loads);
  const int count = items_of(o, Observer::joint_loads) * rows_of(Observer::joint_loads);
  for (int i = 0; i < count; ++i) Float(Real(0)).store(rows + i * kLanes);
}
void look_at_loads(const Constants& t, const Group& g, kernels::Scratch* scratch,
                   const ObserverView& o) {
  if (t.tree.links == 0) observe_loads<Tensor>(t, g, scratch, o);
}
void look_at_drives(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  if (t.tree.links == 0) observe_drives(t, g, o);
}
void fill_joints(kernels::ObserverTable<Real>& out) {
  const int planar = static_cast<int>(Planar::kKind), tensor = static_cast<int>(Tensor::kKind);
  look(out, Observer::joints)[planar] = observe_joints<Planar>;
  look(out, Observer::joints)[tensor] = look_at_joints;
  look(out, Observer::joint_loads)[planar] = observe_loads<Planar>;
  look(out, Observer::joint_loads)[tensor] = look_at_loads;
  begin(out, Observer::joint_loads)[tensor] = begin_loads;
  look(out, Observer::drives)[planar] = look_at_drives;
  look(out, Observer::drives)[tensor] = look_at_drives;
}

kernels::ObserverTable<Real> make_table() {
  kernels::ObserverTable<Real> out{};
  out.place_reals = place_reals;
  out.total_reals = total_reals;
  out.watch = watch;
  out.clear = clear;
  out.saved_bytes = saved_bytes;
  out.save_rows = save_rows;
  fill<Planar>(out);
  fill<Isotropic>(out);
  fill<Tensor>(out);
  fill_joints(out);
  out.of_trees = observe_tree_contacts;
  out.keep_tree_state = keep_tree_state;
  out.loads_of_trees = observe_tree_loads;
  out.links_of_trees = observe_tree_links;
  out.look_at_links = look_at_tree_links;
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
