// Lunar landers flown by a hand-written controller: in every step, the state of all worlds is read
// into arrays, a thrust for each of their thrusters is computed from it and set, and all worlds
// step. A policy network takes the place of fly().
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <manyworlds/manyworlds.hpp>

namespace mw = manyworlds;

namespace {

constexpr int kWorlds = 4096;
constexpr int kSeconds = 25;
constexpr float kTouch = 1.5f;     // m, the height of a lander whose legs may touch something
constexpr float kMaxSpeed = 0.8f;  // m/s, the most that they bear

// What the controller sees of a lander, m, m/s, rad, rad/s. The pad is at x = 0.
struct State {
  float x, y, vx, vy, angle, spin;
};

// Thrust of the main, left and right thruster, N, for a lander of a mass, kg, under gravity, m/s^2.
void fly(const State& s, float mass, float gravity, float* thrust) {
  // Down at a speed that falls with the height, tilted against what moves it off the pad.
  const float height = s.y - 1;
  const float descent = -0.3f - 0.35f * std::max(height, 0.0f);
  const float lift = gravity + 2 * (descent - s.vy);
  const float lean = std::clamp(0.1f * s.x + 0.35f * s.vx, -0.35f, 0.35f);
  const float turn = mass * (2 * (lean - s.angle) - 1.5f * s.spin);
  thrust[0] = mass * std::max(lift, 0.0f) / std::cos(s.angle);
  thrust[1] = std::max(-turn, 0.0f);  // turns clockwise
  thrust[2] = std::max(turn, 0.0f);
}

}  // namespace

int main() {
  const mw::Plan plan = mw::compile(mw::scenes::find("lunar-lander")->make());
  const mw::Scene& scene = plan.scene();
  const int lander = plan.row(plan.body("lander"));
  float mass = 0;  // kg, with its legs
  for (const mw::Body& body : scene.bodies) {
    if (body.motion == mw::Motion::dynamic) {
      mass += static_cast<float>(mw::mass_properties(scene, body).mass);
    }
  }
  const auto gravity = static_cast<float>(-scene.options.gravity.y());

  mw::Batch batch(plan, {.worlds = kWorlds, .seed = 1});
  const auto bodies = static_cast<std::size_t>(batch.bodies());
  std::vector<float> position(batch.size(mw::Field::position));     // [world][body][2]
  std::vector<float> rotation(batch.size(mw::Field::orientation));  // [world][body][cos, sin]
  std::vector<float> velocity(batch.size(mw::Field::linear_velocity));
  std::vector<float> spin(batch.size(mw::Field::angular_velocity));  // [world][body]
  std::vector<float> thrust(kWorlds * scene.controls.size());        // [world][control]
  std::vector<State> state(kWorlds);
  const auto look = [&] {
    batch.read(mw::Field::position, position);
    batch.read(mw::Field::orientation, rotation);
    batch.read(mw::Field::linear_velocity, velocity);
    batch.read(mw::Field::angular_velocity, spin);
    for (std::size_t w = 0; w < kWorlds; ++w) {
      const std::size_t b = w * bodies + static_cast<std::size_t>(lander);
      state[w] = {position[2 * b],
                  position[2 * b + 1],
                  velocity[2 * b],
                  velocity[2 * b + 1],
                  std::atan2(rotation[2 * b + 1], rotation[2 * b]),
                  spin[b]};
    }
  };

  std::vector<bool> hard(kWorlds, false);  // came down too fast
  const int steps = static_cast<int>(std::lround(kSeconds / scene.options.dt));
  for (int step = 0; step < steps; ++step) {
    look();
    for (std::size_t w = 0; w < kWorlds; ++w) {
      hard[w] = hard[w] || (state[w].y < kTouch && state[w].vy < -kMaxSpeed);
      fly(state[w], mass, gravity, thrust.data() + w * scene.controls.size());
    }
    batch.set_controls(thrust);
    batch.step();
  }

  // Landed have those that came down gently and stand upright and still, thrusters off.
  std::fill(thrust.begin(), thrust.end(), 0.0f);
  batch.set_controls(thrust);
  batch.step(120);
  look();
  int landed = 0;
  for (int w = 0; w < kWorlds; ++w) {
    const State& s = state[static_cast<std::size_t>(w)];
    const bool still = std::hypot(s.vx, s.vy) < 0.05f && std::abs(s.spin) < 0.05f;
    landed += still && !hard[static_cast<std::size_t>(w)] && std::abs(s.angle) < 0.2f &&
              s.y < kTouch && batch.status(w) == mw::Status::ok;
  }
  const double fraction = static_cast<double>(landed) / kWorlds;
  std::printf("%d of %d landers landed (%.1f %%), hash %016llx\n", landed, kWorlds, 100 * fraction,
              static_cast<unsigned long long>(batch.hash()));
  return fraction > 0.95 ? 0 : 1;
}
