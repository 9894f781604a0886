// Structures that are to stay, and what friction stops (numerics.md B7, B19, B24, B37).
#include <algorithm>
#include <cmath>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

// The centre of those above lies over each box, an eighth of it from its edge at least.
Trial tilted() {
  Trial t = trial("B7 tilted", "five squares, each 15 cm beyond the one below",
                  "largest displacement after 20 s", "m", 0.05, 20);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    scene.options.density = 1;
    scene.add(ground(Space::planar, 0.6));
    for (int i = 0; i < 5; ++i) {
      Body box = with_shape(Polygon::box(0.5, 0.5), {0.15 * i, 0.5 + i, 0}, 0.6);
      box.jitter.position = {1e-3, 0, 0};
      scene.add(box);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) {
    double most = 0;
    for (int b = 0; b < s.bodies(); ++b) most = std::max(most, s.moved(w, b).norm());
    return most;
  };
  return t;
}

Trial cantilever() {
  Trial t = trial("B7 cantilever", "beam of eight boxes welded to a wall",
                  "sag of its tip, in beam lengths", "", 0.05, 10);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    scene.options.density = 20;
    for (int i = 0; i < 8; ++i) {
      Body box = with_shape(Polygon::box(0.5, 0.25), {0.5 + i, 0, 0});
      box.shapes[0].filter.mask = 0;
      box.jitter.linear_velocity = {0, 0.01, 0};
      scene.add(box);
      scene.add(joint_at(scene, BodyId(i - 1), BodyId(i), frame_at(i, 0), FixedJoint{}));
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return std::abs(s.moved(w, 7).y()) / 8; };
  t.note = "swept joints are springs; more substeps make them stiffer";
  return t;
}

constexpr int kLinks = 160;
constexpr double kSpan = 158;

// Sag of a cable of kLinks m over kSpan m: 2 a sinh(span / 2a) = length.
double catenary_sag() {
  double low = 1, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2 * a * std::sinh(kSpan / 2 / a) > kLinks ? low : high) = a;
  }
  return low * (std::cosh(kSpan / 2 / low) - 1);
}

Trial bridge() {
  Trial t = trial("B19", "bridge of 160 links over 158 m", "relative error of the sag of a cable",
                  "", 0.05, 30);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    for (int i = 0; i < kLinks; ++i) {
      Body link =
          with_shape(Polygon::box(0.5, 0.125), {(i + 0.5) * kSpan / kLinks - kSpan / 2, 0, 0});
      link.shapes[0].density = 20, link.shapes[0].filter.mask = 0;
      link.linear_drag = link.angular_drag = 0.1;
      scene.add(link);
    }
    for (int i = 0; i <= kLinks; ++i) {
      Joint hinge;
      hinge.body_a = BodyId(i == kLinks ? -1 : i - 1);
      hinge.body_b = BodyId(i == kLinks ? i - 1 : i);
      hinge.frame_a.position = {i == 0 ? -kSpan / 2 : i == kLinks ? kSpan / 2 : 0.5, 0, 0};
      hinge.frame_b.position = {i == kLinks ? 0.5 : -0.5, 0, 0};
      scene.add(hinge);
    }
    return scene;
  };
  const double right = catenary_sag();
  t.value = [right](const Seen& s, int w) {
    double sag = 0;
    for (int b = 0; b < s.bodies(); ++b) sag = std::max(sag, -s.position(w, b).y());
    return std::abs(sag / right - 1);
  };
  t.note = "a swept row of 160 soft joints stretches; it needs 32 substeps";
  return t;
}

// 1000 kg on two wheels of 1.6 kg each, under 22 m/s^2.
Trial cart() {
  Trial t =
      trial("B24", "cart of 1000 kg on sprung wheels of 1.6 kg", "speed after 2 s", "m/s", 0.1, 12);
  t.from = 2;
  t.scene = [] {
    Scene scene = empty(Space::planar, 22);
    Options& o = scene.options;
    o.substeps = 12, o.contact.frequency = 240, o.contact.push_out_speed = 0.5;
    o.joint.frequency = 240, o.joint.damping_ratio = 0;
    scene.add(ground(Space::planar, 0.6));
    Body chassis = with_shape(Polygon::box(1, 0.25), {0, 0.6, 0}, 0.6);
    chassis.shapes[0].density = 1000, chassis.jitter.position = {0, 0.01, 0};
    const BodyId cart = scene.add(chassis);
    for (const double x : {-0.8, 0.8}) {
      Body wheel = with_shape(Circle{0.1}, {x, 0.1, 0}, 0.6);
      wheel.shapes[0].density = 50;
      const BodyId body = scene.add(wheel);
      const WheelJoint suspension{Spring{2.2e5, 1.2e4, 0, 0}, Limit{-0.2, 0.2, {}}, {}};
      Frame at;
      at.position = {x, 0.1, 0};
      at.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
      scene.add(joint_at(scene, cart, body, at, suspension));
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

Trial sliding() {
  Trial t = trial("B37", "boxes that slide to rest from 10 m/s, friction 0.1 to 0.75",
                  "relative error of a distance v^2 / (2 mu g)", "", 0.02, 12);
  t.at_end = true;
  static constexpr double kFrictions[] = {0.1, 0.35, 0.5, 0.75};
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    scene.add(ground(Space::planar, 1));
    for (int i = 0; i < 4; ++i) {  // those that come to rest first are in front
      const double mu = kFrictions[i];
      Body box = with_shape(Polygon::box(0.5, 0.1), {200.0 * i, 0.1, 0}, mu * mu);
      box.linear_velocity = {10, 0, 0}, box.jitter.position = {0.5, 0, 0};
      scene.add(box);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) {
    double most = 0;
    for (int i = 0; i < 4; ++i) {
      const double right = 100 / (2 * kFrictions[i] * 10);
      most = std::max(most, std::abs(s.moved(w, i).x() / right - 1));
    }
    return most;
  };
  return t;
}

}  // namespace

std::vector<Trial> structure_trials() {
  return {tilted(), cantilever(), bridge(), cart(), sliding()};
}

}  // namespace manyworlds::report
