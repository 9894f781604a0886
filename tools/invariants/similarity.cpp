// The same scene in other units does the same. Units differ by powers of two, so that no rounding
// does: what differs comes from a value with a unit in the step or the plan.
#include "tools/invariants/similarity.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace manyworlds::invariants {
namespace {

// The factors by which values in the other units are larger.
struct Unit {
  double length = 1, time = 1, density = 1;
  double mass(Space space) const {
    return density * (space == Space::planar ? length * length : length * length * length);
  }
};

Geometry in_units(const Geometry& geometry, double k) {
  Geometry out = geometry;
  if (auto* s = std::get_if<Sphere>(&out)) s->radius *= k;
  if (auto* s = std::get_if<Circle>(&out)) s->radius *= k;
  if (auto* s = std::get_if<Box>(&out)) s->half_extents *= k;
  if (auto* s = std::get_if<Capsule>(&out)) s->radius *= k, s->half_length *= k;
  if (auto* s = std::get_if<Cylinder>(&out)) s->radius *= k, s->half_length *= k;
  if (auto* s = std::get_if<Ellipsoid>(&out)) s->radii *= k;
  if (auto* s = std::get_if<Plane>(&out)) s->offset *= k;
  if (auto* s = std::get_if<HalfPlane>(&out)) s->offset *= k;
  if (auto* s = std::get_if<Segment>(&out)) s->a *= k, s->b *= k;
  if (auto* s = std::get_if<Hull>(&out)) {
    for (Vec3& v : s->vertices) v *= k;
  }
  if (auto* s = std::get_if<Polygon>(&out)) {
    for (Vec2& v : s->vertices) v *= k;
    s->radius *= k;
  }
  return out;
}

void convert(std::optional<Drive>& drive, double speed, double force, double time) {
  if (!drive) return;
  drive->target_speed *= speed, drive->max_force *= force;
  if (drive->spring) drive->spring->frequency /= time;
}

Joint in_units(const Joint& joint, const Unit& unit, double mass) {
  Joint out = joint;
  out.frame_a.position *= unit.length, out.frame_b.position *= unit.length;
  const double force = mass * unit.length / (unit.time * unit.time);
  if (auto* hinge = std::get_if<HingeJoint>(&out.type)) {
    convert(hinge->drive, 1 / unit.time, force * unit.length, unit.time);
  } else if (auto* slider = std::get_if<SliderJoint>(&out.type)) {
    convert(slider->drive, unit.length / unit.time, force, unit.time);
    if (slider->limit) slider->limit->low *= unit.length, slider->limit->high *= unit.length;
  } else if (auto* distance = std::get_if<DistanceJoint>(&out.type)) {
    if (distance->spring) distance->spring->frequency /= unit.time;
  }
  return out;
}

Scene in_units(const Scene& scene, const Unit& unit) {
  Scene out = scene;
  for (Body& body : out.bodies) {
    body.position *= unit.length;
    body.linear_velocity *= unit.length / unit.time;
    body.angular_velocity /= unit.time;
    for (Shape& shape : body.shapes) {
      shape.geometry = in_units(shape.geometry, unit.length);
      shape.position *= unit.length;
      if (shape.density) *shape.density *= unit.density;
      shape.material.rolling_resistance *= unit.length;
      shape.material.torsional_resistance *= unit.length;
    }
  }
  for (Joint& joint : out.joints) joint = in_units(joint, unit, unit.mass(scene.space));
  out.options.density *= unit.density;
  out.options.dt *= unit.time;
  out.options.gravity *= unit.length / (unit.time * unit.time);
  return out;
}

// How far one body is from another, in sizes, radians and body lengths a step.
double difference(const BodyNow& a, const BodyNow& b, double size, double dt) {
  const double off = (b.position - a.position).norm() / size;
  const double turn = (b.rotation.coeffs() - a.rotation.coeffs()).norm();
  const double change = (b.velocity - a.velocity).norm() * dt / size;
  return off + turn + change + (b.spin - a.spin).norm() * dt;
}

// The other world, and how far it is from this one.
class Other {
 public:
  Other(Scene scene, const Unit& unit, double size)
      : scene_(std::move(scene)), unit_(unit), size_(size), dt_(scene_.options.dt / unit.time) {}

  double operator()(const Seen& seen) {
    if (seen.step == 0) return 0;
    const Precision precision = seen.precision;
    if (!world_) {
      world_.emplace(scene_, precision);
      world_->put(0, scene_);
    }
    world_->step(1);
    double most = 0, spread = 0;
    for (std::size_t i = 0; i < seen.now.size(); ++i) {
      BodyNow other = world_->now(0, static_cast<int>(i));
      other.position /= unit_.length, other.spin *= unit_.time;
      other.velocity *= unit_.time / unit_.length;
      const double value = difference(seen.now[i], other, size_, dt_);
      if (!std::isfinite(value)) return HUGE_VAL;
      most = std::max(most, value);
      spread = std::max(spread, difference(seen.now[i], seen.twin[i], size_, dt_));
    }
    // The plan's values are rounded, in float64 also those of the other units: a difference that
    // begins as one of rounding does not count after one of 1e-7 has grown as much.
    if (first_ == 0) first_ = most;
    chaotic_ = chaotic_ || !(spread < 1e-3);
    const double rounding = precision == Precision::f32 ? 1e-5 : 1e-12;
    return chaotic_ && first_ < rounding ? 0 : most;
  }

 private:
  Scene scene_;
  Unit unit_;
  double size_, dt_;  // m and s, in the units of this world
  double first_ = 0;  // the first difference
  bool chaotic_ = false;
  std::optional<SideWorlds> world_;
};

// A joint of any type between two bodies.
Joint draw_joint(Random& random, const Scene& scene, BodyId a, BodyId b, const Scale& scale) {
  const Frame frame = {0.5 * (scene.at(a).position + scene.at(b).position),
                       draw_rotation(random, scene.space)};
  const bool planar = scene.space == Space::planar;
  const double frequency = random.uniform(0.2, 3) / scale.time();
  Drive motor;
  motor.target_speed = random.uniform(-2, 2) / scale.time();
  motor.max_force = mass_of(scene, a).mass * scale.gravity * scale.length;
  Drive servo;
  servo.target_position = random.uniform(-0.5, 0.5);
  servo.spring = Spring{0, 0, frequency, 1};
  JointType type = FixedJoint{};
  switch (random.integer(planar ? 1 : 0, 5)) {
    case 0: type = BallJoint{}; break;
    case 1: type = HingeJoint{Limit{-1, 1}, {}}; break;
    case 2: type = HingeJoint{{}, motor}; break;
    case 3: type = HingeJoint{{}, servo}; break;
    case 4: type = SliderJoint{Limit{-0.5 * scale.length, 0.5 * scale.length}, {}}; break;
    default: type = DistanceJoint{{}, {}, Spring{0, 0, frequency, 0.3}};
  }
  return joint_at(scene, a, b, frame, type);
}

// Falling bodies of any shape, some of them on joints. Poses come from the kind, since the plan
// looks at them.
Scene draw_scene(Space space, Random& kind, Random& state, const Scale& scale) {
  Scene scene = scene_of(space, scale);
  const double size = scale.length;
  const bool planar = space == Space::planar;
  Material material{kind.uniform(0, 2), kind.chance(0.5) ? 0 : kind.uniform(0, 1)};
  scene.add(scenes::ground(space, material));
  const int count = kind.integer(3, 9);
  const bool joints = kind.chance(0.6);
  std::vector<BodyId> bodies;
  for (int i = 0; i < count; ++i) {
    const Geometry geometry = draw_shape(kind, space, size);
    material.friction = kind.uniform(0, 2);
    Body body = scenes::body_of(scenes::shape_of(geometry, material), Vec3::Zero());
    const int column = i % 3;
    const double height = 3.5 * size * (0.55 + i / 3);
    body.position = Vec3(3.5 * size * (column - 1), 0, 0) + height * scenes::up_of(space);
    body.rotation = draw_rotation(kind, space);
    body.shapes[0].density = 1000 * kind.log_uniform(1, 10);
    const double speed = state.uniform(0, 3) * scale.speed();
    Vec3 heading = draw_direction(state, space);
    if (!planar) heading.y() *= 0.2;
    body.linear_velocity = speed * heading;
    const double turn = state.uniform(0, 0.3) / scale.dt;
    body.angular_velocity = turn * draw_axis(state, space);
    bodies.push_back(scene.add(body));
  }
  for (std::size_t i = 1; joints && i < bodies.size(); ++i) {
    if (kind.chance(0.5)) scene.add(draw_joint(kind, scene, bodies[i - 1], bodies[i], scale));
  }
  resist_in_some(kind, scene, scale);
  return scene;
}

Drawn draw_units(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = draw_scene(space, kind, state, scale);
  // Other lengths between 1 mm and 100 m, gravities within 16, densities within 64.
  std::vector<int> lengths;
  for (int k = -8; k <= 8; ++k) {
    const double other = scale.length * std::pow(4, k);
    if (k != 0 && other > 1e-3 && other < 100) lengths.push_back(k);
  }
  const int a =
      lengths[static_cast<std::size_t>(kind.integer(0, static_cast<int>(lengths.size()) - 1))];
  const int b = kind.integer(-2, 2), c = kind.integer(-6, 6);
  const Unit unit{std::pow(4.0, a), std::pow(2.0, a - b), std::pow(2.0, c)};
  out.steps = 90;
  auto other = std::make_shared<Other>(in_units(out.scene, unit), unit, scale.length);
  out.judge = [other](const Seen& seen) { return (*other)(seen); };
  out.twin = out.scene;
  for (Body& body : out.twin->bodies) {
    if (body.motion != Motion::fixed)
      body.position += 1e-7 * scale.length * draw_direction(state, space);
  }
  return out;
}

}  // namespace

std::vector<Family> similarity_families() {
  Family f;
  f.id = "other units", f.law = Law::similarity;
  f.title =
      "falling bodies and joints, in units of length, time and mass that differ by powers of two";
  f.criterion = "difference of states over size, radians and body lengths a step";
  f.limit = 1e-3;
  std::vector<Family> all = in_both_spaces(f, draw_units);
  const auto refinement = refinement_families();
  all.insert(all.end(), refinement.begin(), refinement.end());
  return all;
}

}  // namespace manyworlds::invariants
