// Impacts against the impulse formulas and conservation laws, in both spaces.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/cradle.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

double tight(const Table& table) { return pick(table, 1e-5, 1e-12); }

// A contact-free world in which something hits a plane at height 0 head on.
Scene onto_plane(Space space, Body body, double friction, double restitution) {
  Scene scene = empty_scene(space, 0);
  scene.add(ground(space, friction, restitution));
  body.shapes[0].material = {friction, restitution};
  scene.add(std::move(body));
  return scene;
}

}  // namespace

TEST_CASE("head-on impacts of balls follow the impulse formula", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double e : {0.3, 0.5, 0.8, 1.0}) {
      for (double gap : {0.0, 0.13, 0.4}) {
        for (double density : {250.0, 1000.0, 4000.0}) {
          Scene scene = empty_scene(space, 0);
          scene.add(body_of(shape_of(round_of(space, 0.5), 0, e), Vec3::Zero()));
          scene.add(body_of(shape_of(round_of(space, 0.25), 0, 0), Vec3(0.75 + gap, 0, 0)));
          scene.bodies[0].linear_velocity = Vec3(3, 0, 0);
          scene.bodies[1].linear_velocity = Vec3(-1, 0, 0);
          scene.bodies[1].shapes[0].density = density;
          const double m1 = mass_properties(scene, scene.bodies[0]).mass;
          const double m2 = mass_properties(scene, scene.bodies[1]).mass;
          const double after1 = (m1 * 3 - m2 - m2 * e * 4) / (m1 + m2);
          const double after2 = (m1 * 3 - m2 + m1 * e * 4) / (m1 + m2);
          for (const Table& table : all_tables()) {
            Batch batch(compile(scene), options_of(table));
            batch.step(15);
            INFO(name(table) << " e " << e << " gap " << gap << " density " << density);
            // Relative to v0, which is the approach speed of 4 m/s.
            CHECK((velocity(batch, 0, 0) - Vec3(after1, 0, 0)).norm() < 4 * tight(table));
            CHECK((velocity(batch, 0, 1) - Vec3(after2, 0, 0)).norm() < 4 * tight(table));
          }
        }
      }
    }
  }
}

TEST_CASE("plastic impacts of balls end with one velocity", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = empty_scene(space, 0);
    scene.add(body_of(shape_of(round_of(space, 0.5), 0, 0), Vec3::Zero()));
    scene.add(body_of(shape_of(round_of(space, 0.5), 0, 0), Vec3(1.13, 0, 0)));
    scene.bodies[0].linear_velocity = Vec3(3, 0, 0);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      batch.step(20);
      INFO(name(table));
      CHECK(velocity(batch, 0, 0).x() == approx(1.5, pick(table, 1e-5, 1e-9)));
      CHECK(velocity(batch, 0, 1).x() == approx(1.5, pick(table, 1e-5, 1e-9)));
    }
  }
}

TEST_CASE("equal elastic balls leave an oblique impact at a right angle", "[fast][closed_form]") {
  Random random(5);
  for (Space space : {Space::planar, Space::spatial}) {
    for (int k = 0; k < 20; ++k) {
      Scene scene = empty_scene(space, 0);
      scene.add(body_of(shape_of(round_of(space, 0.5), 0, 1), Vec3::Zero()));
      const Vec3 aside = Vec3(0, random.uniform(-0.8, 0.8), 0);
      scene.add(body_of(shape_of(round_of(space, 0.5), 0, 1), Vec3(1.6, 0, 0) + aside));
      scene.bodies[0].linear_velocity = Vec3(4, 0, 0);
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        batch.step(40);
        const Vec3 a = velocity(batch, 0, 0), b = velocity(batch, 0, 1);
        INFO(name(table) << " offset " << aside.y() << " v " << a.transpose() << ", "
                         << b.transpose());
        REQUIRE(b.norm() > 0.1);
        CHECK(std::abs(a.dot(b)) < 16 * tight(table));
        CHECK((a + b - Vec3(4, 0, 0)).norm() < 4 * tight(table));
      }
    }
  }
}

// j = -(1 + e) vn / (1/m + n . [(I^-1 (r x n)) x r]), for a cube (isotropic inertia) that falls
// on a corner. The normal is up, r goes from the centre to the lowest corner.
TEST_CASE("a cube on its corner takes the impulse of the lever arm", "[fast][closed_form]") {
  Random random(6);
  for (Space space : {Space::planar, Space::spatial}) {
    const Vec3 n = up_of(space);
    for (int k = 0; k < 20; ++k) {
      const double e = random.uniform(0.2, 0.9), speed = random.uniform(2, 4);
      Body cube = body_of(shape_of(cube_of(space, 0.5)), Vec3::Zero());
      Vec3 r = Vec3::Zero();
      double second = 0;  // the next corner's height over the lowest: one contact point only
      do {
        cube.rotation = space == Space::planar ? random.planar_rotation() : random.rotation();
        std::vector<double> heights;
        double lowest = 1e9;
        for (int i = 0; i < (space == Space::planar ? 4 : 8); ++i) {
          const Vec3 corner = cube.rotation * Vec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5,
                                                   space == Space::planar ? 0
                                                   : i & 4                ? 0.5
                                                                          : -0.5);
          heights.push_back(corner.dot(n));
          if (corner.dot(n) < lowest) {
            lowest = corner.dot(n);
            r = corner;
          }
        }
        std::sort(heights.begin(), heights.end());
        second = heights[1] - heights[0];
      } while (second < 0.15);
      cube.position = (0.05 - r.dot(n)) * n;
      cube.linear_velocity = -speed * n;
      const Scene scene = onto_plane(space, cube, 0, e);
      const MassProperties m = mass_properties(scene, scene.bodies[1]);
      const double inv_inertia = 1 / m.inertia(2, 2);
      const Vec3 lever = r.cross(n);
      const double j = (1 + e) * speed / (1 / m.mass + n.dot((inv_inertia * lever).cross(r)));
      const Vec3 v = (j / m.mass - speed) * n, w = inv_inertia * j * lever;
      for (const Table& table : all_tables()) {
        Batch batch(compile(scene), options_of(table));
        int steps = 0;
        while (batch.contacts(0).empty() || spin(batch, 0, 0).norm() == 0) {
          REQUIRE(++steps < 10);
          batch.step();
        }
        INFO(name(table) << " e " << e << " v " << velocity(batch, 0, 0).transpose() << " not "
                         << v.transpose() << ", w " << spin(batch, 0, 0).transpose() << " not "
                         << w.transpose());
        CHECK((velocity(batch, 0, 0) - v).norm() < speed * tight(table));
        CHECK((spin(batch, 0, 0) - w).norm() < 2 * speed * tight(table));
      }
    }
  }
}

// A spinning ball on a plane either grips, vt' = (5 vt + 2 r w) / 7 (disc: (2 vt + r w) / 3), or
// slips with the friction impulse mu (1 + e) m |vn|. w > 0 rolls along +vt.
TEST_CASE("a spinning ball leaves the plane by the grip and slip formulas", "[fast][closed_form]") {
  const double radius = 0.4, vn = 2, e = 0.5;
  struct Case {
    double vt, rw, mu;
  };
  for (Space space : {Space::planar, Space::spatial}) {
    const bool disc = space == Space::planar;
    for (const Case& c : {Case{3, -0.5, 0.9}, Case{3, -0.5, 0.05}, Case{-1, 2, 0.8},
                          Case{-1, 2, 0.1}, Case{0, 1.5, 0.6}, Case{2, 0, 0.02}}) {
      for (double gap : {0.0, 0.05}) {
        Body ball = body_of(shape_of(round_of(space, radius)), (radius + gap) * up_of(space));
        ball.linear_velocity = Vec3(c.vt, 0, 0) - vn * up_of(space);
        const Vec3 axis = disc ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
        ball.angular_velocity = c.rw / radius * axis;
        const Scene scene = onto_plane(space, ball, c.mu, e);
        const double u = c.vt - c.rw, share = disc ? 1.0 / 3 : 2.0 / 7;
        const bool grips = c.mu * (1 + e) * vn >= share * std::abs(u);
        double vt = disc ? (2 * c.vt + c.rw) / 3 : (5 * c.vt + 2 * c.rw) / 7, rw = vt;
        if (!grips) {
          const double friction = c.mu * (1 + e) * vn * (u > 0 ? 1 : -1);
          vt = c.vt - friction;
          rw = c.rw + (disc ? 2 : 2.5) * friction;
        }
        for (const Table& table : all_tables()) {
          Batch batch(compile(scene), options_of(table));
          batch.step(6);
          INFO(name(table) << (grips ? " grips" : " slips") << " gap " << gap << " vt " << c.vt
                           << " rw " << c.rw << " v " << velocity(batch, 0, 0).transpose()
                           << " r w " << radius * spin(batch, 0, 0).dot(axis));
          const double size = std::abs(c.vt) + std::abs(c.rw) + vn;
          CHECK((velocity(batch, 0, 0) - Vec3(vt, 0, 0) - e * vn * up_of(space)).norm() <
                size * tight(table));
          CHECK(std::abs(radius * spin(batch, 0, 0).dot(axis) - rw) < size * tight(table));
        }
      }
    }
  }
}

// Apex heights e^2 h, and the energy after the tenth rebound.
TEST_CASE("a bouncing ball keeps e^2 of its energy at each rebound", "[fast][closed_form]") {
  struct Drop {
    double height, e, gravity;
    int rebounds;
  };
  for (Space space : {Space::planar, Space::spatial}) {
    for (bool on_block : {false, true}) {
      // Impacts well above the threshold: ten from 5 m, and from 1 m as many as there are.
      for (const Drop& drop : {Drop{5, 0.9, 10, 10}, Drop{1, 0.5, 9.81, 3}, Drop{1, 0.8, 9.81, 6},
                               Drop{1, 0.9, 9.81, 10}, Drop{5, 1.0, 10, 10}}) {
        Scene scene = empty_scene(space, drop.gravity);
        const Geometry floor = on_block ? cube_of(space, 2) : ground_of(space);
        scene.add(body_of(shape_of(floor), (on_block ? -2.0 : 0.0) * up_of(space), Motion::fixed));
        scene.add(body_of(shape_of(round_of(space, 0.5), 0.6, drop.e),
                          (0.5 + drop.height) * up_of(space)));
        for (const Table& table : all_tables()) {
          Batch batch(compile(scene), options_of(table));
          int rebounds = 0;
          double before = 0;
          while (rebounds < drop.rebounds && batch.time() < 30) {
            batch.step();
            const double v = velocity(batch, 0, 0).dot(up_of(space));
            if (before < 0 && v > 0) {
              ++rebounds;
              const double energy =
                  (0.5 * v * v) / drop.gravity + position(batch, 0, 0).dot(up_of(space)) - 0.5;
              INFO(name(table) << " e " << drop.e << " rebound " << rebounds << " energy ratio "
                               << energy / (drop.height * std::pow(drop.e, 2 * rebounds)));
              CHECK(energy == Approx(drop.height * std::pow(drop.e, 2 * rebounds)).epsilon(0.01));
            }
            before = v;
          }
          CHECK(rebounds == drop.rebounds);
          if (drop.e < 0.9) {  // rest at t1 (1 + e) / (1 - e)
            while (batch.time() <
                   0.5 + std::sqrt(2 * drop.height / drop.gravity) * (1 + drop.e) / (1 - drop.e))
              batch.step();
            CHECK(velocity(batch, 0, 0).norm() < 1e-3);
            CHECK(position(batch, 0, 0).dot(up_of(space)) == approx(0.5, 2e-3));
          }
        }
      }
    }
  }
}

// What leaves has done with its contact, on whichever side of zero rounding has left its gap.
TEST_CASE("balls that bounce without loss keep their energy", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    for (double size : {0.001, 0.1, 10.0}) {
      for (int substeps : {1, 4}) {
        Scene scene = empty_scene(space, 9.81);
        scene.options.substeps = substeps;
        // One step falls through as much of a ball at any size.
        scene.options.dt = 0.01 * std::sqrt(size / 0.1);
        scene.options.length_unit = 2 * size;
        scene.add(ground(space, 0, 1));
        for (int i = 0; i < 32; ++i) {
          scene.add(body_of(shape_of(round_of(space, size), 0, 1),
                            size * (20 * i * Vec3::UnitX() + (20 + i) * up_of(space))));
        }
        for (const Table& table : all_tables()) {
          Batch batch(compile(scene), options_of(table));
          std::vector<double> energy;
          const auto energy_of = [&](int ball) {
            return 0.5 * velocity(batch, 0, ball).squaredNorm() +
                   9.81 * position(batch, 0, ball).dot(up_of(space));
          };
          for (int i = 0; i < 32; ++i) energy.push_back(energy_of(i));
          batch.step(1000);
          // One substep is exact; more leave an error of second order in dt.
          const double tolerance = substeps == 1 ? pick(table, 1e-5, 1e-12) : 2e-5;
          for (int i = 0; i < 32; ++i) {
            INFO(name(table) << " size " << size << " substeps " << substeps << " ball " << i);
            CHECK(energy_of(i) / energy[static_cast<std::size_t>(i)] ==
                  Approx(1).epsilon(tolerance));
          }
        }
      }
    }
  }
}

TEST_CASE("Newton's cradle sends out as many balls as come in", "[fast][closed_form]") {
  for (int moving : {1, 2, 3}) {
    const Scene scene = scenes::newton_cradle(moving, 1e-3);
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table));
      const Momenta before = momenta(batch, 0);
      const double energy = kinetic_energy(batch, 0);
      batch.step(60);
      INFO(name(table) << " moving " << moving);
      CHECK((momenta(batch, 0).linear - before.linear).norm() <
            tight(table) * before.linear.norm());
      CHECK(kinetic_energy(batch, 0) == Approx(energy).epsilon(1e-3));
      for (int i = 0; i < 5; ++i) {
        INFO("ball " << i);
        CHECK(velocity(batch, 0, i).x() == approx(i >= 5 - moving ? 1 : 0, 2e-3));
      }
    }
  }
}

TEST_CASE("contacts between bodies conserve momentum", "[fast][closed_form]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = crowd(space);
    scene.options.gravity.setZero();
    scene.bodies.erase(scene.bodies.begin(), scene.bodies.begin() + 2);  // ground and block
    for (Body& b : scene.bodies) {
      b.linear_drag = b.angular_drag = 0;
      b.linear_velocity -= 0.8 * (b.position - 1.2 * up_of(space));
    }
    for (const Table& table : all_tables()) {
      Batch batch(compile(scene), options_of(table, 8));
      std::vector<Momenta> before;
      std::vector<double> energy;
      for (int w = 0; w < 8; ++w) {
        before.push_back(momenta(batch, w));
        energy.push_back(kinetic_energy(batch, w));
      }
      batch.step(60);
      for (int w = 0; w < 8; ++w) {
        const Momenta after = momenta(batch, w);
        double scale = 0;  // what could have been lost
        for (int i = 0; i < batch.bodies(w); ++i)
          scale += mass_properties(scene, scene.bodies[static_cast<std::size_t>(i)]).mass * 2;
        INFO(
            name(table) << " world " << w << " dp "
                        << (after.linear - before[static_cast<std::size_t>(w)].linear).transpose()
                        << " dL "
                        << (after.angular - before[static_cast<std::size_t>(w)].angular).transpose()
                        << " scale " << scale);
        CHECK((after.linear - before[static_cast<std::size_t>(w)].linear).norm() <
              pick(table, 2e-6, 1e-13) * scale);
        // Lever arms are those of the start of a step, so that sliding by d within the step moves
        // the line of an impulse P by at most d: the angular momentum is only nearly kept.
        CHECK((after.angular - before[static_cast<std::size_t>(w)].angular).norm() < 2e-2 * scale);
        CHECK(kinetic_energy(batch, w) < 0.9 * energy[static_cast<std::size_t>(w)]);  // they met
      }
    }
  }
}

}  // namespace manyworlds::test
