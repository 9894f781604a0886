// The impulses of all rows of a group: forgetting them, and nonsmooth nonlinear conjugate gradients
// between the sweeps of a solver (Silcowitz-Hansen, Niebe, Erleben 2010). With z the impulses and
// d what a sweep has changed, per lane
//   beta = |d|^2 / |d of the sweep before|^2, or 0 if that is more than 1 (or not a number)
//   z += beta way,  way = beta way + d
// The velocities follow by a warm start with beta way. Moments of resistance stay with the sweeps.
#include "kernels/joint/body.hpp"
#include "kernels/lane/finite.hpp"
#include "kernels/rows/resistance.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Calls visit(impulses, lanes) for each in the order of the solver; inside a lane the layout cannot
// be told from it.
template <class S, class Visit>
MW_INLINE void for_each_impulse(const Constants& t, Work& w, Visit visit) {
  if constexpr (S::kKind != kernels::InertiaKind::isotropic) {  // joints take full tensors
    for (int i = 0; i < t.parts; ++i) {
      unsigned char* at = w.parts + static_cast<std::size_t>(i) * part_bytes(S{});
      auto& part = *reinterpret_cast<PartBodies<S>*>(at);
      for (auto& impulse : part.impulse) visit(impulse, part.mask);
    }
  }
  for_each_block<S>(w, [&](auto& s, int, BlockList&) {
    for (auto& impulse : s.impulse) visit(impulse, s.mask);
    if (!t.has_friction) return;
    for (auto& impulse : s.tangent_impulse) visit(impulse, s.mask);
    if constexpr (std::remove_reference_t<decltype(s)>::kTwist) visit(s.twist_impulse, s.mask);
  });
}

template <class S>
void forget(const Constants& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const Float zero(Real(0));
  for_each_impulse<S>(t, w, [&](Real* z, std::uint32_t) { zero.store(z); });
  if (!t.has_resistance) return;
  for_each_block<S>(w, [&](auto&, int i, BlockList& list) {
    for (auto& z : resistance_at<S>(list, i).impulse) zero.store(z);
  });
}

template <class S>
void begin_search(const Constants& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const Float zero(Real(0));
  zero.store(w.search.square);
  Real* way = w.search.way;
  for_each_impulse<S>(t, w, [&](Real*, std::uint32_t) {
    zero.store(way);
    way += kLanes;
  });
}

template <class S>
void remember(const Constants& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  Real* before = w.search.before;
  for_each_impulse<S>(t, w, [&](Real* z, std::uint32_t) {
    Float::load(z).store(before);
    before += kLanes;
  });
}

template <class S>
void redirect(const Constants& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const Float zero(Real(0)), one(Real(1));
  Real *before = w.search.before, *way = w.search.way;
  Float square = zero;
  for_each_impulse<S>(t, w, [&](Real* z, std::uint32_t lanes) {
    const Float step = select(mask_from_bits(lanes), Float::load(z) - Float::load(before), zero);
    square = fma(step, step, square);
    before += kLanes;
  });
  const Float last = Float::load(w.search.square);
  const Mask shrinks = (zero < last) & (square <= last) & is_finite(last);
  const Float beta = select(shrinks, square / select(zero < last, last, one), zero);
  square.store(w.search.square);
  before = w.search.before;
  for_each_impulse<S>(t, w, [&](Real* z, std::uint32_t lanes) {
    const Float now = Float::load(z);
    const Float step = select(mask_from_bits(lanes), now - Float::load(before), zero);
    const Float more = beta * Float::load(way);
    more.store(z);
    now.store(before);
    (more + step).store(way);
    before += kLanes, way += kLanes;
  });
}

template <class S>
void land(const Constants& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const Real* before = w.search.before;
  for_each_impulse<S>(t, w, [&](Real* z, std::uint32_t) {
    (Float::load(before) + Float::load(z)).store(z);
    before += kLanes;
  });
}

template <class S>
kernels::ImpulseTable<Real> table_of() {
  return {forget<S>, begin_search<S>, remember<S>, redirect<S>, land<S>};
}

}  // namespace

void fill_impulses(kernels::ImpulseTable<Real>* tables) {
  tables[static_cast<int>(Planar::kKind)] = table_of<Planar>();
  tables[static_cast<int>(Isotropic::kKind)] = table_of<Isotropic>();
  tables[static_cast<int>(Tensor::kKind)] = table_of<Tensor>();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
