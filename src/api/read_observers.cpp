// What was seen of a world, in the order and the ids of the scene.
#include <stdexcept>

#include "src/api/batch_data.hpp"
#include "src/api/observer_results.hpp"

namespace manyworlds {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

[[noreturn]] void not_observed(Observed what) {
  const ObserverInfo& by = info(info(what).observer);
  const char* const where = is_given(by.item) ? "" : "Observer::";
  reject(std::string(to_string(what)) + " is not observed: give " + where + by.name +
         " in BatchOptions::observe");
}

}  // namespace

template <class Real>
template <class Out>
void ObserverResultsOf<Real>::read_worlds(Observed what, int k, int first, int count,
                                          Out* out) const {
  const ObservedInfo& about = info(what);
  const int observer = static_cast<int>(about.observer);
  if (!has(about.observer)) not_observed(what);
  const PlanData& plan = worlds_[at(k)]->data();
  const Space space = plan.scene.space;
  const std::size_t items = items_of(info(about.observer).item, plan, observers_);
  if (items == 0) return;
  const std::size_t rows = at(kernels::kObserverRows.of_item[observer]);
  const std::size_t numbers = at(components(what, space));
  const bool last = space == Space::planar && about.components == ObservedComponents::spin;
  const Real* from = kinds_[at(k)].rows[at(observer)].data() + at(first) * items * rows +
                     at(kernels::kObserverRows.first[static_cast<int>(what)] + (last ? 2 : 0));
  for (std::size_t i = 0; i < at(count) * items; ++i, from += rows) {
    for (std::size_t c = 0; c < numbers; ++c) *out++ = static_cast<Out>(from[c]);
  }
}
template <class Real>
void ObserverResultsOf<Real>::read(Observed what, int k, int first, int count, float* out) const {
  read_worlds(what, k, first, count, out);
}
template <class Real>
void ObserverResultsOf<Real>::read(Observed what, int k, int first, int count, double* out) const {
  read_worlds(what, k, first, count, out);
}

template <class Real>
std::vector<StepContact> ObserverResultsOf<Real>::contacts(int k, int world) const {
  if (!has(Observer::contacts)) not_observed(Observed::contact_count);
  const Kind& kind = kinds_[at(k)];
  const std::size_t w = at(world);
  std::vector<StepContact> out(at(contacts_kept(kind, w)));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& from = kind.contacts[w * at(kind.room) + i];
    StepContact& to = out[i];
    const PairIds ids = ids_of(worlds_[at(k)]->data(), worlds_[at(k)]->tables(), from.key);
    to.body_a = ids.a.body(), to.shape_a = ids.a;
    to.body_b = ids.b.body(), to.shape_b = ids.b;
    for (int c = 0; c < 3; ++c) {
      to.normal[c] = static_cast<double>(from.normal[c]);
      to.point[c] = static_cast<double>(from.point[c]);
      to.friction_impulse[c] = static_cast<double>(from.friction[c]);
    }
    to.separation = static_cast<double>(from.separation);
    to.feature = from.feature;
    to.normal_impulse = static_cast<double>(from.impulse);
    to.twist_impulse = static_cast<double>(from.twist);
  }
  return out;
}

#define MW_INSTANTIATE(Real)                                                           \
  template void ObserverResultsOf<Real>::read(Observed, int, int, int, float*) const;  \
  template void ObserverResultsOf<Real>::read(Observed, int, int, int, double*) const; \
  template std::vector<StepContact> ObserverResultsOf<Real>::contacts(int, int) const;
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
