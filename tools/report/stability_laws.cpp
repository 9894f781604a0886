// What the library promises whatever the scene (numerics.md B42, B45, B46).
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

// Boxes, and balls unless they would roll on, that fall into a bin.
Scene pile(bool balls) {
  Scene scene = empty(Space::spatial, 10);
  scene.add(ground(Space::spatial, 0.6));
  for (const double side : {-1.0, 1.0}) {
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
      Body wall = with_shape(Box{{2 - way.x(), 2 - way.y(), 2}}, side * 2.5 * way, 0.6);
      wall.position.z() = 2, wall.motion = Motion::fixed;
      scene.add(wall);
    }
  }
  for (int i = 0; i < 10; ++i) {
    const Vec3 place((i % 2) - 0.5, (i / 2 % 2) - 0.5, 0.8 + 1.1 * (i / 4));
    Body body = with_shape(
        balls && i % 3 == 0 ? Geometry(Sphere{0.4}) : Geometry(Box{Vec3::Constant(0.35)}), place,
        0.6);
    body.jitter.position = Vec3::Constant(0.1), body.jitter.any_orientation = true;
    body.angular_drag = 0.5;
    scene.add(body);
  }
  return scene;
}

int different(const Batch& a, const Batch& b, int but) {
  int out = 0;
  for (int w = 0; w < a.worlds(); ++w) out += w != but && a.hash(w) != b.hash(w) ? 1 : 0;
  return out;
}

Trial poisoned() {
  Trial t = trial("B42", "one world with NaN velocities among others",
                  "other worlds with changed bits, plus 1 if it is not flagged", "", 0, 1);
  t.scene = [] { return pile(true); };
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    Batch clean(plan, options), spoilt(plan, options);
    const int bad = options.worlds / 2;
    std::vector<double> v(static_cast<std::size_t>(plan.bodies()) * 3,
                          std::numeric_limits<double>::quiet_NaN());
    spoilt.write(Field::linear_velocity, bad, v);
    clean.step(60), spoilt.step(60);
    return different(clean, spoilt, bad) + (spoilt.status(bad) == Status::non_finite ? 0.0 : 1.0);
  };
  return t;
}

Trial asleep() {
  Trial t = trial("B45 pile", "a pile that falls asleep", "fraction of worlds awake after 10 s", "",
                  0, 10);
  t.scene = [] { return pile(false); };
  t.whole = [](const Plan& plan, BatchOptions options) {
    options.sleep = true;
    Batch batch(plan, options);
    batch.step(static_cast<int>(10 / plan.scene().options.dt + 0.5));
    return batch.awake_fraction();
  };
  return t;
}
Trial as_awake() {
  Trial t = trial("B45 pyramid", "a pyramid of 15 squares that falls asleep",
                  "position difference to a batch without sleep after 10 s", "m", 1e-3, 10);
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    scene.add(ground(Space::planar, 0.6));
    for (int row = 0; row < 5; ++row) {
      for (int k = 0; k < 5 - row; ++k) {
        Body box =
            with_shape(Polygon::box(0.5, 0.5), {(k - (4 - row) / 2.0) * 1.1, 0.5 + row, 0}, 0.6);
        box.jitter.position = {0.01, 0, 0};
        scene.add(box);
      }
    }
    return scene;
  };
  t.whole = [](const Plan& plan, BatchOptions options) {
    Batch awake(plan, options);
    options.sleep = true;
    Batch sleepy(plan, options);
    const int steps = static_cast<int>(10 / plan.scene().options.dt + 0.5);
    awake.step(steps), sleepy.step(steps);
    if (sleepy.awake_fraction() > 0) return std::numeric_limits<double>::infinity();
    std::vector<double> a(awake.size(Field::position)), b(a.size());
    awake.read(Field::position, a), sleepy.read(Field::position, b);
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  t.note = "the value is infinite while a world is awake";
  return t;
}

Trial same_bits() {
  Trial t = trial("B46", "5 s of a pile with 1 and 3 threads, both layouts and other batch sizes",
                  "worlds whose bits differ", "", 0, 5);
  t.scene = [] { return pile(true); };
  t.whole = [](const Plan& plan, BatchOptions options) {
    const int steps = static_cast<int>(5 / plan.scene().options.dt + 0.5);
    options.threads = 1;
    Batch first(plan, options);
    first.step(steps);
    double out = 0;
    for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
      options.threads = 3, options.layout = layout;
      Batch again(plan, options);
      again.step(steps);
      out += different(first, again, -1);
    }
    BatchOptions alone = options;
    alone.worlds = 1, alone.seed = options.seed + 5;
    Batch one(plan, alone);
    one.step(steps);
    return out + (one.hash(0) == first.hash(5) ? 0 : 1);
  };
  return t;
}

}  // namespace

std::vector<Trial> law_trials() { return {poisoned(), asleep(), as_awake(), same_bits()}; }

}  // namespace manyworlds::report
