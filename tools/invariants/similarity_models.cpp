// Motions along lines, with closed forms.
#include "tools/invariants/similarity_models.hpp"

#include <algorithm>
#include <cmath>

namespace manyworlds::invariants {
namespace {

// Distance and angle of a motion along x, or of heights.
struct Along {
  double x = 0, angle = 0;
};

// Adds a world that starts as `start` and moves by `motion` of time along `axis`, rotating about
// `turn`.
void add_sample(Model& model, const Body& start, int steps, const Vec3& axis, const Vec3& turn,
                const std::function<Along(double)>& motion) {
  model.starts.push_back(start);
  std::vector<BodyNow> right;
  for (int step = 0; step <= steps; ++step) {
    const Along now = motion(step * model.scene.options.dt);
    BodyNow b;
    b.position = start.position + now.x * axis;
    b.rotation = Quat(Eigen::AngleAxisd(now.angle, turn)) * start.rotation;
    right.push_back(b);
  }
  model.right.push_back(std::move(right));
}

Space draw_space(Random& kind) { return kind.chance(0.5) ? Space::planar : Space::spatial; }

// A low box that slides to a stop.
Model slide(ModelDraw& in) {
  const Space space = draw_space(in.kind);
  Model model;
  model.scene = scene_of(space, in.scale);
  const double size = in.scale.length, g = in.scale.gravity, dt = in.scale.dt;
  const double friction = in.kind.uniform(0.05, 0.8);
  model.scene.add(scenes::ground(space, friction));
  const double wide = size * in.kind.uniform(0.7, 1), low = 0.3 * size * in.kind.uniform(0.3, 1);
  const Vec3 half = space == Space::planar ? Vec3(wide, low, 0) : Vec3(wide, wide, low);
  Body body = scenes::body_of(scenes::shape_of(scenes::box_of(space, half), friction),
                              low * scenes::up_of(space));
  model.body = model.scene.add(body);
  // Stops within 6 to 40 steps.
  const double longest = in.kind.uniform(10, 40) * dt;
  model.length = friction * g * longest * longest / 2;
  for (int i = 0; i < kSamples; ++i) {
    const double stop = longest * in.state.uniform(0.6, 1), v = friction * g * stop;
    body.linear_velocity = v * Vec3::UnitX();
    add_sample(model, body, 60, Vec3::UnitX(), Vec3::UnitZ(), [=](double t) {
      t = std::min(t, stop);
      return Along{v * t - friction * g * t * t / 2, 0};
    });
  }
  return model;
}

// A round body, thrown without spin, slides until it rolls; or it rolls down a slope from rest.
Model roll(ModelDraw& in) {
  const Space space = draw_space(in.kind);
  Model model;
  model.scene = scene_of(space, in.scale);
  const double size = in.scale.length, g = in.scale.gravity, dt = in.scale.dt;
  const double radius = size * in.kind.uniform(0.3, 1);
  const double friction = in.kind.uniform(0.1, 1);
  const bool slope = in.kind.chance(0.5);
  model.scene.add(scenes::ground(space, friction));
  Body body = scenes::body_of(scenes::shape_of(scenes::round_of(space, radius), friction),
                              radius * scenes::up_of(space));
  model.body = model.scene.add(body);
  // The plan may leave out orientations of balls, so positions are compared only.
  const double inertia = space == Space::planar ? 0.5 : 0.4;  // over m r^2
  // The body rotates forward about this axis.
  const Vec3 turn = space == Space::planar ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  // Rolls without slip below tan = friction (1 + 1 / inertia).
  const double angle =
      slope ? in.kind.uniform(0.2, 0.8) * std::atan(friction * (1 + 1 / inertia)) : 0;
  model.scene.options.gravity =
      g * (std::sin(angle) * Vec3::UnitX() - std::cos(angle) * scenes::up_of(space));
  // Of few turns, so that angles do not exceed the distances much.
  const double time = 60 * dt, a = g * std::sin(angle) / (1 + inertia);
  model.length = slope ? a * time * time / 2 : radius;
  const double most = std::min(2 * std::sqrt(g * radius), friction * g * 20 * dt);
  if (!slope) model.length = most * time;
  for (int i = 0; i < kSamples; ++i) {
    const double v = slope ? 0 : most * in.state.uniform(0.3, 1);
    body.linear_velocity = v * Vec3::UnitX();
    add_sample(model, body, 60, Vec3::UnitX(), turn, [=](double t) {
      if (slope) return Along{a * t * t / 2, a * t * t / 2 / radius};
      // Friction slows the body and spins it until both agree.
      const double f = friction * g, spin = f / (inertia * radius);
      const double until = v / (f + spin * radius), s = std::min(t, until);
      const double rolled = (v - f * until) * std::max(t - until, 0.0);
      return Along{v * s - f * s * s / 2 + rolled, spin * s * s / 2 + rolled / radius};
    });
  }
  return model;
}

// A ball that falls and bounces.
Model bounce(ModelDraw& in) {
  const Space space = draw_space(in.kind);
  Model model;
  model.scene = scene_of(space, in.scale);
  const double size = in.scale.length, g = in.scale.gravity, dt = in.scale.dt;
  const double radius = size * in.kind.uniform(0.3, 1), e = in.kind.uniform(0.7, 1);
  model.scene.add(scenes::ground(space, 0, e));
  Body body =
      scenes::body_of(scenes::shape_of(scenes::round_of(space, radius), 0, e), Vec3::Zero());
  model.body = model.scene.add(body);
  // Impacts are above the threshold of restitution, two steps of gravity.
  const double fall = in.kind.uniform(15, 40) * dt;
  model.length = g * fall * fall / 2;
  const Vec3 up = scenes::up_of(space);
  // Errors depend on when in a step the impact is.
  for (int i = 0; i < 4 * kSamples; ++i) {
    const double phase = (i + in.state.uniform(0, 1)) / (4 * kSamples);
    const double first = fall - dt * phase, v = g * first;
    body.position = (radius + v * first / 2) * up;
    // All end before the second impact: when it is depends on the rounding of the first.
    const int steps = static_cast<int>(0.85 * (1 + 2 * e) * fall / dt);
    add_sample(model, body, steps, up, Vec3::UnitZ(), [=](double t) {
      const double since = t - first;
      const double height =
          since > 0 ? v * e * since - g * since * since / 2 : v * first / 2 - g * t * t / 2;
      return Along{height - v * first / 2, 0};
    });
  }
  return model;
}

// Thrown against the drag of the air.
Model drag(ModelDraw& in) {
  const Space space = draw_space(in.kind);
  Model model;
  model.scene = scene_of(space, in.scale);
  const double size = in.scale.length, g = in.scale.gravity, dt = in.scale.dt;
  Body body = scenes::body_of(scenes::shape_of(scenes::round_of(space, size)), Vec3::Zero());
  const double c = in.kind.log_uniform(0.002, 0.2) / dt;
  body.linear_drag = c;
  model.body = model.scene.add(body);
  const double end = g / c, time = 60 * dt;
  model.length = g * time * time / 2;
  for (int i = 0; i < kSamples; ++i) {
    const double v = g * time * in.state.uniform(0.3, 1);
    body.linear_velocity = v * scenes::up_of(space);
    add_sample(model, body, 60, scenes::up_of(space), Vec3::UnitZ(), [=](double t) {
      return Along{(v + end) / c * -std::expm1(-c * t) - end * t, 0};
    });
  }
  return model;
}

// A body on a spring along one line, damped.
Model spring(ModelDraw& in) {
  const Space space = draw_space(in.kind);
  Model model;
  model.scene = free_scene(space, in.scale);
  const double size = in.scale.length, dt = in.scale.dt, rest = 10 * size;
  Body body =
      scenes::body_of(scenes::shape_of(scenes::round_of(space, size)), rest * Vec3::UnitX());
  model.body = model.scene.add(body);
  const double frequency = in.kind.log_uniform(0.01, 0.1) / dt, ratio = in.kind.uniform(0, 0.7);
  DistanceJoint type;
  type.length = rest, type.spring = Spring{0, 0, frequency, ratio};
  Joint joint;
  joint.type = type, joint.body_b = model.body;
  model.scene.add(joint);
  model.length = size;
  const double w = 2 * scenes::kPi * frequency, decay = ratio * w;
  const double damped = w * std::sqrt(1 - ratio * ratio);
  for (int i = 0; i < kSamples; ++i) {
    const double x0 = size * in.state.uniform(1, 4), v0 = size * w * in.state.uniform(-2, 2);
    body.position = (rest + x0) * Vec3::UnitX();
    body.linear_velocity = v0 * Vec3::UnitX();
    add_sample(model, body, 60, Vec3::UnitX(), Vec3::UnitZ(), [=](double t) {
      const double s = (v0 + decay * x0) / damped;
      const double x =
          std::exp(-decay * t) * (x0 * std::cos(damped * t) + s * std::sin(damped * t));
      return Along{x - x0, 0};
    });
  }
  return model;
}

}  // namespace

std::vector<ModelType> sliding_models() {
  return {{"slide to a stop", "a low box slides to a stop", slide},
          {"roll", "a ball slides until it rolls, or rolls down a slope", roll},
          {"bounce", "a ball falls and bounces", bounce},
          {"drag", "a body thrown against the drag of the air", drag},
          {"spring", "a body swings on a damped spring", spring}};
}

std::vector<ModelType> model_types() {
  std::vector<ModelType> all = sliding_models();
  const std::vector<ModelType> more = rotating_models();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace manyworlds::invariants
