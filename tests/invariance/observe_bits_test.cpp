// What observers see has bits of its world alone, and seeing changes no bit of the state.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

Observers everything(const Plan& plan) {
  const Space space = plan.scene().space;
  Observers observers;
  observers.what = {Observer::contacts, Observer::touching,    Observer::penetration,
                    Observer::motion,   Observer::joints,      Observer::joint_loads,
                    Observer::residual, Observer::acceleration};
  for (const Observer of_bodies :
       {Observer::links, Observer::link_forces, Observer::sites, Observer::drives}) {
    observers.what.push_back(of_bodies);
  }
  for (int i = 0; i < 12; ++i) {
    Ray ray;
    const double angle = 2 * kPi * i / 12;
    ray.direction = Vec3(std::cos(angle), std::sin(angle), space == Space::planar ? 0 : 0.1);
    ray.origin = 0.8 * up_of(space);
    ray.length = 4;
    if (i % 3 != 0) {
      ray.body = plan.body_in_row(i % 4);
      ray.origin.setZero();
    }
    observers.rays.push_back(ray);
    observers.points.push_back({Vec3(0.3, 0.1 * i, space == Space::planar ? 0 : -0.2),
                                plan.body_in_row(i % plan.bodies())});
  }
  return observers;
}

// All that was seen of a world, in a row; `but` what this observer sees.
std::vector<double> seen(const Batch& batch, int world, std::optional<Observer> but = {}) {
  std::vector<double> all;
  for (int i = 0; i < kObservedCount; ++i) {
    const auto what = static_cast<Observed>(i);
    if (info(what).observer == but) continue;
    if (!observable(info(what).observer, batch.plan().scene())) continue;
    std::vector<double> v(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
    batch.read(what, world, v);
    all.insert(all.end(), v.begin(), v.end());
  }
  for (const StepContact& c : batch.step_contacts(world)) {
    for (const Vec3& v : {c.normal, c.point, c.friction_impulse})
      all.insert(all.end(), v.data(), v.data() + 3);
    for (double x : {c.separation, c.normal_impulse, c.twist_impulse}) all.push_back(x);
    for (int x :
         {c.body_a.index(), c.body_b.index(), c.shape_a.index(), c.shape_b.index(), c.feature})
      all.push_back(x);
  }
  return all;
}

using Seen = std::vector<std::vector<double>>;  // [world]

bool same_bits(const Seen& a, const Seen& b, std::size_t first = 0) {
  for (std::size_t w = 0; w < a.size(); ++w) {
    const auto &x = a[w], &y = b[first + w];
    if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) != 0)
      return false;
  }
  return true;
}

Seen watch(const Plan& plan, BatchOptions options, int calls = 8, int steps = 5) {
  options.observe = everything(plan);
  Batch batch(plan, options);
  for (int i = 0; i < calls; ++i) batch.step(steps);
  Seen all;
  for (int w = 0; w < batch.worlds(); ++w) all.push_back(seen(batch, w));
  return all;
}

std::vector<Scene> scenes() {
  std::vector<Scene> all = {crowd(Space::planar), crowd(Space::spatial),
                            capsule_crowd(Space::planar, true), capsule_crowd(Space::spatial)};
  all.push_back(crowd(Space::spatial));
  for (Body& body : all.back().bodies) body.shapes[0].material.restitution = 0;
  all.push_back(varied_crowd(Space::spatial));
  for (const char* name : {"lunar-lander", "ragdoll"}) all.push_back(scenes::find(name)->make());
  return all;
}

}  // namespace

TEST_CASE("observers change no bit of the state", "[fast][observe][bits][one_thread]") {
  for (const Scene& scene : scenes()) {
    const Plan plan = compile(scene);
    for (const Table& table : all_tables()) {
      INFO(scene.name << ' ' << name(table));
      for (bool sleep : {false, true}) {
        BatchOptions options = options_of(table, 9);
        options.sleep = sleep;
        Batch blind(plan, options);
        options.observe = everything(plan);
        Batch seeing(plan, options);
        for (int i = 0; i < 12; ++i) {
          blind.step(i % 4 + 1), seeing.step(i % 4 + 1);
          if (i == 10) seeing.look();
        }
        CHECK(blind.hash() == seeing.hash());
      }
    }
  }
}

TEST_CASE("what is seen does not depend on instruction set or layout",
          "[fast][observe][bits][one_thread]") {
  for (const Scene& scene : scenes()) {
    const Plan plan = compile(scene);
    for (Precision precision : {Precision::f32, Precision::f64}) {
      Seen reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
          BatchOptions options = options_of(table, 11);
          options.layout = layout;
          const Seen found = watch(plan, options);
          if (reference.empty()) reference = found;
          INFO(scene.name << ' ' << name(table) << ' ' << to_string(layout));
          CHECK(same_bits(found, reference));
        }
      }
      if (reference.empty()) continue;
      CHECK_FALSE(same_bits({reference[0]}, reference, 1));  // worlds do differ
    }
  }
}

TEST_CASE("what is seen does not depend on threads", "[fast][observe][bits]") {
  for (const Scene& scene : scenes()) {
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(scene.name << ' ' << name(table));
      const Seen reference = watch(plan, options_of(table, 30));
      CHECK(same_bits(watch(plan, options_of(table, 30, 3)), reference));
    }
  }
}

TEST_CASE("what is seen does not depend on batch size, place or steps per call",
          "[fast][observe][bits][one_thread]") {
  for (const Scene& scene : scenes()) {
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(scene.name << ' ' << name(table));
      BatchOptions options = options_of(table, 30);
      options.seed = 5;
      const Seen reference = watch(plan, options);
      CHECK(same_bits(watch(plan, options, 40, 1), reference));
      CHECK(same_bits(watch(plan, options, 1, 40), reference));
      for (int n : {1, 3, 7, 13}) {
        options.worlds = n;
        options.seed = 5 + 11;
        CHECK(same_bits(watch(plan, options), reference, 11));
      }
    }
  }
}

// But accelerations: a state has none.
TEST_CASE("a look at the state leaves what steps saw of contacts as it was",
          "[fast][observe][one_thread]") {
  for (const Scene& scene : scenes()) {
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(scene.name << ' ' << name(table));
      BatchOptions options = options_of(table, 37);  // several groups, which differ
      options.observe = everything(plan);
      Batch batch(plan, options);
      batch.step(25);
      const auto all = [&batch] {
        Seen out;
        for (int w = 0; w < batch.worlds(); ++w) {
          out.push_back(seen(batch, w, Observer::acceleration));
        }
        return out;
      };
      const Seen before = all();
      batch.look();
      CHECK(same_bits(all(), before));
    }
  }
}

TEST_CASE("what is seen of sleepers does not depend on who is awake beside them",
          "[fast][observe][bits][one_thread]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = crowd(space);
    scene.options.sleep.time = 0.1;
    scene.options.sleep.speed = 0.5;
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 30);
      options.sleep = true;
      options.seed = 5;
      const Seen reference = watch(plan, options, 90);
      CHECK(same_bits(watch(plan, options, 1, 450), reference));
      int asleep = 0;
      {
        Batch batch(plan, options);
        batch.step(450);
        for (int w = 0; w < 30; ++w)
          for (int b = 0; b < batch.bodies(w); ++b)
            asleep += batch.asleep(w, batch.body_in_row(b)) ? 1 : 0;
      }
      CHECK(asleep > 20);
      CHECK(asleep < 200);
      for (int n : {1, 5}) {
        options.worlds = n;
        options.seed = 5 + 9;
        CHECK(same_bits(watch(plan, options, 225, 2), reference, 9));
      }
    }
  }
}

TEST_CASE("scenes without contacts are seen as well", "[fast][observe][bits]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = crowd(space);
    for (Body& body : scene.bodies) body.shapes[0].filter.mask = 0;
    const Plan plan = compile(scene);
    REQUIRE_FALSE(plan.has(Feature::contacts));
    Seen reference;
    for (const Table& table : all_tables()) {
      if (table.precision != Precision::f32) continue;
      const Seen found = watch(plan, options_of(table, 11));
      if (reference.empty()) reference = found;
      CHECK(same_bits(found, reference));
    }
  }
}

}  // namespace manyworlds::test
