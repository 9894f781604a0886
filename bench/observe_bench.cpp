// What observers cost: a batch with one of them and one without take the same steps alternately.
// The counter `ratio` is the median of their ratios, in processor time of the thread, so that
// others on the machine matter little; docs/observers.md gives these figures.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "manyworlds/scenes.hpp"

namespace manyworlds::bench {
namespace {

constexpr int kObservedWorlds = 512;

struct Choice {
  const char* name;
  std::vector<Observer> what;
  int rays;
};

// Rays to all sides from above the middle, level but for a little.
std::vector<Ray> fan(int count) {
  std::vector<Ray> rays(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / count;
    rays[static_cast<std::size_t>(i)].origin = Vec3(0, 0, 1);
    rays[static_cast<std::size_t>(i)].direction = Vec3(std::cos(angle), std::sin(angle), -0.2);
  }
  return rays;
}

template <class Work>
double processor_seconds_of(Work work) {
  timespec begin{}, end{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  work();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return static_cast<double>(end.tv_sec - begin.tv_sec) +
         1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
}

void time_observer(benchmark::State& state, const char* scene, const Choice& choice) {
  BatchOptions options;
  options.worlds = kObservedWorlds;
  options.threads = 1;
  const Plan plan = compile(scenes::find(scene)->make());
  Batch blind(plan, options);
  options.observe.what = choice.what;
  options.observe.rays = fan(choice.rays);
  Batch seeing(plan, options);
  blind.step(120), seeing.step(120);
  std::vector<double> ratios;
  for ([[maybe_unused]] const auto _ : state) {
    const double without = processor_seconds_of([&] { blind.step(); });
    const double with = processor_seconds_of([&] { seeing.step(); });
    ratios.push_back(with / without);
    state.SetIterationTime(with);
  }
  if (blind.hash() != seeing.hash()) state.SkipWithError("observing changed the state");
  std::sort(ratios.begin(), ratios.end());
  state.counters["ratio"] = ratios[ratios.size() / 2];
  state.SetItemsProcessed(state.iterations() * kObservedWorlds);
}

// What a learner does beside the step: writes all controls and reads all coordinates of joints.
void time_controls(benchmark::State& state) {
  constexpr int kControlled = 4096;
  BatchOptions options;
  options.worlds = kControlled;
  options.threads = 1;
  const Plan plan = compile(scenes::find("lunar-lander")->make());
  Batch left_alone(plan, options);
  options.observe.what = {Observer::joints};
  Batch controlled(plan, options);
  left_alone.step(120), controlled.step(120);
  std::vector<float> controls(static_cast<std::size_t>(kControlled * controlled.controls()));
  controlled.read_controls(controls);
  std::vector<float> angles(controlled.size(Observed::joint_position));
  std::vector<double> ratios;
  for ([[maybe_unused]] const auto _ : state) {
    const double without = processor_seconds_of([&] { left_alone.step(); });
    const double with = processor_seconds_of([&] {
      controlled.set_controls(controls);
      controlled.step();
      controlled.read(Observed::joint_position, angles);
    });
    ratios.push_back(with / without);
    state.SetIterationTime(with);
  }
  if (left_alone.hash() != controlled.hash()) state.SkipWithError("the same controls changed it");
  std::sort(ratios.begin(), ratios.end());
  state.counters["ratio"] = ratios[ratios.size() / 2];
  state.SetItemsProcessed(state.iterations() * kControlled);
}

}  // namespace

void register_observers() {
  benchmark::RegisterBenchmark("observe/lunar-lander/controls_and_angles", time_controls)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
  static const std::vector<Choice> kChoices = {
      {"nothing", {}, 0},
      {"motion", {Observer::motion}, 0},
      {"penetration", {Observer::penetration}, 0},
      {"touching", {Observer::touching}, 0},
      {"contacts", {Observer::contacts}, 0},
      {"residual", {Observer::residual}, 0},
      {"acceleration", {Observer::acceleration}, 0},
      {"rays_8", {}, 8},
      {"rays_32", {}, 32},
      {"everything",
       {Observer::motion, Observer::penetration, Observer::touching, Observer::contacts},
       8},
  };
  for (const char* scene : {"bin-boxes", "stack10"}) {
    for (const Choice& choice : kChoices) {
      benchmark::RegisterBenchmark((std::string("observe/") + scene + "/" + choice.name).c_str(),
                                   time_observer, scene, choice)
          ->UseManualTime();
    }
  }
}

}  // namespace manyworlds::bench
