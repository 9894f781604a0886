#include "src/dispatch/kernels.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace manyworlds {

#define MW_DECLARE(name, Real)                             \
  namespace name {                                         \
  void fill_kernel_table(kernels::KernelTable<Real>& out); \
  }
MW_DECLARE(scalar_f32, float)
MW_DECLARE(scalar_f64, double)
MW_DECLARE(avx2_f32, float)
MW_DECLARE(avx2_f64, double)
MW_DECLARE(avx512_f32, float)
#undef MW_DECLARE

namespace {

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
const kernels::KernelTable<Real>* filled(void (*fill)(kernels::KernelTable<Real>&), Isa isa) {
  if (!cpu_has(isa)) return nullptr;
  auto* table = new kernels::KernelTable<Real>{};  // lives as long as the program
  fill(*table);
  return table;
}

}  // namespace

template <>
const kernels::KernelTable<float>* find_kernels<float>(Isa isa) {
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
const kernels::KernelTable<double>* find_kernels<double>(Isa isa) {
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
const kernels::KernelTable<Real>& kernels_for(Isa isa) {
  for (int i = static_cast<int>(isa); i >= 0; --i) {
    if (const auto* table = find_kernels<Real>(static_cast<Isa>(i))) return *table;
  }
  throw std::invalid_argument(std::string("this build has no kernels for ") + to_string(isa) +
                              (sizeof(Real) == 4 ? " in f32" : " in f64"));
}
template const kernels::KernelTable<float>& kernels_for<float>(Isa);
template const kernels::KernelTable<double>& kernels_for<double>(Isa);

std::vector<Isa> available_isas() {
  std::vector<Isa> out;
  for (const Isa isa : {Isa::scalar, Isa::avx2, Isa::avx512}) {
    if (find_kernels<float>(isa) || find_kernels<double>(isa)) out.push_back(isa);
  }
  return out;
}

Isa default_isa() {
  const std::vector<Isa> have = available_isas();
  const char* forced = std::getenv("MANYWORLDS_ISA");
  if (forced == nullptr || *forced == '\0') return have.back();
  std::string names;
  for (const Isa isa : have) {
    if (std::string(forced) == to_string(isa)) return isa;
    names += std::string(names.empty() ? "" : ", ") + to_string(isa);
  }
  throw std::invalid_argument("MANYWORLDS_ISA is '" + std::string(forced) +
                              "', but this machine and build have: " + names);
}

}  // namespace manyworlds
