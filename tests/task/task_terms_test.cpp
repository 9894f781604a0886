// What expressions are worth: closed forms, and what Batch::read says.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "manyworlds/scenes.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/newton_scenes.hpp"
#include "tests/support/policy.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A ball at x under no gravity, one per world.
Task falling_ball(double gravity = 0) {
  Task task;
  task.scene = empty_scene(Space::spatial, gravity);
  Body ball = body_of(shape_of(Sphere{0.5}), {0, 0, 0});
  ball.jitter.position = {20, 0, 0};
  task.scene.add(ball);
  return task;
}

struct Hypotenuse final : LaneFunction {
  template <class Real>
  static void of(int lanes, std::span<const Real* const> in, Real* out) {
    for (int l = 0; l < lanes; ++l) out[l] = std::sqrt(in[0][l] * in[0][l] + in[1][l] * in[1][l]);
  }
  void operator()(int lanes, std::span<const float* const> in, float* out) const override {
    of(lanes, in, out);
  }
  void operator()(int lanes, std::span<const double* const> in, double* out) const override {
    of(lanes, in, out);
  }
};

double relative(double found, double wanted) {
  return std::abs(found - wanted) / std::max(1.0, std::abs(wanted));
}

}  // namespace

TEST_CASE("elementary functions are those of mathematics, to a few units in the last place",
          "[task][fast]") {
  const Precision precision = GENERATE(from_range(widest_tables())).precision;
  const double ulp = precision == Precision::f32 ? 0x1p-23 : 0x1p-52;
  Task task = falling_ball();
  const Expression x = terms::position(BodyId(0), 0);
  task.observations = {{"x", x}};
  // As parts of the reward, since these are float64.
  task.rewards = {{"x", x},
                  {"sin", sin(x)},
                  {"cos", cos(x)},
                  {"exp", exp(x / 4)},
                  {"floor", floor(x)},
                  {"sqrt", sqrt(abs(x))},
                  {"atan2", atan2(x, 3 - x)},
                  {"clamp", clamp(x, -2, 5)},
                  {"select", select(x < 1, 2 * x, x * x)},
                  {"far sine", sin(1024 * x)}};
  Played p(task, {.worlds = 500, .precision = precision});
  p.step();
  const std::size_t terms = task.rewards.size();
  std::vector<double> worst(terms, 0);
  for (std::size_t w = 0; w < 500; ++w) {
    const double* found = p.reward_terms.data() + w * terms;
    std::vector<double> at(3);
    p.environment.batch().read(Field::position, static_cast<int>(w), at);
    const double v = at[0];
    const double wanted[] = {v,
                             std::sin(v),
                             std::cos(v),
                             std::exp(v / 4),
                             std::floor(v),
                             std::sqrt(std::abs(v)),
                             std::atan2(v, 3 - v),
                             std::clamp(v, -2.0, 5.0),
                             v < 1 ? 2 * v : v * v,
                             std::sin(1024 * v)};
    for (std::size_t i = 0; i < terms; ++i) {
      REQUIRE(std::isfinite(found[i]));
      worst[i] = std::max(worst[i], relative(found[i], wanted[i]) / ulp);
    }
  }
  for (std::size_t i = 0; i < terms; ++i) {
    CAPTURE(task.rewards[i].name, worst[i]);
    CHECK(worst[i] <= 1);
  }
}

TEST_CASE("functions of what is not finite or beyond their range stay in bounds", "[task][fast]") {
  Task task = falling_ball();
  const Expression nan = Expression(0) / 0, infinite = Expression(1) / 0;
  task.observations = {{"exp", exp(200)},
                       {"exp of less", exp(-200)},
                       {"floor", floor(3e9)},
                       {"floor below 0", floor(-0.5)},
                       {"exp of nan", exp(nan)},
                       {"min", min(infinite, 2)},
                       {"0 / 0 is no truth", select(nan < 1, 1, 0)}};
  Played p(task, {.worlds = 1});
  CHECK(std::isinf(p.observations[0]));
  CHECK(p.observations[1] == 0);
  CHECK(p.observations[2] == 3e9f);
  CHECK(p.observations[3] == -1);
  CHECK(std::isnan(p.observations[4]));
  CHECK(p.observations[5] == 2);
  CHECK(p.observations[6] == 0);
}

TEST_CASE("terms are what the batch reads, in the user's frames", "[task][fast]") {
  const Precision precision = GENERATE(from_range(widest_tables())).precision;
  const auto name = GENERATE(as<std::string>(), "car2d", "lunar-lander", "ragdoll", "mixed-pile",
                             "mixed-pile2d", "chain3d");
  Task task;
  task.scene = scenes::find(name)->make();
  const bool planar = task.scene.space == Space::planar;
  const int dim = planar ? 2 : 3;
  const auto observe = [&task](const Expression& e) {
    task.observations.push_back({to_string(e), e});
  };
  for (std::size_t i = 0; i < task.scene.bodies.size(); ++i) {
    const int body = static_cast<int>(i);
    if (task.scene.bodies[i].motion == Motion::fixed) continue;
    for (int c = 0; c < dim; ++c) {
      observe(terms::position(BodyId(body), c));
      observe(terms::velocity(BodyId(body), c));
      for (int of = 0; of < dim; ++of) observe(terms::direction(BodyId(body), of, c));
    }
    if (planar) {
      observe(terms::angular_velocity(BodyId(body), 2));
      observe(terms::angle(BodyId(body)));
    } else {
      for (int c = 0; c < 3; ++c) observe(terms::angular_velocity(BodyId(body), c));
    }
  }
  for (const Expression& e :
       std::vector<Expression>(task.scene.controls.size(), Expression(0.25))) {
    task.controls.push_back(e);
  }
  Played p(task, {.worlds = 19, .precision = precision});
  for (int step = 0; step < 20; ++step) p.step();
  const Batch& batch = p.environment.batch();
  std::size_t at = 0;
  double worst = 0;
  for (int w = 0; w < batch.worlds(); ++w) {
    const auto field = [&](Field f) {
      std::vector<double> v(batch.size(f) / static_cast<std::size_t>(batch.worlds()));
      batch.read(f, w, v);
      return v;
    };
    const auto x = field(Field::position), v = field(Field::linear_velocity),
               q = field(Field::orientation), s = field(Field::angular_velocity);
    const auto see = [&](double wanted) {
      REQUIRE(std::isfinite(p.observations[at]));
      worst = std::max(worst, relative(static_cast<double>(p.observations[at++]), wanted));
    };
    for (int b = 0; b < batch.bodies(); ++b) {
      const auto n = static_cast<std::size_t>(b), d = static_cast<std::size_t>(dim);
      const Mat3 r =
          planar ? Mat3(Eigen::AngleAxisd(std::atan2(q[2 * n + 1], q[2 * n]), Vec3::UnitZ()))
                 : Quat(q[4 * n], q[4 * n + 1], q[4 * n + 2], q[4 * n + 3]).toRotationMatrix();
      for (std::size_t c = 0; c < d; ++c) {
        see(x[n * d + c]);
        see(v[n * d + c]);
        for (std::size_t of = 0; of < d; ++of) {
          see(r(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(of)));
        }
      }
      if (planar) {
        see(s[n]);
        see(std::atan2(q[2 * n + 1], q[2 * n]));
      } else {
        for (std::size_t c = 0; c < 3; ++c) see(s[3 * n + c]);
      }
    }
  }
  REQUIRE(at == p.observations.size());
  CHECK(worst < (precision == Precision::f32 ? 4e-6 : 1e-7));
}

TEST_CASE("joints, touch, rays, controls and age are what observers see", "[task][fast]") {
  Task task;
  task.scene = scenes::find("lunar-lander")->make();
  const BodyId lander = task.scene.body("lander"), leg = task.scene.body("left leg");
  task.actions = {{"main", 0, 2}};
  task.controls = {100 * terms::action(), 0, 1000};
  Ray down;
  down.direction = {0, -1, 0};
  down.length = 30;
  down.mask = 1;
  task.rays = {down};
  task.rays[0].origin = {0, 20, 0};
  task.observations = {{"hip", terms::joint_position(JointId(0))},
                       {"hip speed", terms::joint_speed(JointId(0))},
                       {"leg", terms::touching(leg)},
                       {"ray", terms::ray_distance(0)},
                       {"main", terms::control(ControlId(0))},
                       {"right", terms::control(ControlId(2))},
                       {"age", terms::age()},
                       {"action", terms::action()},
                       {"lost", terms::lost()},
                       {"cabin", terms::touching(lander)}};
  Played p(task, {.worlds = 9});
  CHECK(p.observations[6] == 0);
  p.actions.assign(9, 1.5f);
  p.actions[3] = 99;  // beyond its range
  int touched = 0;
  float nearest = 100;
  for (int step = 1; step <= 400; ++step) {
    p.step();
    const Batch& batch = p.environment.batch();
    for (int w = 0; w < 9; ++w) {
      const float* o = p.observations.data() + 10 * w;
      std::vector<double> joint(2), speed(2), control(27);
      batch.read(Observed::joint_position, w, joint);
      batch.read(Observed::joint_speed, w, speed);
      batch.read_controls(control);
      REQUIRE(o[0] == static_cast<float>(joint[0]));
      REQUIRE(o[1] == static_cast<float>(speed[0]));
      // After a reset, `touching()` still reports the step before it; the environment does not.
      if (o[6] != 0) REQUIRE((o[2] != 0) == batch.touching(w, leg));
      REQUIRE(o[3] == static_cast<float>(batch.ray_hits(w)[0].distance));
      REQUIRE((o[8] != 0) == lost(batch.status(w)));
      if (o[6] != 0) REQUIRE((o[9] != 0) == batch.touching(w, lander));
      nearest = std::min(nearest, o[3]);
      REQUIRE(o[4] == static_cast<float>(control[static_cast<std::size_t>(3 * w)]));
      if (o[6] != 0) {
        REQUIRE(o[5] == static_cast<float>(task.scene.controls[2].high));
        REQUIRE(o[7] == (w == 3 ? 2.0f : 1.5f));
      }
      touched += o[2] != 0;
    }
  }
  CHECK(touched > 0);
  CHECK(nearest < down.length);
}

TEST_CASE("terms of a robot's joints are what observers tell", "[fast][task][newton]") {
  Task task;
  task.scene = newton_robot();
  task.controls = {0.5};
  task.observations = {{"hinge", terms::joint_position(JointId(0))},
                       {"twist", terms::joint_position(JointId(1), 1)},
                       {"twist speed", terms::joint_speed(JointId(1), 1)},
                       {"force", terms::observed(Observed::joint_force, 1, 2)}};
  Played p(task, {.worlds = 9});
  for (int w = 0; w < 9; ++w) {
    CHECK(p.observations[static_cast<std::size_t>(4 * w + 3)] == 0);  // no step yet
  }
  for (int step = 1; step <= 40; ++step) {
    p.step();
    const Batch& batch = p.environment.batch();
    for (int w = 0; w < 9; ++w) {
      const float* o = p.observations.data() + 4 * w;
      std::vector<double> place(3), speed(3), force(6);
      batch.read(Observed::joint_position, w, place);
      batch.read(Observed::joint_speed, w, speed);
      batch.read(Observed::joint_force, w, force);
      REQUIRE(o[0] == static_cast<float>(place[0]));
      REQUIRE(o[1] == static_cast<float>(place[2]));
      REQUIRE(o[2] == static_cast<float>(speed[2]));
      REQUIRE(o[3] == static_cast<float>(force[5]));
    }
  }
}

TEST_CASE("what tasks remember: previous, held and largest", "[task][fast]") {
  Task task = falling_ball(10);
  const Expression x = terms::position(BodyId(0), 2), v = terms::velocity(BodyId(0), 2);
  task.observations = {{"x", x},
                       {"before", terms::previous(x)},
                       {"twice before", terms::previous(terms::previous(x))},
                       {"fast", terms::held(v < -1.05)},
                       {"highest", terms::largest(x)},
                       {"lowest", -terms::largest(-x)},
                       {"age", terms::age()}};
  task.max_steps = 13;
  Played p(task, {.worlds = 5, .autoreset = Autoreset::same_step});
  std::vector<float> x_of_episode{p.observations[0]};
  int fast = 0;
  for (int step = 0; step < 40; ++step) {
    p.step();
    const float* o = p.ended(0) ? p.final_observations.data() : p.observations.data();
    x_of_episode.push_back(o[0]);
    const std::size_t n = x_of_episode.size();
    fast = static_cast<double>(n - 1) * 10.0 / 60 > 1.05 ? fast + 1 : 0;
    CHECK(o[1] == x_of_episode[n - 2]);
    CHECK(o[2] == x_of_episode[n < 3 ? 0 : n - 3]);
    CHECK(o[3] == static_cast<float>(fast));
    CHECK(o[4] == x_of_episode[0]);
    CHECK(o[5] == o[0]);
    CHECK(o[6] == static_cast<float>(n - 1));
    if (!p.ended(0)) continue;
    CHECK(n == 14);
    x_of_episode = {p.observations[0]};
    fast = 0;
    for (int i : {1, 2, 4, 5})
      CHECK(p.observations[static_cast<std::size_t>(i)] == x_of_episode[0]);
    CHECK(p.observations[3] == 0);
    CHECK(p.observations[6] == 0);
  }
}

TEST_CASE("functions of one's own are worked out in lanes", "[task][fast]") {
  Task task = falling_ball();
  const Expression x = terms::position(BodyId(0), 0);
  const Expression h = lane_function(std::make_shared<Hypotenuse>(), {3 * x, 4 * x});
  task.observations = {
      {"x", x},
      {"h", h + 1},
      {"again", lane_function(std::make_shared<Hypotenuse>(), {h, Expression(0)})}};
  Played p(task, {.worlds = 33, .precision = GENERATE(from_range(widest_tables())).precision});
  for (std::size_t w = 0; w < 33; ++w) {
    const float* o = p.observations.data() + 3 * w;
    CHECK(o[1] == Approx(5 * std::abs(o[0]) + 1));
    CHECK(o[2] == Approx(5 * std::abs(o[0])));
  }
}

TEST_CASE("an expression that is nested too deeply is an error", "[task][fast]") {
  Expression sum = 0;
  CHECK_THROWS_AS(
      [&] {
        for (int i = 0; i < 5000; ++i) sum = sum + terms::age();
      }(),
      std::invalid_argument);
}

TEST_CASE("all that is wrong with a task is said at once", "[task][fast]") {
  Task task = falling_ball();
  task.scene.add(joint_at(task.scene, {}, BodyId(0), Frame{}, BallJoint{}));
  task.frame_skip = 0;
  task.max_steps = -1;
  task.choices = 2;
  task.actions = {{"a", 1, 1}};
  task.controls = {0};
  task.observations = {{"one", terms::position(BodyId(1), 0)},
                       {"two", terms::position(BodyId(0), 3)},
                       {"three", terms::angle(BodyId(0))},
                       {"four", terms::joint_position(JointId(0), 2)},
                       {"five", terms::ray_distance(0)},
                       {"six", terms::control(ControlId(0)), 2, 1},
                       {"seven", terms::action(1)}};
  task.rewards = {{"r", terms::touching(BodyId())}};
  task.terminated = terms::joint_speed(JointId(1));
  std::string all;
  for (const Issue& issue : validate(task)) all += to_string(issue) + "\n";
  INFO(all);
  for (const char* part :
       {"frame_skip is 0", "max_steps is -1", "actions are 1, must be none", "action 0 'a' has the",
        "controls are 1, must match the scene's controls: 0",
        "observation 0 'one' position of body 1, axis 0: the body must be 0 to 0",
        "observation 1 'two' position of body 0, axis 3: the axis must be 0 to 2",
        "observation 2 'three' angle of body 0: angles exist in planar scenes only",
        "observation 3 'four' joint_position of joint 0, coordinate 2: the coordinate must be 0 to "
        "1",
        "observation 4 'five' ray_distance of ray 0: the ray must be 0 to 0, but there are none",
        "observation 5 'six' control 0", "observation 5 'six' has the range 2",
        "observation 6 'seven' action 1", "reward 0 'r' touching of body -1",
        "terminated joint_speed of joint 1"}) {
    CHECK_THAT(all, Catch::Contains(part));
  }
  CHECK_THROWS_AS(Environment(task), SceneError);

  Task looks;
  looks.scene = scenes::find("lunar-lander")->make();
  looks.observations = {{"age", terms::age()}};
  const Expression place = terms::position(BodyId(1), 0);
  looks.controls = {terms::previous(place) + place, terms::previous(place), terms::held(place)};
  all.clear();
  for (const Issue& issue : validate(looks)) all += to_string(issue) + "\n";
  CHECK_THAT(all, Catch::Contains("control 0 'main' depends on position of body 1, axis 0, must"));
  CHECK_THAT(all, Catch::Contains("control 2 'right' depends on position of body 1, axis 0, must"));
  CHECK_THAT(all, !Catch::Contains("control 1"));
}

}  // namespace manyworlds::test
