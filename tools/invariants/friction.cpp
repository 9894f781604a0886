// Coulomb's law: bodies that slide without spin follow a curve that is known, and slipping contacts
// have the friction impulse mu N against the slip.
#include <algorithm>
#include <cmath>

#include "tools/invariants/statics.hpp"

namespace manyworlds::invariants {
namespace {

constexpr double kHalfDegree = 0.5 * scenes::kPi / 180;

// Friction of a pair, split over the two materials, whose geometric mean counts.
struct Pair {
  Material floor, body;
};
Pair pair_of(Random& kind, double friction) {
  const double share = kind.log_uniform(0.5, 2);
  Pair out;
  out.floor.friction = friction * share, out.body.friction = friction / share;
  return out;
}

// ---- paths --------------------------------------------------------------------------------------

// A point that slides on a plane: v' = g_t - mu g_n (v - belt) / |v - belt|.
class Path {
 public:
  Path(const Vec3& start, const Vec3& velocity, const Vec3& belt, const Vec3& gravity,
       const Vec3& normal, double friction)
      : x_(start), v_(velocity), belt_(belt) {
    pull_ = gravity - normal.dot(gravity) * normal;
    brake_ = -friction * normal.dot(gravity);
  }
  void advance(double dt) {
    constexpr int kParts = 32;
    const double h = dt / kParts;
    for (int i = 0; i < kParts; ++i) {
      // The midpoint rule, and a stop within the part where friction can hold the body.
      const Vec3 slip = v_ - belt_;
      if (slip.norm() < brake_ * dt) reversed_ = true;
      if (reversed_) free_ += h;
      if (slip.norm() <= brake_ * h && pull_.norm() <= brake_) {
        v_ = belt_, x_ += h * v_, reversed_ = false, free_ = 0;
        continue;
      }
      const Vec3 half = slip + 0.5 * h * acceleration(slip);
      const Vec3 before = v_;
      v_ += h * acceleration(half), x_ += 0.5 * h * (before + v_);
      length_ += h * half.norm(), turned_ += (v_ - before).norm();
    }
  }
  const Vec3& position() const { return x_; }
  Vec3 slip() const { return v_ - belt_; }
  // m, that a step may be off which is exact to first order in its substeps, of dt / 4 at most:
  // half a substep late in every change, and a substep's braking more or less where it turns back.
  double substep_error(double dt) const { return dt / 8 * turned_ + dt / 4 * brake_ * free_; }
  double length() const { return length_; }  // m, of the path over the surface

 private:
  Vec3 acceleration(const Vec3& slip) const {
    const double speed = slip.norm();
    return speed > 0 ? Vec3(pull_ - brake_ / speed * slip) : pull_;
  }
  Vec3 x_, v_, belt_, pull_ = Vec3::Zero();
  double brake_ = 0, length_ = 0, turned_ = 0, free_ = 0;
  bool reversed_ = false;
};

Drawn draw_slide(Space space, Random& kind, Random& state, const Scale& scale) {
  constexpr int kSteps = 150;
  const bool planar = space == Space::planar;
  Drawn out{scene_of(space, scale), kSteps};
  const double dt = scale.dt, fall = scale.gravity * dt * dt;
  // Stops after 60 to 140 steps on level ground, and moves less than a length per step.
  const double steps = kind.uniform(60, 140),
               fastest = std::min(2.0, scale.length / (steps * fall));
  const double wanted = kind.log_uniform(0.02, fastest);
  // Standing first: what tips is not the law's.
  const Material any{};
  Standing standing = draw_standing(kind, space, 0.5 * scale.length, any);
  const double center = standing.height + standing.center.dot(scenes::up_of(space));
  const double friction = std::min(wanted, 0.7 * standing.support / center);
  const double share = kind.chance(0.5) ? kind.uniform(0, 1) : 0;
  const double tilt = share * std::asin(std::min(0.6, scale.length / (kSteps * fall)));
  const double speed = steps * friction * scale.gravity * dt;
  const double slope = scale.gravity * std::sin(tilt), time = kSteps * dt;
  const Pair pair = pair_of(kind, friction);
  FloorDraw floor_draw{.extent = 2 * (speed * time + 0.5 * slope * time * time) + 10 * scale.length,
                       .tilt = tilt,
                       .material = pair.floor,
                       .belt = speed * kind.uniform(0.1, 1)};
  const Floor floor = add_floor(out.scene, kind, scale, floor_draw);
  for (Shape& s : standing.body.shapes) s.material = pair.body;
  for (Shape& s : standing.body.shapes) s.density = 1000;

  const Vec3 at = 0.5 * scale.length * state.in_cube(1);
  const double yaw = state.uniform(-scenes::kPi, scenes::kPi);
  const double fast = state.uniform(0.9, 1), way = state.uniform(-scenes::kPi, scenes::kPi);
  Body body =
      stand(space, standing, floor, planar ? Vec3(at.x(), 0, 0) : Vec3(at.x(), at.y(), 0), yaw);
  Vec3 along(std::cos(way), std::sin(way), 0);
  if (planar) along = Vec3(way < 0 ? -1 : 1, 0, 0);
  body.linear_velocity = floor.velocity + floor.rotation * (speed * fast * along);
  const BodyId id = out.scene.add(body);

  const Vec3 normal = floor.rotation * scenes::up_of(space);
  const Vec3 mass_center = mass_of(out.scene, id).center;
  const auto where = [mass_center](const BodyNow& b) {
    return Vec3(b.position + b.rotation * mass_center);
  };
  Path path(body.position + body.rotation.normalized() * mass_center, body.linear_velocity,
            floor.velocity, out.scene.options.gravity, normal, friction);
  Vec3 course = (floor.rotation * along).normalized();
  const std::size_t i = static_cast<std::size_t>(id.index());
  out.judge = [=](const Seen& seen) mutable {
    if (seen.step == 0) return 0.0;
    path.advance(dt);
    if (path.slip().norm() > 0.1 * speed) course = path.slip().normalized();
    if (seen.step < 20) return 0.0;
    const Vec3 off = where(seen.now[i]) - path.position();
    const Vec3 flat = off - off.dot(normal) * normal;
    const Vec3 aside = normal.cross(course);
    const Quat turned = seen.now[i].rotation * body.rotation.normalized().conjugate();
    const double turn = 2 * std::abs(std::atan2(turned.vec().dot(normal), turned.w()));
    const double step = path.substep_error(dt);
    return std::max({std::abs(flat.dot(course)) / (0.01 * path.length() + step),
                     std::abs(flat.dot(aside)) / (kHalfDegree * path.length() + step),
                     std::min(turn, 2 * scenes::kPi - turn) / 0.02});
  };
  return out;
}

}  // namespace

std::vector<Family> friction_cone_families();  // friction_cone.cpp

std::vector<Family> friction_families() {
  Family slide;
  slide.id = "slide", slide.law = Law::friction;
  slide.title = "a body slides without spin on a floor, slope, height field or conveyor";
  slide.criterion =
      "distance from Coulomb's path (1 % along it, 0.5 degrees aside), yaw (0.02 rad), the "
      "largest as a share of what is allowed";
  slide.limit = 1;
  std::vector<Family> out = in_both_spaces(slide, draw_slide);
  for (Family& f : friction_cone_families()) out.push_back(std::move(f));
  return out;
}

}  // namespace manyworlds::invariants
