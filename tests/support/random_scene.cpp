#include "tests/support/random_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/base/random.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

// Draws of one part of a scene: what one part draws changes nothing in the others.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t part) : draws_(seed, part) {}

  double between(double low, double high) { return low + (high - low) * draws_.uniform(next_++); }
  bool chance(double probability) { return between(0, 1) < probability; }
  int below(int n) { return std::min(n - 1, static_cast<int>(between(0, n))); }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[below(static_cast<int>(values.size()))];
  }

 private:
  Draws draws_;
  std::uint64_t next_ = 0;
};

constexpr double kCell = 2.3;  // bounding radii from one body to the next: they cannot touch

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : seed_(seed), room_(seed, 0), resistance_(seed, 1 << 22) {}

  RandomScene make() {
    planar_ = room_.chance(0.5);
    scene_ = empty_scene(planar_ ? Space::planar : Space::spatial);
    scene_.name = "random scene " + std::to_string(seed_);
    unit_ = room_.one_of({0.1, 0.5, 0.5, 1.0, 5.0});
    cell_ = kCell * unit_;
    crowded_ = room_.chance(0.12);
    columns_ = planar_ ? 3 : 2;
    wall_ = (0.5 * columns_ + 1) * cell_;
    friction_ = !room_.chance(0.2);
    bounces_ = room_.chance(0.5);
    filtered_ = room_.chance(0.25);
    rough_ = room_.chance(0.3);
    choose_options();
    add_room();
    const int bodies = 3 + room_.below(planar_ ? 10 : 8);
    for (int i = 0; i < bodies; ++i) add_body(i);
    RandomScene out;
    out.unit = unit_;
    out.passive = gains_nothing_ && !crowded_ && !driven_;
    out.rough = rough_;
    const double height = (bodies / (planar_ ? 3 : 4) + 2) * cell_;
    out.top_speed = 4 * (fastest_ + std::sqrt(2 * 1.5 * scene_.options.gravity.norm() * height)) +
                    20 * *compile(scene_).resolved().contact.push_out_speed;
    out.scene = std::move(scene_);
    return out;
  }

 private:
  Vec3 vector(Dice& dice, double half) {
    const double x = dice.between(-half, half), y = dice.between(-half, half);
    return {x, y, planar_ ? 0 : dice.between(-half, half)};
  }
  Vec3 axial(Dice& dice, double half) {
    const double z = dice.between(-half, half);
    return planar_ ? Vec3(0, 0, z) : Vec3(dice.between(-half, half), dice.between(-half, half), z);
  }
  Quat rotation(Dice& dice) {
    const Vec3 axis = axial(dice, 1);
    return Quat(dice.between(-1, 1), axis.x(), axis.y(), axis.z() + 0.1);
  }

  void choose_options() {
    Dice dice(seed_, 1);
    Options& o = scene_.options;
    o.length_unit = 2 * unit_;
    o.dt = dice.one_of({1 / 120.0, 1 / 60.0, 1 / 60.0, 1 / 30.0});
    if (!rough_) o.dt = std::min(o.dt, std::sqrt(unit_) / 60);  // falls go with the root of lengths
    o.substeps = dice.one_of({1, 2, 4, 4, 8});
    if (dice.chance(0.15)) o.gravity.setZero();
    if (dice.chance(0.2)) o.contact.frequency = dice.between(30, 120);
    if (dice.chance(0.2)) o.contact.restitution_sweeps = 1 + dice.below(16);
    o.contact.friction_in_bias_pass = !dice.chance(0.25);
    o.contact.cast_between_moving = dice.chance(0.25);
    if (dice.chance(0.1)) {
      const Vec3 far = Vec3::Constant(100 * unit_);
      o.bounds = Eigen::AlignedBox3d(-far, far);
    }
    Dice left(seed_, 1 << 21);  // to the plan
    if (left.chance(0.3)) o.substeps.reset();
    if (left.chance(0.3)) o.length_unit.reset();
    still_air_ = dice.chance(0.5);
    choose_methods();
  }

  // Solvers and integrators other than the default ones may gain some energy.
  void choose_methods() {
    Dice dice(seed_, 1 << 20);
    Options& o = scene_.options;
    if (dice.chance(0.3)) {
      o.solver.method = dice.one_of({Solver::tgs_soft, Solver::sequential_impulse, Solver::sor,
                                     Solver::nncg, Solver::penalty});
      if (o.solver.method == Solver::tgs_soft || dice.chance(0.3))
        o.solver.iterations = 2 + dice.below(10);
      o.solver.split_impulse = dice.chance(0.5);
      o.solver.push_out_share = dice.between(0.1, 0.4);
      gains_nothing_ = false;
    }
    if (dice.chance(0.15)) {
      o.integrator =
          dice.one_of({Integrator::explicit_euler, Integrator::implicit_euler, Integrator::verlet,
                       Integrator::velocity_verlet, Integrator::runge_kutta4});
      gains_nothing_ = false;
    }
  }

  Shape shape(Dice& dice, Geometry geometry) {
    Shape out = shape_of(std::move(geometry), friction_ ? dice.between(0, 1.2) : 0,
                         bounces_ && dice.chance(0.7) ? dice.between(0, 1) : 0);
    if (resists_) {
      out.material.rolling_resistance = resistance_.between(0, 0.2) * unit_;
      if (!planar_) out.material.torsional_resistance = resistance_.between(0, 0.2) * unit_;
    }
    if (dice.chance(0.3)) out.density = rough_ ? dice.between(300, 3000) : dice.between(700, 1400);
    return out;
  }

  // Of the room: everybody collides with it.
  void add_fixed(Dice& dice, Geometry geometry, const Vec3& at, const Quat& orientation) {
    Body body = body_of(shape(dice, std::move(geometry)), at, Motion::fixed);
    body.rotation = orientation;
    body.shapes[0].filter.category = 1u << 31;
    scene_.add(std::move(body));
  }

  void add_room() {
    Dice dice(seed_, 2);
    const Quat straight = Quat::Identity();
    const int ground = dice.below(planar_ ? 4 : 3);
    if (ground == 0) {
      const double deep = 0.5 * unit_;
      add_fixed(dice, slab_of(scene_.space, wall_ + 2 * unit_, deep), -deep * up_of(scene_.space),
                straight);
    } else if (ground == 3) {
      Terrain hills;
      for (double x = -wall_ - unit_; x < wall_ + 3 * unit_; x += dice.between(0.5, 2) * unit_)
        hills.points.emplace_back(x, dice.between(0, 0.9) * unit_);
      add_fixed(dice, hills, Vec3::Zero(), straight);
    } else {
      add_fixed(dice, ground_of(scene_.space), Vec3::Zero(), straight);
    }
    for (int axis = 0; axis < (planar_ ? 1 : 2); ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3 inwards = -side * Vec3::Unit(axis);
        Geometry wall = Plane{inwards, -wall_};
        if (planar_) wall = HalfPlane{inwards.head<2>(), -wall_};
        add_fixed(dice, wall, Vec3::Zero(), straight);
      }
    }
    // On the ground, lower than any body begins.
    const double a = 0.5 * unit_, b = dice.between(0.1, 0.4) * unit_;
    for (int i = dice.below(4); i > 0; --i) {
      Vec3 at = vector(dice, wall_ - unit_);
      (planar_ ? at.y() : at.z()) = 0;
      const Quat orientation = rotation(dice);
      switch (dice.below(5)) {
        case 0: add_fixed(dice, round_of(scene_.space, a), at, orientation); break;
        case 1: add_fixed(dice, box_of(scene_.space, Vec3(b, a, b)), at, orientation); break;
        case 2: add_fixed(dice, Capsule{b, a}, at, orientation); break;
        case 3: {
          Geometry ramp = Segment{{-a, 0.1 * a}, {a, b}};
          if (!planar_) ramp = Cylinder{a, b};
          add_fixed(dice, ramp, at, orientation);
          break;
        }
        default: {
          Geometry wedge = Polygon{{{-a, -b}, {a, -b}, {0, b}}};
          if (!planar_) wedge = hull(dice, a);
          add_fixed(dice, wedge, at, orientation);
        }
      }
    }
  }

  // Corners near those of a cube, on a ball.
  Hull hull(Dice& dice, double radius) {
    Hull out;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      out.vertices.push_back(radius * (corner + 0.4 * vector(dice, 1)).normalized());
    }
    return out;
  }

  Geometry moving_geometry(Dice& dice, double radius) {
    const double thin = dice.between(0.3, 0.6) * radius;
    switch (dice.below(planar_ ? 4 : 5)) {
      case 0: return round_of(scene_.space, radius);
      case 1: {
        const Vec3 half(dice.between(0.3, 1), dice.between(0.3, 1), dice.between(0.3, 1));
        return box_of(scene_.space, radius * half / std::sqrt(planar_ ? 2.0 : 3.0));
      }
      case 2: return Capsule{thin, radius - thin};
      case 3: {
        if (planar_) break;
        const double angle = dice.between(0.4, 1.2);
        return Cylinder{radius * std::sin(angle), radius * std::cos(angle)};
      }
      case 4: return hull(dice, radius);
      default: break;
    }
    Polygon polygon;
    const int n = 3 + dice.below(6);
    const double from = dice.between(0, 7), rounding = dice.chance(0.3) ? 0.3 * radius : 0;
    for (int i = 0; i < n; ++i) {
      const double angle = from + 2 * kPi * (i + dice.between(0, 0.4)) / n;
      polygon.vertices.push_back((radius - rounding) * Vec2(std::cos(angle), std::sin(angle)));
    }
    polygon.radius = rounding;
    return polygon;
  }

  void add_shapes(Dice& dice, Body& body) {
    const double radius = dice.between(rough_ ? 0.35 : 0.7, 1) * unit_;
    if (!dice.chance(0.25)) {
      body.shapes.push_back(shape(dice, moving_geometry(dice, radius)));
    } else {  // a compound, all of it within the radius of the origin
      for (int i = 2 + dice.below(2); i > 0; --i) {
        body.shapes.push_back(shape(dice, moving_geometry(dice, 0.55 * radius)));
        body.shapes.back().position = 0.3 * radius * axial(dice, 1).normalized();
        if (planar_) body.shapes.back().position = 0.4 * vector(dice, 0.7 * radius);
        body.shapes.back().rotation = rotation(dice);
      }
    }
    if (!filtered_) return;
    const std::uint32_t category = 1u << dice.below(3);
    const std::uint32_t mask = (1u << 31) | static_cast<std::uint32_t>(dice.below(8));
    for (Shape& s : body.shapes) s.filter = {category, mask};
  }

  void add_body(int i) {
    Dice dice(seed_, 100 + static_cast<std::uint64_t>(i));
    const int layer = planar_ ? columns_ : columns_ * columns_;
    const double apart = crowded_ ? 0.5 * cell_ : cell_, middle = 0.5 * (columns_ - 1);
    const double x = (i % columns_ - middle) * apart, up = cell_ + (i / layer) * apart;
    const double y = planar_ ? up : (i / columns_ % columns_ - middle) * apart;
    Body body;
    body.position = {x, y, planar_ ? 0 : up};
    add_shapes(dice, body);
    body.rotation = rotation(dice);
    body.jitter.position = Vec3(1, 1, planar_ ? 0 : 1) * 0.05 * cell_;
    body.jitter.angle = dice.between(0, 3);
    body.jitter.any_orientation = !planar_ && dice.chance(0.5);
    // Higher than two bodies, and going up if anywhere: it has nothing to squeeze others against.
    if (i / layer >= 2 && dice.chance(0.3)) {
      body.motion = Motion::kinematic;
      body.jitter.position.setZero();
      if (dice.chance(0.4)) body.angular_velocity = axial(dice, 5);
      if (dice.chance(0.4)) body.linear_velocity = 0.5 * unit_ * up_of(scene_.space);
      driven_ |= !body.angular_velocity.isZero(0) || !body.linear_velocity.isZero(0);
      fastest_ = std::max(fastest_, 10 * unit_);
    } else {
      const double speed =
          std::sqrt(unit_) * (rough_ && dice.chance(0.1) ? 50 : dice.between(0, 5));
      body.linear_velocity = vector(dice, speed);
      body.jitter.linear_velocity = Vec3(1, 1, planar_ ? 0 : 1) * std::sqrt(unit_);
      body.angular_velocity = axial(dice, 6);
      fastest_ = std::max(fastest_, 2 * speed + 2 * std::sqrt(unit_) + 10 * unit_);
      body.gravity_scale = dice.chance(0.1) ? dice.between(0, 1.5) : 1;
      body.linear_drag = still_air_ ? 0 : dice.between(0, 1);
      body.angular_drag = still_air_ ? 0 : dice.between(0, 1);
      body.enabled = !dice.chance(0.05);
      if (dice.chance(0.1)) {
        MassProperties m = mass_properties(scene_, body);
        m.mass *= 2;
        m.inertia *= 3;
        body.mass_properties = m;
      }
    }
    scene_.add(std::move(body));
  }

  std::uint64_t seed_;
  Dice room_, resistance_;  // of the scene, and against rolling and spinning
  Scene scene_;
  bool planar_ = false, crowded_ = false, driven_ = false, friction_ = true, bounces_ = false;
  bool resists_ = resistance_.chance(0.25);
  bool filtered_ = false, still_air_ = true, rough_ = false, gains_nothing_ = true;
  int columns_ = 1;
  double unit_ = 1, cell_ = 1, wall_ = 1, fastest_ = 0;
};

// Height of a terrain above x.
double height_at(const Terrain& terrain, double x) {
  for (std::size_t i = 1; i < terrain.points.size(); ++i) {
    const Vec2 &a = terrain.points[i - 1], &b = terrain.points[i];
    if (x >= a.x() && x <= b.x()) return a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
  }
  return 0;
}

}  // namespace

RandomScene random_scene(std::uint64_t seed) { return Maker(seed).make(); }

double behind_walls(const RandomScene& random, const Vec3& center) {
  double behind = -std::numeric_limits<double>::max();
  const Scene& scene = random.scene;
  bool ground = true;  // the first is the ground
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::fixed) break;
    const Geometry& geometry = body.shapes[0].geometry;
    if (const auto* plane = std::get_if<Plane>(&geometry)) {
      behind = std::max(behind, plane->offset - plane->normal.dot(center));
    } else if (const auto* half = std::get_if<HalfPlane>(&geometry)) {
      behind = std::max(behind, half->offset - half->normal.dot(center.head<2>()));
    } else if (const auto* hills = std::get_if<Terrain>(&geometry)) {
      // Two parts of a body can stand on both sides of a hill, and its centre within.
      behind = std::max(behind, height_at(*hills, center.x()) - random.unit - center.y());
    } else if (ground) {
      behind = std::max(behind, -up_of(scene.space).dot(center));
    }
    ground = false;
  }
  return behind;
}

}  // namespace manyworlds::test
