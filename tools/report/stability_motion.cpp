// Fast spins, bullets and places far away (numerics.md B26 to B32).
#include <algorithm>
#include <cmath>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

const Vec3 kMoments = Vec3(0.13, 0.10, 0.05) / 3;  // MuJoCo's box, 1 kg

Trial spinning(const std::string& id, const std::string& title, const Vec3& rate, double dt,
               double seconds, double limit) {
  Trial t;
  t.id = id, t.title = title, t.limit = limit;
  t.criterion = "energy to that of its start, or the other way round";
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
  t.criterion = "place beyond the middle of the wall", t.unit = "m";
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
  t.title = "five cubes so far from the origin";
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
    t.note = "a float32 place 100 km away is known to 8 mm: faces of cubes do not meet exactly";
  }
  return t;
}

}  // namespace

std::vector<Trial> motion_trials() {
  std::vector<Trial> out = {
      spinning("B26 100", "box that spins at 100 rad/s", {0.1, 100, 0.1}, 1.0 / 240, 10, 1.05),
      spinning("B26 1000", "box that spins at 1000 rad/s", {1, 1000, 1}, 1.0 / 60, 10, 2.1),
      spinning("B27 middle", "box that tumbles about its middle axis for 100 s", {0.05, 5, 0.05},
               0.005, 100, 1.01),
      spinning("B27 long", "box that spins about another for 100 s", {20, 0.05, 0.05}, 0.005, 100,
               1.01),
      bullet(true),
      bullet(false),
      far(6e3),
      far(1e5)};
  return out;
}

}  // namespace manyworlds::report
