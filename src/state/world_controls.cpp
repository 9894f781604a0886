// Controls of worlds.
#include <algorithm>
#include <cmath>

#include "src/state/worlds.hpp"

namespace manyworlds {

template <class Real>
template <class In>
void Worlds<Real>::set_controls_as(int first, int count, const In* in) {
  const auto& ranges = data().control_range;
  const auto lanes = static_cast<std::size_t>(storage_.lanes());
  for (int world = first; !ranges.empty() && world < first + count; ++world) {
    const int lane_index = lane_index_of(world);
    Real* control = storage_.controls(lane_index);
    bool changed = false;
    for (std::size_t i = 0; i < ranges.size(); ++i, ++in) {
      if (std::isnan(*in)) {
        storage_.status(lane_index) |= kernels::kNonFinite;
        continue;
      }
      const auto [low, high] =
          own_ranges_.empty() ? ranges[i]
                              : own_ranges_[static_cast<std::size_t>(world) * ranges.size() + i];
      const Real value =
          std::clamp(static_cast<Real>(*in), static_cast<Real>(low), static_cast<Real>(high));
      Real& stored = control[i * lanes];
      changed = changed || stored != value;
      stored = value;
    }
    if (changed) storage_.wake(lane_index);
  }
}

template <class Real>
template <class Out>
void Worlds<Real>::read_controls_as(int first, int count, Out* out) const {
  for (int world = first; tables().controls > 0 && world < first + count; ++world) {
    const Real* control = storage_.controls(lane_index_of(world));
    for (int i = 0; i < tables().controls; ++i, control += storage_.lanes()) {
      *out++ = static_cast<Out>(*control);
    }
  }
}

#define MW_INSTANTIATE(Real)                                                    \
  template void Worlds<Real>::set_controls_as<float>(int, int, const float*);   \
  template void Worlds<Real>::set_controls_as<double>(int, int, const double*); \
  template void Worlds<Real>::read_controls_as<float>(int, int, float*) const;  \
  template void Worlds<Real>::read_controls_as<double>(int, int, double*) const;
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
