// Cases with contacts: friction, restitution, many contacts at once (numerics.md A15 to A22).
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tools/report/accuracy.hpp"
#include "tools/report/reference.hpp"

namespace manyworlds::report {
namespace {

Case of_contacts(const std::string& id, const std::string& title, const std::string& metric,
                 const std::string& unit, double level, double seconds) {
  Case c;
  c.id = id, c.title = title, c.metric = metric, c.unit = unit, c.level = level;
  c.seconds = c.quick_seconds = seconds;
  c.steps = {1e-2, 4e-3, 1e-3, 4e-4}, c.quick_steps = {1e-2, 4e-3};
  c.methods = substeps({1, 4});
  for (Method& m : other_solvers(true)) c.methods.push_back(std::move(m));
  return c;
}

// A box with 25 balls on it that a force pulls along (SimBenchmark "rolling").
Case rolling(const std::string& id, const Vec3& way) {
  Case c = of_contacts(id, "pulled box with 25 balls on it (SimBenchmark)",
                       "mean of |v - a t|^2 of box and a ball", "m^2/s^2", 1e-6, 4);
  // Pairs use the geometric mean: 0.4 of box and ground, 0.8 of box and balls.
  c.scene = [] {
    Scene scene = empty(Space::spatial);
    scene.add(ground(Space::spatial, 0.4));
    Body box = with_shape(Box{{10, 10, 0.5}}, {0, 0, 0.5}, 0.4);
    weigh(box, 10, 10.0 / 12 * Vec3(401, 401, 800));
    scene.add(box);
    for (int i = 0; i < 25; ++i) {
      Body ball = with_shape(Sphere{0.5}, {2.0 * (i % 5) - 4, 2.0 * (i / 5) - 4, 1.5}, 1.6);
      weigh(ball, 1, Vec3::Constant(0.1));
      scene.add(ball);
    }
    return scene;
  };
  c.before_step = [way](Batch& b) {
    for (int w = 0; w < b.worlds(); ++w) b.add_force(w, b.body_in_row(0), 150 * way);
  };
  const double held = 0.4 * 35 * kG, pull = ((150 - held) / 10) / (3.5 + 2.5);
  const double box = (150 - held - 25 * pull) / 10;
  c.over = Over::mean;
  c.error = [=](const Batch& b, double t) {
    return (velocity(b, 0, 0) - box * t * way).squaredNorm() +
           (velocity(b, 0, 1) - pull * t * way).squaredNorm();
  };
  if (way.x() != 0) {
    c.published = {{"Bullet", 1e-3, 5.7e-9, 0.562},
                   {"RaiSim", 1e-3, 4.1e-7, 0.308},
                   {"MuJoCo Euler", 1e-3, 7e-3},
                   {"ODE", 1e-3, 3.145},
                   {"DART", 1e-3, 3.145}};
  } else {
    c.published = {{"ODE", 1e-3, 7.7e-9}, {"DART", 1e-3, 0.426}};
  }
  return c;
}

double energy_error(const Batch& b, double start) {
  const Energy e = b.energy(0);
  return (e.kinetic + e.potential - start) * (e.kinetic + e.potential - start);
}

Case bouncing() {
  Case c = of_contacts("A16", "49 balls that bounce without loss (SimBenchmark)",
                       "mean of (E - E0)^2", "J^2", 1, 20);
  c.scene = [] {
    Scene scene = empty(Space::spatial);
    scene.options.length_unit = 0.2;
    scene.add(ground(Space::spatial, 0, 1));
    for (int i = 0; i < 49; ++i) {
      Body ball = with_shape(Sphere{0.1}, {2.0 * (i % 7), 2.0 * (i / 7), 5}, 0, 1);
      weigh(ball, 10, Vec3::Constant(0.04));
      scene.add(ball);
    }
    return scene;
  };
  c.over = Over::mean;
  c.error = [](const Batch& b, double) { return energy_error(b, 49 * 10 * kG * 5); };
  c.published = {{"RaiSim", 1e-2, 186, 0.0253},   {"RaiSim", 4e-3, 4.76, 0.0611},
                 {"RaiSim", 1e-3, 0.0186, 0.235}, {"RaiSim", 4e-4, 4.77e-4, 0.602},
                 {"ODE", 1e-2, 1.88e4, 0.189},    {"ODE", 4e-3, 2980, 0.474},
                 {"ODE", 1e-3, 185, 1.89},        {"ODE", 4e-4, 29.6, 4.6},
                 {"Bullet", 1e-2, 7.41e6, 0.102}, {"Bullet", 4e-3, 1.2e6, 0.227},
                 {"Bullet", 1e-3, 7.52e4, 0.852}, {"Bullet", 4e-4, 1.2e4, 2.08}};
  return c;
}

// 6 x 6 x 6 balls 1 cm apart, dropped.
Scene cube_of_balls(double height, double restitution) {
  Scene scene = empty(Space::spatial);
  scene.options.length_unit = 0.2;
  scene.add(ground(Space::spatial, 0, restitution));
  std::mt19937 draw(1);  // its numbers are the same everywhere
  const auto jitter = [&] { return 1e-3 * static_cast<double>(draw()) / 4294967296.0; };
  for (int i = 0; i < 216; ++i) {
    const Vec3 at(0.21 * (i % 6), 0.21 * (i / 6 % 6), height + 0.21 * (i / 36));
    Body ball = with_shape(Sphere{0.1}, at + Vec3(jitter(), jitter(), jitter()), 0, restitution);
    weigh(ball, 10, Vec3::Constant(0.04));
    scene.add(ball);
  }
  return scene;
}

Case heap() {
  Case c = of_contacts("A17", "216 balls dropped 1 mm (SimBenchmark 666)",
                       "mean of the sum of squared overlaps", "m^2", 1e-2, 10);
  c.quick_seconds = 2, c.quick_steps = {1e-2};
  c.scene = [] { return cube_of_balls(0.101, 0); };
  c.over = Over::mean;
  c.error = [](const Batch& b, double) {
    std::vector<double> all(static_cast<std::size_t>(3 * b.bodies(0)));
    b.read(Field::position, 0, all);
    const Eigen::Map<const Eigen::Matrix3Xd> x(all.data(), 3, b.bodies(0));
    double sum = 0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      sum += std::pow(std::max(0.0, 0.1 - x(2, i)), 2);
      for (Eigen::Index k = 0; k < i; ++k) {
        const double far = (x.col(i) - x.col(k)).squaredNorm();
        if (far < 0.04) sum += std::pow(0.2 - std::sqrt(far), 2);
      }
    }
    return sum;
  };
  c.published = {{"RaiSim", 1e-3, 1.35e-4, 1.51},  {"ODE", 1e-2, 0.0161, 1.36},
                 {"ODE", 4e-3, 0.00242, 2.78},     {"ODE", 1e-3, 1.55e-4, 10.6},
                 {"ODE", 4e-4, 2.62e-5, 25.2},     {"DART Dantzig", 1e-3, 2.82e-4, 22.9},
                 {"MuJoCo CG", 1e-2, 0.934, 1.79}, {"MuJoCo CG", 4e-3, 0.374, 4.33},
                 {"MuJoCo CG", 1e-3, 0.095, 12.1}, {"Bullet", 1e-2, 37.4, 2.01},
                 {"Bullet", 4e-3, 5.78, 4.14},     {"Bullet", 1e-3, 0.382, 12}};
  return c;
}

Case elastic_heap() {
  Case c = of_contacts("A17e", "216 balls dropped 1 m that bounce without loss (SimBenchmark)",
                       "mean of (E - E0)^2", "J^2", 1e4, 10);
  c.quick_seconds = 2, c.quick_steps = {1e-2};
  c.scene = [] { return cube_of_balls(1.101, 1); };
  double start = 0;
  for (const Body& b : c.scene().bodies) start += b.position.z() * 10 * kG;
  c.over = Over::mean;
  c.error = [start](const Batch& b, double) { return energy_error(b, start); };
  c.published = {{"RaiSim", 1e-4, 1.1e-3, 6.1},
                 {"ODE", 1e-4, 1.1, 56},
                 {"Bullet", 1e-4, 168, 21},
                 {"DART", 1e-4, 2438}};
  return c;
}

}  // namespace

std::vector<Case> contact_cases() {
  std::vector<Case> out = {rolling("A15x", Vec3(0.5, std::sqrt(0.75), 0)),
                           rolling("A15y", Vec3::UnitY()), bouncing(), heap(), elastic_heap()};

  const double slope = kPi / 12, a = 5.0 / 7 * kG * std::sin(slope);
  Case roll = of_contacts("A19", "ball that rolls down a slope of 15 degrees",
                          "relative speed error after 1 s", "share", 1e-3, 1);
  roll.scene = [=] {
    Scene scene = scenes::incline(Space::spatial, slope, 1, Sphere{0.05}, 0.05);
    scene.options.length_unit = 0.1;
    return scene;
  };
  roll.error = [=](const Batch& b, double t) {
    return std::max(std::abs(velocity(b, 0, 0).x() - a * t),
                    std::abs(0.05 * spin(b, 0, 0).y() - a * t)) /
           (a * t);
  };
  out.push_back(roll);

  Case stop = of_contacts("A20", "block that slides to a stop", "relative error of the distance",
                          "share", 1e-3, 2);
  stop.scene = [] {
    Scene scene = scenes::incline(Space::spatial, 0, 0.3, Box{Vec3::Constant(0.25)}, 0.25);
    scene.bodies[1].linear_velocity = {5, 0, 0};
    return scene;
  };
  stop.error = [](const Batch& b, double) {
    const double distance = 25 / (2 * 0.3 * kG);
    return std::abs(position(b, 0, 0).x() - distance) / distance;
  };
  out.push_back(stop);

  Case bounce = of_contacts("A21", "ball that bounces, restitution 0.8",
                            "largest height error over four bounces", "m", 1e-2, 2.4);
  bounce.scene = [] {
    Scene scene = empty(Space::spatial);
    scene.options.contact.restitution_threshold = 0.1;
    scene.add(ground(Space::spatial, 0, 0.8));
    scene.add(with_shape(Sphere{0.1}, {0, 0, 1.1}, 0, 0.8));
    return scene;
  };
  bounce.over = Over::largest;
  bounce.error = [](const Batch& b, double t) {
    double from = std::sqrt(2 / kG), v = kG * from;  // of the first impact
    double height = 1 - 0.5 * kG * t * t;
    while (t >= from) {
      v *= 0.8;
      const double since = t - from;
      height = v * since - 0.5 * kG * since * since;
      from += 2 * v / kG;
    }
    return std::abs(position(b, 0, 0).z() - 0.1 - height);
  };
  out.push_back(bounce);

  Case grip = of_contacts("A22", "spinning ball that hits the ground and grips",
                          "velocity error after the impact, relative to the speed before", "share",
                          1e-4, 0.5);
  grip.scene = [] {
    Scene scene = empty(Space::spatial, 0);
    scene.add(ground(Space::spatial, 1, 0.5));
    scene.add(with_shape(Sphere{0.25}, {0, 0, 1}, 1, 0.5));
    scene.bodies[1].linear_velocity = {2, 0, -5};
    scene.bodies[1].angular_velocity = {0, -8, 0};
    return scene;
  };
  grip.error = [](const Batch& b, double) {
    const double along = (5 * 2 + 2 * 0.25 * -8) / 7.0;
    const Vec3 off = velocity(b, 0, 0) - Vec3(along, 0, 2.5);
    return std::hypot(off.norm(), 0.25 * spin(b, 0, 0).y() - along) / std::sqrt(29.0);
  };
  out.push_back(grip);
  return out;
}

}  // namespace manyworlds::report
