// What a target says when a promise is broken; libFuzzer then keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace manyworlds::fuzz {

inline void require(bool good, const std::string& what) {
  if (good) return;
  std::fprintf(stderr, "broken: %s\n", what.c_str());
  std::abort();
}

}  // namespace manyworlds::fuzz
