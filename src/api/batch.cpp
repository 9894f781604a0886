// The public Batch: how it is made, and its shape. Its other files check arguments, find the kind
// of a world, and hand over to its core.
#include "manyworlds/batch.hpp"

#include <new>

#include "src/api/batch_data.hpp"
#include "src/api/memory.hpp"
#include "src/base/machine_memory.hpp"

namespace manyworlds {

void Batch::Impl::make_core_within_memory() {
  const Isa isa = checked_isa(options);
  const int threads = executor->threads();
  const auto needed = [&] { return memory_of(kinds, options, isa, threads); };
  if (may_be_large(kinds, options, threads)) {
    const double bytes = needed(), present = machine_memory();
    if (bytes > present) {
      reject(memory_text(kinds, bytes) + ", the machine has " + gigabytes(present));
    }
  }
  try {
    core = make_core(kinds, options, isa, threads);
  } catch (const std::bad_alloc&) {
    reject(memory_text(kinds, needed()) + ", which could not be allocated");
  }
}

Batch::Batch(Plan plan, const BatchOptions& options)
    : Batch(std::vector<Kind>{{std::move(plan), options.worlds}}, options) {}
Batch::Batch(std::vector<Kind> kinds, const BatchOptions& options)
    : impl_(Pimpl<Impl>::make(std::move(kinds), options)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;

int Batch::worlds() const { return impl_->first_world.back(); }
int Batch::kinds() const { return static_cast<int>(impl_->kinds.size()); }
const Plan& Batch::plan(int kind) const {
  impl_->check_kind(kind);
  return impl_->plan(kind);
}
int Batch::kind_of(int world) const { return impl_->find(world).kind; }
int Batch::bodies(int world) const { return impl_->plan(kind_of(world)).bodies(); }
int Batch::threads() const { return impl_->executor->threads(); }
Isa Batch::isa() const { return impl_->core->isa(); }
Precision Batch::precision() const { return impl_->options.precision; }
std::uint64_t Batch::seed() const { return impl_->options.seed; }
std::uint64_t Batch::seed_of(int world) const {
  const auto p = impl_->find(world);
  return impl_->worlds(p.kind).seed(p.world);
}
int Batch::lanes() const { return impl_->core->lanes(); }
std::string Batch::kernel_table() const {
  return std::string(to_string(isa())) + " " + to_string(precision()) + " x" +
         std::to_string(lanes());
}
std::size_t Batch::bytes_per_world() const {
  std::size_t total = 0;
  for (int k = 0; k < kinds(); ++k) total += impl_->worlds(k).bytes();
  return total / static_cast<std::size_t>(worlds());
}
std::size_t Batch::scratch_bytes() const { return impl_->core->scratch_bytes(); }

}  // namespace manyworlds
