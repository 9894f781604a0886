// Drives and limits of single joints: the other rows of the joint are part of theirs.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

enum class Kind { hinge, slider, wheel };

struct Link {
  Scene scene;
  Vec3 axis = Vec3::UnitZ();  // of the hinge, or along the slider
  double inertia = 0;         // kg m^2 about the hinge, or kg: of a link on the world
};

// A body of any mass and size whose centre lies up to `far` sizes from the origin.
BodyId add_link(Random& random, Scene& scene, double far, Vec3& center, Vec3& moments) {
  const double size = random.log_uniform(1e-3, 100), mass = random.log_uniform(1e-3, 1e3);
  const bool planar = scene.space == Space::planar;
  moments = mass * size * size * random.uniform(0.02, 0.4) * Vec3(1, 0.8, 0.7);
  const Vec3 way = planar ? random.planar_direction() : random.direction();
  center = size * random.uniform(0, far) * way;
  return scene.add(lump(scene.space, mass, moments, center));
}
// On the world, or on another such body; swept over.
Link random_link(Random& random, Space space, Kind kind, double far, bool pair = false) {
  Link out;
  out.scene = empty_scene(space, 0);
  out.scene.options.joint.method = JointMethod::sweep;
  Vec3 center, moments, of_other;
  BodyId other;
  if (pair) other = add_link(random, out.scene, far, of_other, moments);
  const BodyId link = add_link(random, out.scene, far, center, moments);
  const Quat turn = space == Space::planar ? random.planar_rotation() : random.rotation();
  const JointType types[] = {HingeJoint{}, SliderJoint{},
                             WheelJoint{.suspension = {.damping = 1e-12}}};
  const Joint joint = joint_at(out.scene, other, link, at(Vec3::Zero(), turn),
                               types[static_cast<std::size_t>(kind)]);
  out.scene.add(joint);
  const bool slides = kind == Kind::slider;
  out.axis = turn * (slides ? Vec3::UnitX() : Vec3::UnitZ());
  out.inertia = mass_properties(out.scene, out.scene.at(link)).mass;
  if (!slides) {
    out.inertia = out.axis.dot(moments.cwiseProduct(out.axis)) +
                  out.inertia * out.axis.cross(center).squaredNorm();
  }
  return out;
}

void set_drive(Scene& scene, const Drive& drive) {
  std::visit(
      [&](auto& type) {
        if constexpr (requires { type.drive; }) type.drive = drive;
      },
      scene.joints[0].type);
}

// Of the joint's coordinate; a slider is on the world.
double rate_of(const Batch& batch, const Link& link) {
  const Joint& joint = link.scene.joints[0];
  if (std::holds_alternative<SliderJoint>(joint.type)) return link.axis.dot(velocity(batch, 0, 0));
  const int last = static_cast<int>(link.scene.bodies.size()) - 1;
  Vec3 spins = spin(batch, 0, last);
  if (joint.body_a) spins -= spin(batch, 0, 0);
  return link.axis.dot(spins);
}

// What implicit Euler makes of k x + c x' against an inertia.
struct Damped {
  double inertia, k, c, x, v = 0;
  void step(double h) {
    v = (inertia * v - h * k * x) / (inertia + h * c + h * h * k);
    x += h * v;
  }
};

}  // namespace

TEST_CASE("a motor gives a link its speed in the first step, however long the arm",
          "[fast][joint]") {
  struct Case {
    Kind kind;
    Space space;
    double far;
    bool pair = false;
  };
  // In space float32 has too few digits for arms of more than some radii of gyration.
  const Case cases[] = {{Kind::hinge, Space::planar, 100},  {Kind::hinge, Space::planar, 100, true},
                        {Kind::slider, Space::planar, 100}, {Kind::wheel, Space::planar, 100, true},
                        {Kind::hinge, Space::spatial, 3},   {Kind::hinge, Space::spatial, 3, true},
                        {Kind::slider, Space::spatial, 3},  {Kind::wheel, Space::spatial, 3, true}};
  Random random(11);
  for (const Case& c : cases) {
    for (int i = 0; i < 20; ++i) {
      Link link = random_link(random, c.space, c.kind, c.far, c.pair);
      const double speed = 1e-4 / c.far;  // rad/s or m/s: too little for the arm to turn
      set_drive(link.scene, {.target_speed = speed});
      for (const Table& table : widest_tables()) {
        Batch batch(compile(link.scene), options_of(table));
        batch.step();
        INFO(name(table) << ", case " << &c - cases << ", link " << i);
        CHECK(rate_of(batch, link) == approx(speed, pick(table, 1e-2, 1e-6) * speed));
      }
    }
  }
}

TEST_CASE("motors do not fling arms that are too long for the digits of a row", "[fast][joint]") {
  for (const double arm : {10.0, 50.0, 70.0, 100.0}) {  // radii of a ball
    Scene scene = empty_scene(Space::spatial, 0);
    scene.options.joint.method = JointMethod::sweep;
    const BodyId ball = scene.add(lump(Space::spatial, 1, Vec3::Constant(0.4), {arm, 0, 0}));
    HingeJoint hinge;
    hinge.drive = Drive{.target_speed = 1};
    scene.add(joint_at(scene, {}, ball, at(Vec3::Zero()), hinge));
    for (const Table& table : widest_tables()) {
      Batch batch(compile(scene), options_of(table));
      double fastest = 0;
      for (int i = 0; i < 600; ++i) {
        batch.step();
        fastest = std::max(fastest, spin(batch, 0, 0).norm());
      }
      INFO(name(table) << ", arm of " << arm << " radii");
      CHECK(batch.status(0) == Status::ok);
      CHECK(fastest < 2);
      CHECK(spin(batch, 0, 0).z() > 0);
    }
  }
}

TEST_CASE("bodies that a target draws to one another rotate freely", "[fast][joint]") {
  for (const Space space : kSpaces) {
    for (const double apart : {0.1, 1.0, 5.0}) {
      Scene scene = empty_scene(space, 0);
      const BodyId a = scene.add(lump(space, 1, Vec3::Constant(0.1), Vec3::Zero()));
      const BodyId b = scene.add(lump(space, 1, Vec3::Constant(0.1), {apart, 0, 0}));
      scene.at(a).angular_velocity = {0, 0, 10};
      Joint target{.type = TargetJoint{.spring = Spring{.stiffness = 1, .damping = 5}}};
      target.body_a = a, target.body_b = b;
      scene.add(target);
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(60);
        INFO(name(table) << ", " << apart << " m apart");
        CHECK(spin(batch, 0, 0).z() == approx(10, 1e-3));
        CHECK(spin(batch, 0, 1).z() == approx(0, 1e-3));
      }
    }
  }
}

TEST_CASE("a servo moves a link by the recurrence of implicit Euler", "[fast][joint]") {
  Random random(12);
  for (const Space space : kSpaces) {
    for (int i = 0; i < 40; ++i) {
      Link link = random_link(random, space, i % 3 == 0 ? Kind::slider : Kind::hinge, 3);
      const double h = 1.0 / 240, rate = random.log_uniform(1e-2, 1e3) / h, ratio = 1.5;
      const double k = link.inertia * rate * rate, c = 2 * ratio * link.inertia * rate;
      const double target = 1e-3;
      set_drive(link.scene, {.target_position = target, .spring = Spring{k, c}});
      for (const Table& table : widest_tables()) {
        Batch batch(compile(link.scene), options_of(table));
        INFO(name(table) << ", link " << i << ", k h^2 / I " << h * h * rate * rate);
        Damped expected{link.inertia, k, c, -target};
        double fastest = 0;
        for (int step = 0; step < 40; ++step) {
          for (int s = 0; s < 4; ++s) {
            expected.step(h);
            fastest = std::max(fastest, std::abs(expected.v));
          }
          batch.step();
          CHECK(rate_of(batch, link) == approx(expected.v, pick(table, 1e-2, 1e-3) * fastest));
        }
      }
    }
  }
}

TEST_CASE("springs given by a frequency swing at it, as drives and as limits", "[fast][joint]") {
  struct Case {
    JointMethod method;
    bool limit, weak_drive;
  };
  const Case cases[] = {{JointMethod::sweep, false, false}, {JointMethod::tree, false, false},
                        {JointMethod::sweep, true, false},  {JointMethod::tree, true, false},
                        {JointMethod::sweep, true, true},   {JointMethod::tree, true, true}};
  for (const Space space : kSpaces) {
    for (const Case& c : cases) {
      Scene scene = empty_scene(space, 0);
      scene.options.joint.method = c.method;
      const BodyId rod = scene.add(uniform_rod(space, 1, 1, {0.5, 0, 0}));
      const Spring spring{.frequency = 1, .damping_ratio = 0.1};
      HingeJoint hinge;
      if (c.limit) {
        hinge.limit = Limit{0.1, 3, spring};
        if (c.weak_drive) hinge.drive = Drive{.max_force = 1e-9};
      } else {
        hinge.drive = Drive{.target_position = 0.1, .spring = spring};
      }
      scene.add(joint_at(scene, {}, rod, at(Vec3::Zero()), hinge));
      const double w = 2 * std::numbers::pi;
      for (const Table& table : widest_tables()) {
        Batch batch(compile(scene), options_of(table));
        Damped expected{1, w * w, 0.2 * w, -0.1};
        for (int step = 0; step < 14; ++step) {  // until the limit lets go
          for (int s = 0; s < 4; ++s) expected.step(1.0 / 240);
          batch.step();
          INFO(name(table) << ", case " << &c - cases << ", step " << step);
          CHECK(spin(batch, 0, 0).z() == approx(expected.v, 0.02));
        }
      }
    }
  }
}

TEST_CASE("no motor passes a limit of its joint", "[fast][joint]") {
  for (const Space space : kSpaces) {
    for (const double force : {10.0, 1e3, 1e6, std::numeric_limits<double>::infinity()}) {
      for (const double speed : {1.0, 50.0}) {
        Scene scene = empty_scene(space, 0);
        const BodyId bar = scene.add(uniform_rod(space, 1, 1, {0.5, 0, 0}));
        HingeJoint hinge;
        hinge.limit = Limit{-0.7, 0.7};
        hinge.drive = Drive{.target_speed = speed, .max_force = force};
        scene.add(joint_at(scene, {}, bar, at(Vec3::Zero()), hinge));
        for (const Table& table : widest_tables()) {
          Batch batch(compile(scene), options_of(table));
          INFO(name(table) << ", " << force << " N m, " << speed << " rad/s");
          double most = 0;
          for (int i = 0; i < 240; ++i) {
            batch.step();
            const Vec3 along = rotation(batch, 0, 0) * Vec3::UnitX();
            most = std::max(most, std::atan2(along.y(), along.x()));
          }
          CHECK(most < 0.7 + 1e-3);
          CHECK(most > 0.7 - 1e-3);
          CHECK(spin(batch, 0, 0).norm() < pick(table, 1e-4, 1e-9) * speed);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
