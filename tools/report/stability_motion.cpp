// Fast spins, bullets and places far away (numerics.md B26 to B32).
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

const Vec3 kMoments = Vec3(0.13, 0.10, 0.05) / 3;  // MuJoCo's box, 1 kg

Trial spinning(const std::string& id, const std::string& title, const Vec3& rate, double dt,
               double seconds, double limit) {
  Trial t;
  t.id = id, t.title = title, t.limit = limit;
  t.criterion = "energy divided by that at the start, or the inverse";
  t.seconds = seconds, t.dt = dt;
  t.scene = [=] {
    Scene scene = empty(Space::spatial, 0);
    scene.add(lump(Space::spatial, 1, kMoments, Vec3::Zero()));
    scene.bodies[0].angular_velocity = rate;
    scene.bodies[0].jitter.angle = 1e-3;  // the spin stays in the world, and differs in the body
    return scene;
  };
  t.value = [](const Seen& s, int w) {
    const double ratio = s.energy(w) / s.start_energy(w);
    return std::max(ratio, 1 / ratio);
  };
  return t;
}

Trial bullet(bool planar) {
  Trial t;
  t.id = planar ? "B29 2D" : "B29 3D";
  t.title = planar ? "circle at 200 m/s against a wall of 10 cm"
                   : "sphere at 180 m/s against a wall of 20 cm";
  t.criterion = "position beyond the middle of the wall", t.unit = "m";
  t.seconds = 1;
  t.scene = [planar] {
    const Space space = planar ? Space::planar : Space::spatial;
    Scene scene = empty(space, 0);
    Body wall = with_shape(planar ? Geometry(Polygon::box(0.05, 5)) : Geometry(Box{{0.1, 5, 5}}),
                           Vec3::Zero(), 0.6);
    wall.motion = Motion::fixed;
    scene.add(wall);
    Body body =
        with_shape(planar ? Geometry(Circle{0.1}) : Geometry(Sphere{0.1}), {-10, 0, 0}, 0.6);
    body.linear_velocity = {planar ? 200.0 : 180.0, 0, 0};
    body.jitter.position = {3, 0.3, planar ? 0 : 0.3};
    scene.add(body);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return std::max(0.0, s.position(w, 0).x()); };
  return t;
}

// A stack far from the origin.
Trial far(double distance) {
  Trial t;
  t.id = distance < 1e4 ? "B32 6 km" : "B32 100 km";
  t.title = "stack of five cubes far from the origin";
  t.criterion = "speed", t.unit = "m/s", t.limit = 1;
  t.scene = [distance] {
    Scene scene = empty(Space::spatial, 10);
    scene.add(ground(Space::spatial, 0.6));
    for (int i = 0; i < 5; ++i) {
      Body box = with_shape(Box{Vec3::Constant(0.5)}, {distance, -0.8 * distance, 0.5 + i}, 0.6);
      box.jitter.position = {1e-3, 1e-3, 0};
      scene.add(box);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  if (distance > 1e4) {
    t.note = "float32 resolves 8 mm at 100 km, so faces of cubes do not touch exactly";
  }
  return t;
}

// Times at which the spin about the middle axis changes its sign, s, by Runge-Kutta 4 in body axes.
std::vector<double> flips_of(const Vec3& moments, Vec3 w, double seconds) {
  constexpr double h = 1e-4;
  const auto rate = [&](const Vec3& v) {
    return Vec3(((moments.y() - moments.z()) * v.y() * v.z()) / moments.x(),
                ((moments.z() - moments.x()) * v.z() * v.x()) / moments.y(),
                ((moments.x() - moments.y()) * v.x() * v.y()) / moments.z());
  };
  std::vector<double> out;
  for (int i = 0; i * h < seconds; ++i) {
    const Vec3 a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
    const Vec3 next = w + h / 6 * (a + 2 * b + 2 * c + d);
    if (next.y() * w.y() < 0) out.push_back((i + 1) * h);
    w = next;
  }
  return out;
}
Vec3 spin_in_body(const Seen& s, int w) { return s.rotation(w, 0).conjugate() * s.spin(w, 0); }

// A book that is thrown up, spinning about one of its axes.
Trial book(int axis) {
  Trial t = trial(axis == 1   ? "B28 middle"
                  : axis == 0 ? "B28 largest"
                              : "B28 least",
                  std::string("book that spins about its axis of ") +
                      (axis == 1   ? "middle"
                       : axis == 0 ? "largest"
                                   : "least") +
                      " moment",
                  axis == 1 ? "relative error of the time between flips" : "tilt of its axis",
                  axis == 1 ? "" : "rad", axis == 1 ? 0.1 : 0.05, 20);
  const Vec3 half(0.08, 0.35, 0.5);  // moments fall from x to z
  const Vec3 moments =
      Vec3(half.y() * half.y() + half.z() * half.z(), half.x() * half.x() + half.z() * half.z(),
           half.x() * half.x() + half.y() * half.y()) /
      3;
  Vec3 rate = Vec3::Constant(0.01);
  rate[axis] += 5;
  t.scene = [=] {
    Scene scene = empty(Space::spatial, 0);
    scene.add(lump(Space::spatial, 1, moments, Vec3::Zero()));
    scene.bodies[0].angular_velocity = rate;
    return scene;
  };
  if (axis != 1) {
    t.value = [axis](const Seen& s, int w) {
      const Vec3 spin = spin_in_body(s, w);
      return std::acos(std::min(1.0, spin[axis] / spin.norm()));
    };
    return t;
  }
  const std::vector<double> wanted = flips_of(moments, rate, t.seconds);
  struct Flips {
    double last = 1, first_time = 0, last_time = 0;
    int count = 0;
  };
  const auto seen = std::make_shared<std::vector<Flips>>();
  t.value = [=](const Seen& s, int w) {
    if (seen->size() <= static_cast<std::size_t>(w)) seen->resize(static_cast<std::size_t>(w) + 1);
    Flips& f = (*seen)[static_cast<std::size_t>(w)];
    if (s.time() < f.last_time || s.time() < 0.1) f = {};
    const double now = spin_in_body(s, w).y();
    if (now * f.last < 0) {
      if (f.count == 0) f.first_time = s.time();
      ++f.count, f.last_time = s.time();
    }
    f.last = now;
    if (s.time() < 19.9) return 0.0;
    if (f.count < 2) return std::numeric_limits<double>::infinity();
    const double period = (f.last_time - f.first_time) / (f.count - 1),
                 right =
                     (wanted.back() - wanted.front()) / (static_cast<double>(wanted.size()) - 1);
    return std::abs(period / right - 1);
  };
  return t;
}

// A ball that flies 12 times its radius in a step lands on the ground.
Trial landing() {
  Trial t = trial("B31 landing", "ball of 5 cm that lands at 20 m/s, steps of 30 ms",
                  "penetration at the end", "m", 0.01, 1.2);
  t.at_end = true, t.dt = 0.03;
  t.scene = [] {
    Scene scene = empty(Space::spatial, 10);
    scene.add(ground(Space::spatial, 0.6));
    Body ball = with_shape(Sphere{0.05}, {0, 0, 2}, 0.6);
    ball.linear_velocity = {0, 0, -20}, ball.jitter.position = {0, 0, 0.5};
    scene.add(ball);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return 0.05 - s.position(w, 0).z(); };
  return t;
}
// A box that flies past a corner, and over an edge, without touching.
Trial passing() {
  Trial t = trial("B31 passing", "box that passes 2 cm above another at 60 m/s",
                  "relative change of its speed", "", 0.01, 0.5);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 0);
    Body block = with_shape(Polygon::box(2, 0.5), {0, -0.5, 0}, 0.6);
    block.motion = Motion::fixed;
    scene.add(block);
    Body box = with_shape(Polygon::box(0.5, 0.5), {-10, 0.52, 0}, 0.6);
    box.linear_velocity = {60, 0, 0}, box.jitter.position = {0.5, 0, 0};
    scene.add(box);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return std::abs(1 - s.velocity(w, 0).norm() / 60); };
  return t;
}

}  // namespace

std::vector<Trial> motion_trials() {
  std::vector<Trial> out = {
      spinning("B26 100", "box that spins at 100 rad/s", {0.1, 100, 0.1}, 1.0 / 240, 10, 1.05),
      spinning("B26 1000", "box that spins at 1000 rad/s", {1, 1000, 1}, 1.0 / 60, 10, 2.1),
      spinning("B27 middle", "box that tumbles about its middle axis for 100 s", {0.05, 5, 0.05},
               0.005, 100, 1.01),
      spinning("B27 long", "box that spins about its x axis for 100 s", {20, 0.05, 0.05}, 0.005,
               100, 1.01),
      book(0),
      book(1),
      book(2),
      bullet(true),
      bullet(false),
      landing(),
      passing(),
      far(6e3),
      far(1e5)};
  return out;
}

}  // namespace manyworlds::report
