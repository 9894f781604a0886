// Terms of what observers see: what Batch::read says, and what is refused.
#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "manyworlds/expression_graph.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {

TEST_CASE("what observers see is to be had in tasks: points, accelerations, sums",
          "[task][fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Task task;
    task.scene = varied_crowd(space);
    const BodyId two(static_cast<int>(task.scene.bodies.size()) - 1);
    task.points = {{{0.1, 0.2, 0}, two}, {{0.3, 0, 0}, two}};
    task.frame_skip = 3;
    struct Asked {
      Observed what;
      int item, component;
      std::size_t at;  // in what Batch::read gives
    };
    const Plan plan = compile(task.scene);
    const std::size_t dim = space == Space::planar ? 2 : 3, spins = space == Space::planar ? 1 : 3,
                      row = static_cast<std::size_t>(plan.row(two));
    const std::vector<Asked> all = {
        {Observed::linear_acceleration, two.index(), 1, row * dim + 1},
        {Observed::proper_acceleration, two.index(), 0, row * dim},
        {Observed::angular_acceleration, two.index(), 2, row * spins + spins - 1},
        {Observed::point_position, 1, 0, dim},
        {Observed::point_velocity, 1, 1, dim + 1},
        {Observed::momentum, 0, 1, 1},
        {Observed::kinetic_energy, 0, 0, 0},
        {Observed::penetration, 0, 0, 0},
    };
    std::vector<Expression> expressions;
    for (const Asked& a : all) {
      expressions.push_back(terms::observed(a.what, a.item, a.component));
    }
    expressions = from_graph(graph_of(expressions));  // as plain values and back
    for (const Expression& e : expressions) task.observations.push_back({"", e});
    Played p(task, {.worlds = 9});
    CHECK(p.observations[0] == 0);  // a state has no acceleration
    for (int step = 0; step < 20; ++step) {
      p.step();
      for (int w = 0; w < 9; ++w) {
        for (std::size_t i = 0; i < all.size(); ++i) {
          const Batch& batch = p.environment.batch();
          std::vector<double> v(batch.size(all[i].what) / 9);
          batch.read(all[i].what, w, v);
          INFO(to_string(all[i].what));
          REQUIRE(p.observations[static_cast<std::size_t>(w) * all.size() + i] ==
                  static_cast<float>(v[all[i].at]));
        }
      }
    }
    CHECK(text_of(terms::proper_acceleration(two, 1), 72) ==
          "proper_acceleration(" + std::to_string(two.index()) + ", 'y')");
  }
}

TEST_CASE("terms of what is not there are issues of the task", "[task][fast][observe]") {
  Task task;
  task.scene = empty_scene(Space::planar);
  task.scene.add(ground(Space::planar));
  task.scene.add(body_of(shape_of(Circle{0.5}), {0, 3, 0}));
  task.points = {{{0, 0, 0}, BodyId(0)}};
  const auto message = [&](const Expression& e) {
    task.observations = {{"", e}};
    std::string all;
    for (const Issue& issue : validate(task)) all += issue.place + ": " + issue.message + "\n";
    return all;
  };
  using Catch::Contains;
  CHECK_THAT(
      message(terms::linear_acceleration(BodyId(0), 0)),
      Contains("a fixed body is not observed") && Contains("points: points[0].body is body"));
  CHECK_THAT(message(terms::linear_acceleration(BodyId(1), 2)),
             Contains("the axis must be 0 to 1"));
  CHECK_THAT(
      message(terms::angular_acceleration(BodyId(1), 0)),
      Contains("angular_acceleration of body 1, axis 0: the axis must be 2 in a planar scene"));
  CHECK_THAT(message(terms::point_velocity(1, 0)),
             Contains("point_velocity of point 1, axis 0: the point must be 0 to 0"));
  task.scene.add(Site{"top", BodyId(1), Vec3(0, 0.5, 0)});
  CHECK(message(terms::site_position(SiteId(0), 1)).find("site_position") == std::string::npos);
  CHECK_THAT(message(terms::site_position(SiteId(1), 0)),
             Contains("site_position of site 1, axis 0: the site must be 0 to 0"));
  CHECK_THAT(message(terms::site_position(SiteId(0), 2)), Contains("the axis must be 0 to 1"));
  CHECK_THAT(message(terms::observed(Observed::momentum, 1, 0)),
             Contains("the item must be 0 to 0"));
  CHECK_THAT(message(terms::tendon_length(TendonId(0))),
             Contains("its solver is tgs-soft, and only newton has trees of links"));
  task.scene.options.solver.method = Solver::newton;
  CHECK_THAT(message(terms::tendon_length(TendonId(0))),
             Contains("tendon_length of tendon 0: the tendon must be 0 to 0, but there are none"));
}

}  // namespace manyworlds::test
