// Sleep: islands that rest stop, wake exactly when something reaches them, and change nobody's
// bits.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

BatchOptions sleeping(const Table& table, int worlds = 1, int threads = 1) {
  BatchOptions options = options_of(table, worlds, threads);
  options.sleep = true;
  return options;
}

// Two stacks of three boxes, 6 m apart.
Scene two_stacks(Space space) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  for (double x : {-3.0, 3.0})
    for (int i = 0; i < 3; ++i)
      scene.add(
          body_of(shape_of(cube_of(space, 0.5)), Vec3(x, 0, 0) + (0.5 + 1.0 * i) * up_of(space)));
  return scene;
}

int sleepers(const Batch& batch, int world, int first, int last) {
  int n = 0;
  for (int b = first; b <= last; ++b) n += batch.asleep(world, batch.body_in_row(b)) ? 1 : 0;
  return n;
}

// Stored normal impulses of the contacts of scene bodies from `first` on.
std::vector<double> impulses_above(const Batch& batch, int first) {
  std::vector<double> all;
  for (const Contact& c : batch.contacts(0))
    if (c.body_b.index() >= first) all.push_back(c.normal_impulse);
  return all;
}

// Impulses that reach different worlds at different times, by world and not by its place.
void disturb_worlds(Batch& batch, int first_world, int step) {
  for (int w = 0; w < batch.worlds(); ++w) {
    const int id = first_world + w;
    if (step % 90 != (id * 17) % 90 || id % 3 == 0) continue;
    const int body = id % batch.bodies(w);
    if (id % 2 == 0) batch.add_impulse(w, batch.body_in_row(body), Vec3(0, 300, 0));
    if (id % 2 == 1) batch.add_force(w, batch.body_in_row(body), Vec3(900, 0, 0));
  }
}

struct Result {
  std::vector<std::uint64_t> hash;
  std::vector<bool> rests;
  bool operator==(const Result&) const = default;
};

Result run_disturbed(const Plan& plan, const BatchOptions& options, int first, int steps) {
  Batch batch(plan, options);
  for (int i = 0; i < steps; ++i) {
    disturb_worlds(batch, first, i);
    batch.step();
  }
  Result result;
  for (int w = 0; w < batch.worlds(); ++w) {
    result.hash.push_back(batch.hash(w));
    result.rests.push_back(batch.asleep(w));
  }
  return result;
}

Scene lively_crowd(Space space) {
  Scene scene = crowd(space);
  scene.options.sleep.time = 0.1;  // so that some fall asleep soon
  scene.options.sleep.speed = 0.5;
  for (Body& body : scene.bodies) body.linear_drag = body.angular_drag = 1;  // nothing rolls away
  return scene;
}

}  // namespace

TEST_CASE("with sleep, bits do not depend on batch size, place, packing or threads",
          "[fast][sleep][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(lively_crowd(space));
    for (const Table& table : widest_tables()) {
      BatchOptions options = sleeping(table, 40);
      options.seed = 7;
      const Result reference = run_disturbed(plan, options, 0, 240);
      const auto resting = std::count(reference.rests.begin(), reference.rests.end(), true);
      INFO(name(table) << (space == Space::planar ? " planar " : " spatial ") << resting);
      CHECK(resting > 4);  // the test is about a mix
      CHECK(resting < 36);
      for (int threads : {2, 3}) {
        options.threads = threads;
        CHECK(run_disturbed(plan, options, 0, 240) == reference);
      }
      for (int n : {1, 3, 8, 13, 29}) {
        const int first = (11 * n) % (41 - n);
        options.threads = 1;
        options.worlds = n;
        options.seed = 7 + static_cast<std::uint64_t>(first);
        const Result part = run_disturbed(plan, options, first, 240);
        INFO("worlds " << n << " from " << first);
        CHECK(std::equal(part.hash.begin(), part.hash.end(), reference.hash.begin() + first));
        CHECK(std::equal(part.rests.begin(), part.rests.end(), reference.rests.begin() + first));
      }
    }
  }
}

TEST_CASE("with sleep, bits do not depend on the instruction set, the layout or the broad phase",
          "[fast][sleep][bits][one_thread]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<Result> results;
      for (BroadPhase broad :
           {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
        PlanOptions plan_options;
        plan_options.broad_phase = broad;
        const Plan plan = compile(lively_crowd(space), plan_options);
        for (Isa isa : available_isas()) {
          if (!has_table({isa, precision})) continue;
          for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
            BatchOptions options = sleeping({isa, precision}, 19);
            options.layout = layout;
            results.push_back(run_disturbed(plan, options, 0, 150));
            INFO(to_string(isa) << ' ' << to_string(layout) << ' ' << to_string(broad));
            CHECK(results.back() == results.front());
          }
        }
      }
    }
  }
}

TEST_CASE("a batch at rest executes no group step", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (const Table& table : widest_tables()) {
      Batch batch(compile(two_stacks(space)), sleeping(table, 21));
      batch.step(120);
      CHECK(batch.awake_fraction() == 0);
      const std::int64_t before = batch.group_steps();
      const std::uint64_t hash = batch.hash();
      batch.step(50);
      CHECK(batch.group_steps() == before);
      CHECK(batch.hash() == hash);
      // One world that moves costs one group.
      batch.add_impulse(13, batch.body_in_row(0), Vec3(500, 0, 0));
      batch.step(5);
      CHECK(batch.group_steps() == before + 5);
    }
  }
}

TEST_CASE("worlds that move are packed into as few groups as they fill", "[fast][sleep]") {
  for (const Table& table : widest_tables()) {
    Batch batch(compile(two_stacks(Space::spatial)), sleeping(table, 64));
    batch.step(120);
    REQUIRE(batch.awake_fraction() == 0);
    for (int w = 3; w < 64; w += 8) batch.add_impulse(w, batch.body_in_row(0), Vec3(500, 0, 0));
    const std::int64_t before = batch.group_steps();
    batch.step();
    CHECK(batch.group_steps() - before == (8 + batch.lanes() - 1) / batch.lanes());
    CHECK(batch.awake_fraction() == 8.0 / 64);
  }
}

TEST_CASE("an island sleeps and wakes for itself", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(compile(two_stacks(space)), sleeping(table));
      batch.step(120);
      REQUIRE(sleepers(batch, 0, 0, 5) == 6);
      const std::vector<double> before = values(batch, Field::position);
      const std::vector<double> carried = impulses_above(batch, 4);
      batch.add_impulse(0, batch.body_in_row(2), Vec3(400, 0, 0));
      CHECK(sleepers(batch, 0, 0, 2) == 0);  // its whole stack
      CHECK(sleepers(batch, 0, 3, 5) == 3);
      batch.step(10);
      CHECK(sleepers(batch, 0, 3, 5) == 3);
      const std::vector<double> after = values(batch, Field::position);
      const std::size_t half = before.size() / 2;
      CHECK(std::equal(before.begin() + static_cast<std::ptrdiff_t>(half), before.end(),
                       after.begin() + static_cast<std::ptrdiff_t>(half)));
      CHECK(before[0] != after[0]);
      // The sleeping stack has kept the impulses that carry it, though its world went on.
      CHECK(impulses_above(batch, 4) == carried);
      CHECK(*std::max_element(carried.begin(), carried.end()) > 0);
    }
  }
}

TEST_CASE("who sleeps wakes in the step in which something comes near", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = two_stacks(space);
    Body ball = body_of(shape_of(round_of(space, 0.3)), Vec3(-3, 0, 0) + 9 * up_of(space));
    ball.enabled = false;
    scene.add(ball);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), sleeping(table));
      batch.step(120);
      REQUIRE(batch.asleep(0));
      batch.spawn(0, batch.body_in_row(6), {ball.position});
      CHECK_FALSE(batch.asleep(0));
      double speed = 0, fall = 0;
      int steps = 0;
      while (sleepers(batch, 0, 0, 2) == 3 && steps < 120) {
        fall = velocity(batch, 0, 6).dot(up_of(space)) - speed;
        speed = velocity(batch, 0, 6).dot(up_of(space));
        batch.step();
        ++steps;
      }
      INFO(name(table) << " woke after " << steps);
      CHECK(steps > 50);  // about a second of free fall: nobody woke early
      CHECK(steps < 70);
      CHECK(fall == Approx(-10.0 / 60).epsilon(1e-4));  // up to then nothing held the ball
      CHECK(sleepers(batch, 0, 0, 2) == 0);
      CHECK(sleepers(batch, 0, 3, 5) == 3);
      batch.step(300);
      CHECK(batch.asleep(0));
    }
  }
}

TEST_CASE("forces, impulses, writes and lost supports wake", "[fast][sleep]") {
  const Space space = Space::spatial;
  for (const Table& table : widest_tables()) {
    const auto rested = [&] {
      Batch batch(compile(two_stacks(space)), sleeping(table, 2));
      batch.step(120);
      REQUIRE(batch.awake_fraction() == 0);
      return batch;
    };
    const auto awake = [](Batch batch, auto change) {
      change(batch);
      CHECK(batch.asleep(1));
      return sleepers(batch, 0, 0, 5) < 6;
    };
    CHECK(awake(rested(), [](Batch& b) { b.add_force(0, b.body_in_row(1), Vec3(1, 0, 0)); }));
    CHECK_FALSE(awake(rested(), [](Batch& b) { b.add_force(0, b.body_in_row(1), Vec3(0, 0, 0)); }));
    CHECK(awake(rested(), [](Batch& b) { b.add_torque(0, b.body_in_row(1), Vec3(0, 0, 1)); }));
    CHECK(awake(rested(), [](Batch& b) { b.add_impulse(0, b.body_in_row(1), Vec3(1, 0, 0)); }));
    CHECK(awake(rested(), [](Batch& b) {
      b.write(Field::linear_velocity, 0, values(b, Field::linear_velocity, 0));
    }));
    CHECK(awake(rested(), [](Batch& b) {
      const std::vector<std::uint8_t> mask = {1, 0};
      b.reset(mask);
    }));
    Batch batch = rested();
    batch.set_enabled(0, batch.body_in_row(0), false);
    CHECK(sleepers(batch, 0, 0, 2) == 0);
    CHECK(sleepers(batch, 0, 3, 5) == 3);
    batch.step(10);
    CHECK(velocity(batch, 0, 2).z() < -1);  // its support has gone
  }
}

TEST_CASE("a kinematic body wakes what it comes near, at rest it lets it sleep", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = two_stacks(space);
    Body pusher = body_of(shape_of(cube_of(space, 0.5)), Vec3(-6, 0, 0) + 0.6 * up_of(space),
                          Motion::kinematic);
    scene.add(pusher);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), sleeping(table));
      batch.step(120);
      REQUIRE(batch.asleep(0));
      set_vector(batch, Field::linear_velocity, 0, 6, Vec3(1, 0, 0));
      CHECK_FALSE(batch.asleep(0));
      batch.step(60);
      CHECK_FALSE(batch.asleep(0));
      CHECK(sleepers(batch, 0, 0, 5) == 6);  // 1 m away still
      batch.step(90);
      CHECK(sleepers(batch, 0, 0, 2) == 0);
      CHECK(sleepers(batch, 0, 3, 5) == 3);
    }
  }
}

TEST_CASE("lanes without a world rest, whatever its kinematic bodies do", "[fast][sleep]") {
  Scene scene = two_stacks(Space::spatial);
  Body pusher = body_of(shape_of(cube_of(Space::spatial, 0.2)), Vec3(0, 9, 5), Motion::kinematic);
  pusher.linear_velocity = Vec3(0, 0.1, 0);
  scene.add(pusher);
  for (const Table& table : widest_tables()) {
    Batch batch(compile(scene), sleeping(table));
    batch.step(120);
    CHECK_FALSE(batch.asleep(0));  // the pusher moves
    set_vector(batch, Field::linear_velocity, 0, 6, Vec3::Zero());
    batch.step(60);
    CHECK(batch.asleep(0));
    const std::int64_t before = batch.group_steps();
    batch.step(20);
    CHECK(batch.group_steps() == before);
  }
}

TEST_CASE("what is pulled and not held does not sleep", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double gravity : {0.0, 0.02}) {
      Scene scene = empty_scene(space, gravity);
      scene.add(ground(space));
      scene.add(body_of(shape_of(cube_of(space, 0.5)), 30 * up_of(space)));
      for (const Table& table : widest_tables()) {
        INFO(name(table) << " gravity " << gravity);
        const double mass = mass_properties(scene, scene.bodies[1]).mass;
        Batch batch(compile(scene), sleeping(table));
        if (gravity == 0) batch.add_force(0, batch.body_in_row(0), 0.02 * mass * up_of(space));
        batch.step(300);  // 5 s at 0.02 m/s^2
        CHECK(std::abs(position(batch, 0, 0).dot(up_of(space)) - 30) == Approx(0.25).epsilon(1e-3));
        CHECK_FALSE(batch.asleep(0, batch.body_in_row(0)));
        if (gravity == 0) set_vector(batch, Field::linear_velocity, 0, 0, Vec3::Zero());
        batch.step(60);
        CHECK(batch.asleep(0, batch.body_in_row(0)) ==
              (gravity == 0));  // at rest where nothing pulls
      }
    }
  }
}

TEST_CASE("a frozen world is the same whoever shares its group", "[fast][sleep][bits]") {
  const Plan plan = compile(lively_crowd(Space::spatial));
  for (const Table& table : widest_tables()) {
    BatchOptions options = sleeping(table, 24);
    Batch many(plan, options);
    options.worlds = 1;
    options.seed += 5;
    Batch one(plan, options);
    for (Batch* batch : {&many, &one}) {
      batch->step(20);
      batch->add_force(batch == &many ? 5 : 0, batch->body_in_row(2), Vec3(std::nan(""), 0, 0));
      batch->step(100);
    }
    CHECK(many.status(5) == Status::non_finite);
    CHECK(one.hash(0) == many.hash(5));
    for (int b = 0; b < one.bodies(); ++b)
      CHECK(one.asleep(0, one.body_in_row(b)) == many.asleep(5, many.body_in_row(b)));
    const auto a = one.contacts(0), c = many.contacts(5);
    REQUIRE(a.size() == c.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i].normal_impulse == c[i].normal_impulse);
  }
}

TEST_CASE("nobody sleeps who moves steadily", "[fast][sleep]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space);
    scene.add(ground(space, 0));
    Body box = body_of(shape_of(cube_of(space, 0.5), 0), 0.5 * up_of(space));
    box.linear_velocity = Vec3(0.1, 0, 0);
    scene.add(box);
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), sleeping(table));
      batch.step(600);
      CHECK_FALSE(batch.asleep(0));
      CHECK(position(batch, 0, 0).x() == Approx(1).epsilon(1e-3));
    }
  }
}

TEST_CASE("a pile sleeps within 5 s", "[slow][sleep]") {
  const Plan plan = compile(scenes::find("bin-boxes")->make());
  for (const Table& table : widest_tables()) {
    Batch batch(plan, sleeping(table, 64));
    batch.step(300);
    INFO(name(table) << " awake " << batch.awake_fraction());
    CHECK(batch.awake_fraction() < 0.05);
    CHECK(batch.lost_worlds() == 0);
  }
}

// A tall column is another matter: its slow sway is cut short, some millimetres from where it ends.
TEST_CASE("stacks lie where they lie without sleep", "[slow][sleep]") {
  for (const Scene& scene : {scenes::find("pyramid2d")->make(), two_stacks(Space::spatial)}) {
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch with(plan, sleeping(table, 16)), without(plan, options_of(table, 16));
      with.step(600);
      without.step(600);
      INFO(name(table) << ' ' << scene.name);
      CHECK(with.awake_fraction() == 0);
      double apart = 0;
      for (int w = 0; w < 16; ++w) {
        const auto a = values(with, Field::position, w), b = values(without, Field::position, w);
        for (std::size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(a[i] - b[i]));
      }
      CHECK(apart < 1e-3);
    }
  }
}

}  // namespace manyworlds::test
