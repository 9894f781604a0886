// The kernel table of this instruction set and precision.
#include "kernels/data/table.hpp"

#include "kernels/motion/free_motion.hpp"
#include "kernels/motion/free_step.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/rows/touched.hpp"
#include "kernels/sleep/sleep.hpp"
#include "kernels/work/solver_tables.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

template <class S>
void free_motion(const Constants& t, const Group& g, kernels::Scratch* scratch, int steps) {
  free_motion_steps<S>(t, g, work_of(scratch), steps);
}

void gather_met(const Constants& t, const Group&, kernels::Scratch* scratch) {
  gather_met(t, work_of(scratch));
}

void set_class(kernels::Scratch* scratch, int class_index) {
  work_of(scratch).class_index = class_index;
}

const kernels::GroupCounters& counters(kernels::Scratch* scratch) {
  return work_of(scratch).counters;
}

int record(kernels::Scratch* scratch, int lane, kernels::ContactPoint<Real>* out, int max) {
  Work& w = work_of(scratch);
  const int count = w.recorder ? w.recorder->count : 0;
  w.recorder_storage = {out, max, lane, 0, nullptr};
  w.recorder = out ? &w.recorder_storage : nullptr;
  return count;
}

constexpr const char* isa_name() {
#if defined(MW_ISA_AVX512)
  return "avx512";
#elif defined(MW_ISA_AVX2)
  return "avx2";
#else
  return "scalar";
#endif
}

kernels::Kernels<Real> make_table() {
  using kernels::InertiaKind;
  kernels::Kernels<Real> out{};
  out.isa = isa_name();
  out.lanes = kLanes;
  out.scratch_bytes = scratch_bytes;
  out.make_scratch = make_scratch;
  out.begin = begin;
  out.broad_phase = broad_phase;
  out.choose_layout = choose_layout;
  out.gather_met = gather_met;
  fill_collide_planar(out.collide[static_cast<int>(kernels::Dimension::planar)]);
  fill_collide_spatial(out.collide[static_cast<int>(kernels::Dimension::spatial)]);
  auto& planar = out.solver[static_cast<int>(InertiaKind::planar)];
  auto& isotropic = out.solver[static_cast<int>(InertiaKind::isotropic)];
  auto& tensor = out.solver[static_cast<int>(InertiaKind::tensor)];
  fill_solver_planar_dense(planar[0]);
  fill_solver_planar_rows(planar[1]);
  fill_solver_isotropic_dense(isotropic[0]);
  fill_solver_isotropic_rows(isotropic[1]);
  fill_solver_tensor_dense(tensor[0]);
  fill_solver_tensor_rows(tensor[1]);
  auto& flat = out.joints[static_cast<int>(InertiaKind::planar)];
  auto& spatial = out.joints[static_cast<int>(InertiaKind::tensor)];
  fill_joints_planar(flat[0], flat[1]);
  fill_joints_tensor(spatial[0], spatial[1]);
  auto& flat_trees = out.direct[static_cast<int>(InertiaKind::planar)];
  auto& trees = out.direct[static_cast<int>(InertiaKind::tensor)];
  fill_direct_planar(flat_trees[0], flat_trees[1]);
  fill_direct_tensor(trees[0], trees[1]);
  out.free_motion[static_cast<int>(InertiaKind::planar)] = free_motion<Planar>;
  out.free_motion[static_cast<int>(InertiaKind::isotropic)] = free_motion<Isotropic>;
  out.free_motion[static_cast<int>(InertiaKind::tensor)] = free_motion<Tensor>;
  out.free_step[static_cast<int>(InertiaKind::planar)] = free_step<Planar>;
  out.free_step[static_cast<int>(InertiaKind::isotropic)] = free_step<Isotropic>;
  out.free_step[static_cast<int>(InertiaKind::tensor)] = free_step<Tensor>;
  const auto sweeps = [&](InertiaKind kind, FillSweeps* fill) {
    auto& of = out.sweeps[static_cast<int>(kind)];
    fill(of[0], of[1]);
  };
  sweeps(InertiaKind::planar, fill_sweeps_planar);
  sweeps(InertiaKind::isotropic, fill_sweeps_isotropic);
  sweeps(InertiaKind::tensor, fill_sweeps_tensor);
  fill_impulses(out.impulses);
  fill_flight_planar(out.flight);
  fill_flight_spatial(out.flight);
  fill_tree(out.tree);
  fill_audits(out.audit);
  out.settle = settle;
  out.set_class = set_class;
  out.counters = counters;
  out.record = record;
  out.observer = observer_table();
  return out;
}

}  // namespace

void fill_kernel_table(kernels::Kernels<Real>& out) { out = make_table(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
