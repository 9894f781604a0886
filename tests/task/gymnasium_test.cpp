// Gymnasium's tasks on the robots that come with the library, which are not Gymnasium's models;
// python/tests/test_gym_mujoco.py holds those of its own against Gymnasium.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <string>

#include "manyworlds/gymnasium.hpp"
#include "manyworlds/scenes.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Scene robot(const char* name) { return scenes::find(name)->make(); }

// What a step tells, to the last bit: rewards in double, observations as floats.
using Told = std::vector<double>;
Told told(const Task& task, EnvironmentOptions options, int worlds, int first) {
  options.worlds = worlds, options.seed = 5 + static_cast<std::uint64_t>(first);
  Played p(task, options);
  std::vector<double> infos(static_cast<std::size_t>(worlds) * task.infos.size());
  Told out;
  for (int i = 0; i < 12; ++i) {
    p.act_at_random(i, first);
    StepArrays arrays = p.arrays();
    arrays.infos = infos;
    p.environment.step(std::span<const float>(p.actions), arrays);
    const auto last = [&](const auto& all, std::size_t n) {
      out.insert(out.end(), all.end() - static_cast<std::ptrdiff_t>(n), all.end());
    };
    last(p.observations, task.observations.size());
    last(p.rewards, 1), last(infos, task.infos.size());
  }
  return out;
}
bool same_told(const Told& a, const Told& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("tasks of models are sound, whatever their arguments", "[fast][task][gymnasium]") {
  const std::map<std::string, const char*> models = {{"Hopper-v5", "hopper"},
                                                     {"HalfCheetah-v5", "cheetah"},
                                                     {"Walker2d-v5", "cheetah"},
                                                     {"Swimmer-v5", "cheetah"},
                                                     {"Ant-v5", "ant"},
                                                     {"Humanoid-v5", "humanoid"},
                                                     {"HumanoidStandup-v5", "humanoid"}};
  CHECK(gymnasium::all().size() == 11);
  for (const auto& [name, model] : models) {
    INFO(name);
    const gymnasium::Entry* entry = gymnasium::find(name);
    REQUIRE(entry != nullptr);
    std::vector<gymnasium::Argument> arguments = entry->arguments;
    const Task by_default = entry->make(robot(model), arguments);
    CHECK(validate(by_default).empty());
    CHECK(by_default.name == name);
    for (gymnasium::Argument& a : arguments) {
      if (a.kind == gymnasium::Argument::Kind::flag) a.value[0] = a.value[0] == 0 ? 1 : 0;
      if (std::string(a.name) == "frame_skip") a.value[0] = 3;
    }
    const Task other = entry->make(robot(model), arguments);
    CHECK(validate(other).empty());
    CHECK(other.frame_skip == 3);
    CHECK(other.observations.size() != by_default.observations.size());
    arguments.pop_back();
    CHECK_THROWS_AS(entry->make(robot(model), arguments), std::invalid_argument);
  }
}

TEST_CASE("a model that does not fit is refused", "[fast][task][gymnasium]") {
  using Catch::Contains;
  CHECK_THROWS_WITH(gymnasium::reacher(robot("hopper")),
                    Contains("has 6 coordinates, must have 4"));
  CHECK_THROWS_WITH(gymnasium::ant(robot("hopper")),
                    Contains("has 6 coordinates, must have 7 or more"));
  CHECK_THROWS_WITH(gymnasium::ant(robot("bin-boxes")), Contains("Solver::newton"));
  CHECK_THROWS_WITH(gymnasium::ant(robot("ant"), {.main_body = 0}), Contains("0 is asked for"));
}

TEST_CASE("links, inertias and forces of a task have the bits of its world alone",
          "[fast][task][gymnasium][bits]") {
  for (const Task& task : {gymnasium::ant(robot("ant")), gymnasium::humanoid(robot("humanoid")),
                           gymnasium::hopper(robot("hopper"))}) {
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      Told reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        EnvironmentOptions options;
        options.precision = precision, options.isa = table.isa;
        for (const int worlds : {1, 11}) {
          options.threads = worlds == 1 ? 1 : 2;
          const Told found = told(task, options, worlds, 11 - worlds);
          if (reference.empty()) reference = found;
          INFO(task.name << ' ' << name(table) << ' ' << worlds);
          CHECK(same_told(found, reference));
        }
      }
    }
  }
}

TEST_CASE("terms of links are where bodies are before a step, and then one step behind",
          "[fast][task][gymnasium]") {
  if (!has_table(double_table())) return;
  Task task = gymnasium::ant(robot("ant"), {.frame_skip = 1});
  task.observations.clear();
  const std::vector<BodyId> bodies = {BodyId(1), BodyId(3)};
  for (const BodyId body : bodies) {
    for (int axis = 0; axis < 3; ++axis) {
      task.observations.push_back({"", terms::position(body, axis)});
      task.observations.push_back({"", terms::link_position(body, axis)});
    }
  }
  task.scene.options.integrator = Integrator::symplectic_euler;
  Played p(task, {.worlds = 4, .threads = 1, .seed = 3, .precision = Precision::f64});
  const auto check = [&](const std::vector<float>& expected) {
    for (std::size_t i = 0; i < expected.size(); i += 2) {
      CHECK(p.observations[i + 1] == approx(expected[i], 1e-6));
    }
  };
  check(p.observations);
  for (int i = 0; i < 5; ++i) {
    const std::vector<float> before = p.observations;
    p.act_at_random(i);
    p.step();
    check(before);
    CHECK(p.observations != before);
  }
}

}  // namespace manyworlds::test
