// The one list of members (members.hpp): each counts in the fingerprint, or says why not.
#include <catch2/catch.hpp>

#include <map>
#include <set>
#include <utility>

#include "src/plan/plan_data.hpp"
#include "tests/support/changed_members.hpp"

namespace manyworlds::test {

TEST_CASE("a changed member changes the fingerprint, unless it is said why not", "[fast][scene]") {
  std::set<std::string> left_out;
  std::map<std::pair<Solver, std::string>, bool> counts;
  for (const Solver solver : kSolversOfEverything) {
    const Scene scene = scene_with_everything(solver);
    const std::vector<Change> changes = changes_of(scene);
    CHECK(changes.size() > 800);
    for (const Change& change : changes) {
      INFO(to_string(solver) << ", " << change.member);
      CHECK((fingerprint(change.scene) != fingerprint(scene)) == change.counts);
      if (!change.counts) left_out.insert(change.member);
      counts.insert_or_assign({solver, change.member}, change.counts);
    }
  }
  // What the lists say, told once more.
  const auto has = [&](const char* member) { return left_out.count(member) == 1; };
  CHECK(has("name"));
  CHECK(has("bodies/0/name"));
  CHECK(has("bodies/0/shapes/3/name"));
  CHECK(has("bodies/0/enabled"));
  CHECK(has("bodies/0/position/0"));
  CHECK_FALSE(has("bodies/1/position/0"));  // fixed
  CHECK(has("bodies/1/jitter/angle"));
  CHECK(has("controls/0/initial"));
  CHECK(has("variations/0/high/0"));
  CHECK(has("options/solver/relaxation"));
  CHECK_FALSE(has("options/solver/method"));
  CHECK_FALSE(has("options/dt"));
  CHECK_FALSE(has("bodies/0/shapes/4/geometry/radius"));
  // Those of the newton solver count where they are not as they always were.
  for (const char* member :
       {"bodies/0/shapes/0/material/soft/dimensions", "bodies/1/shapes/3/material/soft/weight",
        "bodies/1/shapes/3/material/soft/compliance/power", "joints/1/type/limit/margin",
        "joints/8/type/limit/compliance/time_constant", "joints/8/type/limit/margin",
        "joints/0/after", "joints/8/after", "joints/2/dynamics/armature",
        "joints/8/dynamics/reference", "controls/0/actuator/gear", "controls/1/actuator/bias/2",
        "exclusions"}) {
    INFO(member);
    CHECK_FALSE(has(member));
  }
  for (const char* member :
       {"keyframes", "keyframes/0/name", "keyframes/0/controls/1",
        "keyframes/0/generalized_position/0", "coordinate_draws", "coordinate_draws/0/high/1",
        "tendons",  // without a limit, as the one that is added has none
        "sites", "sites/0/body", "sites/0/position/2"}) {
    INFO(member);
    CHECK(has(member));
  }
  CHECK(counts.at({Solver::newton, "exclusions/0/body_b"}));
  CHECK(counts.at({Solver::newton, "joints/9/type/limit"}));
  CHECK(counts.at({Solver::newton, "joints/9/type/limit/high"}));
  CHECK(counts.at({Solver::newton, "tendons/0/terms/1/coefficient"}));
  CHECK(counts.at({Solver::newton, "tendons/0/limit/margin"}));
  for (const char* member : {"tolerance", "line_search_iterations", "line_search_tolerance",
                             "impedance_ratio", "implicit_damping"}) {
    INFO(member);
    const std::string place = std::string("options/solver/") + member;
    CHECK_FALSE(counts.at({Solver::tgs_soft, place}));
    CHECK_FALSE(counts.at({Solver::sor, place}));
    CHECK(counts.at({Solver::newton, place}));
  }
}

}  // namespace manyworlds::test
