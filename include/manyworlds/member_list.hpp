// Lists of members (members.hpp), and whether the fingerprint of a plan counts each member.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// Whether a member changes the fingerprint of a plan (Plan::fingerprint). Snapshots and recordings
// of plans with different fingerprints are incompatible.
struct Counted {
  bool yes = true;
  const char* unless = "";  // reason, if not counted
};
constexpr Counted not_counted(const char* why) { return {false, why}; }
constexpr Counted counted_if(bool condition, const char* why_not) { return {condition, why_not}; }

inline constexpr const char* kOfNewton = "the default; only Solver::newton uses others";
inline constexpr const char* kName = "names do not affect the simulation";
inline constexpr const char* kInitial = "initial values do not affect a world that has started";

template <class Struct>
struct Members;  // name; visit(value, visit): visit("member", value.member[, Counted]) for each
template <class Struct>
concept HasMembers = requires {
  Members<Struct>::name;
};

}  // namespace manyworlds
