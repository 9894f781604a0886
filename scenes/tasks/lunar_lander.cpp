// The scene lunar-lander as a task shaped like Gymnasium's LunarLander: eight observations, engines
// that cost, a potential that rewards coming near, slow and upright, 100 for rest, -100 for a
// crash.
#include "manyworlds/scenes.hpp"
#include "scenes/tasks/makers.hpp"

namespace manyworlds::tasks {
namespace {

// Units of the observations.
constexpr double kWidth = 10, kHeight = 20.0 / 3;  // m
constexpr double kStanding = 0.8;                  // m, of the cabin over its feet
constexpr double kSpeedX = 5, kSpeedY = 7.5;       // m/s
constexpr double kTurn = 2.5;                      // rad/s
constexpr int kRest = 30;                          // steps that it must stand

int body_named(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

// `main` and `side`: shares of the engines' thrust, side -1 (to the left) to 1.
Task lander(const Expression& main, const Expression& side) {
  using namespace terms;
  Task task;
  task.scene = scenes::find("lunar-lander")->make();
  const int cabin = body_named(task.scene, "lander"), left = body_named(task.scene, "left leg"),
            right = body_named(task.scene, "right leg");
  const auto& controls = task.scene.controls;
  task.controls = {controls[0].high * main, controls[1].high * max(side, 0),
                   controls[2].high * max(-side, 0)};

  const Expression x = position(cabin, 0) / kWidth, y = (position(cabin, 1) - kStanding) / kHeight,
                   vx = velocity(cabin, 0) / kSpeedX, vy = velocity(cabin, 1) / kSpeedY,
                   lean = angle(cabin), turn = angular_velocity(cabin, 2) / kTurn,
                   on_left = touching(left), on_right = touching(right);
  task.observations = {{"x", x, -2.5, 2.5},
                       {"y", y, -2.5, 10},
                       {"vx", vx, -10, 10},
                       {"vy", vy, -10, 10},
                       {"angle", lean, -6.2831855, 6.2831855},
                       {"turn", turn, -10, 10},
                       {"left leg", on_left, 0, 1},
                       {"right leg", on_right, 0, 1}};

  const Expression crashed = touching(cabin) | (abs(x) >= 1) | (y > 5) | lost();
  const Expression slow =
      square(velocity(cabin, 0)) + square(velocity(cabin, 1)) + square(angular_velocity(cabin, 2)) <
      0.01;
  const Expression landed = (held(slow & on_left & on_right) >= kRest) & !crashed;
  const Expression potential = -100 * sqrt(square(x) + square(y)) -
                               100 * sqrt(square(vx) + square(vy)) - 100 * abs(lean) +
                               10 * on_left + 10 * on_right;
  const auto unless_crashed = [&](const Expression& e) { return select(crashed, 0, e); };
  task.rewards = {{"potential", unless_crashed(potential - previous(potential))},
                  {"main engine", unless_crashed(-0.3 * main)},
                  {"side engines", unless_crashed(-0.03 * abs(side))},
                  {"landed", select(landed, 100, 0)},
                  {"crashed", select(crashed, -100, 0)}};
  task.terminated = crashed | landed;
  task.most_steps = 1000;
  task.solved_at = 200;
  return task;
}

}  // namespace

Task lunar_lander() {
  const Expression a = terms::action();
  Task task = lander(equal(a, 2), equal(a, 1) - equal(a, 3));
  task.name = "LunarLander";
  task.choices = 4;
  return task;
}

Task lunar_lander_continuous() {
  using terms::action;
  // The main engine runs at half its thrust or more, the side engines too.
  const Expression main = select(action(0) > 0, 0.5 + 0.5 * action(0), 0),
                   side = select(abs(action(1)) > 0.5, action(1), 0);
  Task task = lander(main, side);
  task.name = "LunarLanderContinuous";
  task.actions = {{"main engine", -1, 1}, {"side engines", -1, 1}};
  return task;
}

}  // namespace manyworlds::tasks
