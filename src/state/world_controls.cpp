// Controls of a world.
#include <algorithm>
#include <cmath>

#include "src/state/worlds.hpp"

namespace manyworlds {

template <class Real>
template <class In>
void Worlds<Real>::set_controls(int world, const In* in) {
  const std::vector<Control>& controls = plan_.scene().controls;
  const int slot = slot_of(world);
  bool changed = false;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const Real low = static_cast<Real>(controls[i].low), high = static_cast<Real>(controls[i].high);
    if (std::isnan(in[i])) {
      storage_.status(slot) |= kernels::kNonFinite;
      continue;
    }
    const Real value = std::clamp(static_cast<Real>(in[i]), low, high);
    Real& stored = storage_.control(slot, static_cast<int>(i));
    changed = changed || !(stored == value);
    stored = value;
  }
  if (changed) storage_.wake(slot);
}

template <class Real>
template <class Out>
void Worlds<Real>::read_controls(int world, Out* out) const {
  for (int i = 0; i < tables().controls; ++i) {
    out[i] = static_cast<Out>(storage_.control(slot_of(world), i));
  }
}

#define MW_INSTANTIATE(Real)                                            \
  template void Worlds<Real>::set_controls<float>(int, const float*);   \
  template void Worlds<Real>::set_controls<double>(int, const double*); \
  template void Worlds<Real>::read_controls<float>(int, float*) const;  \
  template void Worlds<Real>::read_controls<double>(int, double*) const;
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
