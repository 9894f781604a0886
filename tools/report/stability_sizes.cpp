// Bodies of any size under any load, as they are described: nothing is set but the sizes, and sleep
// where a case wants it (C1 to C5, C8).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/report/reference.hpp"
#include "tools/report/stability.hpp"

namespace manyworlds::report {
namespace {

constexpr double kFrictionOfSizes = 0.6;

Scene grounded_scene() {
  Scene scene = empty(Space::spatial, 10);
  scene.add(ground(Space::spatial, kFrictionOfSizes));
  return scene;
}
Body block(const Vec3& half, const Vec3& at) {
  Body body = with_shape(Box{half}, at, kFrictionOfSizes);
  body.jitter.position = 1e-3 * Vec3(half.x(), half.y(), 0);
  return body;
}
Body cube_of(double size, const Vec3& at) { return block(Vec3::Constant(size / 2), at); }

std::string size_text(double size) {
  return size >= 1      ? fmt::format("{:g} m", size)
         : size >= 0.01 ? fmt::format("{:g} cm", 100 * size)
                        : fmt::format("{:g} mm", 1000 * size);
}

void push_all(Batch& batch, int row, const Vec3& force) {
  for (int w = 0; w < batch.worlds(); ++w) batch.add_force(w, batch.body_in_row(row), force);
}

// A cube pressed on the ground by so many times its weight.
Trial press(double size, double weights) {
  const bool much = weights > 1000;
  Trial t = trial(fmt::format("C1 {} x {:g}", size_text(size), weights),
                  "cube pressed on the ground by a multiple of its weight",
                  "displacement, in cube sizes", "", much ? 0.5 : 0.02, 10);
  t.scene = [size] {
    Scene scene = grounded_scene();
    scene.add(cube_of(size, {0, 0, size / 2}));
    return scene;
  };
  const double force = weights * 1000 * size * size * size * 10;
  t.act = [force](Batch& b, double) { push_all(b, 0, {0, 0, -force}); };
  t.value = [size](const Seen& s, int w) { return s.moved(w, 0).norm() / size; };
  return t;
}

// The worst of all worlds after `seconds`, with sleep; infinite where one is awake.
double asleep_then(const Plan& plan, BatchOptions options, double seconds,
                   const std::function<double(const Seen&, int)>& value) {
  options.sleep = true;
  Batch batch(plan, options);
  Seen seen(batch);
  batch.step(static_cast<int>(seconds / plan.scene().options.dt + 0.5));
  seen.look(seconds);
  double worst = 0;
  for (int w = 0; w < batch.worlds(); ++w) {
    const bool rests = batch.asleep(w) && batch.status(w) == Status::ok;
    worst = std::max(worst, rests ? value(seen, w) : std::numeric_limits<double>::infinity());
  }
  return worst;
}

Scene column(int count, const Vec3& half) {
  Scene scene = grounded_scene();
  for (int i = 0; i < count; ++i) scene.add(block(half, {0, 0, (2 * i + 1) * half.z()}));
  return scene;
}

// How far a column's top has moved, in the height of the column.
Trial stack(const std::string& id, const std::string& title, int count, const Vec3& half,
            double seconds) {
  Trial t = trial(id, title, "displacement of the top, in stack heights", "", 0.02, seconds);
  t.scene = [=] { return column(count, half); };
  t.whole = [=](const Plan& plan, const BatchOptions& options) {
    return asleep_then(plan, options, seconds, [=](const Seen& s, int w) {
      return s.moved(w, count - 1).norm() / (2 * half.z() * count);
    });
  };
  return t;
}
Trial stack(double size, int count) {
  return stack(fmt::format("C2 {} x {}", count, size_text(size)),
               "stack of cubes, asleep after 20 s", count, Vec3::Constant(size / 2), 20);
}
Trial rest(double size) {
  return stack(fmt::format("C3 rest {}", size_text(size)), "stack of five cubes, asleep after 5 s",
               5, Vec3::Constant(size / 2), 5);
}
Trial cards() {
  return stack("C3 cards", "stack of ten cards of 1 mm, asleep after 20 s", 10,
               {0.032, 0.044, 5e-4}, 20);
}

// A box of 6 cm and 1 kg held against a wall by one finger of 0.1 kg.
Trial grip(double force) {
  Trial t = trial(fmt::format("C4 {:g} N", force), "box of 1 kg held against a wall by one finger",
                  "slip", "m", 1e-4, 10);
  t.scene = [] {
    Scene scene = empty(Space::spatial, 10);
    Body wall = with_shape(Box{{0.05, 0.2, 0.2}}, {-0.05, 0, 0}, kFrictionOfSizes);
    wall.motion = Motion::fixed;
    scene.add(wall);
    Body box = with_shape(Box{Vec3::Constant(0.03)}, {0.03, 0, 0}, kFrictionOfSizes);
    box.shapes[0].density = 1 / std::pow(0.06, 3);
    box.jitter.position = {0, 1e-4, 1e-4};
    scene.add(box);
    Body finger = with_shape(Box{Vec3::Constant(0.01)}, {0.07, 0, 0}, kFrictionOfSizes);
    finger.shapes[0].density = 0.1 / std::pow(0.02, 3);
    scene.add(finger);
    return scene;
  };
  t.act = [force](Batch& b, double) { push_all(b, 1, {-force, 0, 0}); };
  t.value = [](const Seen& s, int w) {
    const Vec3 m = s.moved(w, 0);
    return std::hypot(m.y(), m.z());
  };
  return t;
}

// 20 boxes as hulls, 20 cylinders and 20 capsules of 10 cm fall into a bin of 0.6 m. They begin
// apart however they are turned and moved.
Scene mixed_drop() {
  constexpr double kApart = 0.17;  // m; they are up to 0.142 long, and are moved by 0.01
  Scene scene = grounded_scene();
  for (const double side : {-1.0, 1.0}) {
    for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
      Body wall = with_shape(Box{{way.x() != 0 ? 0.1 : 0.5, way.y() != 0 ? 0.1 : 0.5, 1}},
                             side * 0.4 * way + Vec3(0, 0, 1), kFrictionOfSizes);
      wall.motion = Motion::fixed;
      scene.add(wall);
    }
  }
  Hull lump;  // an octahedron cut flat at two of its ends
  for (const double x : {-1.0, 1.0}) {
    lump.vertices.push_back({0.05 * x, 0, 0}), lump.vertices.push_back({0, 0.05 * x, 0});
    for (const double y : {-1.0, 1.0}) {
      lump.vertices.push_back({0.02 * y, 0.02, 0.04 * x});
      lump.vertices.push_back({0.02 * y, -0.02, 0.04 * x});
    }
  }
  for (int i = 0; i < 60; ++i) {
    const Vec3 at = kApart * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9) + Vec3(0, 0, 0.1);
    Body body = with_shape(i % 3 == 0   ? Geometry(lump)
                           : i % 3 == 1 ? Geometry(Cylinder{0.05, 0.05})
                                        : Geometry(Capsule{0.03, 0.02}),
                           at, kFrictionOfSizes);
    body.jitter.position = Vec3::Constant(0.01), body.jitter.any_orientation = true;
    scene.add(body);
  }
  return scene;
}
Trial drop_overlap() {
  Trial t = trial("C5 overlap", "60 hulls, cylinders and capsules of 10 cm dropped into a bin",
                  "largest penetration", "m", 0.01, 20);
  t.note =
      "bodies fall by half their size in a step, and an impulse reaches the body behind a stopped "
      "one a step later";
  t.scene = mixed_drop;
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    Batch batch(plan, options);
    double deepest = 0;
    for (int i = 0; i < 1200; ++i) {
      batch.step();
      if (i < 240 || i % 10 == 0) {
        deepest = std::max(deepest, batch.measure_contacts().max_penetration);
      }
    }
    return batch.lost_worlds() > 0 ? std::numeric_limits<double>::infinity() : deepest;
  };
  return t;
}
Trial drop_rest() {
  Trial t = trial("C5 rest", "the same", "fraction of worlds awake after 20 s", "", 0, 20);
  t.note = "nothing brakes a body that rolls along a groove or spins on a point";
  t.scene = mixed_drop;
  t.whole = [](const Plan& plan, BatchOptions options) {
    options.sleep = true;
    Batch batch(plan, options);
    batch.step(1200);
    return batch.awake_fraction();
  };
  return t;
}

// Dominoes of real size. The wave takes this long from the fifth to the last but two, in the mean
// of all worlds, s; infinite where one stays upright.
constexpr int kDominoes = 20;
double wave_time(const Plan& plan, const BatchOptions& options) {
  constexpr double kFallen = 0.3;  // rad
  Batch batch(plan, options);
  Seen seen(batch);
  const double dt = plan.scene().options.dt;
  struct Fall {
    double lean = 0, time = 0;
  };
  std::vector<std::array<Fall, kDominoes>> falls(static_cast<std::size_t>(batch.worlds()));
  for (int i = 1; i * dt < 4; ++i) {
    batch.step();
    seen.look(i * dt);
    for (int w = 0; w < batch.worlds(); ++w) {
      for (int b = 0; b < kDominoes; ++b) {
        Fall& fall = falls[static_cast<std::size_t>(w)][static_cast<std::size_t>(b)];
        const double upright = (seen.rotation(w, b) * Vec3::UnitZ()).z();
        const double lean = std::acos(std::clamp(upright, -1.0, 1.0));
        if (fall.time == 0 && lean > kFallen) {
          fall.time = (i - (lean - kFallen) / (lean - fall.lean)) * dt;
        }
        fall.lean = lean;
      }
    }
  }
  double sum = 0;
  for (const auto& of_world : falls) {
    for (const Fall& fall : of_world) {
      if (fall.time == 0) return std::numeric_limits<double>::infinity();
    }
    sum += of_world[kDominoes - 3].time - of_world[4].time;
  }
  return sum / batch.worlds();
}
Trial dominoes() {
  Trial t = trial("C8", "dominoes of 4.8 cm",
                  "relative difference of the wave's speed to that at a quarter of the step", "",
                  0.05, 4);
  t.scene = [] {
    Scene scene = grounded_scene();
    for (int i = 0; i < kDominoes; ++i) {
      Body domino = block({0.00375, 0.012, 0.024}, {0.02 * i, 0, 0.024});
      if (i == 0) domino.angular_velocity = {0, 4, 0}, domino.linear_velocity = {0.096, 0, 0.015};
      scene.add(domino);
    }
    return scene;
  };
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    Scene finer = plan.scene();
    finer.options.dt /= 4;
    return std::abs(wave_time(plan, options) / wave_time(compile(finer), options) - 1);
  };
  return t;
}

}  // namespace

std::vector<Trial> size_trials() {
  std::vector<Trial> out;
  for (const auto& [size, weights] :
       {std::pair(1.0, 1000.0), {0.1, 300.0}, {0.01, 100.0}, {0.001, 30.0}}) {
    out.push_back(press(size, weights)), out.push_back(press(size, 1e5));
  }
  for (const double size : {0.01, 0.1, 1.0}) {
    for (const int count : {5, 12, 20}) out.push_back(stack(size, count));
  }
  out.push_back(stack(1e-3, 5));
  for (const double size : {1e-3, 0.01, 0.1, 1.0, 10.0}) out.push_back(rest(size));
  out.push_back(cards());
  for (const double force : {20.0, 50.0, 100.0}) out.push_back(grip(force));
  out.push_back(drop_overlap()), out.push_back(drop_rest()), out.push_back(dominoes());
  return out;
}

}  // namespace manyworlds::report
