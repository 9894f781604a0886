// The members of scenes (members.hpp) as the dataclasses of the package have them. A test compares
// them, and every default, with the dataclasses.
#pragma once

#include <string_view>

#include "convert.hpp"
#include "manyworlds/members.hpp"
#include "manyworlds/observe.hpp"

namespace manyworlds::python {

template <class T>
struct Described {
  static constexpr const char* name = Members<T>::name;
  static void fields(auto&& visit, auto& s) {
    Members<T>::visit(s, [&](const char* member, auto& value, Counted = {}) {
      const bool keyword = std::string_view(member) == "with";  // of Python
      visit(keyword ? "with_body" : member, value);
    });
  }
};

template <>
struct Described<Ray> {
  static constexpr const char* name = "Ray";
  static void fields(auto&& visit, auto& s) {
    visit("origin", s.origin), visit("direction", s.direction), visit("length", s.length);
    visit("body", s.body), visit("mask", s.mask);
  }
};

template <>
struct Described<Point> {
  static constexpr const char* name = "Point";
  static void fields(auto&& visit, auto& s) {
    visit("position", s.position), visit("body", s.body);
  }
};

}  // namespace manyworlds::python
