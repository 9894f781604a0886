// Pimpl: what stands behind a public object. Using an object that was moved from is an error that
// says so.
#pragma once

#include <memory>
#include <utility>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// The members are defined in src/base/pimpl.hpp; Impl::kName is what the object is called.
template <class Impl>
class Pimpl {
 public:
  explicit Pimpl(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
  // Makes Impl(arguments...), in the library's floating-point mode.
  template <class... Arguments>
  static Pimpl make(Arguments&&... arguments);

  // For as long as the expression lasts, the thread is in the library's floating-point mode. Throws
  // std::invalid_argument when there is nothing behind the object.
  class Use;
  Use operator->() const;
  Impl& operator*() const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace manyworlds
