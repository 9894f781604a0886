// Bodies that spin on a ball joint: the heavy top (numerics.md A10), and that nothing gains energy
// by the gyroscopic term.
#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// A body with these moments about its centre of mass, `arm` above the pivot along its z axis,
// tilted by `tilt` about x and turning by `spin` in its own axes.
Scene top(double mass, const Vec3& moments, double arm, double tilt, const Vec3& spin,
          double gravity, double rate) {
  Scene scene = empty_scene(Space::spatial, gravity);
  scene.options.dt = 1 / rate;
  const Quat q(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
  Body body = lump(Space::spatial, mass, moments, q * Vec3(0, 0, arm));
  body.rotation = q;
  body.angular_velocity = q * spin;
  body.linear_velocity = body.angular_velocity.cross(body.position);
  scene.add(body);
  scene.add(joint_at(scene, {}, BodyId(0), at(Vec3::Zero()), BallJoint{}));
  return scene;
}
constexpr double kTilt = kPi / 6;
const Vec3 kMoments(5e-4, 5e-4, 8e-4);

Vec3 axis_of(const Batch& batch) { return rotation(batch, 0, 0) * Vec3::UnitZ(); }
double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

TEST_CASE("a heavy top nods and precesses (A10)", "[fast][joint]") {
  const Table table = double_table();
  if (!has_table(table)) return;
  Batch batch(compile(top(0.5, kMoments, 0.06, kTilt, {0, 0, 150}, 9.81, 960)), options_of(table));
  const struct {
    double time;
    Vec3 axis;
  } expected[] = {{0.1, {0.157643530250256, -0.497434231802729, 0.853057854076185}},
                  {0.5, {0.500103112528809, -0.124221645587959, 0.857009836353362}},
                  {1, {0.282829412124562, 0.460179453309986, 0.84157138401243}},
                  {2, {-0.488862523574039, -0.179453482747485, 0.853703625724185}}};
  for (const auto& [time, axis] : expected) {
    batch.step(static_cast<int>(std::lround(time * 960)) - static_cast<int>(batch.steps()));
    INFO("t " << time);
    CHECK(angle_between(axis_of(batch), axis) < 1e-2);
  }
}

TEST_CASE("a heavy top that precesses steadily keeps its tilt and its rate (A10)",
          "[fast][joint]") {
  const Table table = double_table();
  if (!has_table(table)) return;
  const double rate = 2.56140113796036;  // rad/s, slow root
  const Vec3 spin(0, rate * std::sin(kTilt), 150);
  Batch batch(compile(top(0.5, kMoments, 0.06, kTilt, spin, 9.81, 960)), options_of(table));
  const Vec3 start = axis_of(batch);
  batch.step(1920);
  const Vec3 end = axis_of(batch);
  CHECK(end.z() == approx(std::cos(kTilt), 2e-3));
  const Vec3 turned = Eigen::AngleAxisd(5.12280227592, Vec3::UnitZ()) * start;
  CHECK(angle_between(end, turned) < 1e-2);
}

TEST_CASE("it does not matter which of its axes a body on a joint is long along", "[joint]") {
  const Vec3 shapes[] = {{1, 1, 0.002}, {1, 0.9, 0.15}, {1, 0.55, 0.5}};
  const Vec3 directions[] = {{1, 0.1, 0.1}, {0.6, 0.3, 0.74}, {0.1, 0.1, 1}};
  for (const Table& table : widest_tables()) {
    const bool single = table.precision == Precision::f32;
    for (const Vec3& shape : shapes) {
      for (const Vec3& direction : directions) {
        for (const double per_step : {0.05, 0.3, 1.0}) {  // rad
          std::vector<Vec3> ends;
          for (int shift = 0; shift < 3; ++shift) {
            const Vec3 spin = 60 * per_step * direction.normalized();
            Vec3 moments;
            Mat3 axes;  // of the first body, in those of this one
            for (int k = 0; k < 3; ++k) {
              moments[k] = 0.3 * shape[(k + shift) % 3];
              axes.row(k) = Vec3::Unit((k + shift) % 3).transpose();
            }
            Scene scene = top(2, moments, 0, 0, Vec3::Zero(), 0, 60);
            Body& body = scene.bodies[0];
            body.rotation = Quat(Mat3(axes.transpose()));
            body.angular_velocity = spin;
            Batch batch(compile(scene), options_of(table));
            batch.step(60);
            const std::vector<double> omega = read_all(batch, Field::angular_velocity);
            ends.emplace_back(omega[0], omega[1], omega[2]);
          }
          INFO(name(table) << " moments " << shape.transpose() << " spin " << direction.transpose()
                           << ", rad a step: " << per_step);
          const double allowed = (single ? 1e-3 : 1e-9) * 60 * per_step;
          CHECK((ends[1] - ends[0]).norm() < allowed);
          CHECK((ends[2] - ends[0]).norm() < allowed);
        }
      }
    }
  }
}

TEST_CASE("what spins on a ball joint gains no energy, however fast and thin", "[slow][joint]") {
  const Vec3 shapes[] = {{1, 1, 1.6}, {1, 1, 0.01}, {1, 0.6, 0.4}, {0.5, 0.52, 1}, {1, 0.9, 0.15}};
  for (const Table& table : widest_tables()) {
    for (const Vec3& shape : shapes) {
      for (const double per_step : {0.01, 0.03, 0.05, 0.15, 0.5, 1.0, 2.5}) {  // rad
        const Vec3 spin = 60 * per_step * Vec3(0.6, 0.3, 0.74).normalized();
        for (const double gravity : {0.0, 10.0}) {
          const double arm = gravity > 0 ? 0.4 : 0.05;
          Batch batch(compile(top(2, 0.3 * shape, arm, 0.5, spin, gravity, 60)), options_of(table));
          const double kinetic = batch.energy(0).kinetic;
          // Measured from the lowest that it can hang.
          const double least = -2 * gravity * arm, start = energy_of(batch, 0) - least;
          batch.step(1200);
          INFO(name(table) << " moments " << shape.transpose() << " turn " << per_step
                           << " gravity " << gravity << " kinetic " << kinetic);
          CHECK(energy_of(batch, 0) - least < 1.01 * start);
          CHECK(worst_gap(batch, 0) < 0.12);
        }
      }
    }
  }
}

}  // namespace manyworlds::test
