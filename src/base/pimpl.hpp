// What a call of a public object does first: looks that there is something behind it, and computes
// in the library's floating-point mode.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "manyworlds/pimpl.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

template <class Impl>
class Pimpl<Impl>::Use {
 public:
  explicit Use(Impl& impl) : impl_(&impl) {}
  Impl* operator->() const { return impl_; }

 private:
  Impl* impl_;
  FloatMode mode_;
};

template <class Impl>
template <class... Arguments>
Pimpl<Impl> Pimpl<Impl>::make(Arguments&&... arguments) {
  const FloatMode mode;
  return Pimpl(std::make_unique<Impl>(std::forward<Arguments>(arguments)...));
}

template <class Impl>
Impl& Pimpl<Impl>::operator*() const {
  if (!impl_) {
    throw std::invalid_argument(std::string(Impl::kName) +
                                " was moved from: it can only be assigned to or destroyed");
  }
  return *impl_;
}

template <class Impl>
typename Pimpl<Impl>::Use Pimpl<Impl>::operator->() const {
  return Use(**this);
}

}  // namespace manyworlds
