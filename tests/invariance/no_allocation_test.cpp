// step() allocates nothing. This unit counts the heap's calls while asked to: it replaces the
// global operators new and delete of the test program, or, under a sanitizer, hooks into its
// allocator, whose checks of new against delete would be lost with the operators.
#include <catch2/catch.hpp>

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#if defined(__has_feature)  // clang's way of saying what GCC says by a macro
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// GCC installs the function but not the header, sanitizer/allocator_interface.h.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));
#endif

#include "manyworlds/scenes.hpp"
#include "manyworlds/tasks.hpp"
#include "src/api/memory.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/tables.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<long> calls{0};

void note() {
  if (counting.load(std::memory_order_relaxed)) calls.fetch_add(1, std::memory_order_relaxed);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { note(); }, [](const volatile void*) { note(); });

}  // namespace

#else

std::atomic<long> bytes{0};  // in use more than when the counting began

void* allocate(std::size_t size, std::size_t alignment) {
  note();
  if (size == 0) size = 1;
  void* p = nullptr;
  if (alignment <= alignof(std::max_align_t)) {
    p = std::malloc(size);
  } else {
    p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  }
  if (p == nullptr) throw std::bad_alloc();
  if (counting.load(std::memory_order_relaxed)) bytes += static_cast<long>(malloc_usable_size(p));
  return p;
}

void release(void* p) noexcept {
  if (p != nullptr) note();
  if (counting.load(std::memory_order_relaxed)) bytes -= static_cast<long>(malloc_usable_size(p));
  std::free(p);
}

}  // namespace

// NOLINTBEGIN(misc-new-delete-overloads)
void* operator new(std::size_t size) { return allocate(size, 1); }
void* operator new[](std::size_t size) { return allocate(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }
void operator delete(void* p, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { release(p); }
// NOLINTEND(misc-new-delete-overloads)

#endif

namespace manyworlds::test {
namespace {

// The heap's calls while `work` runs once; the fewest of that many `rounds`, up to a first with
// none.
template <class Work>
long calls_during(Work work, int rounds = 1) {
  long fewest = 0;
  for (int round = 0; round < rounds; ++round) {
    calls = 0;
    counting = true;
    work();
    counting = false;
    fewest = round == 0 ? calls.load() : std::min(fewest, calls.load());
    if (fewest == 0) break;
  }
  return fewest;
}

#if defined(__SANITIZE_THREAD__)
constexpr int kMaxThreads = 1;  // oneTBB's stand-in starts a thread anew for every step
#else
constexpr int kMaxThreads = 2;
#endif

void check_scene(const Scene& scene) {
  const Plan plan = compile(scene);
  for (const Table& table : widest_tables()) {
    for (int threads = 1; threads <= kMaxThreads; ++threads) {
      // A second thread sets itself up when the scheduler first runs it, at whatever step that is.
      const int rounds = threads == 1 ? 1 : 10;
      Batch batch(plan, options_of(table, 100, threads));
      batch.step();
      INFO(scene.name << ' ' << name(table) << ", " << threads << " threads");
      CHECK(calls_during(
                [&] {
                  for (int i = 0; i < 40; ++i) batch.step();
                  batch.step(16);
                },
                rounds) == 0);
      CHECK(calls_during([&] { batch.step_to(batch.time() + 0.1); }, rounds) == 0);
      batch.add_force(3, batch.body_in_row(0), Vec3(1, 0, 0));  // the first one may allocate
      batch.step();
      CHECK(calls_during(
                [&] {
                  batch.add_force(5, batch.body_in_row(0), Vec3(1, 0, 0));
                  batch.add_torque(50, batch.body_in_row(0), Vec3(0, 0, 1));
                  batch.add_impulse(7, batch.body_in_row(0), Vec3(0.1, 0, 0));
                  batch.step();
                },
                rounds) == 0);
      std::vector<std::uint8_t> some(100, 0);
      some[3] = some[40] = some[41] = 1;
      batch.step(some);
      CHECK(calls_during([&] { batch.step(some, 3); }, rounds) == 0);
    }
  }
}

}  // namespace

TEST_CASE("the counter counts", "[fast][allocation]") {
  CHECK(calls_during([] {
          ::operator delete(::operator new(3));  // a new expression could be optimised away
        }) == 2);
}

TEST_CASE("stepping allocates nothing", "[slow][allocation]") {
  for (const char* scene :
       {"bin-boxes", "bin2d", "mixed-pile", "ball3d", "chain2d", "chain3d", "free-flight"}) {
    const scenes::Entry* entry = scenes::find(scene);
    REQUIRE(entry != nullptr);
    check_scene(entry->make());
  }
}

TEST_CASE("stepping by any solver allocates nothing", "[fast][allocation][solver]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (int i = 0; i <= static_cast<int>(Solver::penalty); ++i) {
      Scene scene = crowd(space);
      scene.add(joint_at(scene, BodyId(2), BodyId(3), {}, HingeJoint{}));
      scene.options.solver.method = static_cast<Solver>(i);
      scene.options.solver.split_impulse = i % 2 == 0;
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table, 40));
        batch.step();
        CHECK(calls_during([&] { batch.step(100); }) == 0);
      }
    }
  }
}

TEST_CASE("stepping trees allocates nothing", "[fast][allocation][newton]") {
  Scene wet = newton_robot();
  wet.options.solver.cone = FrictionCone::elliptic;
  wet.options.medium = {.density = 100, .viscosity = 0.2};
  Scene implicit = newton_robot();
  implicit.options.integrator = Integrator::implicit_fast;
  for (const Scene& scene : {newton_pendulum(), newton_robot(), wet, implicit}) {
    for (const Table& table : widest_tables()) {
      BatchOptions options = options_of(table, 40);
      for (const bool observed : {false, true}) {
        if (observed) {
          options.observe.what = {Observer::contacts, Observer::motion, Observer::joints,
                                  Observer::joint_loads, Observer::acceleration};
        }
        Batch batch(compile(scene), options);
        batch.step();
        CHECK(calls_during([&] { batch.step(100); }) == 0);
      }
    }
  }
}

TEST_CASE("steps of tasks allocate nothing, with the worlds that begin anew in them",
          "[fast][allocation][task]") {
  for (const tasks::Entry& entry : tasks::all()) {
    Task task = entry.make();
    task.max_steps = 11;
    task.levels = {{"episodes", 0, terms::level("episodes") + 1}};
    task.observations.push_back({"level", terms::level("episodes")});
    task.observations.push_back({"late", terms::delayed(task.observations[0].value, 3)});
    Variation friction = vary(Parameter::friction, 0, 2, Draw::none);
    friction.shape = ShapeId(BodyId(0), 0);
    task.scene.variations = {friction};
    const Expression of = terms::parameter(Parameter::friction, friction.shape);
    task.initial_parameters = {{of, 0.1 * terms::level("episodes")}};
    for (const Autoreset autoreset : {Autoreset::next_step, Autoreset::same_step}) {
      Played p(task, {.worlds = 40, .threads = 1, .autoreset = autoreset});
      p.step();
      INFO(task.name);
      CHECK(calls_during([&] {
              for (int step = 0; step < 30; ++step) {
                p.act_at_random(step);
                p.step();
              }
            }) == 0);
    }
  }
}

TEST_CASE("falling asleep, packing, waking and disabling allocate nothing", "[fast][allocation]") {
  Scene scene = crowd(Space::planar);
  scene.options.sleep.time = 0.1;
  scene.options.sleep.speed = 0.5;
  for (const Table& table : widest_tables()) {
    BatchOptions options = options_of(table, 40);
    options.sleep = true;
    Batch batch(compile(scene), options);
    batch.add_force(0, batch.body_in_row(0), Vec3(1, 0, 0));
    batch.step();
    CHECK(calls_during([&] {
            for (int i = 0; i < 200; ++i) {
              batch.step();
              if (i % 20 == 0) batch.add_impulse(i % 40, batch.body_in_row(0), Vec3(100, 0, 0));
              if (i % 30 == 0) batch.set_enabled(i % 40, batch.body_in_row(1), i % 60 == 0);
            }
          }) == 0);
    CHECK(batch.awake_fraction() < 1);
  }
}

TEST_CASE("observing everything allocates nothing", "[fast][allocation][observe]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = crowd(space);
    scene.add(joint_at(scene, BodyId(2), BodyId(3), {}, HingeJoint{}));
    scene.options.sleep.time = 0.1;
    scene.options.sleep.speed = 0.5;
    for (const Table& table : widest_tables()) {
      BatchOptions options = options_of(table, 40);
      options.sleep = true;
      options.observe.what = {Observer::contacts, Observer::touching,    Observer::penetration,
                              Observer::motion,   Observer::joints,      Observer::joint_loads,
                              Observer::residual, Observer::acceleration};
      options.observe.rays.resize(9);
      options.observe.points.resize(5, Point{Vec3(0.1, 0.2, 0), BodyId(2)});
      std::vector<Ray> rays(9);
      Batch batch(compile(scene), options);
      batch.step();
      CHECK(calls_during([&] {
              for (int i = 0; i < 100; ++i) {
                batch.step(1 + i % 3);
                batch.look();
                rays[2].origin.x() = 0.1 * i;
                batch.set_rays(i % 40, rays);
              }
            }) == 0);
    }
  }
}

TEST_CASE("stepping a crowd allocates nothing", "[fast][allocation]") {
  check_scene(crowd(Space::planar));
  check_scene(crowd(Space::spatial));
  Scene varied = crowd(Space::spatial);
  varied.variations = {vary(Parameter::mass, 1, 2), vary(Parameter::friction, 0, 1),
                       vary(Parameter::linear_drag, 0, 1)};
  check_scene(varied);
  check_scene(crowd(Space::planar, 70));  // without a table of pairs
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

TEST_CASE("the memory that a batch is said to need is what it takes", "[fast][allocation]") {
  for (const char* scene : {"bin-boxes", "bin2d", "chain3d", "free-flight", "stack10"}) {
    const Plan plan = compile(scenes::find(scene)->make());
    for (const bool observed : {false, true}) {
      BatchOptions options = options_of(widest_tables().front(), 3000);
      if (observed) {
        options.observe.what = {Observer::contacts, Observer::touching,    Observer::penetration,
                                Observer::motion,   Observer::joints,      Observer::joint_loads,
                                Observer::residual, Observer::acceleration};
        options.observe.rays.resize(9);
        options.observe.points.resize(5, Point{Vec3(0.1, 0.2, 0), plan.body_in_row(0)});
      }
      bytes = 0;
      counting = true;
      const Batch batch(plan, options);
      counting = false;
      const double said = memory_of({{plan, 3000}}, options, batch.isa(), 1);
      INFO(scene << (observed ? ", observed: " : ": ") << said << ", took " << bytes.load());
      CHECK(static_cast<double>(bytes) > 0.9 * said);
      CHECK(static_cast<double>(bytes) < 1.1 * said);
    }
  }
}

#endif

}  // namespace manyworlds::test
