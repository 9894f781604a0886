// Batch: controls.
#include "src/api/batch_data.hpp"

namespace manyworlds {

namespace {

// Calls visit(kind, world in kind, where its controls begin in the canonical array).
template <class Impl, class Visit>
void visit_controls(const Impl& impl, std::size_t numbers, Visit visit) {
  std::size_t total = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) {
    total +=
        impl.kinds[k].plan.scene().controls.size() * static_cast<std::size_t>(impl.kinds[k].worlds);
  }
  if (numbers != total) {
    reject("controls are " + std::to_string(total) + " numbers, the buffer has " +
           std::to_string(numbers));
  }
  std::size_t at = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) {
    for (int w = 0; w < impl.kinds[k].worlds; ++w) {
      visit(static_cast<int>(k), w, at);
      at += impl.kinds[k].plan.scene().controls.size();
    }
  }
}

}  // namespace

int Batch::controls(int world) const {
  return static_cast<int>(plan(kind_of(world)).scene().controls.size());
}

template <class Number>
void Batch::Impl::set_controls(const Batch& batch, std::span<const Number> in) {
  visit_controls(*this, in.size(), [&](int kind, int world, std::size_t at) {
    core->set_controls(kind, world, in.data() + at);
  });
  if (listeners.empty()) return;
  visit_controls(*this, in.size(), [&](int kind, int world, std::size_t at) {
    const auto n = static_cast<std::ptrdiff_t>(plan(kind).scene().controls.size());
    const auto begin = in.begin() + static_cast<std::ptrdiff_t>(at);
    const std::vector<double> values(begin, begin + n);
    tell_controls(batch, first_world[static_cast<std::size_t>(kind)] + world, values);
  });
}
void Batch::set_controls(std::span<const float> in) { impl_->set_controls(*this, in); }
void Batch::set_controls(std::span<const double> in) { impl_->set_controls(*this, in); }

void Batch::set_controls(int world, std::span<const double> in) {
  const auto p = impl_->find(world);
  const std::size_t wanted = impl_->plan(p.kind).scene().controls.size();
  if (in.size() != wanted) {
    reject("controls of a world are " + std::to_string(wanted) + " numbers, the buffer has " +
           std::to_string(in.size()));
  }
  impl_->core->set_controls(p.kind, p.world, in.data());
  impl_->tell_controls(*this, world, in);
}

void Batch::read_controls(std::span<float> out) const {
  visit_controls(*impl_, out.size(), [&](int kind, int world, std::size_t at) {
    impl_->core->read_controls(kind, world, out.data() + at);
  });
}
void Batch::read_controls(std::span<double> out) const {
  visit_controls(*impl_, out.size(), [&](int kind, int world, std::size_t at) {
    impl_->core->read_controls(kind, world, out.data() + at);
  });
}

}  // namespace manyworlds
