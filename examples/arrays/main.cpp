// Cart-poles as an RL or optimal-control user has them: actions go in and observations, rewards and
// ends come out as flat arrays, [world][number]; worlds that end begin anew. A linear feedback
// balances them; a policy network takes its place.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include <manyworlds/manyworlds.hpp>

namespace mw = manyworlds;

namespace {

constexpr std::size_t kWorlds = 2048, kObservations = 4, kActions = 1;
constexpr float kMostLean = 0.2f, kMostTravel = 2.4f;  // rad, m; an episode ends beyond
constexpr int kMostSteps = 500;                        // and after so many

mw::Shape bar(double half_x, double half_y, double mass) {
  mw::Shape shape;
  shape.geometry = mw::Polygon::box(half_x, half_y);
  shape.density = mass / (4 * half_x * half_y);
  shape.filter.mask = 0;  // touches nothing
  return shape;
}

// A cart of 1 kg on a rail and a pole of 0.1 kg and 1 m that stands on it, on a hinge.
mw::Scene cart_pole() {
  mw::Scene scene;
  scene.space = mw::Space::planar;
  scene.options.gravity = {0, -9.81, 0};
  scene.options.dt = 0.02;
  mw::Body cart;
  cart.shapes = {bar(0.25, 0.1, 1)};
  cart.jitter.position = {0.5, 0, 0};
  const int base = scene.add(cart);
  mw::Body pole;  // its frame is at the hinge
  pole.shapes = {bar(0.02, 0.5, 0.1)};
  pole.shapes[0].position = {0, 0.5, 0};
  pole.jitter.with = base;
  pole.jitter.angle = 0.1;
  const int upper = scene.add(pole);
  scene.add(mw::joint_at(scene, -1, base, mw::Frame{}, mw::SliderJoint{}));
  scene.add(mw::joint_at(scene, base, upper, mw::Frame{}, mw::HingeJoint{}));
  mw::Control push;
  push.kind = mw::ControlKind::thrust;  // N, along x
  push.body = base;
  push.low = -10, push.high = 10;
  scene.controls = {push};
  return scene;
}

class CartPoles {
 public:
  CartPoles()
      : batch_(mw::compile(cart_pole()),
               {.worlds = kWorlds, .seed = 1, .observe = {{mw::Observer::joints}, {}, 0}}) {}

  // What the last step ended with; of a world that has just begun anew, what it begins with.
  std::vector<float> observations = std::vector<float>(kWorlds * kObservations);
  std::vector<float> rewards = std::vector<float>(kWorlds);
  std::vector<std::uint8_t> ended = std::vector<std::uint8_t>(kWorlds);

  void step(std::span<const float> actions) {
    batch_.set_controls(actions);  // [world][control]
    batch_.step();
    observe();
    bool any_ended = false;
    for (std::size_t w = 0; w < kWorlds; ++w) {
      const float* seen = observations.data() + w * kObservations;
      const float travel = seen[0];
      rewards[w] = 1 - 0.1f * travel * travel;
      const bool failed = std::abs(seen[2]) > kMostLean || std::abs(travel) > kMostTravel;
      ended[w] = failed || ++age_[w] == kMostSteps;
      if (ended[w]) age_[w] = 0;
      any_ended = any_ended || ended[w];
    }
    if (!any_ended) return;
    batch_.reset(ended);  // with a new draw
    batch_.look();
    observe();
  }

  const mw::Batch& batch() const { return batch_; }

 private:
  void observe() {
    batch_.read(mw::Observed::joint_position, place_);  // [world][travel, angle]
    batch_.read(mw::Observed::joint_speed, speed_);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      float* seen = observations.data() + w * kObservations;
      seen[0] = place_[2 * w], seen[1] = speed_[2 * w];
      seen[2] = place_[2 * w + 1], seen[3] = speed_[2 * w + 1];
    }
  }

  mw::Batch batch_;
  std::vector<float> place_ = std::vector<float>(2 * kWorlds);
  std::vector<float> speed_ = std::vector<float>(2 * kWorlds);
  std::vector<int> age_ = std::vector<int>(kWorlds);  // steps
};

// N; angles are positive to the left.
float balance(const float* seen) { return seen[0] + 2 * seen[1] - 30 * seen[2] - 6 * seen[3]; }
float let_go(const float*) { return 0; }

// Mean return of the episodes that end within 1000 steps.
double mean_return(float (*policy)(const float*), const char* name) {
  CartPoles environment;
  std::vector<float> actions(kWorlds * kActions), returns(kWorlds);
  double sum = 0;
  int episodes = 0;
  for (int step = 0; step < 2 * kMostSteps; ++step) {
    for (std::size_t w = 0; w < kWorlds; ++w) {
      actions[w] = policy(environment.observations.data() + w * kObservations);
    }
    environment.step(actions);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      returns[w] += environment.rewards[w];
      if (!environment.ended[w]) continue;
      sum += returns[w], ++episodes;
      returns[w] = 0;
    }
  }
  const double mean = sum / std::max(episodes, 1);
  std::printf("%-8s mean return %6.1f of %d episodes, hash %016llx\n", name, mean, episodes,
              static_cast<unsigned long long>(environment.batch().hash()));
  return mean;
}

}  // namespace

int main() {
  const double untouched = mean_return(let_go, "let go"),
               balanced = mean_return(balance, "balance");
  return balanced > 0.9 * kMostSteps && untouched < 0.3 * kMostSteps ? 0 : 1;
}
