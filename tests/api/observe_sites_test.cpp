// Sites and tendons: where points with names are, and how long sums of coordinates are.
#include <catch2/catch.hpp>

#include <cstring>
#include <limits>
#include <vector>

#include "tests/support/newton_scenes.hpp"
#include "tests/support/observed.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

bool same_bits(const Numbers& a, const Numbers& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Of the robots a site on each body and one in the world, and two tendons, one with a limit.
Scene marked(Scene scene) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    scene.add(Site{"on " + std::to_string(b), BodyId(static_cast<int>(b)), Vec3(0.1, -0.05, 0.2)});
  }
  scene.add(Site{"mark", {}, Vec3(1, 2, 3)});
  std::vector<JointId> moving;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const JointType& type = scene.joints[j].type;
    if (std::holds_alternative<HingeJoint>(type) || std::holds_alternative<SliderJoint>(type)) {
      moving.emplace_back(static_cast<int>(j));
    }
  }
  scene.add(Tendon{"free", {{moving[0], -1}, {moving[3], 1}}, {}});
  scene.add(Tendon{"held", {{moving.back(), 0.5}, {moving[2], 2}}, Limit{-0.2, 0.2}});
  return scene;
}

}  // namespace

TEST_CASE("sites are found by name", "[fast][observe][scene]") {
  const Scene scene = marked(robots());
  CHECK(scene.site("on 2") == SiteId(2));
  CHECK(scene.at(scene.site("mark")).position == Vec3(1, 2, 3));
  CHECK(scene.tendon("held") == TendonId(1));
  const Plan plan = compile(scene);
  CHECK(plan.site("mark") == scene.site("mark"));
  CHECK_THROWS_WITH(plan.tendon("hold"), Catch::Contains("no tendon is named 'hold'") &&
                                             Catch::Contains("nearest: 'held'"));
  CHECK_THROWS_WITH(scene.site("nark"), Catch::Contains("nearest: 'mark'"));
}

TEST_CASE("sites of other solvers are where points are", "[fast][observe]") {
  for (const Space space : {Space::planar, Space::spatial}) {
    Scene scene = varied_crowd(space);
    Body floor = ground(space);
    floor.position = up_of(space) * -3,
    floor.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
    const BodyId fixed = scene.add(std::move(floor));
    const Vec3 arm(0.4, -0.3, space == Space::planar ? 0 : 0.2);
    BatchOptions options;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      const BodyId body(static_cast<int>(b));
      if (scene.at(body).motion == Motion::fixed) continue;
      scene.add(Site{"", body, arm});
      options.observe.points.push_back({arm, body});
    }
    const SiteId still = scene.add(Site{"still", fixed, arm});
    const SiteId mark = scene.add(Site{"mark", {}, arm});
    const Plan plan = compile(scene);
    const std::size_t dim = space == Space::planar ? 2 : 3;
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions own = options_of(table, 7);
      own.observe = options.observe;
      own.observe.what = {Observer::sites};
      Batch batch(plan, own);
      for (int call = 0; call < 3; ++call) {
        batch.step(9);
        for (int world = 0; world < 7; ++world) {
          Numbers sites = numbers(batch, Observed::site_position, world);
          const Numbers points = numbers(batch, Observed::point_position, world);
          REQUIRE(sites.size() == points.size() + 2 * dim);
          const Vec3 of_fixed = scene.at(fixed).position + scene.at(fixed).rotation * arm;
          for (std::size_t c = 0; c < dim; ++c) {
            const auto i = static_cast<Eigen::Index>(c);
            CHECK(sites[static_cast<std::size_t>(still.index()) * dim + c] ==
                  Approx(of_fixed[i]).epsilon(1e-6));
            CHECK(sites[static_cast<std::size_t>(mark.index()) * dim + c] ==
                  Approx(arm[i]).epsilon(1e-6));
          }
          sites.resize(points.size());
          REQUIRE(same_bits(sites, points));
        }
      }
    }
  }
}

TEST_CASE("sites and tendons of trees are where the last forces were found",
          "[fast][observe][newton]") {
  for (Scene scene : {marked(robots()), marked(randomized(robots()))}) {
    scene.options.substeps = 1;
    const Plan plan = compile(scene);
    const BodyId seen[] = {BodyId(1), BodyId(4)};
    for (const Table& table : all_tables()) {
      INFO(scene.name << ' ' << name(table));
      BatchOptions options = options_of(table, 5);
      options.observe.what = {Observer::sites, Observer::tendons, Observer::joints};
      for (const BodyId body : seen) {
        options.observe.points.push_back({scene.at(SiteId(body.index())).position, body});
      }
      Batch batch(plan, options);
      batch.set_controls(std::span<const double>(
          Numbers(scene.controls.size() * static_cast<std::size_t>(batch.worlds()), 0.3)));
      const double near = pick(table, 1e-5, 1e-12);
      // What the state itself says.
      const auto expected = [&](int world) {
        Numbers out = numbers(batch, Observed::point_position, world);
        const Numbers q = numbers(batch, Observed::joint_position, world);
        const Numbers v = numbers(batch, Observed::joint_speed, world);
        for (const Tendon& tendon : scene.tendons) {
          double length = 0, velocity = 0;
          for (const TendonTerm& term : tendon.terms) {
            const auto at = static_cast<std::size_t>(plan.first_observed(term.joint));
            length += term.coefficient * q[at], velocity += term.coefficient * v[at];
          }
          out.push_back(length), out.push_back(velocity);
        }
        return out;
      };
      const auto check = [&](int world, const Numbers& wanted) {
        const Numbers sites = numbers(batch, Observed::site_position, world);
        Numbers found;
        for (const BodyId body : seen) {
          const auto at = sites.begin() + 3 * body.index();
          found.insert(found.end(), at, at + 3);
        }
        const Numbers length = numbers(batch, Observed::tendon_length, world);
        const Numbers velocity = numbers(batch, Observed::tendon_velocity, world);
        for (std::size_t t = 0; t < length.size(); ++t) {
          found.push_back(length[t]), found.push_back(velocity[t]);
        }
        REQUIRE(found.size() == wanted.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
          CHECK(found[i] == Approx(wanted[i]).epsilon(near).margin(near));
        }
        for (std::size_t c = 0; c < 3; ++c) {  // the world's
          CHECK(sites[sites.size() - 3 + c] == 1 + static_cast<double>(c));
        }
      };
      for (int call = 0; call < 4; ++call) {
        batch.look();
        std::vector<Numbers> before;
        for (int w = 0; w < batch.worlds(); ++w) {
          before.push_back(expected(w));
          check(w, before.back());
        }
        batch.step();
        for (int w = 0; w < batch.worlds(); ++w) check(w, before[static_cast<std::size_t>(w)]);
        batch.step(7);
      }
    }
  }
}

TEST_CASE("sites and tendons have the bits of their world alone, and change none",
          "[fast][observe][bits][newton]") {
  const Plan plan = compile(marked(robots()));
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<Numbers> reference;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const int worlds : {11, 3}) {
        BatchOptions options = options_of(table, worlds);
        options.seed = static_cast<std::uint64_t>(11 - worlds);
        Batch blind(plan, options);
        options.observe.what = {Observer::sites, Observer::tendons};
        Batch batch(plan, options);
        blind.step(12), batch.step(7), batch.step(5);
        CHECK(blind.hash() == batch.hash());
        std::vector<Numbers> all;
        for (int w = 0; w < worlds; ++w) {
          Numbers& own = all.emplace_back();
          for (const Observed what :
               {Observed::site_position, Observed::tendon_length, Observed::tendon_velocity}) {
            const Numbers v = numbers(batch, what, w);
            own.insert(own.end(), v.begin(), v.end());
          }
        }
        if (reference.empty()) reference = all;
        INFO(name(table) << ' ' << worlds);
        for (std::size_t w = 0; w < all.size(); ++w) {
          CHECK(same_bits(all[w], reference[reference.size() - all.size() + w]));
        }
      }
    }
    if (!reference.empty()) CHECK_FALSE(same_bits(reference[0], reference[1]));
  }
}

TEST_CASE("sites that make no sense are issues of the scene", "[fast][scene]") {
  Scene scene = robots();
  const int bodies = static_cast<int>(scene.bodies.size());
  scene.add(Site{"far", BodyId(bodies), Vec3(0, 0, 0)});
  scene.add(Site{"", BodyId(0), Vec3(0, std::numeric_limits<double>::infinity(), 0)});
  const std::vector<Issue> issues = validate(scene);
  REQUIRE(issues.size() == 2);
  CHECK(to_string(issues[0]) == "site 0 'far': body is " + std::to_string(bodies) +
                                    ", must be a body, or -1 for the world, up to " +
                                    std::to_string(bodies - 1));
  CHECK_THAT(to_string(issues[1]), Catch::StartsWith("site 1: position.y is inf m"));
}

}  // namespace manyworlds::test
