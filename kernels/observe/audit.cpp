// The audit's table of this instruction set and precision.
#include "kernels/observe/audit.hpp"

#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_audits(kernels::EnergyAudit<Real>* tables) {
  const auto fill = [&]<class S>(S) {
    tables[static_cast<int>(S::kKind)] = {steps_ahead, count_steps, clear_gaps, begin_audit<S>,
                                          end_audit<S>};
  };
  fill(Planar{}), fill(Isotropic{}), fill(Tensor{});
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
