// Plans without tables of pairs find the same pairs in the same order as plans with them, and so
// give the same bits.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "kernels/data/pair_keys.hpp"
#include "src/plan/plan_data.hpp"
#include "src/state/tables.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

Geometry shape_number(Space space, int i, double size) {
  if (space == Space::spatial) {
    if (i % 3 == 0) return Sphere{size};
    if (i % 3 == 1) return Box{Vec3(size, 0.8 * size, 0.7 * size)};
    return Capsule{0.5 * size, 0.6 * size};
  }
  if (i % 4 == 0) return Circle{size};
  if (i % 4 == 1) return Polygon::box(size, 0.7 * size);
  if (i % 4 == 2) return Polygon{{{-size, -size}, {size, -size}, {0, size}}};
  return Capsule{0.5 * size, 0.6 * size};
}

// Everything that decides about pairs: kinds, sizes from 1 to 4, filters, compounds, kinematic and
// disabled bodies, fixed obstacles, in the plane a terrain.
Scene mixture(Space space, int bodies) {
  const bool planar = space == Space::planar;
  Scene scene = empty_scene(space);
  scene.options.sleep.speed = 1;
  scene.options.sleep.time = 0.1;
  scene.add(ground(space, 0.5, 0.2));
  const int side = planar ? 10 : 4;
  for (int i = 0; i < bodies; ++i) {
    const double size = i % 11 == 0 ? 0.8 : 0.2 + 0.02 * (i % 7);
    const int layer = planar ? i / side : i / (side * side);
    const Vec3 at(0.65 * (i % side) + 0.1 * (layer % 2), planar ? 0 : 0.65 * (i / side % side), 0);
    Body body = body_of(shape_of(shape_number(space, i, size), 0.1 * (i % 5), i % 4 == 0 ? 0.4 : 0),
                        at + (0.7 + 0.65 * layer) * up_of(space));
    if (i % 6 == 0) {  // a compound
      body.shapes.push_back(shape_of(shape_number(space, i + 1, 0.2), 0.4));
      body.shapes.back().position = 0.2 * up_of(space);
    }
    if (i % 13 == 5) body.motion = Motion::kinematic, body.linear_velocity = Vec3(0.2, 0, 0);
    if (i % 13 == 7) body.motion = Motion::kinematic;
    if (i % 17 == 3) body.enabled = false;
    if (i % 9 == 2) body.shapes[0].filter = {2, 0xfffffffe};
    if (i % 9 == 4) body.shapes[0].filter = {4, 3};
    body.jitter.position = planar ? Vec3(0.05, 0.05, 0) : Vec3(0.05, 0.05, 0.05);
    body.jitter.angle = 1.5;
    body.linear_drag = body.angular_drag = 1;
    scene.add(body);
  }
  for (int i = 0; i < 6; ++i) {
    scene.add(
        body_of(shape_of(shape_number(space, i, 0.3), 0.4), Vec3(1.2 * i, 0.3, 0), Motion::fixed));
  }
  if (planar) {
    Terrain terrain;
    for (int i = 0; i <= 40; ++i) terrain.points.emplace_back(-3 + 0.4 * i, i % 2 == 0 ? 0.1 : 0.2);
    scene.add(body_of(shape_of(std::move(terrain)), Vec3::Zero(), Motion::fixed));
  }
  return scene;
}

Plan plan_of(const Scene& scene, BroadPhase broad_phase) {
  PlanOptions options;
  options.broad_phase = broad_phase;
  return compile(scene, options);
}

// What can be seen of a batch, bit for bit.
struct SeenWorld {
  std::vector<std::uint64_t> hash;
  std::vector<Status> status;
  std::vector<bool> asleep;
  std::vector<double> contacts;
  bool operator==(const SeenWorld&) const = default;
};
SeenWorld look(const Batch& batch) {
  SeenWorld seen;
  for (int w = 0; w < batch.worlds(); ++w) {
    seen.hash.push_back(batch.hash(w));
    seen.status.push_back(batch.status(w));
    for (int b = 0; b < batch.bodies(w); ++b)
      seen.asleep.push_back(batch.asleep(w, batch.body_in_row(b)));
    for (const Contact& c : batch.contacts(w)) {
      for (int n :
           {c.body_a.index(), c.shape_a.index(), c.body_b.index(), c.shape_b.index(), c.feature})
        seen.contacts.push_back(n);
      for (int k = 0; k < 3; ++k) seen.contacts.push_back(c.normal[k]);
      seen.contacts.push_back(c.separation);
      seen.contacts.push_back(c.normal_impulse);
    }
  }
  return seen;
}

// What a user may do between steps, of world `first` + w.
void disturb(Batch& batch, int first, int step) {
  for (int w = 0; w < batch.worlds(); ++w) {
    const int who = (first + w + step) % batch.bodies(w);
    if ((first + w + step) % 7 == 0) batch.set_enabled(w, batch.body_in_row(who), step % 2 == 0);
    if ((first + w + step) % 11 == 0)
      batch.add_impulse(w, batch.body_in_row(who), Vec3(0.5, 0.2, 0));
  }
}

SeenWorld run_sparse(const Plan& plan, const BatchOptions& options, int first, int steps) {
  Batch batch(plan, options);
  for (int i = 0; i < steps; ++i) {
    if (i > steps / 2) disturb(batch, first, i);
    batch.step();
  }
  return look(batch);
}

}  // namespace

TEST_CASE("places in the tournament count through all pairs", "[fast][sparse]") {
  for (int n : {2, 3, 4, 5, 8, 9, 64, 65, 100, 101}) {
    std::vector<int> met(static_cast<std::size_t>(n * n), 0);
    int place = 0, seats = n + n % 2;
    for (int round = 0; round + 1 < seats; ++round) {
      for (int table = 0; table < seats / 2; ++table, ++place) {
        const int x = table == 0 ? seats - 1 : (round + table) % (seats - 1);
        const int y = (round + seats - 1 - table) % (seats - 1);
        const int i = std::min(x, y), j = std::max(x, y);
        const auto pair = kernels::tournament_pair(n, place);
        CHECK((pair.a == i && pair.b == j));
        if (j >= n) continue;
        CHECK(kernels::tournament_place(n, i, j) == place);
        ++met[static_cast<std::size_t>(i * n + j)];
      }
    }
    CHECK(kernels::places_of_tournament(n) == place);
    CHECK(std::count(met.begin(), met.end(), 1) == n * (n - 1) / 2);
  }
}

TEST_CASE("plans with and without tables of pairs count alike", "[fast][sparse]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Scene scene = mixture(space, 90);
    const PlanReport listed = plan_of(scene, BroadPhase::all_pairs).report();
    const PlanReport sparse = plan_of(scene, BroadPhase::sparse).report();
    CHECK(sparse.broad_phase == BroadPhase::sparse);
    REQUIRE(listed.pairs.size() == sparse.pairs.size());
    for (std::size_t i = 0; i < listed.pairs.size(); ++i) {
      INFO(listed.pairs[i].kernel);
      CHECK(listed.pairs[i].kernel == sparse.pairs[i].kernel);
      CHECK(listed.pairs[i].kind == sparse.pairs[i].kind);
      CHECK(listed.pairs[i].candidates == sparse.pairs[i].candidates);
      CHECK(listed.pairs[i].culled == sparse.pairs[i].culled);
    }
    CHECK(listed.pair_capacity == sparse.pair_capacity);
    CHECK(listed.fixed_capacity == sparse.fixed_capacity);
    for (std::size_t i = 0; i < listed.features.size(); ++i)
      CHECK(listed.features[i].in == sparse.features[i].in);
  }
}

TEST_CASE("the keys of a sparse plan are the pairs that others list, in their order",
          "[fast][sparse]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (int bodies : {20, 71}) {
      const Plan listed_plan = plan_of(mixture(space, bodies), BroadPhase::all_pairs);
      const Plan sparse_plan = plan_of(mixture(space, bodies), BroadPhase::sparse);
      const TablesOf<float> listed_tables(listed_plan.data(), BatchOptions{}, 1);
      const TablesOf<float> sparse_tables(sparse_plan.data(), BatchOptions{}, 1);
      const auto &listed = listed_tables.get(), &sparse = sparse_tables.get();
      REQUIRE(listed.classes == sparse.classes);
      for (int c = 0; c < listed.classes; ++c) {
        const auto &a = listed.pair_class[c], &b = sparse.pair_class[c];
        CHECK((a.kind == b.kind && a.list == b.list));
        int found = 0, same = 0;
        for (int place = 0; place < b.count; ++place) {
          const std::int32_t key = b.first_key + place;
          if (!kernels::is_key(sparse, b.list, key)) continue;
          const auto pair = kernels::pair_of_key(sparse, key);
          same += found < a.count && pair.a == a.a[found] && pair.b == a.b[found] ? 1 : 0;
          ++found;
        }
        CHECK(found == a.count);
        CHECK(same == a.count);
      }
      const auto& last = sparse.pair_class[sparse.classes - 1];
      CHECK_FALSE(kernels::is_key(sparse, last.list, last.first_key + last.count));
      CHECK_FALSE(kernels::is_key(sparse, last.list, -1));
    }
  }
}

TEST_CASE("the default lists pairs of up to 512 moving shapes", "[fast][sparse]") {
  const auto balls = [](Space space, int n, int fixed) {
    Scene scene = empty_scene(space);
    for (int i = 0; i < n; ++i)
      scene.add(body_of(shape_of(round_of(space, 0.5)), 1.5 * i * Vec3::UnitX()));
    for (int i = 0; i < fixed; ++i) {
      scene.add(body_of(shape_of(round_of(space, 0.5)), Vec3(1.5 * i, 3, 0), Motion::fixed));
    }
    return compile(scene).report().broad_phase;
  };
  CHECK(balls(Space::planar, 47, 0) == BroadPhase::all_pairs);
  CHECK(balls(Space::planar, 48, 0) == BroadPhase::sort_and_sweep);
  CHECK(balls(Space::spatial, 64, 512) == BroadPhase::all_pairs);
  for (Space space : {Space::planar, Space::spatial}) {
    CHECK(balls(space, 512, 0) != BroadPhase::sparse);
    CHECK(balls(space, 513, 0) == BroadPhase::sparse);
    CHECK(balls(space, 32, 1025) == BroadPhase::sparse);
  }
}

TEST_CASE("sparse plans give the bits of plans with tables", "[fast][sparse][bits][one_thread]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (int bodies : {20, 65, 120}) {
      const Scene scene = mixture(space, bodies);
      const Plan listed = plan_of(scene, BroadPhase::all_pairs);
      const Plan sparse = plan_of(scene, BroadPhase::sparse);
      for (const Table& table : widest_tables()) {
        for (bool sleep : {false, true}) {
          BatchOptions options = options_of(table, 11);
          options.sleep = sleep;
          const SeenWorld wanted = run_sparse(listed, options, 0, 60);
          INFO(name(table) << " sleep " << sleep << " bodies " << bodies << " planar "
                           << (space == Space::planar));
          CHECK(wanted.contacts.size() > 100);
          CHECK((!sleep || std::count(wanted.asleep.begin(), wanted.asleep.end(), true) > 0));
          CHECK(run_sparse(sparse, options, 0, 60) == wanted);
        }
      }
    }
  }
}

TEST_CASE("sparse plans give the same bits on every table, layout, lane and thread",
          "[sparse][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = plan_of(mixture(space, 80), BroadPhase::sparse);
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<SeenWorld> seen;
      for (Isa isa : available_isas()) {
        if (!has_table({isa, precision})) continue;
        for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
          BatchOptions options = options_of({isa, precision}, 19);
          options.sleep = true;
          options.layout = layout;
          options.threads = layout == ContactLayout::dense ? 1 : 2;
          seen.push_back(run_sparse(plan, options, 0, 40));
          INFO(to_string(isa) << ' ' << to_string(precision) << ' ' << to_string(layout));
          CHECK(seen.back() == seen.front());
          for (int n : {1, 5}) {  // other lanes, and lanes without a world
            options.worlds = n;
            options.seed = static_cast<std::uint64_t>(9 - n);
            const SeenWorld part = run_sparse(plan, options, 9 - n, 40);
            CHECK(
                std::equal(part.hash.begin(), part.hash.end(), seen.front().hash.begin() + 9 - n));
          }
        }
      }
    }
  }
}

TEST_CASE("what a full list leaves out does not depend on the tables", "[fast][sparse][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = mixture(space, 80);
    scene.options.contact_capacity = 4;
    for (const Table& table : widest_tables()) {
      const BatchOptions options = options_of(table, 9);
      const SeenWorld listed = run_sparse(plan_of(scene, BroadPhase::all_pairs), options, 0, 30);
      const SeenWorld sparse = run_sparse(plan_of(scene, BroadPhase::sparse), options, 0, 30);
      INFO(name(table));
      CHECK(std::count(listed.status.begin(), listed.status.end(), Status::contact_overflow) > 4);
      CHECK(listed == sparse);
    }
  }
}

TEST_CASE("casts between moving shapes are the same in sparse plans", "[fast][sparse][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = mixture(space, 70);
    scene.options.contact.cast_between_moving = true;
    for (std::size_t i = 1; i < 70; i += 7)
      scene.bodies[i].linear_velocity = Vec3(i < 35 ? 120 : -120, 0, 0) - 30 * up_of(space);
    for (const Table& table : widest_tables()) {
      const BatchOptions options = options_of(table, 9);
      const SeenWorld listed = run_sparse(plan_of(scene, BroadPhase::all_pairs), options, 0, 20);
      CHECK(run_sparse(plan_of(scene, BroadPhase::sparse), options, 0, 20) == listed);
      scene.options.contact.cast_between_moving = false;
      CHECK_FALSE(run_sparse(plan_of(scene, BroadPhase::sparse), options, 0, 20) == listed);
      scene.options.contact.cast_between_moving = true;
    }
  }
}

TEST_CASE("far from the origin and at any scale a sweep loses no pair", "[fast][sparse]") {
  for (double offset : {0.0, 300.0, 1e5}) {
    for (double scale : {0.01, 1.0, 100.0}) {
      Scene scene = empty_scene(Space::spatial);
      scene.options.length_unit = scale;
      scene.options.gravity.setZero();
      for (int i = 0; i < 100; ++i) {
        Body ball = body_of(shape_of(Sphere{0.5 * scale}),
                            scale * Vec3(offset + i % 5, i / 5 % 5 * 1.01, i / 25 * 0.99));
        scene.add(ball);
      }
      for (const Table& table : all_tables()) {
        INFO(name(table) << " offset " << offset << " scale " << scale);
        Batch listed(plan_of(scene, BroadPhase::all_pairs), options_of(table));
        Batch sparse(plan_of(scene, BroadPhase::sparse), options_of(table));
        CHECK(look(listed) == look(sparse));
        listed.step(3);
        sparse.step(3);
        CHECK(look(listed) == look(sparse));
      }
    }
  }
}

TEST_CASE("a sparse plan without moving shapes or with one has no pairs", "[fast][sparse]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(ground(space));
    scene.add(body_of(shape_of(cube_of(space, 0.5)), 0.5 * up_of(space)));
    const Plan one = plan_of(scene, BroadPhase::sparse);
    for (const Table& table : widest_tables()) {
      Batch batch(one, options_of(table, 3));
      batch.step(10);
      CHECK(batch.contacts(1).size() == (space == Space::planar ? 2 : 4));
    }
    scene.bodies.pop_back();
    CHECK_FALSE(plan_of(scene, BroadPhase::sparse).has(Feature::contacts));
  }
}

TEST_CASE("more pairs than keys are an error", "[fast][sparse][one_thread]") {
  Scene scene = empty_scene(Space::spatial);
  for (int i = 0; i < 32000; ++i) {
    scene.add(body_of(shape_of(shape_number(Space::spatial, i, 0.3)), Vec3(i, 0, 0)));
  }
  try {
    compile(scene);
    FAIL("no error");
  } catch (const SceneError& error) {
    REQUIRE(error.issues().size() == 1);
    CHECK(error.issues()[0].place == "shapes");
    CHECK(error.issues()[0].message.find("must be at most 2147483646") != std::string::npos);
  }
}

}  // namespace manyworlds::test
