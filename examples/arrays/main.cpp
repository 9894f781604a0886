// A task of one's own, as an RL or optimal-control user has it: what a policy does, sees and is
// paid for is said in expressions, which are worked out in SIMD lanes within the step. Actions go
// in and observations, rewards and ends come out as flat arrays, [world][number]; worlds that end
// begin anew. A linear feedback balances the cart-poles; a policy network takes its place.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include <manyworlds/manyworlds.hpp>

namespace mw = manyworlds;

namespace {

constexpr std::size_t kWorlds = 2048, kObservations = 4;
constexpr double kMaxLean = 0.2, kMaxTravel = 2.4, kMaxThrust = 10;  // rad, m, N
constexpr int kMaxSteps = 500;                                       // of an episode

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
  const mw::BodyId base = scene.add(cart);
  mw::Body pole;  // its frame is at the hinge
  pole.shapes = {bar(0.02, 0.5, 0.1)};
  pole.shapes[0].position = {0, 0.5, 0};
  pole.jitter.with = base;
  pole.jitter.angle = 0.1;
  const mw::BodyId upper = scene.add(pole);
  const mw::JointId rail = scene.add(mw::joint_at(scene, {}, base, {}, mw::SliderJoint{}));
  const mw::JointId hinge = scene.add(mw::joint_at(scene, base, upper, {}, mw::HingeJoint{}));
  scene.at(rail).name = "rail", scene.at(hinge).name = "hinge";
  mw::Control motor;
  motor.kind = mw::ControlKind::thrust;  // N, along x
  motor.body = base;
  motor.low = -kMaxThrust, motor.high = kMaxThrust;
  scene.controls = {motor};
  return scene;
}

mw::Task balancing() {
  using namespace mw::terms;
  mw::Task task;
  task.name = "balancing";
  task.scene = cart_pole();
  task.actions = {{"push", -1, 1}};
  task.controls = {kMaxThrust * action()};
  const mw::JointId rail = task.scene.joint("rail"), hinge = task.scene.joint("hinge");
  // The hinge's angle is positive to the left.
  const mw::Expression travel = joint_position(rail), lean = joint_position(hinge);
  task.observations = {{"travel", travel},
                       {"speed", joint_speed(rail)},
                       {"lean", lean},
                       {"turn", joint_speed(hinge)}};
  task.rewards = {{"upright", 1}, {"off the middle", -0.1 * square(travel)}};
  task.terminated = (abs(lean) > kMaxLean) | (abs(travel) > kMaxTravel);
  task.max_steps = kMaxSteps;
  return task;
}

float balance(const float* seen) {
  return 0.1f * seen[0] + 0.2f * seen[1] - 3 * seen[2] - 0.6f * seen[3];
}
float let_go(const float*) { return 0; }

// Mean return of the episodes that end within 1000 steps.
double mean_return(float (*policy)(const float*), const char* name) {
  mw::Environment environment(
      balancing(), {.worlds = kWorlds, .seed = 1, .autoreset = mw::Autoreset::same_step});
  std::vector<float> observations(kWorlds * kObservations), actions(kWorlds);
  std::vector<double> rewards(kWorlds), returns(kWorlds);
  std::vector<std::uint8_t> terminated(kWorlds), truncated(kWorlds);
  const mw::StepArrays arrays{.observations = observations,
                              .rewards = rewards,
                              .terminated = terminated,
                              .truncated = truncated};
  environment.reset(std::vector<std::uint8_t>(kWorlds, 1), observations);
  double sum = 0;
  int episodes = 0;
  for (int step = 0; step < 2 * kMaxSteps; ++step) {
    for (std::size_t w = 0; w < kWorlds; ++w) {
      actions[w] = policy(observations.data() + w * kObservations);
    }
    environment.step(actions, arrays);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      returns[w] += rewards[w];
      if (!terminated[w] && !truncated[w]) continue;
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
  return balanced > 0.9 * kMaxSteps && untouched < 0.3 * kMaxSteps ? 0 : 1;
}
