#include "tools/base/random_controls.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "src/base/random.hpp"

namespace manyworlds::tools {

RandomControls::RandomControls(const Batch& batch, std::uint64_t seed)
    : seed_(seed),
      values_(static_cast<std::size_t>(batch.worlds()) * batch.plan().scene().controls.size()),
      mask_(static_cast<std::size_t>(batch.worlds())) {
  for (const Control& control : batch.plan().scene().controls) {
    ranges_.push_back({std::isfinite(control.low) ? control.low : -1,
                       std::isfinite(control.high) ? control.high : 1});
  }
}

bool RandomControls::suit(const Plan& plan) {
  return plan.scene().options.solver.method == Solver::newton && !plan.scene().controls.empty();
}

int RandomControls::steps_until_next(std::int64_t step) const {
  return ranges_.empty() ? std::numeric_limits<int>::max()
                         : kPeriod - static_cast<int>(step % kPeriod);
}

void RandomControls::apply(Batch& batch, std::int64_t step) {
  if (ranges_.empty() || step % kPeriod != 0) return;
  bool any = false;
  std::size_t value = 0;
  for (std::size_t w = 0; w < mask_.size(); ++w) {
    const Draws draws(seed_ + w, static_cast<std::uint64_t>(step / kPeriod));
    for (const Range& range : ranges_) {
      const double share = draws.uniform(value % ranges_.size());
      values_[value++] = range.low + share * (range.high - range.low);
    }
    constexpr int kPhases = kEpisode / kPeriod;
    const auto phase = static_cast<int>(kPhases * Draws(seed_ + w, 0).uniform(ranges_.size()));
    const bool due = step > 0 && (step / kPeriod + phase) % kPhases == 0;
    mask_[w] = due && !lost(batch.status(static_cast<int>(w)));
    any = any || mask_[w] != 0;
  }
  if (any) keyframe_ ? batch.reset(mask_, keyframe_) : batch.reset(mask_);
  batch.set_controls(values_);
}

}  // namespace manyworlds::tools
