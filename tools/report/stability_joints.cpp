// Chains, ropes, springs and loops under loads (numerics.md B15 to B25).
#include <algorithm>
#include <cmath>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

// Links of a half length in a row along x from the origin, hinged end to end, and what hangs on the
// last one.
Scene chain(int links, double half, double radius, const Body& load, double load_reach) {
  Scene scene = empty(Space::planar, 10);
  scene.options.density = 20;
  const auto pin = [&](int a, int b, double x) {
    scene.add(joint_at(scene, BodyId(a), BodyId(b), frame_at(x, 0), HingeJoint{}));
  };
  for (int i = 0; i < links; ++i) {
    Body link = with_shape(Capsule{radius, half}, {half * (2 * i + 1), 0, 0});
    link.shapes[0].filter.mask = 0;
    link.angular_drag = link.linear_drag = 0.1;
    link.jitter.linear_velocity = {0, 0.05, 0};
    scene.add(link);
    pin(i - 1, i, 2 * half * i);
  }
  Body end = load;
  end.position = {2 * half * links + load_reach, 0, 0};
  end.shapes[0].filter.mask = 0;
  scene.add(end);
  pin(links - 1, links, 2 * half * links);
  return scene;
}

Trial ball_and_chain() {
  Trial t = trial("B15", "ball of 672 links' mass on 40 links", "gap of a joint", "m", 0.05, 10);
  t.scene = [] { return chain(40, 0.5, 0.125, with_shape(Circle{8}, Vec3::Zero()), 8); };
  t.value = [](const Seen& s, int w) { return s.worst_gap(w); };
  t.note = "also passes with swept joints and 12 substeps";
  return t;
}
Trial heavy_rope() {
  Trial t = trial("B16", "block of 1800 links' mass on 20 links", "gap of a joint", "m", 0.05, 10);
  t.scene = [] { return chain(20, 0.5, 0.25, with_shape(Polygon::box(15, 15), Vec3::Zero()), 15); };
  t.value = [](const Seen& s, int w) { return s.worst_gap(w); };
  return t;
}

// Joints that begin a metre apart, and close by 1 m/s each. Hung, and with joints that are closed,
// the same chain lashes like a whip: in its exact motion (tests/joint/direct_whip_test.cpp) the
// last bead reaches 70.2 m/s as it turns over. Pulls
// add what they part the ends by, at most.
Trial stretched(bool gravity) {
  constexpr double kWhip = 70, kPulls = 40;  // m/s
  Trial t = trial(
      gravity ? "B17 hung" : "B17",
      std::string("chain whose 40 joints start 1 m apart") + (gravity ? ", under gravity" : ""),
      "speed", "m/s", gravity ? kWhip + kPulls : 50, 3);
  t.scene = [gravity] {
    Scene scene = empty(Space::planar, gravity ? 10 : 0);
    scene.options.joint.pull_speed = 1;
    for (int i = 0; i < 40; ++i) {
      Body bead = with_shape(Circle{0.2}, {2.0 * i, 0, 0});
      bead.shapes[0].filter.mask = 0;
      bead.jitter.position = {1e-3, 1e-3, 0};
      scene.add(bead);
      Joint joint;
      joint.type = HingeJoint{};
      joint.body_a = BodyId(i - 1), joint.body_b = BodyId(i);
      joint.frame_a.position = {i == 0 ? -0.5 : 0.5, 0, 0}, joint.frame_b.position = {-0.5, 0, 0};
      scene.add(joint);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  if (gravity) t.note = "a chain that falls while it contracts whips";
  return t;
}

Trial grid() {
  Trial t = trial("B18", "net of 25 x 25 circles hung from five", "speed in the last second", "m/s",
                  5, 10);
  t.from = 9;
  t.scene = [] {
    Scene scene = empty(Space::planar, 20);
    scene.options.density = 1;
    const auto at = [](int i, int k) { return Vec3(i, -k, 0); };
    for (int k = 0; k < 25; ++k) {
      for (int i = 0; i < 25; ++i) {
        Body body = with_shape(Circle{0.4}, at(i, k));
        body.shapes[0].filter.mask = 0;
        body.linear_drag = 0.2;
        if (k == 0 && std::abs(i - 12) <= 2) body.motion = Motion::fixed;
        scene.add(body);
        const auto fixed = [&](int b) {
          return scene.bodies[static_cast<std::size_t>(b)].motion == Motion::fixed;
        };
        const auto pin = [&](int other, const Vec3& from) {
          const int self = 25 * k + i;
          Frame middle;
          middle.position = (at(i, k) + from) / 2;
          const int a = fixed(self) ? self : other,
                    b = fixed(self) ? other : self;  // A may be fixed
          if (!fixed(b)) scene.add(joint_at(scene, BodyId(a), BodyId(b), middle, HingeJoint{}));
        };
        if (i > 0) pin(25 * k + i - 1, at(i - 1, k));
        if (k > 0) pin(25 * (k - 1) + i, at(i, k - 1));
      }
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

// Masses that hang one below the other on springs, soft and stiff alternately.
Trial spring_chain() {
  Trial t = trial("B20", "eight masses on springs of 1000 and 1e6 N/m",
                  "error of a spring's extension F / k, in F / 1000", "", 0.01, 10);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    for (int i = 0; i < 8; ++i) {
      Body mass = lump(Space::planar, 1, Vec3::Ones(), {0, -1.0 - i, 0});
      mass.linear_drag = 1;
      mass.jitter.position = {0, 1e-3, 0};
      scene.add(mass);
      DistanceJoint line;
      line.length = 1, line.spring = Spring{i % 2 == 0 ? 1000.0 : 1e6, 1, 0, 0};
      Joint joint;
      joint.type = line, joint.body_a = BodyId(i - 1), joint.body_b = BodyId(i);
      scene.add(joint);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) {
    double most = 0;
    Vec3 above = Vec3::Zero();
    for (int i = 0; i < 8; ++i) {
      const Vec3 at = s.position(w, i);
      const double force = 10.0 * (8 - i), stiffness = i % 2 == 0 ? 1000 : 1e6;
      most = std::max(most, std::abs((at - above).norm() - 1 - force / stiffness) / (force / 1000));
      above = at;
    }
    return most;
  };
  return t;
}

Trial stiff_spring(double stiffness, Integrator integrator) {
  Trial t =
      trial(std::string("B21 ") + (stiffness < 1e5 ? "1e2" : "1e8") + " " + to_string(integrator),
            "mass on a spring, 600 steps", "distance from the rest position, in 1 m", "", 1.01, 10);
  t.scene = [=] {
    Scene scene = empty(Space::planar, 0);
    scene.options.integrator = integrator;
    if (integrator != Integrator::symplectic_euler) scene.options.substeps = 1;
    scene.add(lump(Space::planar, 1, Vec3::Ones(), {1, 0, 0}));
    scene.bodies[0].jitter.position = {1e-3, 0, 0};
    TargetJoint target;
    target.spring.stiffness = stiffness;
    Joint joint;
    joint.type = target, joint.body_b = BodyId(0);
    scene.add(joint);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.position(w, 0).norm(); };
  if (stiffness > 1e5 && integrator != Integrator::symplectic_euler &&
      integrator != Integrator::implicit_euler) {
    t.note =
        "explicit methods are stable up to omega h of about 2; implicit-euler and the default are "
        "always stable";
  }
  return t;
}

// A11 with large steps.
Trial loops() {
  Trial t = trial("B25", "40 loops of four bars at 1/60 s", "speed", "m/s", 7.2, 10);
  t.scene = [] { return scenes::loops_of_four_bars(40); };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

}  // namespace

std::vector<Trial> joint_trials() {
  std::vector<Trial> out = {ball_and_chain(), heavy_rope(), stretched(false),
                            stretched(true),  grid(),       spring_chain()};
  for (const Integrator i : {Integrator::symplectic_euler, Integrator::implicit_euler,
                             Integrator::velocity_verlet, Integrator::runge_kutta4}) {
    for (const double stiffness : {1e2, 1e8}) out.push_back(stiff_spring(stiffness, i));
  }
  out.push_back(loops());
  return out;
}

}  // namespace manyworlds::report
