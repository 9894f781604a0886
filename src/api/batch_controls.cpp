// Batch: controls.
#include "src/api/batch_data.hpp"

namespace manyworlds {

namespace {

// Calls visit(kind, where its worlds' controls begin in the canonical array, numbers of a world).
template <class Impl, class Visit>
void visit_controls(const Impl& impl, std::size_t numbers, Visit visit) {
  const auto of_world = [&](std::size_t k) { return impl.kinds[k].plan.scene().controls.size(); };
  const auto of_kind = [&](std::size_t k) {
    return of_world(k) * static_cast<std::size_t>(impl.kinds[k].worlds);
  };
  std::size_t total = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) total += of_kind(k);
  if (numbers != total) {
    reject("controls are " + std::to_string(total) + " numbers, the buffer has " +
           std::to_string(numbers));
  }
  std::size_t at = 0;
  for (std::size_t k = 0; k < impl.kinds.size(); ++k) {
    visit(static_cast<int>(k), at, of_world(k));
    at += of_kind(k);
  }
}

}  // namespace

int Batch::controls(int world) const {
  return static_cast<int>(plan(kind_of(world)).scene().controls.size());
}

template <class Number>
void Batch::Impl::set_controls(const Batch& batch, std::span<const Number> in) {
  const auto worlds_of = [&](int kind) { return kinds[static_cast<std::size_t>(kind)].worlds; };
  visit_controls(*this, in.size(), [&](int kind, std::size_t at, std::size_t) {
    core->set_controls(kind, 0, worlds_of(kind), in.data() + at);
  });
  if (listeners.empty()) return;
  visit_controls(*this, in.size(), [&](int kind, std::size_t at, std::size_t of_world) {
    for (int w = 0; w < worlds_of(kind); ++w) {
      const auto own = in.subspan(at + static_cast<std::size_t>(w) * of_world, of_world);
      tell_controls(batch, first_world[static_cast<std::size_t>(kind)] + w,
                    std::vector<double>(own.begin(), own.end()));
    }
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
  impl_->core->set_controls(p.kind, p.world, 1, in.data());
  impl_->tell_controls(*this, world, in);
}

template <class Number>
void Batch::Impl::read_controls(std::span<Number> out) const {
  visit_controls(*this, out.size(), [&](int kind, std::size_t at, std::size_t) {
    core->read_controls(kind, 0, kinds[static_cast<std::size_t>(kind)].worlds, out.data() + at);
  });
}
void Batch::read_controls(std::span<float> out) const { impl_->read_controls(out); }
void Batch::read_controls(std::span<double> out) const { impl_->read_controls(out); }

}  // namespace manyworlds
