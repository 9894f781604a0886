// Random valid scenes against what holds for every scene: finite, no energy from nothing, nobody
// behind a wall, a failing world harms nobody, the same bits however it is run.
//
// MANYWORLDS_RANDOM_SEED=17 runs scene 17 alone, with MANYWORLDS_RANDOM_SCENES=5000 that many from
// there on.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/random_scene.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr int kSteps = 90;

class Trial {
 public:
  Trial(std::uint64_t seed, int worlds)
      : random_(random_scene(seed)), plan_(compile(random_.scene)) {
    const auto tables = widest_tables();
    options_ = options_of(tables[seed % 4 == 3 ? tables.size() - 1 : 0], worlds);
    options_.seed = 1000 * seed;
    options_.sleep = seed % 5 == 0;
    const Scene& scene = random_.scene;
    for (int i = 0; i < plan_.bodies(); ++i) {
      const Body& body = scene.at(plan_.body_in_row(i));
      dynamic_.push_back(body.motion == Motion::dynamic);
      center_.push_back(dynamic_.back() ? mass_properties(scene, body).center : Vec3::Zero());
    }
  }

  // All worlds, looked at from time to time; keeps what the runs after it compare with.
  void run() {
    Batch batch(plan_, options_);
    std::vector<double> energy;
    for (int w = 0; w < batch.worlds(); ++w) energy.push_back(mechanical_energy(batch, w));
    for (int step = 0; step < kSteps; step += 15) {
      if (step == kSteps / 2) saved_ = batch.save();
      batch.step(15);
      for (int w = 0; w < batch.worlds(); ++w) look(batch, w, energy[static_cast<std::size_t>(w)]);
    }
    for (int w = 0; w < batch.worlds(); ++w) hashes_.push_back(batch.hash(w));
  }

  // Parts of it in other ways: the same bits.
  void rerun() {
    BatchOptions o = options_;
    o.layout = ContactLayout::dense;
    compare("dense, step by step", plan_, o, 9, 1);
    o.layout = ContactLayout::rows;
    compare("in rows", plan_, o, 9, 7);
    o = options_;
    o.threads = 3;
    compare("on 3 threads", plan_, o, 21, kSteps);
    o = options_;
    o.isa = Isa::scalar;
    compare("scalar", plan_, o, 2, kSteps);
    const bool sweeps = plan_.report().broad_phase == BroadPhase::sort_and_sweep;
    PlanOptions other;
    other.broad_phase = sweeps ? BroadPhase::all_pairs : BroadPhase::sort_and_sweep;
    compare("with the other broad phase", compile(random_.scene, other), options_, 9, kSteps);
    spoil_one();
    resume();
  }

 private:
  static double mechanical_energy(const Batch& batch, int world) {
    const Energy e = batch.energy(world);
    return e.kinetic + e.potential;
  }

  void look(const Batch& batch, int world, double energy) const {
    INFO("world " << world << " after step " << batch.steps());
    const std::vector<double> all = state(batch, world);
    CHECK_FALSE(frozen(batch.status(world)));
    CHECK(std::all_of(all.begin(), all.end(), [](double x) { return std::isfinite(x); }));
    if (random_.rough) return;
    CHECK(max_speed(batch, world) < random_.top_speed);
    if (random_.passive) {
      CHECK(mechanical_energy(batch, world) < 1.01 * energy + 1e-9);
    }
    double behind = -1;
    for (int b = 0; b < batch.bodies(world); ++b) {
      const auto i = static_cast<std::size_t>(b);
      if (!dynamic_[i] || !batch.enabled(world, batch.body_in_row(b))) continue;
      const Vec3 center = position(batch, world, b) + rotation(batch, world, b) * center_[i];
      behind = std::max(behind, behind_walls(random_, center));
    }
    CHECK(behind < 0);
  }

  // `worlds` of them, from a place in the middle, so that they are in other lanes and groups.
  int window(int worlds) const { return (options_.worlds - worlds) / 2; }
  BatchOptions window_options(BatchOptions options, int worlds) const {
    options.worlds = worlds;
    options.seed = options_.seed + static_cast<std::uint64_t>(window(worlds));
    return options;
  }
  bool agrees(const Batch& batch, int world) const {
    return batch.hash(world) == hashes_[static_cast<std::size_t>(window(batch.worlds()) + world)];
  }

  void compare(const std::string& how, const Plan& plan, const BatchOptions& options, int worlds,
               int at_once) const {
    Batch batch(plan, window_options(options, worlds));
    for (int left = kSteps; left > 0; left -= at_once) batch.step(std::min(left, at_once));
    for (int w = 0; w < worlds; ++w) {
      INFO("world " << window(worlds) + w << ' ' << how);
      CHECK(agrees(batch, w));
    }
  }

  void spoil_one() const {
    constexpr int kWorlds = 9, kBad = 4;
    Batch batch(plan_, window_options(options_, kWorlds));
    batch.step(20);
    const int body =
        static_cast<int>(std::find(dynamic_.begin(), dynamic_.end(), true) - dynamic_.begin());
    batch.set_enabled(kBad, batch.body_in_row(body), true);
    set_vector(batch, Field::linear_velocity, kBad, body,
               Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    batch.step(kSteps - 20);
    CHECK(batch.status(kBad) == Status::non_finite);
    for (int w = 0; w < kWorlds; ++w) {
      INFO("world " << window(kWorlds) + w << " beside one full of NaN");
      if (w != kBad) CHECK(agrees(batch, w));
    }
  }

  void resume() const {
    constexpr int kWorlds = 5;
    Batch batch(plan_, window_options(options_, kWorlds));
    const Snapshot saved = Snapshot::from_bytes(saved_.bytes());
    for (int w = 0; w < kWorlds; ++w) batch.restore(saved, window(kWorlds) + w, kWorlds - 1 - w);
    batch.step(kSteps - kSteps / 2);
    for (int w = 0; w < kWorlds; ++w) {
      INFO("world " << window(kWorlds) + w << " from a snapshot");
      CHECK(batch.hash(kWorlds - 1 - w) == hashes_[static_cast<std::size_t>(window(kWorlds) + w)]);
    }
  }

  RandomScene random_;
  Plan plan_;
  BatchOptions options_;
  std::vector<bool> dynamic_;
  std::vector<Vec3> center_;  // of mass, in the body frame
  Snapshot saved_;
  std::vector<std::uint64_t> hashes_;
};

void try_scenes(std::uint64_t first, std::uint64_t count, int worlds) {
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    INFO("rerun with MANYWORLDS_RANDOM_SEED=" << seed);
    const std::vector<Issue> issues = validate(random_scene(seed).scene);
    for (const Issue& issue : issues) CHECK(to_string(issue).empty());
    if (!issues.empty()) continue;
    Trial trial(seed, worlds);
    trial.run();
    trial.rerun();
  }
}

}  // namespace

TEST_CASE("some random scenes keep to what holds for all", "[fast][random_scenes]") {
  try_scenes(0, 8, 24);
}

TEST_CASE("ten thousand random worlds keep to what holds for all", "[random_scenes]") {
  const auto number = [](const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text != nullptr ? std::stoull(text) : otherwise;
  };
  const bool one = std::getenv("MANYWORLDS_RANDOM_SEED") != nullptr;
  try_scenes(number("MANYWORLDS_RANDOM_SEED", 0), number("MANYWORLDS_RANDOM_SCENES", one ? 1 : 200),
             50);
}

}  // namespace manyworlds::test
