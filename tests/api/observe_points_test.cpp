// Points of bodies against their bodies' poses and velocities, and what is refused.
#include <catch2/catch.hpp>

#include <limits>
#include <vector>

#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

std::vector<Vec3> read(const Batch& batch, Observed what, int world = 0) {
  std::vector<double> v(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
  batch.read(what, world, v);
  const auto n = static_cast<std::size_t>(components(what, space_of(batch)));
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < v.size(); i += n) {
    out.emplace_back(v[i], v[i + 1], n == 3 ? v[i + 2] : 0);
  }
  return out;
}

BatchOptions observing_points(const Table& table, std::vector<Point> points, int worlds = 1) {
  BatchOptions options = options_of(table, worlds);
  options.observe.points = std::move(points);
  return options;
}

}  // namespace

TEST_CASE("a point of a spinning rod has the velocity v + w x r", "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    Shape rod = shape_of(box_of(space, {1, 0.1, 0.1}));
    rod.position = {1, 0, 0};  // the body's frame is at its end
    Body body = body_of(rod, {5, 6, 0});
    body.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
    body.linear_velocity = {0.5, 0, 0};
    body.angular_velocity = {0, 0, 3};
    scene.add(body);
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(compile(scene),
                  observing_points(table, {{{2, 0, 0}, BodyId(0)}, {{0, 0, 0}, BodyId(0)}}));
      const double near = pick(table, 1e-4, 1e-10);
      batch.look();
      auto x = read(batch, Observed::point_position), v = read(batch, Observed::point_velocity);
      REQUIRE(x.size() == 2);
      CHECK((x[0] - Vec3(5, 8, 0)).norm() < near);
      CHECK((x[1] - Vec3(5, 6, 0)).norm() < near);
      CHECK((v[0] - Vec3(0.5 - 3, 0, 0)).norm() < near);
      CHECK((v[1] - Vec3(0.5 + 3, 0, 0)).norm() < near);
      batch.step(7);
      x = read(batch, Observed::point_position), v = read(batch, Observed::point_velocity);
      const double angle = kPi / 2 + 3 * batch.time();
      const Vec3 along(std::cos(angle), std::sin(angle), 0), centre(5 + 0.5 * batch.time(), 7, 0);
      CHECK((x[0] - (centre + along)).norm() < 10 * near);
      CHECK((v[0] - (Vec3(0.5, 0, 0) + 3 * Vec3(-along.y(), along.x(), 0))).norm() < 10 * near);
    }
  }
}

TEST_CASE("points go where the frames of their bodies go, in worlds that differ",
          "[fast][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(varied_crowd(space));
    const Vec3 arm(0.4, -0.3, space == Space::planar ? 0 : 0.2), other(-0.1, 0.6, 0);
    std::vector<Point> points;
    for (int b = 0; b < plan.bodies(); ++b) {
      points.push_back({arm, plan.body_in_row(b)});
      points.push_back({other, plan.body_in_row(b)});
    }
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(plan, observing_points(table, points, 7));
      const double near = pick(table, 1e-4, 1e-9);
      for (int call = 0; call < 5; ++call) {
        batch.step(9);
        for (int world = 0; world < 7; ++world) {
          const auto x = read(batch, Observed::point_position, world);
          const auto v = read(batch, Observed::point_velocity, world);
          for (int b = 0; b < plan.bodies(); ++b) {
            const auto i = static_cast<std::size_t>(2 * b);
            const Quat q = rotation(batch, world, b);
            REQUIRE((x[i] - position(batch, world, b) - q * arm).norm() < near);
            const Vec3 w = spin(batch, world, b), r = q * (arm - other);
            REQUIRE((v[i] - v[i + 1] - w.cross(r)).norm() < near * (1 + w.norm()));
          }
        }
      }
    }
  }
}

TEST_CASE("points that make no sense are refused, all that is wrong with them at once",
          "[fast][observe]") {
  Scene scene = empty_scene(Space::spatial);
  scene.add(ground(Space::spatial));
  scene.bodies[0].name = "ground";
  scene.add(body_of(shape_of(Sphere{0.5}), {0, 0, 3}));
  const Plan plan = compile(scene);
  const Table table = widest_tables().front();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(Batch(plan, observing_points(table, {{{0, 0, 0}, BodyId(0)}})),
                    "points[0].body is body 0 'ground', must be a body that can move: points of a "
                    "fixed body do not move");
  CHECK_THROWS_WITH(Batch(plan, observing_points(table, {{}})),
                    "points[0].body is -1, must be 0 to 1");
  CHECK_THROWS_WITH(
      Batch(plan, observing_points(table, {{{0, 0, 0}, BodyId(1)}, {{0, nan, 0}, BodyId(2)}})),
      Catch::Contains("points[1].position is ") &&
          Catch::Contains("must be finite; points[1].body is 2, must be 0 to 1"));
  BatchOptions options = options_of(table);
  options.observe.what = {Observer::points};
  CHECK_THROWS_WITH(Batch(plan, options), Catch::Contains("observe.what[0] is points"));
  options.observe.what = {Observer::motion};
  Batch batch(plan, options);
  std::vector<double> none;
  CHECK_THROWS_WITH(batch.read(Observed::point_velocity, 0, none),
                    Catch::Contains("point_velocity is not observed: give points"));
}

}  // namespace manyworlds::test
