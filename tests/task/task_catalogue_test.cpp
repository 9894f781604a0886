// The named tasks: what simple policies get in them.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

#include "manyworlds/tasks.hpp"
#include "tests/support/policy.hpp"

namespace manyworlds::test {
namespace {

// Mean return of the first episodes of 64 worlds, in which none is lost. `act` fills in the actions
// of a world.
using Act = std::function<void(const float* seen, float* actions, std::int64_t& choice)>;
double mean_return(const Task& task, const Act& act) {
  constexpr int kWorlds = 64;
  Played p(task, {.worlds = kWorlds, .seed = 1, .autoreset = Autoreset::disabled});
  std::vector<bool> done(kWorlds, false);
  double sum = 0;
  int lost_ones = 0;
  const auto n = static_cast<std::size_t>(p.environment.observations()),
             m = static_cast<std::size_t>(p.environment.actions());
  for (int step = 0; step < task.max_steps; ++step) {
    if (act) {
      for (std::size_t w = 0; w < kWorlds; ++w) {
        act(p.observations.data() + w * n, p.actions.data() + w * m, p.choices[w]);
      }
    } else {
      p.act_at_random(step);
    }
    p.step();
    for (int w = 0; w < kWorlds; ++w) {
      const auto i = static_cast<std::size_t>(w);
      if (done[i]) continue;
      sum += p.rewards[i];
      done[i] = p.ended(w);
      if (done[i] && lost(p.environment.batch().status(w))) ++lost_ones;
    }
  }
  CHECK(lost_ones == 0);
  return sum / kWorlds;
}
double random_return(const Task& task) { return mean_return(task, nullptr); }

Task task_of(const char* name) { return tasks::find(name)->make(); }

}  // namespace

TEST_CASE("every named task is in order and has its name", "[task][fast]") {
  for (const tasks::Entry& entry : tasks::all()) {
    const Task task = entry.make();
    CHECK(task.name == entry.name);
    CHECK(tasks::find(entry.name) == &entry);
    for (const Issue& issue : validate(task)) FAIL_CHECK(entry.name << ": " << to_string(issue));
    CHECK(task.max_steps > 0);
  }
  CHECK(tasks::find("nothing") == nullptr);
}

TEST_CASE("CartPole is balanced by linear feedback and not by chance", "[task][fast]") {
  const Task task = task_of("CartPole");
  const double balanced = mean_return(task, [](const float* s, float*, std::int64_t& choice) {
    choice = s[0] + 2 * s[1] + 30 * s[2] + 6 * s[3] > 0 ? 1 : 0;
  });
  CHECK(balanced > 495);
  CHECK(random_return(task) < 40);
}

// The equations of Barto, Sutton and Anderson (1983) without friction or force.
struct PoleOnCart {
  double x = 0, v = 0, lean = 0, turn = 0;

  void step(double dt, bool explicit_euler) {
    constexpr double kGravity = 9.8, kPole = 0.1, kBoth = 1.1, kHalf = 0.5;  // m/s^2, kg, kg, m
    const double s = std::sin(lean), c = std::cos(lean);
    const double drive = kPole * kHalf * turn * turn * s / kBoth;
    const double turning = (kGravity * s - c * drive) / (kHalf * (4.0 / 3 - kPole * c * c / kBoth));
    const double pushing = drive - kPole * kHalf * turning * c / kBoth;
    if (!explicit_euler) v += dt * pushing, turn += dt * turning;
    x += dt * v, lean += dt * turn;
    if (explicit_euler) v += dt * pushing, turn += dt * turning;
  }
};

TEST_CASE("CartPole falls as the equations say, nearer to them than by explicit Euler steps",
          "[task][fast]") {
  constexpr double kLean = 0.1;  // rad
  constexpr int kSteps = 40;     // 0.8 s
  Scene scene = task_of("CartPole").scene;
  for (Body& body : scene.bodies) body.jitter = {};
  scene.bodies[1].rotation = Quat(Eigen::AngleAxisd(kLean, Vec3::UnitZ()));
  const auto fallen = [&](int substeps) {
    scene.options.substeps = substeps;
    Batch batch(compile(scene), BatchOptions{});
    batch.step(kSteps);
    std::vector<double> turned(4), place(4);  // [body][2]
    batch.read(Field::orientation, 0, turned);
    batch.read(Field::position, 0, place);
    CHECK(std::hypot(place[2] - place[0], place[3] - place[1]) < 0.005);  // m, the hinge's gap
    return std::atan2(turned[3], turned[2]);
  };
  PoleOnCart exact{.lean = kLean}, euler{.lean = kLean};
  const double dt = scene.options.dt;
  for (int i = 0; i < 2000 * kSteps; ++i) exact.step(dt / 2000, false);
  for (int i = 0; i < kSteps; ++i) euler.step(dt, true);
  REQUIRE(scene.options.substeps == 1);
  const double error = std::abs(fallen(1) - exact.lean);
  CAPTURE(error, exact.lean, euler.lean);
  CHECK(error < 0.03 * exact.lean);
  CHECK(error < std::abs(euler.lean - exact.lean) / 3);
  CHECK(std::abs(fallen(16) - exact.lean) < error / 12);
}

TEST_CASE("CartPoleSwingUp: swinging by energy, then balancing", "[task]") {
  const Task task = task_of("CartPoleSwingUp");
  const double swung = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    const float x = s[0], v = s[1], upright = s[2], sideways = s[3], turn = s[4];
    if (upright > 0.9f && std::abs(turn) < 4) {
      a[0] = (x + 2 * v + 40 * sideways + 8 * turn) / 15;
    } else {
      // Pushes that add energy until the pole has what it needs, and back to the middle.
      const float energy = 0.5f * turn * turn * 0.667f / 9.8f + upright - 1;
      a[0] =
          (energy < 0 ? 0.6f : -0.2f) * (turn * upright < 0 ? 1.0f : -1.0f) - 0.3f * x - 0.1f * v;
    }
  });
  CHECK(swung > 350);
  CHECK(random_return(task) < 30);
}

TEST_CASE("Pendulum: energy pumping beats rest and chance", "[task][fast]") {
  const Task task = task_of("Pendulum");
  const double pumped = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    const float energy = 0.5f * s[2] * s[2] / 3 + 5 * (s[0] - 1);
    a[0] = s[0] > 0.92f && std::abs(s[2]) < 1.5f
               ? -(16 * s[1] + 3 * s[2])
               : (energy < 0 ? 2.0f : -2.0f) * (s[2] > 0 ? 1 : -1);
  });
  CHECK(pumped > -200);
  CHECK(random_return(task) < -1100);
}

TEST_CASE("Acrobot: pushing along with the elbow reaches the height", "[task][fast]") {
  const Task task = task_of("Acrobot");
  const double pushed = mean_return(
      task, [](const float* s, float*, std::int64_t& choice) { choice = s[5] > 0 ? 2 : 0; });
  CHECK(pushed > -130);
  CHECK(random_return(task) < -450);
}

TEST_CASE("LunarLander is landed by a simple controller, in both forms", "[task][fast]") {
  // Descends the slower the lower it is, leans against where it drifts.
  struct Wish {
    float thrust, turn;
  };
  const auto fly = [](const float* s) {
    const float x = s[0] * 10, y = s[1] * 6.667f, vx = s[2] * 5, vy = s[3] * 7.5f, lean = s[4],
                turn = s[5] * 2.5f;
    const bool down = s[6] > 0 && s[7] > 0;
    const float wanted_lean = down ? 0 : std::clamp(0.08f * x + 0.25f * vx, -0.35f, 0.35f);
    const float wanted_vy = -0.25f - 0.25f * std::max(y, 0.0f);
    return Wish{down ? 0 : wanted_vy - vy, 3 * (wanted_lean - lean) - 2 * turn};
  };
  const double landed =
      mean_return(task_of("LunarLander"), [&](const float* s, float*, std::int64_t& choice) {
        const Wish w = fly(s);
        choice = std::abs(w.turn) > 0.5f ? (w.turn > 0 ? 1 : 3) : w.thrust > 0 ? 2 : 0;
      });
  CHECK(landed > 160);
  const double smooth =
      mean_return(task_of("LunarLanderContinuous"), [&](const float* s, float* a, std::int64_t&) {
        const Wish w = fly(s);
        a[0] = w.thrust > 0 ? std::min(2 * w.thrust - 0.5f, 1.0f) : -1;
        a[1] = -w.turn;
      });
  CHECK(smooth > 180);
  CHECK(random_return(task_of("LunarLander")) < -80);
}

TEST_CASE("Hopper stands a while, and falls by chance", "[task][fast]") {
  const Task task = task_of("Hopper");
  const double stood = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    for (int i = 0; i < 3; ++i) a[i] = std::clamp(-4 * s[2 + i] - 0.4f * s[8 + i], -1.0f, 1.0f);
    a[2] = std::clamp(a[2] + 3 * s[1] + 0.5f * s[7], -1.0f, 1.0f);
  });
  CHECK(stood > 8 * random_return(task));
}

TEST_CASE("Pusher: going round the puck and pushing brings it to the mark", "[task][fast]") {
  const Task task = task_of("Pusher");
  const double pushed = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    // hand, its speed, puck from hand, puck's speed, mark from puck: x, then y
    const float px = s[2], py = s[7], mx = s[4], my = s[9];
    const float far = std::max(std::hypot(mx, my), 1e-3f);
    // A place behind the puck, seen from the mark.
    const float bx = px - 0.4f * mx / far, by = py - 0.4f * my / far;
    const bool behind = std::hypot(bx, by) < 0.25f;
    const float wx = behind ? px + 0.2f * mx / far : bx, wy = behind ? py + 0.2f * my / far : by;
    const float push = behind ? std::min(4.0f, 1 + 3 * far) : 3;
    a[0] = std::clamp(push * wx - 0.3f * s[1], -1.0f, 1.0f);
    a[1] = std::clamp(push * wy - 0.3f * s[6], -1.0f, 1.0f);
  });
  CHECK(pushed > 8);
  CHECK(random_return(task) < 0);
}

TEST_CASE("BirdSling: some shots hit, and not slinging does not", "[task][fast][long]") {
  const Task task = task_of("BirdSling");
  const auto shot = [&](float strength, float steepness) {
    return mean_return(
        task, [=](const float*, float* a, std::int64_t&) { a[0] = strength, a[1] = steepness; });
  };
  CHECK(shot(0, 0.3f) == 0);
  double best = 0;
  for (const float strength : {0.5f, 0.7f, 0.9f, 1.0f}) {
    for (const float steepness : {0.2f, 0.35f, 0.5f})
      best = std::max(best, shot(strength, steepness));
  }
  CHECK(best > 4);
}

TEST_CASE("BallBalance: tilting against the ball keeps it", "[task][fast]") {
  const Task task = task_of("BallBalance");
  const double kept = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    // The plate's normal leans to where the ball is to go.
    const auto drive = [](float x, float v, float tilt, float turn) {
      const float wanted = std::clamp(-0.6f * x - 0.5f * v, -0.25f, 0.25f);
      return std::clamp(6 * (wanted - tilt) - 1.5f * turn, -1.0f, 1.0f);
    };
    a[1] = drive(s[0], s[2], s[4], s[7]);
    a[0] = -drive(s[1], s[3], s[5], -s[6]);
  });
  CHECK(kept > 450);
  CHECK(random_return(task) < 50);
}

TEST_CASE("Stacking: a box flown over the tower and let down stands", "[task][fast]") {
  const Task task = task_of("Stacking");
  const double stacked = mean_return(task, [](const float* s, float* a, std::int64_t&) {
    const float dx = s[0], dy = s[1], vx = s[2], vy = s[3], lean = s[5], turn = s[6];
    const bool over = std::abs(dx) < 0.05f && std::abs(vx) < 0.1f;
    const bool down = s[7] > 0 && std::abs(dx) < 0.1f && dy < 0.05f;
    const float aim = over ? -0.3f : 0.4f;  // m over the tower; into it, to arrive
    a[0] = down ? 0 : std::clamp(-1.0f * dx - 0.8f * vx, -1.0f, 1.0f);
    a[1] = down ? 0 : std::clamp(0.4f + (over ? 0.3f : 0.8f) * (aim - dy) - 0.6f * vy, -1.0f, 1.0f);
    a[2] = down ? 0 : std::clamp(-3 * lean - turn, -1.0f, 1.0f);
  });
  CHECK(stacked > 12);
  CHECK(random_return(task) < -2);
}

}  // namespace manyworlds::test
