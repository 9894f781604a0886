// A world's bits depend on its plan, its initial state and its inputs, and on nothing else.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::uint64_t> run(const Plan& plan, const BatchOptions& options, int steps) {
  Batch batch(plan, options);
  batch.step(steps);
  for (int w = 0; w < batch.worlds(); ++w) {
    INFO("world " << w << ' ' << to_string(batch.status(w)));
    CHECK_FALSE(frozen(batch.status(w)));
  }
  return hashes(batch);
}

const std::vector<ContactLayout> kLayouts = {ContactLayout::automatic, ContactLayout::dense,
                                             ContactLayout::rows};

}  // namespace

TEST_CASE("AVX-512 is among the tested instruction sets", "[fast][bits]") {
  if (std::getenv("MANYWORLDS_ISA") != nullptr) return;
  const auto isas = available_isas();
  REQUIRE(!isas.empty());
  CHECK(isas.front() == Isa::scalar);
  CHECK(std::is_sorted(isas.begin(), isas.end()));
  if (std::find(isas.begin(), isas.end(), Isa::avx512) == isas.end())
    WARN("AVX-512 is not available here: its kernels were not tested");
  if (std::find(isas.begin(), isas.end(), Isa::avx2) == isas.end())
    WARN("AVX2 is not available here: its kernels were not tested");
  for (Isa isa : isas) {
    CHECK(has_table({isa, Precision::f32}));
    if (isa != Isa::avx512 && !has_table({isa, Precision::f64}))
      WARN("this build has no float64 kernels for " << to_string(isa));
  }
}

TEST_CASE("bits do not depend on the batch size or the position in it", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 40);
      options.seed = 100;
      const auto reference = run(plan, options, 20);
      std::vector<std::uint64_t> sorted = reference;
      std::sort(sorted.begin(), sorted.end());
      CHECK(std::unique(sorted.begin(), sorted.end()) == sorted.end());  // worlds do differ
      for (int n = 1; n < 40; ++n) {
        // Batch of n worlds that starts at world `first` of the reference: every world is met in
        // several lanes and groups.
        const int first = (7 * n) % (41 - n);
        options.worlds = n;
        options.seed = 100 + static_cast<std::uint64_t>(first);
        const auto part = run(plan, options, 20);
        INFO("worlds " << n << " from " << first);
        CHECK(std::equal(part.begin(), part.end(), reference.begin() + first));
      }
    }
  }
}

TEST_CASE("a force in one world changes no other world's bits", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double gravity : {0.0, 9.81, 9.80665, 3.7}) {
      for (bool contacts : {false, true}) {
        Scene scene = crowd(space);
        scene.options.gravity = -gravity * up_of(space);
        for (Body& body : scene.bodies) {
          if (!contacts) body.shapes[0].filter.mask = 0;
          if (body.motion == Motion::dynamic) body.angular_velocity.z() = -0.0;
        }
        const Plan plan = compile(scene);
        for (const Table& table : all_tables()) {
          INFO(name(table) << " gravity " << gravity << " contacts " << contacts);
          Batch disturbed(plan, options_of(table, 19)), quiet(plan, options_of(table, 19));
          for (int i = 0; i < 5; ++i) {
            disturbed.add_force(4, disturbed.body_in_row(1), Vec3(3, 2, 0));
            disturbed.add_torque(4, disturbed.body_in_row(2), Vec3(0, 0, 1));
            disturbed.step(2);
            quiet.step(2);
          }
          for (int w = 0; w < 19; ++w) CHECK((disturbed.hash(w) == quiet.hash(w)) == (w != 4));
        }
      }
    }
  }
}

TEST_CASE("bits do not depend on the number of threads", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 70);
      const auto reference = run(plan, options, 20);
      for (int threads = 2; threads <= 4; ++threads) {
        options.threads = threads;
        INFO("threads " << threads);
        CHECK(run(plan, options, 20) == reference);
      }
    }
  }
}

TEST_CASE("bits do not depend on the instruction set, the layout or the broad phase",
          "[fast][bits]") {
  for (Scene scene :
       {crowd(Space::planar, 12), crowd(Space::spatial, 12), capsule_crowd(Space::planar),
        capsule_crowd(Space::planar, true), capsule_crowd(Space::spatial)}) {
    scene.options.contact.cast_between_moving = true;  // the tenth body is fast enough for it
    scene.bodies[11].linear_velocity = Vec3(-80, 0, 0) - 20 * up_of(scene.space);
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (BroadPhase broad :
           {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
        PlanOptions plan_options;
        plan_options.broad_phase = broad;
        const Plan plan = compile(scene, plan_options);
        for (Isa isa : available_isas()) {
          if (!has_table({isa, precision})) continue;
          for (ContactLayout layout : kLayouts) {
            BatchOptions options = options_of({isa, precision}, 19);
            options.layout = layout;
            const auto result = run(plan, options, 25);
            if (reference.empty()) reference = result;
            INFO(to_string(isa) << ' ' << to_string(precision) << ' ' << to_string(layout) << ' '
                                << to_string(broad) << ' ' << scene.name);
            CHECK(result == reference);
          }
        }
      }
    }
  }
}

TEST_CASE("every named scene has the same bits on every table, layout and broad phase",
          "[slow][bits]") {
  for (const scenes::Entry& entry : scenes::all()) {
    const Scene scene = entry.make();
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (BroadPhase broad :
           {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
        PlanOptions plan_options;
        plan_options.broad_phase = broad;
        const Plan plan = compile(scene, plan_options);
        for (Isa isa : available_isas()) {
          if (!has_table({isa, precision})) continue;
          // Every instruction set with both layouts, and the widest with every broad phase and the
          // choice of layouts.
          const bool widest = isa == widest_of(precision);
          if (!widest && broad != BroadPhase::sort_and_sweep) continue;
          for (ContactLayout layout : kLayouts) {
            if (layout == ContactLayout::automatic && !widest) continue;
            BatchOptions options = options_of({isa, precision}, 21);
            options.layout = layout;
            options.threads = layout == ContactLayout::dense ? 1 : 2;
            const auto result = run(plan, options, 90);
            if (reference.empty()) reference = result;
            INFO(entry.name << ' ' << to_string(isa) << ' ' << to_string(precision) << ' '
                            << to_string(layout) << ' ' << to_string(broad));
            CHECK(result == reference);
          }
        }
      }
    }
  }
}

TEST_CASE("many steps in one call have the bits of one step at a time", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : widest_tables()) {
      Batch one(plan, options_of(table, 20)), many(plan, options_of(table, 20));
      for (int i = 0; i < 32; ++i) one.step();
      many.step(32);
      CHECK(hashes(one) == hashes(many));
      CHECK(one.hash() == many.hash());
      CHECK(one.steps() == 32);
      CHECK(many.time() == Approx(one.time()));
    }
  }
}

TEST_CASE("switched-off stages change no bits when kept", "[fast][bits]") {
  // Frictionless balls without gravity or drag leave most features out.
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    for (int i = 0; i < 5; ++i) {
      Body ball = body_of(shape_of(round_of(space, 0.4), 0, 0), Vec3(0.9 * i, 0.1 * i, 0));
      ball.linear_velocity = Vec3(2.0 - i, 0, 0);
      ball.jitter.position = Vec3(0.05, 0.2, 0);
      scene.add(ball);
    }
    PlanOptions all;
    for (int f = 0; f < kFeatureCount; ++f) all.keep.push_back(static_cast<Feature>(f));
    const Plan lean = compile(scene), full = compile(scene, all);
    for (int f = 0; f < kFeatureCount; ++f) CHECK(full.has(static_cast<Feature>(f)));
    CHECK_FALSE(lean.has(Feature::friction));
    CHECK_FALSE(lean.has(Feature::gravity));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch a(lean, options_of(table, 9)), b(full, options_of(table, 9));
      a.step(60);
      b.step(60);
      for (int w = 0; w < 9; ++w) {
        for (Field field : {Field::position, Field::linear_velocity})
          CHECK(same_bits(values(a, field, w), values(b, field, w)));
      }
    }
  }
}

// Neighbours in the same group that keep contact blocks running must not touch a world whose blocks
// are idle: not even the sign of its zeros.
TEST_CASE("busy neighbours leave negative zeros alone", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    const std::vector<Geometry> shapes = {round_of(space, 0.5), cube_of(space, 0.5),
                                          cube_of(space, 0.4), round_of(space, 0.4)};
    for (std::size_t i = 0; i < shapes.size(); ++i)
      scene.add(body_of(shape_of(shapes[i], 0.5, 0.5), Vec3(3.0 * static_cast<double>(i), 5, 5)));
    if (space == Space::planar)
      for (Body& b : scene.bodies) b.position.z() = 0;
    scene.add(ground(space, 0.5, 0.5));
    const Plan plan = compile(scene);
    for (const Table& table : all_tables()) {
      for (ContactLayout layout : kLayouts) {
        INFO(name(table) << ' ' << to_string(layout));
        BatchOptions options = options_of(table, 32);
        options.layout = layout;
        Batch quiet(plan, options), busy(plan, options);
        const std::vector<int> watched = {0, 3, 6, 13, 31};
        for (Batch* batch : {&quiet, &busy}) {
          for (int w : watched) {
            for (Field field : {Field::linear_velocity, Field::angular_velocity}) {
              std::vector<double> v = values(*batch, field, w);
              for (std::size_t i = 0; i < v.size(); ++i) v[i] = i % 5 == 4 ? 0.25 : -0.0;
              batch->write(field, w, v);
            }
          }
        }
        for (int w = 0; w < 32; ++w) {
          if (std::find(watched.begin(), watched.end(), w) != watched.end()) continue;
          for (int b = 0; b < 4; ++b) {  // a heap on the ground, moving
            set_vector(busy, Field::position, w, b,
                       Vec3(0.5 * b, 0, 0) + (0.45 + 0.1 * b) * up_of(space));
            set_vector(busy, Field::linear_velocity, w, b, Vec3(1.0 - b, 0, 0) - up_of(space));
          }
        }
        for (int i = 0; i < 12; ++i) {
          quiet.step();
          busy.step();
          for (int w : watched) {
            INFO("step " << i << " world " << w);
            REQUIRE(same_bits(state(quiet, w), state(busy, w)));
            REQUIRE(quiet.hash(w) == busy.hash(w));
          }
        }
        CHECK(busy.hash(1) != quiet.hash(1));
      }
    }
  }
}

TEST_CASE("a body without an orientation freezes its world", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (const bool contacts : {false, true}) {
      Scene scene = crowd(space);
      for (Body& body : scene.bodies) {
        if (!contacts) body.shapes[0].filter.mask = 0;
      }
      const Plan plan = compile(scene);
      for (const Table& table : all_tables()) {
        INFO(name(table) << " contacts " << contacts);
        Batch spoilt(plan, options_of(table, 9)), sound(plan, options_of(table, 9));
        std::vector<double> q = values(spoilt, Field::orientation, 4);
        const auto n = static_cast<std::size_t>(components(Field::orientation, space));
        std::fill_n(q.begin() + static_cast<std::ptrdiff_t>(n), n, 0.0);
        spoilt.write(Field::orientation, 4, q);
        spoilt.step(3), sound.step(3);
        CHECK(has(spoilt.status(4), Status::out_of_range));
        for (int w = 0; w < 9; ++w) CHECK((spoilt.hash(w) == sound.hash(w)) == (w != 4));
      }
    }
  }
}

TEST_CASE("a world with a NaN is frozen and flagged, the others keep their bits", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      for (ContactLayout layout : kLayouts) {
        BatchOptions options = options_of(table, 18);
        options.layout = layout;
        Batch good(plan, options);
        good.step(15);
        for (int f = 0; f < kFieldCount; ++f) {
          const Field field = static_cast<Field>(f);
          if (plan.numbers(field) == 0) continue;  // of trees, of which there are none
          INFO(name(table) << ' ' << to_string(layout) << ' ' << info(field).name);
          Batch bad(plan, options);
          std::vector<double> v = values(bad, field, 5);
          v[1] = kNan;
          bad.write(field, 5, v);
          const std::vector<double> before = state(bad, 5);
          bad.step(15);
          CHECK(has(bad.status(5), Status::non_finite));
          CHECK(frozen(bad.status(5)));
          CHECK(lost(bad.status(5)));
          CHECK(bad.lost_worlds() == 1);
          CHECK(same_bits(state(bad, 5), before));
          for (int w = 0; w < 18; ++w)
            if (w != 5) CHECK((bad.hash(w) == good.hash(w) && bad.status(w) == good.status(w)));
        }
      }
    }
  }
}

TEST_CASE("an absurd force freezes its world before the step, the others keep their bits",
          "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      for (double force : {kNan, 1e30, -std::numeric_limits<double>::infinity()}) {
        for (int kind = 0; kind < 2; ++kind) {
          INFO(name(table) << " force " << force << (kind == 0 ? "" : " as torque"));
          Batch good(plan, options_of(table, 18)), bad(plan, options_of(table, 18));
          good.step(12);
          bad.step(12);
          const std::vector<double> before = state(bad, 7);
          if (kind == 0) {
            bad.add_force(7, bad.body_in_row(2), Vec3(0, force, 0));
          } else {
            bad.add_torque(7, bad.body_in_row(2), Vec3(0, 0, force));
          }
          for (int i = 0; i < 3; ++i) {
            bad.step(2);
            good.step(2);
            CHECK(frozen(bad.status(7)));
            CHECK(same_bits(state(bad, 7), before));
            for (int w = 0; w < 18; ++w)
              if (w != 7) CHECK((bad.hash(w) == good.hash(w) && bad.status(w) == good.status(w)));
          }
          // A reset brings it back.
          std::vector<std::uint8_t> mask(18, 0);
          mask[7] = 1;
          bad.reset(mask);
          CHECK(bad.status(7) == Status::ok);
          bad.step(5);
          CHECK(bad.status(7) == Status::ok);
        }
      }
    }
  }
}

TEST_CASE("positions and speeds out of range freeze a world", "[fast][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const Plan plan = compile(crowd(space));
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch batch(plan, options_of(table, 3));
      set_vector(batch, Field::position, 0, 1, Vec3(2e10, 0, 0));
      set_vector(batch, Field::linear_velocity, 2, 1, Vec3(2e5, 0, 0));
      batch.step();
      CHECK(has(batch.status(0), Status::out_of_range));
      CHECK(batch.status(1) == Status::ok);
      CHECK(has(batch.status(2), Status::out_of_range));
      CHECK(batch.lost_worlds() == 2);
    }
  }
}

}  // namespace manyworlds::test
