#include "src/dispatch/kernels.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <stdexcept>
#include <string>

namespace manyworlds {

#define MW_DECLARE(name, Real)                         \
  namespace name {                                     \
  void fill_kernel_table(kernels::Kernels<Real>& out); \
  }
MW_DECLARE(scalar_f32, float)
MW_DECLARE(scalar_f64, double)
MW_DECLARE(avx2_f32, float)
MW_DECLARE(avx2_f64, double)
MW_DECLARE(avx512_f32, float)
#undef MW_DECLARE

namespace {

constexpr Isa kIsas[] = {Isa::scalar, Isa::avx2, Isa::avx512};

// What this build has kernels for, as in "avx2 f32, avx2 f64", and how to get the others.
constexpr const char* kBuilt =
    MW_KERNELS_BUILT " (tools/run --all in the repository builds all; MW_KERNELS, MW_ISAS)";

bool cpu_has(Isa isa) {
  switch (isa) {
    case Isa::scalar: return true;
    case Isa::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
             __builtin_cpu_supports("bmi2");
    case Isa::avx512:
      return cpu_has(Isa::avx2) && __builtin_cpu_supports("avx512f") &&
             __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512bw");
  }
  return false;
}

template <class Real>
const kernels::Kernels<Real>* filled(void (*fill)(kernels::Kernels<Real>&), Isa isa) {
  if (!cpu_has(isa)) return nullptr;
  auto* table = new kernels::Kernels<Real>{};  // lives as long as the program
  fill(*table);
  return table;
}

}  // namespace

template <>
const kernels::Kernels<float>* find_kernels<float>(Isa isa) {
  switch (isa) {
    case Isa::scalar: {
#if defined(MW_HAVE_SCALAR_F32)
      static const auto* const kTable = filled(scalar_f32::fill_kernel_table, isa);
      return kTable;
#else
      return nullptr;
#endif
    }
    case Isa::avx2: {
#if defined(MW_HAVE_AVX2_F32)
      static const auto* const kTable = filled(avx2_f32::fill_kernel_table, isa);
      return kTable;
#else
      return nullptr;
#endif
    }
    case Isa::avx512: {
#if defined(MW_HAVE_AVX512_F32)
      static const auto* const kTable = filled(avx512_f32::fill_kernel_table, isa);
      return kTable;
#else
      return nullptr;
#endif
    }
  }
  return nullptr;
}

template <>
const kernels::Kernels<double>* find_kernels<double>(Isa isa) {
  switch (isa) {
    case Isa::scalar: {
#if defined(MW_HAVE_SCALAR_F64)
      static const auto* const kTable = filled(scalar_f64::fill_kernel_table, isa);
      return kTable;
#else
      return nullptr;
#endif
    }
    case Isa::avx2: {
#if defined(MW_HAVE_AVX2_F64)
      static const auto* const kTable = filled(avx2_f64::fill_kernel_table, isa);
      return kTable;
#else
      return nullptr;
#endif
    }
    case Isa::avx512: return nullptr;  // float64 stops at AVX2
  }
  return nullptr;
}

template <class Real>
const kernels::Kernels<Real>& kernels_for(Isa isa) {
  for (int i = static_cast<int>(isa); i >= 0; --i) {
    if (const auto* table = find_kernels<Real>(static_cast<Isa>(i))) return *table;
  }
  // A build may leave the narrow ones out. All give the same bits.
  for (const Isa wider : kIsas) {
    if (const auto* table = find_kernels<Real>(wider)) return *table;
  }
  throw std::invalid_argument(std::string("no kernels in ") + (sizeof(Real) == 4 ? "f32" : "f64") +
                              ": this build has " + kBuilt);
}
template const kernels::Kernels<float>& kernels_for<float>(Isa);
template const kernels::Kernels<double>& kernels_for<double>(Isa);

bool has_kernels(Precision precision) {
  return std::any_of(std::begin(kIsas), std::end(kIsas), [&](Isa isa) {
    return precision == Precision::f32 ? find_kernels<float>(isa) != nullptr
                                       : find_kernels<double>(isa) != nullptr;
  });
}

std::vector<Isa> available_isas() {
  std::vector<Isa> out;
  for (const Isa isa : kIsas) {
    if (find_kernels<float>(isa) || find_kernels<double>(isa)) out.push_back(isa);
  }
  return out;
}

void require_isa(Isa isa, const std::string& name) {
  const std::vector<Isa> have = available_isas();
  if (std::find(have.begin(), have.end(), isa) != have.end()) return;
  throw std::invalid_argument(name + " is '" + to_string(isa) +
                              (cpu_has(isa)
                                   ? "', which was not built: this build has " + std::string(kBuilt)
                                   : "', which this CPU cannot run"));
}

Isa default_isa() {
  const char* forced = std::getenv("MANYWORLDS_ISA");
  if (forced != nullptr && *forced != '\0') {
    for (const Isa isa : kIsas) {
      if (std::string(forced) != to_string(isa)) continue;
      require_isa(isa, "MANYWORLDS_ISA");
      return isa;
    }
    throw std::invalid_argument("MANYWORLDS_ISA is '" + std::string(forced) +
                                "', must be scalar, avx2 or avx512");
  }
  const std::vector<Isa> have = available_isas();
  if (have.empty()) {
    throw std::invalid_argument("this CPU cannot run any of the kernels of this build: " +
                                std::string(kBuilt));
  }
  return have.back();
}

}  // namespace manyworlds
