// Stacks, overlaps, friction and scale (numerics.md B2 to B14 and B33 to B44).
#include <algorithm>
#include <cmath>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

constexpr double kFriction = 0.6;

Scene grounded(Space space, double friction = kFriction) {
  Scene scene = empty(space, 10);
  if (space == Space::planar) scene.options.density = 1;
  scene.add(ground(space, friction));
  return scene;
}
Body box2(double half_x, double half_y, double x, double y, double friction = kFriction) {
  Body body = with_shape(Polygon::box(half_x, half_y), {x, y, 0}, friction);
  body.jitter.position = {1e-3, 0, 0};
  return body;
}
Body cube(double half, const Vec3& at, double friction = kFriction) {
  Body body = with_shape(Box{Vec3::Constant(half)}, at, friction);
  body.jitter.position = {1e-3 * half, 1e-3 * half, 0};
  return body;
}

double sideways(const Vec3& v, Space space) {
  return (v - up_of(space).dot(v) * up_of(space)).norm();
}
Space space_of(const Seen& s) { return s.batch().plan().scene().space; }

// How far a tower's top is to the side of where it began.
double top_off(const Seen& s, int world) {
  const Vec3 moved = s.moved(world, s.bodies() - 1);
  return sideways(moved, space_of(s));
}

Trial mass_ratio(int which) {
  Trial t = trial("B" + std::to_string(which + 1), "", "", "m", 0, 10);
  t.at_end = true;
  if (which == 1) {
    t.note = "these mass ratios need 10 to 12 substeps";
    t.title = "three pyramids, tops of 100 to 300 times the density dropped on them";
    t.criterion = "height error of a box at the end", t.limit = 0.1;
    t.scene = [] {
      Scene scene = grounded(Space::planar, 0.5);
      for (int j = 0; j < 3; ++j) {
        for (int row = 0; row < 10; ++row) {
          for (int k = 0; k < 10 - row; ++k) {
            const double x = 2 * (k - (10 - row) / 2.0) - 20 + 22 * j;
            Body box = box2(1, 1, x, 1 + 2 * row + (row == 9 ? 2 : 0), 0.5);
            if (row == 9) box.shapes[0].density = 100.0 * (j + 1);
            scene.add(box);
          }
        }
      }
      return scene;
    };
    t.value = [](const Seen& s, int w) {
      double most = 0;
      for (int j = 0, body = 0; j < 3; ++j) {
        for (int row = 0; row < 10; ++row) {
          for (int k = 0; k < 10 - row; ++k, ++body) {
            most = std::max(most, std::abs(s.position(w, body).y() - (1 + 2 * row)));
          }
        }
      }
      return most;
    };
    return t;
  }
  t.title = which == 2 ? "box of 20 m dropped on two of 1 m" : "the same on a thick ground";
  t.criterion = "height error of the large box at the end", t.limit = 0.1;
  t.scene = [which] {
    Scene scene = empty(Space::planar, 10);
    scene.options.density = 1;
    if (which == 2) {
      scene.add(ground(Space::planar, kFriction));
    } else {
      Body slab = with_shape(Polygon::box(40, 2), {0, -2, 0}, kFriction);
      slab.motion = Motion::fixed;
      scene.add(slab);
    }
    scene.add(box2(0.5, 0.5, -9, 0.5)), scene.add(box2(0.5, 0.5, 9, 0.5));
    scene.add(box2(10, 10, 0, 26));
    return scene;
  };
  t.note = "these mass ratios need 10 to 12 substeps";
  t.value = [](const Seen& s, int w) { return std::abs(s.position(w, 2).y() - 11); };
  return t;
}

Trial tower(Space space, int boxes) {
  const bool planar = space == Space::planar;
  Trial t = trial("B6-" + std::to_string(boxes) + (planar ? " 2D" : " 3D"),
                  "tower of " + std::to_string(boxes) + (planar ? " squares" : " cubes"),
                  "sideways displacement of the top after 20 s", "m", 0.1, 20);
  t.at_end = true;
  t.scene = [=] {
    Scene scene = grounded(space, 0.3);
    for (int i = 0; i < boxes; ++i) {
      const double x = i % 2 == 0 ? 0.01 : -0.01, height = 0.5 + 1.1 * i;
      scene.add(planar ? box2(0.5, 0.5, x, height, 0.3) : cube(0.5, {x, 0, height}, 0.3));
    }
    return scene;
  };
  t.value = top_off;
  if (!planar && boxes > 10) {
    t.note = "a tall column of soft contacts buckles under its weight";
  }
  return t;
}

Trial card_house() {
  Trial t = trial("B9", "house of cards, five stories",
                  "vertical displacement of the top card after 10 s", "m", 0.02, 10);
  t.at_end = true;
  t.scene = [] {
    Scene scene = grounded(Space::planar, 0.7);
    const auto card = [&](double x, double y, double angle) {
      Body body = with_shape(Polygon::box(0.001, 0.2), {x, y, 0}, 0.7);
      body.rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
      body.jitter.position = {1e-5, 0, 0};
      scene.add(body);
    };
    const double lean = 25 * kPi / 180;
    double left = 0, y = 0.18;
    for (int pairs = 5; pairs > 0; --pairs, left += 0.175, y += 0.37) {
      for (int i = 0; i < pairs; ++i) {
        const double x = left + 0.35 * i;
        if (i + 1 < pairs) card(x + 0.25, y + 0.185, kPi / 2);
        card(x, y, -lean), card(x + 0.175, y, lean);
      }
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return std::abs(s.moved(w, s.bodies() - 1).y()); };
  return t;
}

Trial cylinders() {
  Trial t = trial("B11", "stack of five cylinders",
                  "sideways displacement of the top one after 20 s", "m", 0.02, 20);
  t.at_end = true;
  t.scene = [] {
    Scene scene = grounded(Space::spatial);
    for (int i = 0; i < 5; ++i) {
      Body body = with_shape(Cylinder{0.5, 0.5}, {0, 0, 0.5 + i}, kFriction);
      body.jitter.position = {1e-3, 1e-3, 0};
      scene.add(body);
    }
    return scene;
  };
  t.value = top_off;
  return t;
}

Trial warm_start() {
  Trial t = trial("B12", "circle of 100 times the density removed from two others",
                  "speed of the two from 0.06 s later on", "m/s", 0.05, 4);
  t.from = 2.06;
  t.scene = [] {
    Scene scene = grounded(Space::planar);
    for (int i = 0; i < 3; ++i) {
      Body ball = with_shape(Circle{0.5}, {0, 0.5 + i, 0}, kFriction);
      ball.shapes[0].density = i == 2 ? 100 : 1;
      ball.jitter.position = {0, 1e-3, 0};  // to the side they would topple by themselves
      scene.add(ball);
    }
    return scene;
  };
  t.act = [](Batch& b, double time) {
    if (std::abs(time - 2) > 1e-6) return;
    for (int w = 0; w < b.worlds(); ++w) b.set_enabled(w, b.body_in_row(2), false);
  };
  t.value = [](const Seen& s, int w) {
    return std::max(s.velocity(w, 0).norm(), s.velocity(w, 1).norm());
  };
  return t;
}

Trial overlap() {
  Trial t = trial("B13", "pyramid spawned with 25 % overlap", "speed of a box", "m/s", 3.5, 6);
  t.scene = [] {
    Scene scene = grounded(Space::planar);
    for (int row = 0; row < 4; ++row) {
      for (int k = 0; k < 4 - row; ++k) {
        scene.add(box2(0.5, 0.5, 0.75 * (k - 0.5 * (3 - row)), 0.5 + 0.75 * row));
      }
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

Trial coincident(int bodies, bool boxes) {
  Trial t = trial("B14-" + std::to_string(bodies) + (boxes ? " boxes" : " spheres"),
                  std::to_string(bodies) + " bodies at one position", "speed", "m/s", 4, 5);
  if (bodies == 100) {
    t.limit = 40;
    t.note =
        "separation velocities of pairs (at most 1.5 m/s each) add up along a row: n bodies "
        "separate at up to n / 4 times as much";
  }
  t.scene = [=] {
    Scene scene = empty(Space::spatial, 0);
    scene.options.contact_capacity = bodies * bodies / 2 + 8;
    for (int i = 0; i < bodies; ++i) {
      scene.add(boxes ? with_shape(Box{Vec3::Constant(0.5)}, Vec3::Zero(), kFriction)
                      : with_shape(Sphere{0.5}, Vec3::Zero(), kFriction));
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

// A small pyramid, or a stack of cubes of this size.
Trial scale(double size) {
  Trial t = trial(size == 0.05  ? "B33 5 cm"
                  : size < 0.05 ? "B33 1 mm"
                                : "B33 1 km",
                  "stack of five cubes", "displacement of the top, in cube sizes", "", 0.05,
                  100 * std::sqrt(size / 10));
  t.at_end = true;
  t.dt = std::sqrt(size) / 60;  // falls take as many steps whatever the size
  t.scene = [size] {
    Scene scene = grounded(Space::spatial);
    for (int i = 0; i < 5; ++i) scene.add(cube(size / 2, {0, 0, size * (0.5 + i)}));
    return scene;
  };
  t.value = [size](const Seen& s, int w) { return s.moved(w, 4).norm() / size; };
  return t;
}

Trial large_step() {
  Trial t = trial("B34", "stack of five cubes, steps of 0.1 s",
                  "displacement of the top after 20 s", "m", 0.05, 20);
  t.at_end = true;
  t.dt = 0.1;
  t.scene = [] {
    Scene scene = grounded(Space::spatial);
    for (int i = 0; i < 5; ++i) scene.add(cube(0.5, {0, 0, 0.5 + i}));
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.moved(w, 4).norm(); };
  return t;
}

// A rod whose tip leads on rough ground: no forces fit rigid laws at that instant.
Trial painleve() {
  Trial t = trial("B35", "Painleve's rod, friction 2", "relative energy gain", "", 0.01, 3);
  t.scene = [] {
    Scene scene = grounded(Space::planar, 2);
    const double angle = 63.435 * kPi / 180;
    Body rod = with_shape(Polygon::box(0.5, 0.005), Vec3::Zero(), 2);
    rod.rotation = Quat(Eigen::AngleAxisd(kPi - angle, Vec3::UnitZ()));
    rod.position = {0, 0.5 * std::sin(angle) + 0.005, 0};
    rod.linear_velocity = {1, 0, 0};
    weigh(rod, 1, Vec3::Constant(1.0 / 12));
    rod.jitter.linear_velocity = {0.01, 0, 0};
    scene.add(rod);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.energy(w) / s.start_energy(w) - 1; };
  return t;
}

Trial incline(double friction, double degrees) {
  const double critical = std::atan(friction), angle = critical + degrees * kPi / 180;
  Trial t = trial(degrees < 0 ? "B36 below" : "B36 above",
                  std::string("block on a slope a degree ") + (degrees < 0 ? "below" : "above") +
                      " its critical angle",
                  degrees < 0 ? "creep in 10 s" : "relative error of the speed",
                  degrees < 0 ? "m" : "", degrees < 0 ? 1e-3 : 1e-2, degrees < 0 ? 10 : 3);
  t.at_end = true;
  t.scene = [=] {
    Scene scene = grounded(Space::spatial, friction);
    scene.options.gravity = 10 * Vec3(std::sin(angle), 0, -std::cos(angle));
    Body slab = with_shape(Box{{0.2, 0.2, 0.05}}, {0, 0, 0.05}, friction);
    slab.jitter.angle = kPi;
    scene.add(slab);
    return scene;
  };
  t.value = [=](const Seen& s, int w) {
    if (degrees < 0) return sideways(s.moved(w, 0), Space::spatial);
    const double law = 10 * (std::sin(angle) - friction * std::cos(angle)) * s.time();
    return std::abs(s.velocity(w, 0).x() - law) / law;
  };
  return t;
}

Trial rush() {
  Trial t = trial("B39", "400 circles pulled together by 1000 N each", "speed in the last second",
                  "m/s", 1, 12);
  t.from = 11;
  t.scene = [] {
    Scene scene = empty(Space::planar, 0);
    Body post = with_shape(Circle{0.5}, Vec3::Zero(), 0.2);
    post.motion = Motion::fixed;
    scene.add(post);
    double angle = 0, far = 5;
    for (int i = 0; i < 400; ++i, angle += 0.2, far += 0.05) {
      Body ball = with_shape(Circle{0.5}, {far * std::cos(angle), far * std::sin(angle), 0}, 0.2);
      ball.shapes[0].density = 100;
      ball.jitter.position = {1e-3, 1e-3, 0};
      scene.add(ball);
    }
    return scene;
  };
  t.act = [](Batch& b, double) {
    std::vector<double> x(b.size(Field::position));
    b.read(Field::position, x);
    std::size_t i = 0;
    for (int w = 0; w < b.worlds(); ++w) {
      for (int body = 0; body < b.bodies(w); ++body, i += 2) {
        const Vec3 at(x[i], x[i + 1], 0);
        if (at.norm() > 0.1) b.add_force(w, b.body_in_row(body), -1000 * at.normalized());
      }
    }
  };
  t.value = [](const Seen& s, int w) { return s.fastest(w); };
  return t;
}

Trial flat_drop() {
  Trial t = trial("B44", "elastic box dropped flat", "spin after the impact", "rad/s", 0.1, 2);
  t.scene = [] {
    Scene scene = empty(Space::spatial, 10);
    scene.add(ground(Space::spatial, 0, 1));
    Body box = with_shape(Box{{0.5, 0.5, 0.5}}, {0, 0, 1.5}, 0, 1);
    box.jitter.position = {1, 1, 0.1};
    scene.add(box);
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.spin(w, 0).norm(); };
  return t;
}

}  // namespace

std::vector<Trial> contact_trials() {
  return {mass_ratio(1),
          mass_ratio(2),
          mass_ratio(3),
          tower(Space::planar, 10),
          tower(Space::spatial, 10),
          tower(Space::planar, 20),
          tower(Space::spatial, 20),
          card_house(),
          cylinders(),
          warm_start(),
          overlap(),
          coincident(2, false),
          coincident(2, true),
          coincident(10, false),
          coincident(10, true),
          coincident(100, false),
          scale(0.001),
          scale(0.05),
          scale(1000),
          large_step(),
          painleve(),
          incline(0.6, -1),
          incline(0.6, 1),
          rush(),
          flat_drop()};
}

}  // namespace manyworlds::report
