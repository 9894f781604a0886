#include "src/api/batch_core.hpp"

namespace manyworlds {

std::unique_ptr<BatchCore> make_core(const std::vector<Batch::Kind>& kinds,
                                     const BatchOptions& options, Isa isa, int threads) {
  if (options.precision == Precision::f32) {
    return std::make_unique<CoreOf<float>>(kinds, options, isa, threads);
  }
  return std::make_unique<CoreOf<double>>(kinds, options, isa, threads);
}

}  // namespace manyworlds
