// Arrays as the extension takes them: in order, on the CPU, of exactly the type and size it wants.
// The package around it converts; what does not fit is an error here, never an access outside.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace manyworlds::python {

template <class T>
using In = nanobind::ndarray<const T, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Out = nanobind::ndarray<T, nanobind::c_contig, nanobind::device::cpu>;
using AnyIn = nanobind::ndarray<nanobind::ro, nanobind::c_contig, nanobind::device::cpu>;
using AnyOut = nanobind::ndarray<nanobind::c_contig, nanobind::device::cpu>;
using Ids = In<std::int32_t>;

template <class Array>
auto span_of(const Array& array) {
  return std::span(array.data(), array.size());
}

inline void check_size(const char* what, std::size_t found, std::size_t wanted) {
  if (found == wanted) return;
  throw nanobind::value_error((std::string(what) + " has " + std::to_string(found) +
                               " values, must have " + std::to_string(wanted))
                                  .c_str());
}

// Calls f with the numbers of an array of float32 or float64.
template <class Array, class F>
void with_reals(const Array& array, F f) {
  const auto numbers = [&]<class T>(T*) {
    using Number = std::conditional_t<Array::ReadOnly, const T, T>;
    return std::span(static_cast<Number*>(array.data()), array.size());
  };
  if (array.dtype() == nanobind::dtype<float>()) {
    f(numbers(static_cast<float*>(nullptr)));
  } else if (array.dtype() == nanobind::dtype<double>()) {
    f(numbers(static_cast<double*>(nullptr)));
  } else {
    throw nanobind::type_error("the array must be of float32 or float64");
  }
}

// A NumPy array that owns its numbers.
template <class T>
nanobind::ndarray<nanobind::numpy, T> owned(std::vector<T> numbers,
                                            std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(numbers));
  const nanobind::capsule owner(kept,
                                [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return {kept->data(), shape, owner};
}

}  // namespace manyworlds::python
