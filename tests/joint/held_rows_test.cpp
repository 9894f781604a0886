// Drives and limits of single joints: the other rows of the joint are part of theirs.
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

struct Link {
  Scene scene;
  Vec3 axis = Vec3::UnitZ();  // of the hinge, or along the slider
  double inertia = 0;         // kg m^2 about the hinge, or kg
};

// A link of any mass and size on a hinge that may be far from its centre, or on a slider.
Link random_link(Random& random, Space space, bool slides) {
  Link out;
  out.scene = empty_scene(space, 0);
  const double size = random.log_uniform(1e-3, 100);
  const double mass = random.log_uniform(1e-3, 1e3);
  const Vec3 moments = mass * size * size * random.uniform(0.02, 0.4) * Vec3(1, 0.8, 0.7);
  const Vec3 far = space == Space::planar ? random.planar_direction() : random.direction();
  const Vec3 center = size * random.uniform(0, 3) * far;
  const BodyId link = out.scene.add(lump(space, mass, moments, center));
  const Quat turn = space == Space::planar ? random.planar_rotation() : random.rotation();
  const JointType type = slides ? JointType(SliderJoint{}) : JointType(HingeJoint{});
  out.scene.add(joint_at(out.scene, {}, link, at(Vec3::Zero(), turn), type));
  out.axis = turn * (slides ? Vec3::UnitX() : Vec3::UnitZ());
  out.inertia = mass;
  if (!slides) {
    out.inertia =
        out.axis.dot(moments.cwiseProduct(out.axis)) + mass * out.axis.cross(center).squaredNorm();
  }
  return out;
}

std::optional<Drive>& drive_of(Scene& scene) {
  JointType& type = scene.joints[0].type;
  if (auto* slider = std::get_if<SliderJoint>(&type)) return slider->drive;
  return std::get<HingeJoint>(type).drive;
}

double rate_of(const Batch& batch, const Link& link) {
  const bool slides = std::holds_alternative<SliderJoint>(link.scene.joints[0].type);
  return link.axis.dot(slides ? velocity(batch, 0, 0) : spin(batch, 0, 0));
}

}  // namespace

TEST_CASE("a motor gives a link its speed in the first step, however long the arm",
          "[fast][joint]") {
  Random random(11);
  for (const Space space : kSpaces) {
    for (int i = 0; i < 40; ++i) {
      Link link = random_link(random, space, i % 3 == 0);
      const double speed = 1e-3;  // rad/s or m/s: too little for the arm to turn
      drive_of(link.scene) = Drive{.target_speed = speed};
      for (const Table& table : widest_tables()) {
        Batch batch(compile(link.scene), options_of(table));
        batch.step();
        INFO(name(table) << ", link " << i);
        CHECK(rate_of(batch, link) == approx(speed, pick(table, 1e-3, 1e-6) * speed));
      }
    }
  }
}

TEST_CASE("a servo moves a link by the recurrence of implicit Euler", "[fast][joint]") {
  Random random(12);
  for (const Space space : kSpaces) {
    for (int i = 0; i < 40; ++i) {
      Link link = random_link(random, space, i % 3 == 0);
      const double h = 1.0 / 240, rate = random.log_uniform(1e-2, 1e3) / h, ratio = 1.5;
      const double k = link.inertia * rate * rate, c = 2 * ratio * link.inertia * rate;
      const double target = 1e-3;
      drive_of(link.scene) = Drive{.target_position = target, .spring = Spring{k, c}};
      for (const Table& table : widest_tables()) {
        Batch batch(compile(link.scene), options_of(table));
        INFO(name(table) << ", link " << i << ", k h^2 / I " << h * h * rate * rate);
        double x = 0, v = 0, fastest = 0;
        for (int step = 0; step < 40; ++step) {
          for (int s = 0; s < 4; ++s) {
            v = (link.inertia * v - h * k * (x - target)) / (link.inertia + h * c + h * h * k);
            x += h * v;
            fastest = std::max(fastest, std::abs(v));
          }
          batch.step();
          CHECK(rate_of(batch, link) == approx(v, pick(table, 1e-2, 1e-3) * fastest));
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
