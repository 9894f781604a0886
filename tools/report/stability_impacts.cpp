// Impacts that share bodies, and rough ground (C6, C7, C9).
#include <algorithm>
#include <cmath>
#include <string>

#include "manyworlds/scenes.hpp"
#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

Trial elastic_balls() {
  Trial t = trial("C6 balls", "20 elastic balls in a closed box, no gravity",
                  "relative energy error within 60 s", "", 0.01, 60);
  t.scene = [] {
    Scene scene = empty(Space::spatial, 0);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Body wall = with_shape(Plane{-side * Vec3::Unit(axis), -2}, Vec3::Zero(), 0, 1);
        wall.motion = Motion::fixed;
        scene.add(wall);
      }
    }
    for (int i = 0; i < 20; ++i) {
      const Vec3 place(0.8 * (i % 5 - 2), 0.8 * (i / 5 - 1.5), 0);
      Body ball = with_shape(Sphere{0.3}, place, 0, 1);
      ball.jitter.position = {0.09, 0.09, 0.3};
      ball.jitter.linear_velocity = {3, 3, 3};
      scene.add(ball);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return std::abs(s.energy(w) / s.start_energy(w) - 1); };
  return t;
}

// Both normals are 30 degrees off the line of motion: v' = -v / 5.
Scene ball_on_two(double radius) {
  Scene scene = empty(Space::spatial, 0);
  for (const Vec3& place :
       {Vec3(-1.05 * std::sqrt(3.0) * radius, 0, 0), Vec3(0, radius, 0), Vec3(0, -radius, 0)}) {
    scene.add(with_shape(Sphere{radius}, place, 0, 1));
  }
  scene.bodies[0].linear_velocity = {2, 0, 0};
  scene.bodies[0].jitter.position.x() = 0.08 * radius;
  return scene;
}

Trial on_two(double radius) {
  Trial t = trial(radius < 0.1 ? "C7 two 5 cm" : "C7 two 50 cm",
                  "ball at 2 m/s that hits two touching balls at once",
                  "relative error of its velocity of -0.4 m/s", "", 0.01, 1);
  t.at_end = true;
  t.scene = [radius] { return ball_on_two(radius); };
  t.value = [](const Seen& s, int w) { return std::abs(s.velocity(w, 0).x() / -0.4 - 1); };
  return t;
}
Trial mirrored() {
  Trial t = trial("C7 mirror", "the same",
                  "difference of one's velocity and the other's mirror image", "m/s", 1e-4, 1);
  t.at_end = true;
  t.scene = [] { return ball_on_two(0.5); };
  t.value = [](const Seen& s, int w) {
    const Vec3 a = s.velocity(w, 1), b = s.velocity(w, 2);
    return (a - Vec3(b.x(), -b.y(), b.z())).norm();
  };
  return t;
}

// The kernels' own contacts; tests/collide/rough_ground_test.cpp compares them with the ground.
Trial rough_ground() {
  Trial t = trial("C9 hills", "24 bodies of every shape on hills",
                  "largest penetration from 5 s on", "m", 6e-3, 10);
  t.note = "the limit is 2 slop; resting bodies sink by a tenth of that";
  t.scene = [] { return scenes::find("hills")->make(); };
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    Batch batch(plan, options);
    const auto steps = [&](double seconds) {
      return static_cast<int>(std::lround(seconds / plan.scene().options.dt));
    };
    double deepest = 0;
    batch.step(steps(5));
    for (int i = 0; i < 10; ++i) {
      batch.step(steps(0.5));
      deepest = std::max(deepest, batch.measure_contacts().max_penetration);
    }
    return deepest;
  };
  return t;
}

}  // namespace

std::vector<Trial> impact_trials() {
  return {elastic_balls(), on_two(0.5), on_two(0.05), mirrored(), rough_ground()};
}

}  // namespace manyworlds::report
