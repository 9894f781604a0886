// The one list of members (members.hpp): each counts in the fingerprint, or says why not.
#include <catch2/catch.hpp>

#include <set>

#include "src/plan/plan_data.hpp"
#include "tests/support/changed_members.hpp"

namespace manyworlds::test {

TEST_CASE("a changed member changes the fingerprint, unless it is said why not", "[fast][scene]") {
  std::set<std::string> left_out;
  for (const bool all : {false, true}) {
    const Scene scene = scene_with_everything(all);
    const std::vector<Change> changes = changes_of(scene);
    CHECK(changes.size() > 800);
    for (const Change& change : changes) {
      INFO((all ? "all, " : "") << change.member);
      CHECK((fingerprint(change.scene) != fingerprint(scene)) == change.counts);
      if (!change.counts) left_out.insert(change.member);
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
}

}  // namespace manyworlds::test
