// Numbers of joints, actuators and shapes of Solver::newton that differ from world to world.
#include <catch2/catch.hpp>

#include <set>

#include "src/scene/variations.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

Control actuator(JointId joint, const Vec3& gain, const Vec3& bias) {
  Control out;
  out.kind = ControlKind::joint_force, out.joint = joint;
  out.actuator.gear = 2, out.actuator.gain = gain, out.actuator.bias = bias;
  return out;
}

// A free trunk of two shapes, off its centre, with an arm of a hinge, a ball and a slider, each
// with an actuator or a spring, and a free body. Nothing touches, and nothing is limited.
Scene flying_arm() {
  Scene scene = robot_scene(2);
  scene.options.substeps = 1;
  RobotBuilder build(scene);
  const BodyId trunk = build.body(Box{{0.1, 0.15, 0.2}}, {0, 0, 1});
  scene.at(trunk).shapes.push_back(shape_of(Capsule{0.05, 0.1}));
  scene.at(trunk).shapes[1].position = {0.2, 0.1, 0.05};
  scene.at(trunk).jitter.any_orientation = true;
  const BodyId upper = build.body(Capsule{0.04, 0.1}, {0.3, 0, 1});
  const JointId hinge = build.hinge(trunk, upper, {0.2, 0, 1}, {0, 1, 0.2}, 1);
  scene.at(hinge).type = HingeJoint{};
  scene.at(hinge).dynamics.stiffness = 3, scene.at(hinge).dynamics.rest = 0.2;
  const BodyId lower = build.body(Capsule{0.03, 0.1}, {0.5, 0, 1});
  scene.at(build.ball(upper, lower, {0.4, 0, 1})).dynamics.stiffness = 2;
  const BodyId hand = build.body(Box{{0.05, 0.04, 0.02}}, {0.7, 0, 1});
  const JointId slider = build.slider(lower, hand, {0.7, 0, 1}, Vec3::UnitX());
  const JointId wrist = build.hinge(lower, hand, {0.7, 0, 1}, Vec3::UnitZ(), 1);
  scene.at(wrist).type = HingeJoint{};
  scene.add(actuator(hinge, {1, 0.1, 0.2}, {0.3, -0.4, -0.05}));
  scene.add(actuator(slider, {20, 0, 0}, {0, -20, -1}));  // a position servo
  scene.add(actuator(wrist, {0.3, 0, 0}, {0, 0, -0.3}));  // a velocity servo
  build.body(Sphere{0.1}, {0, 3, 1});
  for (Body& body : scene.bodies) {
    for (Shape& shape : body.shapes) shape.filter.mask = 0;
  }
  return scene;
}

Variation of(Variation v, int control) {
  v.control = ControlId(control);
  return v;
}
Variation of_three(Parameter parameter, const Vec3& low, const Vec3& high) {
  Variation v;
  v.parameter = parameter, v.low = low, v.high = high;
  return v;
}
Scene varied_arm() {
  Scene scene = flying_arm();
  scene.variations = {of_three(Parameter::size, Vec3::Constant(0.05), Vec3::Constant(0.2)),
                      vary(Parameter::density, 300, 2000),
                      vary(Parameter::gravity_scale, 0.5, 2),
                      vary(Parameter::armature, 0, 0.1),
                      vary(Parameter::damping, 0, 0.5),
                      vary(Parameter::stiffness, 0, 5),
                      vary(Parameter::rest, -0.5, 0.5),
                      of(of_three(Parameter::gain, {0.5, -1, -1}, {2, 1, 1}), 0),
                      of(of_three(Parameter::bias, {-1, -2, -0.5}, {1, 0, 0}), 0),
                      of(vary(Parameter::kp, 5, 50, Draw::log_uniform), 1),
                      of(vary(Parameter::kv, 0, 2), 1),
                      of(vary(Parameter::kv, 0.1, 1), 2)};
  Variation mass = vary(Parameter::mass, 1, 3);
  mass.body = BodyId(1);
  scene.variations.push_back(mass);
  vary_around(scene, Parameter::center_of_mass, 0.02);
  scene.variations.push_back(vary(Parameter::inertia_scale, 1, 1.3));
  return scene;
}

void push(Batch& batch, int first, int step) {
  const std::size_t each = batch.plan(0).scene().controls.size();
  for (int w = 0; w < batch.worlds(); ++w) {
    Random random(static_cast<std::uint64_t>(100 * (first + w) + step));
    std::vector<double> u(each);
    for (double& x : u) x = random.uniform(-1, 1);
    batch.set_controls(w, u);
  }
}

}  // namespace

TEST_CASE("a robot with numbers of its own is one of the scene that has them, bit for bit",
          "[fast][robots][parameters]") {
  constexpr int kWorlds = 11;
  std::vector<Scene> scenes(4, varied_arm());
  scenes[1].options.integrator = Integrator::runge_kutta4;
  scenes[2].options.integrator = Integrator::implicit_fast;
  scenes[3].options.medium = {.density = 50, .viscosity = 0.1};
  for (const Scene& scene : scenes) {
    for (const Table& table : all_tables()) {
      BatchOptions options = options_of(table, kWorlds);
      options.seed = 5;
      Batch batch(compile(scene), options);
      std::vector<Batch> alone;
      for (int w = 0; w < kWorlds; ++w) {
        BatchOptions one = options_of(table, 1);
        one.seed = 5 + static_cast<std::uint64_t>(w);
        alone.emplace_back(compile(built_with(batch, w)), one);
      }
      for (int s = 0; s < 4; ++s) {
        push(batch, 0, s);
        batch.step(15);
        for (int w = 0; w < kWorlds; ++w) {
          push(alone[static_cast<std::size_t>(w)], w, s);
          alone[static_cast<std::size_t>(w)].step(15);
        }
      }
      std::set<std::uint64_t> seen;
      for (int w = 0; w < kWorlds; ++w) {
        const Batch& own = alone[static_cast<std::size_t>(w)];
        INFO(name(table) << ", " << to_string(scene.options.integrator) << ", world " << w);
        CHECK(batch.status(w) == Status::ok);
        CHECK(batch.hash(w) == own.hash(0));
        CHECK(batch.energy(w).kinetic == own.energy(0).kinetic);
        CHECK(batch.energy(w).potential == own.energy(0).potential);
        seen.insert(batch.hash(w));
      }
      CHECK(seen.size() == kWorlds);
    }
  }
}

TEST_CASE("numbers that are as in the scene change no bit, limits and contacts included",
          "[fast][robots][parameters]") {
  for (const Scene& plain : {robots(), lone_walker()}) {
    Scene scene = plain;
    const double most = 1e6;
    for (const Parameter p : {Parameter::armature, Parameter::damping}) {
      scene.variations.push_back(vary(p, 0, most, Draw::none));
    }
    for (const Parameter p : {Parameter::stiffness, Parameter::rest}) {
      for (std::size_t j = 0; j < scene.joints.size(); ++j) {  // a spring of 0 is one more sum
        const bool ball = std::holds_alternative<BallJoint>(scene.joints[j].type);
        if (scene.joints[j].dynamics.stiffness == 0 || (ball && p == Parameter::rest)) continue;
        Variation v = vary(p, 0, most, Draw::none);
        v.joint = JointId(static_cast<int>(j));
        scene.variations.push_back(v);
      }
    }
    Variation gain = of_three(Parameter::gain, Vec3::Constant(-most), Vec3::Constant(most));
    gain.draw = Draw::none;
    Variation size = of_three(Parameter::size, Vec3::Constant(1e-3), Vec3::Constant(10));
    size.draw = Draw::none;
    scene.variations.insert(scene.variations.end(),
                            {gain, size, vary(Parameter::density, 1, most, Draw::none)});
    const Plan other = compile(scene);
    Scene same = plain;
    same.options = other.resolved();  // what varies counts where the plan chooses
    const Plan one = compile(same);
    CHECK(one.fingerprint() != other.fingerprint());
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch a(one, options_of(table, 19)), b(other, options_of(table, 19));
      for (int s = 0; s < 6; ++s) {
        push(a, 0, s), push(b, 0, s);
        a.step(20), b.step(20);
      }
      CHECK(hashes(a) == hashes(b));
    }
  }
}

TEST_CASE("numbers of joints and controls are drawn at resets, written and read",
          "[fast][robots][parameters]") {
  const Plan plan = compile(varied_arm());
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 6));
    CHECK(batch.size(Parameter::armature) == 6 * 4);
    CHECK(batch.size(Parameter::gain) == 6 * 3 * 3);
    CHECK(batch.size(Parameter::kp) == 6 * 3);
    const auto first = numbers(batch, Parameter::stiffness, 2);
    CHECK(numbers(batch, Parameter::stiffness, 3) != first);
    const std::vector<std::uint8_t> third = {0, 0, 1, 0, 0, 0};
    const auto kept = numbers(batch, Parameter::kv, 3);
    batch.reset(third);
    CHECK(numbers(batch, Parameter::stiffness, 2) != first);
    CHECK(numbers(batch, Parameter::kv, 3) == kept);
    for (const double x : numbers(batch, Parameter::damping, 2)) CHECK((0 <= x && x <= 0.5));
    CHECK(numbers(batch, Parameter::rest, 2)[1] == 0);  // a ball has none

    // Gains tell what servos have.
    const auto kp = numbers(batch, Parameter::kp, 1), kv = numbers(batch, Parameter::kv, 1),
               gain = numbers(batch, Parameter::gain, 1), bias = numbers(batch, Parameter::bias, 1);
    CHECK((kp[0] == 0 && kp[2] == 0 && kv[0] == 0));
    CHECK((gain[3] == kp[1] && bias[4] == -kp[1] && bias[5] == -kv[1]));
    CHECK((gain[6] == kv[2] && bias[7] == 0 && bias[8] == -kv[2]));

    std::vector<double> given = {0.01, 0.02, 0.03, 0.04};
    batch.write(Parameter::armature, 4, given);
    CHECK(numbers(batch, Parameter::armature, 4) == given);
    given[3] = 0.2;
    CHECK_THROWS_WITH(batch.write(Parameter::armature, 4, given),
                      Catch::Contains("armature of joint 3 is 0.2, must be between 0 and 0.1"));
    std::vector<double> gains = gain;
    gains[3] = 1;
    CHECK_THROWS_WITH(batch.write(Parameter::gain, 1, gains),
                      Catch::Contains("gain of control 1, number 0 is 1, must be"));
    CHECK_NOTHROW(batch.write(Parameter::gain, 1, gain));

    const Snapshot saved = batch.save();
    batch.step(20);
    const auto then = hashes(batch);
    batch.reset();
    batch.restore(saved);
    batch.step(20);
    CHECK(hashes(batch) == then);
    CHECK(numbers(batch, Parameter::armature, 4)[0] == 0.01);
  }
}

TEST_CASE("a link whose size is written stays where its coordinates are",
          "[fast][robots][parameters]") {
  const Plan plan = compile(varied_arm());
  for (const Table& table : widest_tables()) {
    INFO(name(table));
    Batch batch(plan, options_of(table, 3));
    batch.step(10);
    const auto read = [&](Field field) {
      std::vector<double> out(plan.numbers(field));
      batch.read(field, 1, out);
      return out;
    };
    const auto q = read(Field::generalized_position), x = read(Field::position);
    auto size = numbers(batch, Parameter::size, 1);
    const double mass = numbers(batch, Parameter::mass, 1)[1];
    for (double& s : size) s = s == 0 ? 0 : s > 0.1 ? 0.06 : 0.18;
    batch.write(Parameter::size, 1, size);
    CHECK(read(Field::generalized_position) == q);
    const auto after = read(Field::position);
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(after[i] == approx(x[i], pick(table, 2e-6, 1e-12)));
    }
    CHECK(numbers(batch, Parameter::mass, 1)[1] == mass);  // that of body 1 is its own
    CHECK(numbers(batch, Parameter::mass, 1)[2] != numbers(batch, Parameter::mass, 0)[2]);
    batch.step(10);
    CHECK(batch.status(1) == Status::ok);
  }
}

TEST_CASE("a plan has numbers per world only of what varies", "[fast][robots][parameters]") {
  Scene scene = lone_walker();
  const auto bytes = [&](const std::vector<Variation>& variations) {
    scene.variations = variations;
    return Batch(compile(scene), options_of(widest_tables().front(), 64)).bytes_per_world();
  };
  const std::size_t none = bytes({}), joints = bytes({vary(Parameter::armature, 0, 1)}),
                    controls = bytes({vary(Parameter::gain, 0, 1)});
  const std::size_t real = sizeof(float), dofs = 6 + 3 + 2 * 5 + 6, actuators = 2 * 5;
  // In the lanes, and as they are written, in double.
  CHECK(joints - none >= dofs * 4 * real);
  CHECK(joints - none < dofs * 4 * real + 11 * sizeof(double) + 32);
  CHECK(controls - none < actuators * (9 * real + 3 * sizeof(double)) + 32);
}

}  // namespace manyworlds::test
