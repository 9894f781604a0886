// Pimpl: pointer to the implementation of a public object. Use of a moved-from object is reported
// as an error.
#pragma once

#include <memory>
#include <utility>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// The members are defined in src/base/pimpl.hpp; Impl::kName is the object's name.
template <class Impl>
class Pimpl {
 public:
  explicit Pimpl(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
  // Constructs Impl(arguments...) in the library's floating-point mode.
  template <class... Arguments>
  static Pimpl make(Arguments&&... arguments);

  // Sets the thread to the library's floating-point mode until the end of the expression. Throws
  // std::invalid_argument if the object was moved from.
  class Use;
  Use operator->() const;
  Impl& operator*() const;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace manyworlds
