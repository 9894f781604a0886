// Our models with joints in Solver::newton against MuJoCo, by the code of `manyworlds compare`:
// links, contacts, accelerations, the next state, and paths.
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"
#include "tests/support/paths.hpp"

namespace manyworlds::test {
namespace {

MjcfFiles scene_files(const std::string& name) {
  return MjcfFiles::read(std::filesystem::path(kSourceFolder) / "scenes" / "mjcf" /
                         (name + ".xml"));
}

}  // namespace

TEST_CASE("models with joints accelerate and step as in MuJoCo", "[mjcf][robots]") {
  const std::string model =
      GENERATE("robot_pendulum", "robot_hopper", "robot_cheetah", "robot_ant", "robot_humanoid");
  const compare::Pair pair(scene_files(model), kConverged);
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const auto samples = compare::draw_samples(pair, precision, 200);
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      const auto c = compare::compare_states(pair, samples, kernels_of(table));
      INFO(model << ", " << name(table) << ": " << to_string(c));
      CHECK(c.failures() == std::vector<std::string>());
      CHECK(c.contacts > c.states / 20);
      CHECK(c.uncertain <= c.states / 50);
      CHECK(c.other_points == 0);
      CHECK(c.at("qacc, constrained").differences.size() > 20);
      // At this tolerance far within the gates.
      for (const compare::Quantity& q : c.quantities) {
        INFO(q.name);
        CHECK(q.most() < pick(table, 1e-3, 1e-11));
        CHECK(q.median() < pick(table, 3e-5, 1e-12));
      }
    }
  }
}

TEST_CASE("models follow MuJoCo's path for 1,000 steps without contacts", "[mjcf][robots]") {
  const std::string model =
      GENERATE("robot_pendulum", "robot_hopper", "robot_cheetah", "robot_ant", "robot_humanoid");
  INFO(model);
  compare::Pair pair(scene_files(model), kConverged);
  pair.disable_contacts();
  for (const Table& table : all_tables()) {
    if (table.precision != Precision::f64) continue;
    const compare::FreePaths paths = compare::compare_free_paths(pair, kernels_of(table), 2);
    CHECK(paths.failures() == std::vector<std::string>());
    CHECK(paths.most() < 1e-11);
  }
}

TEST_CASE("paths of float64 stay on MuJoCo's as long as its own do", "[mjcf][robots]") {
  const compare::Pair pair(scene_files("robot_hopper"), kConverged);
  for (const Table& table : all_tables()) {
    const compare::Parting parting = compare::compare_paths(pair, kernels_of(table), 8, 300);
    REQUIRE(parting.ours.size() == 8);
    REQUIRE(parting.own.size() == 8);
    if (table.precision != Precision::f64) continue;
    // Controls throw it about on the ground for 1.5 s.
    CHECK(compare::Parting::median(parting.ours) < 0);
    CHECK(compare::Parting::median(parting.own) < 0);
  }
}

TEST_CASE("what differs from MuJoCo fails the gates", "[mjcf][robots][fast]") {
  compare::Pair pair(scene_files("robot_hopper"), kConverged);
  const auto samples = compare::draw_samples(pair, Precision::f32, 50);
  pair.disable_contacts();
  const auto c = compare::compare_states(pair, samples, kernels_of(widest_tables().front()));
  CHECK(c.other_contacts > 0);
  CHECK(c.failures().size() == 1);
  auto moved = samples;
  for (compare::Sample& s : moved) s.v[0] += 0.1, s.touches.clear();
  const auto other = compare::compare_states(pair, moved, kernels_of(widest_tables().front()));
  CHECK_FALSE(other.at("link velocity").holds());
  CHECK_FALSE(other.at("next qvel, constrained").holds());
  CHECK(other.at("link position").holds());
}

TEST_CASE("free bodies alone are not compared", "[mjcf][robots][fast]") {
  const MjcfFiles files = MjcfFiles::of_string(
      "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>");
  CHECK_THROWS_WITH(compare::Pair(files, kConverged),
                    "the model has only free joints, and is not stepped with MuJoCo's physics "
                    "(tgs-soft); expected a hinge, a slide or a ball joint");
}

}  // namespace manyworlds::test
