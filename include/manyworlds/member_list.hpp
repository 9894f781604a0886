// What a list of members is (members.hpp), and what it says of each.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// Whether plans that differ in a member have different fingerprints (Plan::fingerprint), and so
// snapshots and recordings that are not for one another.
struct Counted {
  bool yes = true;
  const char* unless = "";  // why not
};
constexpr Counted not_counted(const char* why) { return {false, why}; }
constexpr Counted counted_if(bool condition, const char* why_not) { return {condition, why_not}; }

inline constexpr const char* kOfNewton = "the default is what there was before Solver::newton";

template <class Struct>
struct Members;  // name; visit(value, visit): visit("member", value.member[, Counted]) in turn
template <class Struct>
concept HasMembers = requires {
  Members<Struct>::name;
};

}  // namespace manyworlds
