// The names of laws and units, for programs with and without families.
#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {

const char* to_string(Units units) { return units == Units::similar ? "similar" : "earth"; }

const char* to_string(Law law) {
  switch (law) {
    case Law::symmetry: return "symmetry";
    case Law::momentum: return "momentum";
    case Law::energy: return "energy";
    case Law::friction: return "friction";
    case Law::rest: return "rest";
    case Law::penetration: return "penetration";
    case Law::similarity: return "similarity";
    case Law::independence: return "independence";
    case Law::joints: return "joints";
  }
  return "";
}

}  // namespace manyworlds::invariants
