// Manifolds in the poses that matter most: faces at rest on each other, coincident centres, and
// the twins themselves.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

// Area of the convex hull of points seen along `up` (spatial), or their spread (planar).
double spread(const std::vector<Contact>& contacts, Space space) {
  if (space == Space::planar) {
    double low = 1e9, high = -1e9;
    for (const Contact& c : contacts) {
      low = std::min(low, c.point.x());
      high = std::max(high, c.point.x());
    }
    return high - low;
  }
  std::vector<Vec2> p;
  for (const Contact& c : contacts) p.emplace_back(c.point.x(), c.point.y());
  const auto cross = [](const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
  Vec2 center = Vec2::Zero();
  for (const Vec2& v : p) center += v / static_cast<double>(p.size());
  std::sort(p.begin(), p.end(), [&](const Vec2& a, const Vec2& b) {
    return std::atan2(a.y() - center.y(), a.x() - center.x()) <
           std::atan2(b.y() - center.y(), b.x() - center.x());
  });
  double area = 0;
  for (std::size_t i = 0; i < p.size(); ++i) area += 0.5 * cross(p[i], p[(i + 1) % p.size()]);
  return area;
}

Scene crate_on(Space space, Geometry below, const Vec3& below_position, Motion motion,
               const Vec3& position) {
  Scene s = empty_scene(space);
  s.add(body_of(shape_of(std::move(below)), below_position, motion));
  s.add(body_of(shape_of(cube_of(space, 0.5)), position));
  return s;
}

void check_face(const Scene& scene, double overlap, double spanned, double tolerance_of_span) {
  const std::size_t points = scene.space == Space::planar ? 2 : 4;
  const Vec3 up = up_of(scene.space);
  for (const Table& table : all_tables()) {
    const double tight = pick(table, 2e-6, 1e-12);
    Batch batch(compile(scene), options_of(table));
    const auto contacts = batch.contacts(0);
    INFO(name(table));
    REQUIRE(contacts.size() == points);
    std::set<int> ids;
    for (const Contact& c : contacts) {
      CHECK((c.normal - up * (c.body_a == BodyId(0) ? 1.0 : -1.0)).norm() < tight);
      CHECK(c.separation == approx(-overlap, tight));
      CHECK(c.normal_impulse == 0);
      ids.insert(c.feature);
    }
    CHECK(ids.size() == points);
    CHECK(spread(contacts, scene.space) == Approx(spanned).epsilon(tolerance_of_span));
  }
}

}  // namespace

TEST_CASE("a face at rest has points at its corners", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    const Vec3 aside(0.3, space == Space::planar ? 0 : 0.2, 0);
    check_face(crate_on(space, ground_of(space), Vec3::Zero(), Motion::fixed, 0.495 * up), 0.005, 1,
               1e-5);
    check_face(
        crate_on(space, slab_of(space, 3, 0.5), -0.5 * up, Motion::fixed, 0.495 * up + aside),
        0.005, 1, 1e-5);
    check_face(
        crate_on(space, slab_of(space, 3, 0.5), -0.5 * up, Motion::dynamic, 0.495 * up + aside),
        0.005, 1, 1e-5);
    // Equal cubes, one set aside: the points span the common part.
    const double common = space == Space::planar ? 0.7 : 0.7 * 0.8;
    check_face(crate_on(space, cube_of(space, 0.5), -0.5 * up, Motion::dynamic, 0.495 * up + aside),
               0.005, common, 1e-5);
    // Not yet touching: the speculative margin is 4 slop, 0.02 m.
    check_face(crate_on(space, ground_of(space), Vec3::Zero(), Motion::fixed, 0.517 * up), -0.017,
               1, 1e-5);
    check_face(crate_on(space, slab_of(space, 3, 0.5), -0.5 * up, Motion::fixed, 0.517 * up),
               -0.017, 1, 1e-5);
    check_face(crate_on(space, slab_of(space, 3, 0.5), -0.5 * up, Motion::dynamic, 0.517 * up),
               -0.017, 1, 1e-5);
  }
}

// Edges that coincide, or nearly, with the border they are clipped against are the usual case in
// stacks, and the one where rounding decides which side they are on.
TEST_CASE("equal cubes stacked almost exactly keep all their points", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    const Plan plan =
        compile(crate_on(space, cube_of(space, 0.5), -0.5 * up, Motion::dynamic, 0.499 * up));
    for (const Table& table : all_tables()) {
      Batch batch(plan, options_of(table));
      int worst_points = 9;
      double worst_spread = 9;
      for (double shift : {0.0, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, -1e-5, 1e-3, -1e-3}) {
        for (double turn : {0.0, 1e-10, -1e-10, 1e-8, -1e-8, 1e-6, -1e-6, 1e-4, -1e-4, 1e-3}) {
          for (int tilt_axis = 0; tilt_axis < (space == Space::planar ? 1 : 3); ++tilt_axis) {
            const Vec3 axis = space == Space::planar ? Vec3(0, 0, 1) : Vec3(Vec3::Unit(tilt_axis));
            const Quat q(Eigen::AngleAxisd(turn, axis));
            const Vec3 aside = tilt_axis == 1 ? Vec3(0, shift, 0) : Vec3(shift, 0, 0);
            set_vector(batch, Field::position, 0, 1,
                       0.499 * up + (space == Space::planar ? Vec3(shift, 0, 0) : aside));
            std::vector<double> v = values(batch, Field::orientation);
            if (space == Space::planar) {
              v[2] = std::cos(turn);
              v[3] = std::sin(turn);
            } else {
              for (int k = 0; k < 4; ++k)
                v[static_cast<std::size_t>(4 + k)] = k == 0 ? q.w() : q.vec()(k - 1);
            }
            batch.write(Field::orientation, 0, v);
            const auto contacts = batch.contacts(0);
            const double s = contacts.empty() ? 0 : spread(contacts, space);
            INFO(name(table) << " shift " << shift << " turn " << turn << " about "
                             << axis.transpose() << " points " << contacts.size() << " spread "
                             << s);
            CHECK(contacts.size() == (space == Space::planar ? 2u : 4u));
            CHECK(s > 0.99);
            worst_points = std::min(worst_points, static_cast<int>(contacts.size()));
            worst_spread = std::min(worst_spread, s);
          }
        }
      }
      INFO(name(table) << " worst " << worst_points << " points, spread " << worst_spread);
      CHECK(worst_spread > 0.99);
    }
  }
}

TEST_CASE("four points keep most of an octagonal overlap", "[fast][collide]") {
  Scene scene =
      crate_on(Space::spatial, Box{{0.5, 0.5, 0.5}}, {0, 0, -0.5}, Motion::dynamic, {0, 0, 0.495});
  scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(kPi / 4, Vec3::UnitZ()));
  for (const Table& table : all_tables()) {
    const auto contacts = Batch(compile(scene), options_of(table)).contacts(0);
    INFO(name(table));
    REQUIRE(contacts.size() == 4);
    // The octagon has area 2 (sqrt 2 - 1) = 0.828; the best quadrilateral in it 0.586.
    CHECK(spread(contacts, Space::spatial) > 0.4);
    Vec3 mean = Vec3::Zero();
    for (const Contact& c : contacts) mean += 0.25 * c.point;
    CHECK(mean.head<2>().norm() < 0.15);
  }
}

TEST_CASE("feature ids stay with their points through small motions", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 up = up_of(space);
    const std::vector<Scene> scenes = {
        crate_on(space, ground_of(space), Vec3::Zero(), Motion::fixed, 0.495 * up),
        crate_on(space, slab_of(space, 3, 0.5), -0.5 * up, Motion::dynamic, 0.495 * up),
    };
    for (const Scene& scene : scenes) {
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        const int crate = batch.bodies() - 1;
        std::map<int, Vec3> before;
        for (const Contact& c : batch.contacts(0)) before[c.feature] = c.point;
        const Vec3 at = position(batch, 0, crate);
        for (double shift : {1e-4, -1e-4, 3e-3}) {
          INFO(name(table) << " shift " << shift << " points " << before.size());
          set_vector(batch, Field::position, 0, crate, at + Vec3(shift, 0, 0) + 0.1 * shift * up);
          const auto contacts = batch.contacts(0);
          REQUIRE(contacts.size() == before.size());
          for (const Contact& c : contacts) {
            INFO("id " << c.feature << " at " << c.point.transpose());
            REQUIRE(before.count(c.feature) == 1);
            CHECK((before[c.feature] - c.point).norm() < 0.01);
          }
        }
      }
    }
  }
}

TEST_CASE("coincident shapes get finite unit normals", "[fast][collide]") {
  struct Pair {
    Space space;
    Geometry a, b;
  };
  const std::vector<Pair> pairs = {
      {Space::spatial, Sphere{0.5}, Sphere{0.5}},
      {Space::spatial, Sphere{0.5}, Sphere{0.3}},
      {Space::spatial, Sphere{0.3}, Box{{0.5, 0.5, 0.5}}},
      {Space::spatial, Box{{0.5, 0.5, 0.5}}, Box{{0.5, 0.5, 0.5}}},
      {Space::spatial, Box{{0.5, 0.5, 0.5}}, Box{{0.2, 0.3, 0.4}}},
      {Space::planar, Circle{0.5}, Circle{0.5}},
      {Space::planar, Circle{0.5}, Polygon::box(0.5, 0.5)},
      {Space::planar, Polygon::box(0.5, 0.5), Polygon::box(0.5, 0.5)},
      {Space::planar, Polygon{{{0, 0.5}, {-0.5, -0.4}, {0.5, -0.4}}}, Polygon::box(0.3, 0.2)},
  };
  for (const Pair& pair : pairs) {
    for (Motion motion : {Motion::dynamic, Motion::fixed}) {
      Scene scene = empty_scene(pair.space);
      scene.add(body_of(shape_of(pair.a), Vec3(1, 2, 0), motion));
      scene.add(body_of(shape_of(pair.b), Vec3(1, 2, 0)));
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        INFO(name(table) << " shapes " << pair.a.index() << ' ' << pair.b.index());
        const auto contacts = batch.contacts(0);
        REQUIRE(!contacts.empty());
        for (const Contact& c : contacts) {
          CHECK(c.normal.norm() == approx(1, 1e-6));
          CHECK(c.point.allFinite());
          CHECK(c.separation < -0.1);
        }
        batch.step(10);
        CHECK(batch.status(0) == Status::ok);
      }
    }
  }
}

TEST_CASE("filters and shared bodies keep shapes apart", "[fast][collide]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(body_of(shape_of(round_of(space, 0.5)), Vec3::Zero()));
    scene.add(body_of(shape_of(round_of(space, 0.5)), Vec3(0.5, 0, 0)));
    scene.bodies[0].shapes.push_back(shape_of(cube_of(space, 0.4)));  // overlaps its own body
    for (const Table& table : widest_tables()) {
      CHECK(Batch(compile(scene), options_of(table)).contacts(0).size() >= 2);
      Scene filtered = scene;
      filtered.bodies[1].shapes[0].filter = {2, 2};  // not in the others' category
      CHECK(Batch(compile(filtered), options_of(table)).contacts(0).empty());
      filtered.bodies[0].shapes[1].filter = {2, 2};
      const auto contacts = Batch(compile(filtered), options_of(table)).contacts(0);
      REQUIRE(!contacts.empty());
      for (const Contact& c : contacts) {
        CHECK(c.shape_a.index() + c.shape_b.index() == 1);
        CHECK(c.body_a != c.body_b);
      }
    }
  }
}

TEST_CASE("the twins agree with a dense search over directions", "[fast][twin]") {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const bool planar = i % 2 == 0;
    Shape a, b;
    if (planar) {
      a.geometry = random_polygon(random, random.integer(3, 8));
      b.geometry = random_polygon(random, random.integer(3, 8));
    } else {
      a.geometry = random_box(random);
      b.geometry = random_box(random);
    }
    const Quat qa = planar ? random.planar_rotation() : random.rotation();
    const Quat qb = planar ? random.planar_rotation() : random.rotation();
    Vec3 x = random.in_cube(0.8);
    if (planar) x.z() = 0;
    const Solid solid_a = make_solid(a, {Vec3::Zero(), qa});
    const Solid solid_b = make_solid(b, {x, qb});
    const double truth = separation(solid_a, solid_b);
    // Random directions, then ever smaller steps from the best one.
    Vec3 best = Vec3::UnitX();
    double most = -1e9;
    const auto offer = [&](const Vec3& d) {
      const double s = separation_along(solid_a, solid_b, d);
      REQUIRE(s <= truth + 1e-9);
      if (s > most) {
        most = s;
        best = d;
      }
    };
    for (int k = 0; k < 4000; ++k) offer(planar ? random.planar_direction() : random.direction());
    for (double step = 0.1; step > 1e-7; step *= 0.97) {
      for (int k = 0; k < 4; ++k) {
        Vec3 d = best + random.in_cube(step);
        if (planar) d.z() = 0;
        offer(d.normalized());
      }
    }
    CHECK(most == approx(truth, 2e-3));
  }
}

}  // namespace manyworlds::test
