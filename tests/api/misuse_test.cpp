// What nobody means: values that an enumeration does not have, numbers without sense, objects that
// were moved from, more worlds than the machine has memory for. Each is a std::invalid_argument
// that gives name, value and what was expected, and nothing has changed.
#include <catch2/catch.hpp>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/environment.hpp"
#include "manyworlds/tasks.hpp"
#include "src/base/enum_names.hpp"
#include "src/base/machine_memory.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Misuse {
  const char* text;  // what is said
  std::function<void()> call;
};

void check_misuses(const std::vector<Misuse>& all) {
  for (const Misuse& misuse : all) {
    INFO(misuse.text);
    try {
      misuse.call();
      FAIL_CHECK("nothing was thrown");
    } catch (const std::invalid_argument& error) {
      CHECK_THAT(error.what(), Catch::Contains(misuse.text));
    }
  }
}

Scene one_joint() {
  Scene scene = contraption(Space::planar);
  Control control;
  control.kind = ControlKind::thrust;
  control.body = BodyId(1);
  scene.controls.push_back(control);
  return scene;
}
// A scene that is sound but for one change.
Misuse in_scene(const char* text, std::function<void(Scene&)> change) {
  return {text, [change = std::move(change)] {
            Scene scene = one_joint();
            change(scene);
            compile(scene);
          }};
}

Plan plan_of(int bodies = 3) { return compile(crowd(Space::planar, bodies)); }
Misuse in_options(const char* text, std::function<void(BatchOptions&)> change) {
  return {text, [change = std::move(change)] {
            BatchOptions options = {.worlds = 2, .threads = 1};
            change(options);
            Batch(plan_of(), options);
          }};
}
Misuse in_batch(const char* text, std::function<void(Batch&)> call) {
  return {text, [call = std::move(call)] {
            Batch batch(plan_of(), {.worlds = 2, .threads = 1});
            const std::uint64_t hash = batch.hash();
            try {
              call(batch);
            } catch (...) {
              CHECK(batch.hash() == hash);
              CHECK(batch.steps() == 0);
              throw;
            }
          }};
}

template <class Enum>
Enum none(int value) {
  return static_cast<Enum>(value);
}

const std::vector<Misuse> kEnumsInScenes = {
    in_scene("space is 7, must be planar or spatial", [](Scene& s) { s.space = none<Space>(7); }),
    in_scene("body 1: motion is 3, must be dynamic, kinematic or fixed",
             [](Scene& s) { s.bodies[1].motion = none<Motion>(3); }),
    in_scene("options.integrator is -1, must be symplectic-euler, explicit-euler, ",
             [](Scene& s) { s.options.integrator = none<Integrator>(-1); }),
    in_scene("options.rotation is 3, must be splitting, quaternion or exponential",
             [](Scene& s) { s.options.rotation = none<Rotation>(3); }),
    in_scene("options.solver.method is 99, must be tgs-soft, sequential-impulse, sor, nncg, "
             "penalty or newton",
             [](Scene& s) { s.options.solver.method = none<Solver>(99); }),
    in_scene("control 0: kind is 5, must be target_position, target_speed, thrust, torque or "
             "joint_force",
             [](Scene& s) { s.controls[0].kind = none<ControlKind>(5); }),
    in_scene("variation 0: parameter is 99, must be size, density, shape_position, ",
             [](Scene& s) { s.variations = {vary(none<Parameter>(99), 0, 1)}; }),
    in_scene("variation 0: draw is 3, must be none, uniform or log_uniform",
             [](Scene& s) { s.variations = {vary(Parameter::friction, 0.1, 1, none<Draw>(3))}; }),
    {"broad_phase is 4, must be automatic, all-pairs, sort-and-sweep or sparse",
     [] { compile(crowd(Space::planar), {.broad_phase = none<BroadPhase>(4), .keep = {}}); }},
    {"keep[1] is 9, must be orientation, inertia, ",
     [] {
       compile(crowd(Space::planar), {.keep = {Feature::drag, none<Feature>(9)}});
     }},
    {"feature is 9, must be", [] { plan_of().has(none<Feature>(9)); }},
    {"field is 17, must be position, orientation, linear_velocity, angular_velocity, "
     "generalized_position, generalized_velocity or generalized_acceleration",
     [] { components(none<Field>(17), Space::planar); }},
    {"parameter is -1, must be", [] { info(none<Parameter>(-1)); }},
};

const std::vector<Misuse> kEnumsInBatches = {
    in_options("precision is 9, must be f32 or f64",
               [](BatchOptions& o) { o.precision = none<Precision>(9); }),
    in_options("isa is 3, must be scalar, avx2 or avx512",
               [](BatchOptions& o) { o.isa = none<Isa>(3); }),
    in_options("layout is 3, must be automatic, dense or rows",
               [](BatchOptions& o) { o.layout = none<ContactLayout>(3); }),
    in_options("observe.what[1] is 50, must be contacts, touching, ",
               [](BatchOptions& o) {
                 o.observe.what = {Observer::motion, none<Observer>(50)};
               }),
    in_batch("field is 17, must be", [](Batch& b) { b.size(none<Field>(17)); }),
    in_batch("field is 17, must be",
             [](Batch& b) { b.read(none<Field>(17), 0, std::span<double>()); }),
    in_batch("field is 7, must be",
             [](Batch& b) { b.write(none<Field>(7), std::span<const double>()); }),
    in_batch("field is 7, must be",
             [](Batch& b) { b.set_initial(none<Field>(7), std::span<const double>()); }),
    in_batch("field is 7, must be", [](Batch& b) { b.lane_blocks(none<Field>(7)); }),
    in_batch("parameter is 99, must be", [](Batch& b) { b.size(none<Parameter>(99)); }),
    in_batch("parameter is 99, must be",
             [](Batch& b) { b.read(none<Parameter>(99), 0, std::span<double>()); }),
    in_batch("parameter is 99, must be",
             [](Batch& b) { b.write(none<Parameter>(99), std::span<const double>()); }),
    in_batch("observed is 99, must be kinetic_energy, ",
             [](Batch& b) { b.size(none<Observed>(99)); }),
    in_batch("observed is 99, must be",
             [](Batch& b) { b.read(none<Observed>(99), std::span<double>()); }),
    {"autoreset is 3, must be next_step, same_step or disabled",
     [] { Environment(tasks::find("Pendulum")->make(), {.autoreset = none<Autoreset>(3)}); }},
    {"precision is 9, must be",
     [] { Environment(tasks::find("Pendulum")->make(), {.precision = none<Precision>(9)}); }},
};

class ManyThreads final : public Executor {
 public:
  int threads() const override { return 100000; }
  void run(int, Task, void*) override {}
};

const std::vector<Misuse> kNumbers = {
    in_options("worlds is 0, must be >= 1", [](BatchOptions& o) { o.worlds = 0; }),
    in_options("threads is -1, must be 0 to 1024", [](BatchOptions& o) { o.threads = -1; }),
    in_options("threads is 100000, must be 0 to 1024", [](BatchOptions& o) { o.threads = 100000; }),
    in_options("the executor has 100000 threads, must be 1 to 1024",
               [](BatchOptions& o) {
                 o.threads = 0;
                 o.executor = std::make_shared<ManyThreads>();
               }),
    in_options("observe.contacts_per_world is -1, must be >= 0",
               [](BatchOptions& o) { o.observe.contacts_per_world = -1; }),
    in_batch("n is -1, must be >= 0", [](Batch& b) { b.step(-1); }),
    in_batch("n is -5, must be >= 0",
             [](Batch& b) {
               b.step(std::vector<std::uint8_t>{1, 0}, -5);
             }),
    in_batch("max_steps is -1, must be >= 0", [](Batch& b) { b.step_to(1, -1); }),
    in_batch("clock is nan s, must be finite",
             [](Batch& b) { b.step_to(std::numeric_limits<double>::quiet_NaN()); }),
    in_batch("clock is inf s, must be finite",
             [](Batch& b) { b.step_to(std::numeric_limits<double>::infinity()); }),
    in_batch("kind is 1, must be 0 to 0", [](Batch& b) { b.plan(1); }),
    in_batch("kind is -1, must be 0 to 0", [](Batch& b) { b.plan(-1); }),
    in_batch("world is 2, must be 0 to 1", [](Batch& b) { b.wake(2); }),
    {"worlds of all kinds are 2147483648 or more, must be at most 2147483647",
     [] {
       const Plan plan = plan_of();
       Batch(std::vector<Batch::Kind>{{plan, std::numeric_limits<int>::max()}, {plan, 1}});
     }},
    {"Plan: it is empty, compile() makes a plan", [] { Plan{nullptr}; }},
    {"Expression: the node is null", [] { Expression{std::shared_ptr<const Expression::Node>()}; }},
};

}  // namespace

TEST_CASE("a value that an enumeration does not have is refused", "[fast][misuse]") {
  check_misuses(kEnumsInScenes);
  check_misuses(kEnumsInBatches);
  for (const Space space : {Space::planar, Space::spatial}) {
    CHECK(validate(contraption(space)).empty());  // what is changed is all that is wrong
  }
  // Names of what there is not are no crash either.
  CHECK(to_string(none<Solver>(99)) == std::string("unknown"));
  CHECK(to_string(none<Observed>(-1)) == std::string("unknown"));
  CHECK(to_string(none<Input>(200)) == std::string("unknown"));
}

TEST_CASE("numbers without sense are refused", "[fast][misuse]") { check_misuses(kNumbers); }

TEST_CASE("what was moved from says so", "[fast][misuse]") {
  Batch batch(plan_of(), {.worlds = 2, .threads = 1});
  Batch other(std::move(batch));
  const std::vector<std::uint8_t> mask(2);
  const std::string text = "Batch was moved from";
  // NOLINTBEGIN(bugprone-use-after-move): that is what is tried
  for (const std::function<void()>& call : std::vector<std::function<void()>>{
           [&] { batch.step(); },
           [&] { batch.step(mask); },
           [&] { batch.step_to(1); },
           [&] { batch.worlds(); },
           [&] { batch.plan(); },
           [&] { batch.hash(); },
           [&] { batch.save(); },
           [&] { batch.reset(); },
           [&] { batch.reset(mask); },
           [&] { batch.time(); },
           [&] { batch.threads(); },
           [&] { batch.size(Field::position); },
           [&] { batch.lane_blocks(Field::position); },
           [&] { batch.add_force(0, BodyId(2), Vec3::Zero()); },
           [&] { batch.add_impulse_at(0, BodyId(2), Vec3::Zero(), Vec3::Zero()); },
           [&] { batch.spawn(0, BodyId(2), {}); },
           [&] { batch.set_controls(std::span<const double>()); },
           [&] { batch.restore(other.save()); },
           [&] { batch.contacts(0); },
           [&] { batch.measure_contacts(); },
           [&] { batch.step_contacts(0); },
           [&] { batch.look(); },
           [&] { batch.listen({}); },
           [&] { batch.profile(true); },
       }) {
    CHECK_THROWS_WITH(call(), Catch::Contains(text));
    CHECK_THROWS_AS(call(), std::invalid_argument);
  }
  batch = std::move(other);
  CHECK_NOTHROW(batch.step());
  CHECK_THROWS_WITH(other.step(), Catch::Contains(text));

  Environment environment(tasks::find("Pendulum")->make());
  Environment moved(std::move(environment));
  const std::vector<float> action(1);
  CHECK_THROWS_WITH(environment.worlds(), Catch::Contains("Environment was moved from"));
  CHECK_THROWS_WITH(environment.step(action, {}), Catch::Contains("Environment was moved from"));
  CHECK_THROWS_WITH(environment.reset(mask, {}), Catch::Contains("Environment was moved from"));
  CHECK_THROWS_WITH(environment.save(), Catch::Contains("Environment was moved from"));
  CHECK_THROWS_WITH(environment.batch(), Catch::Contains("Environment was moved from"));
  CHECK_NOTHROW(moved.step(action, {}));

  // Plans and expressions are handles of what does not change: a moved one is a copied one.
  Plan plan = plan_of();
  const Plan taken = std::move(plan);
  CHECK(plan.fingerprint() == taken.fingerprint());
  Expression one = 1;
  const Expression same = std::move(one);
  CHECK_NOTHROW(one + same);

  Batch whole(plan_of(), {.worlds = 2, .threads = 1});
  Snapshot snapshot = whole.save();
  const Snapshot kept = std::move(snapshot);
  CHECK(snapshot.worlds() == 0);
  CHECK_THROWS_WITH(whole.restore(snapshot), Catch::Contains("is empty"));
  CHECK_THROWS_AS(whole.restore(snapshot, 0, 0), std::invalid_argument);
  CHECK_NOTHROW(whole.restore(kept));
  // NOLINTEND(bugprone-use-after-move)
}

TEST_CASE("more worlds than the machine has memory for are refused before it is asked for",
          "[fast][misuse]") {
  constexpr int kMax = std::numeric_limits<int>::max();
  const Plan plan = compile(capsule_crowd(Space::spatial));
  const std::string expected =
      " need " + std::string("\\d+\\.\\d GB of memory, the machine has ") + "\\d+\\.\\d GB";
  const auto refused = [&](const std::string& what, const BatchOptions& options) {
    CHECK_THROWS_AS(Batch(plan, options), std::invalid_argument);
    CHECK_THROWS_WITH(Batch(plan, options), Catch::Matches("worlds: " + what + expected));
  };
  REQUIRE(machine_memory() < 1e12);
  refused("2147483647 worlds of 'crowd-capsules'", {.worlds = kMax, .threads = 1});
  refused("2147483647 worlds of 'crowd-capsules'", {.worlds = kMax, .threads = 2, .sleep = true});
  BatchOptions observed{.worlds = 20000, .threads = 1};
  observed.observe.what = {Observer::contacts};
  observed.observe.contacts_per_world = kMax;
  refused("20000 worlds of 'crowd-capsules'", observed);
  Task task = tasks::find("Pendulum")->make();
  CHECK_THROWS_WITH(Environment(task, {.worlds = kMax}),
                    Catch::Contains("worlds: 2147483647 worlds of 'Pendulum' need ") ||
                        Catch::Contains("worlds: 2147483647 worlds of 'pendulum' need "));

  // What is said is what it would have been: of a batch that fits, within a few percent.
  Batch fits(plan, {.worlds = 1024, .threads = 1});
  try {
    Batch(plan, {.worlds = kMax, .threads = 1});
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    const double said = std::stod(text.substr(text.find(" need ") + 6)) * 1e9;
    CHECK(said / kMax == Approx(static_cast<double>(fits.bytes_per_world())).epsilon(0.05));
  }
}

}  // namespace manyworlds::test
