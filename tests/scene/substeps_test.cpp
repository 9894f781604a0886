// What a plan chooses where Options leave it to it, and what it says of it.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "manyworlds/scenes.hpp"
#include "scenes/sized.hpp"
#include "src/plan/substeps.hpp"
#include "tests/support/arch.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

int substeps_of(const Scene& scene) { return *compile(scene).resolved().substeps; }
std::string why(const Scene& scene, const std::string& option = "substeps") {
  for (const auto& choice : compile(scene).report().choices) {
    if (choice.option == option) return choice.why;
  }
  return "";
}
bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Scene column(Space space, int count, double size, double gap = 0) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  for (int i = 0; i < count; ++i) {
    scene.add(
        body_of(shape_of(cube_of(space, size / 2)), (size * (0.5 + i) + gap * i) * up_of(space)));
  }
  return scene;
}

// A row of cubes of 1 m, each hinged to the one before it, the first to the world.
Scene chain_of(Space space, int count) {
  Scene chain = empty_scene(space);
  for (int i = 0; i < count; ++i) {
    chain.add(body_of(shape_of(cube_of(space, 0.5)), i * Vec3::UnitX()));
    Joint hinge;
    if (i > 0) hinge.body_a = BodyId(i - 1);
    hinge.body_b = BodyId(i);
    hinge.frame_a.position = {i == 0 ? -0.5 : 0.5, 0, 0};
    hinge.frame_b.position = {-0.5, 0, 0};
    chain.add(hinge);
  }
  return chain;
}

}  // namespace

TEST_CASE("the scenes of bench have four substeps", "[fast][plan]") {
  int all = 0;
  for (const auto& entry : scenes::all()) {
    if (!entry.standard && std::string(entry.name) != "free-flight") continue;
    INFO(entry.name);
    CHECK(substeps_of(entry.make()) == 4);
    ++all;
  }
  CHECK(all == 13);
}

TEST_CASE("columns get the substeps that they stand with", "[fast][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    CHECK(substeps_of(column(space, 10, 1)) == 4);
    CHECK(substeps_of(column(space, 20, 1)) > 4);
    CHECK(says(why(column(space, 20, 1)), "20 bodies up to body 20 stand on one another"));
    CHECK(substeps_of(column(space, 5, 1e-3)) > substeps_of(column(space, 5, 1e-2)));
    CHECK(substeps_of(column(space, 200, 1)) == 64);
    // What begins above something else with room between is no column.
    CHECK(substeps_of(column(space, 20, 1, 0.3)) == 4);
    // Side by side they are no higher.
    Scene wall = empty_scene(space);
    for (int row = 0; row < 12; ++row) {
      for (int i = 0; i < 12; ++i) {
        wall.add(body_of(shape_of(cube_of(space, 0.5)),
                         (i + 0.5 * (row % 2)) * Vec3::UnitX() + (0.5 + row) * up_of(space)));
      }
    }
    CHECK(substeps_of(wall) <= substeps_of(column(space, 12, 1)));
    Scene weightless = column(space, 20, 1);
    weightless.options.gravity.setZero();
    CHECK(substeps_of(weightless) == 4);
  }
}

TEST_CASE("contacts are softer where bodies stand deep", "[fast][plan]") {
  const auto hz = [](const Scene& scene) { return *compile(scene).resolved().contact.frequency; };
  CHECK(hz(scenes::pyramid(15)) == Approx(60));
  CHECK(hz(scenes::pyramid(60)) == Approx(30));
  CHECK(says(why(scenes::pyramid(60), "contact.frequency"),
             "0.125 of the rate of 4 substeps per step, Hz; less than a quarter since bodies stand "
             "60 deep"));
  // A wide pile is no deeper, nor is one with room between its bodies.
  Scene beside = scenes::pyramid(15);
  for (int i = 0; i < 30; ++i) {
    beside.add(body_of(shape_of(cube_of(Space::planar, 0.5)), Vec3(40 + 1.1 * i, 0.5, 0)));
  }
  CHECK(hz(beside) == Approx(60));
  CHECK(hz(column(Space::planar, 80, 1, 0.3)) == Approx(60));
  // Where springs have to be stiff, the substeps are more.
  const Options deep = compile(column(Space::spatial, 30, 1)).resolved();
  CHECK(*deep.contact.frequency == Approx(0.25 * std::sqrt(15.0 / 30) * 60 * *deep.substeps));
  Scene given = scenes::pyramid(60);
  given.options.contact.frequency = 100;
  CHECK(hz(given) == 100);
}

// Nothing upsets what lies there; where it is about as stable either way, rounding must not decide.
TEST_CASE("what lies on the ground needs no more substeps", "[fast][plan]") {
  struct Lying {
    Geometry shape;
    double height;  // m, of its center
    Quat rotation = Quat::Identity();
  };
  const Quat aside(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  const Lying spatial[] = {{Sphere{0.4}, 0.4},
                           {Capsule{0.3, 0.6}, 0.3, aside},
                           {Cylinder{0.4, 0.3}, 0.3},
                           {Cylinder{0.3, 0.6}, 0.3, aside},
                           {Ellipsoid{{0.6, 0.6, 0.25}}, 0.25},
                           {Ellipsoid{{0.77, 0.73, 0.4}}, 0.4},
                           {Box{{0.4, 0.6, 0.2}}, 0.2}};
  const Lying planar[] = {{Circle{0.4}, 0.4},
                          {Capsule{0.3, 0.6}, 0.3, Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()))},
                          {Polygon::box(0.6, 0.3), 0.3}};
  const auto check = [](Space space, const Lying& one) {
    for (int i = 0; i < 100; ++i) {
      // Two blocks side by side, whose seam is below the body.
      Scene scene = empty_scene(space, 4);
      const Geometry block = space == Space::planar ? Geometry(Polygon::box(2, 1)) : Box{{2, 2, 1}};
      for (const double side : {-2.0, 2.0}) {
        scene.add(
            body_of(shape_of(block, i % 2), side * Vec3::UnitX() - up_of(space), Motion::fixed));
      }
      Body body = body_of(shape_of(one.shape, i % 2), one.height * up_of(space));
      body.position += 0.003 * i * Vec3::UnitX();
      body.rotation = one.rotation;
      if (space == Space::spatial) {
        body.position.y() = -0.004 * i;
        body.rotation = Quat(Eigen::AngleAxisd(0.41 * i, Vec3::UnitZ())) * one.rotation;
      }
      scene.add(body);
      INFO(one.shape.index() << ", draw " << i << ": " << why(scene));
      CHECK(substeps_of(scene) == 4);
    }
  };
  for (const Lying& one : spatial) check(Space::spatial, one);
  for (const Lying& one : planar) check(Space::planar, one);
}

// What no rule by levels sees: an arch's weight goes through faces that are not level.
TEST_CASE("arches get the substeps that they stand with", "[fast][plan]") {
  Scene scene = arch(Space::planar, 13, 0.3);
  CHECK(substeps_of(scene) > 4);
  CHECK(substeps_of(scene) < 16);
  CHECK(says(why(scene), "13 bodies up to body 7 stand on one another and would sag"));
  // Half of it falls, whatever the stiffness.
  scene.bodies.resize(7);
  CHECK(!says(why(scene), "stand on one another"));
}

TEST_CASE("columns sag and lean as springs at their corners say", "[fast][plan]") {
  // Contacts between cubes of the mass m are springs of m w^2 / 2, the one against the ground of
  // about 4 m w^2 / 2: the top of five sags by 21 g / w^2. It may by a hundredth of two sizes.
  const Scene five = column(Space::spatial, 5, 0.01);
  const StandingNeed need = need_of_standing_bodies(five);
  CHECK(need.bodies == 5);
  CHECK(!need.leans);
  CHECK(need.w * need.w == Approx(21 * 10 / (0.01 * 2 * 0.01)).epsilon(0.1));
  // 40 lean first: at 2 g / (w^2 L) = 1.96 / n^3, measured. A tenth of it comes of the load.
  const StandingNeed tall = need_of_standing_bodies(column(Space::spatial, 40, 1));
  CHECK(tall.leans);
  CHECK(tall.w * tall.w == Approx(2 * 10 * 64000 / (0.3 * 1.96)).epsilon(0.2));
}

TEST_CASE("ratios of mass and loads of joints ask for substeps", "[fast][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    Scene scene = column(space, 2, 1, 1);
    scene.bodies[2].shapes[0].density = 400 * scene.options.density;
    const Options chosen = compile(scene).resolved();
    CHECK(*chosen.substeps == 12);
    CHECK(*chosen.contact.frequency == 60);  // stiffer contacts would not help
    CHECK(says(why(scene), "has 400 times the mass of"));
    scene.bodies[2].shapes[0].filter = {2, ~1u};  // the other one is of category 1
    CHECK(substeps_of(scene) == 4);

    Scene chain = chain_of(space, 10);
    CHECK(substeps_of(chain) == 4);
    Shape& last = chain.bodies[9].shapes[0];
    last.density = 1000 * chain.options.density, last.filter.mask = 0;
    CHECK(substeps_of(chain) == 4);  // solved at once
    CHECK(compile(chain).resolved().joint.method == JointMethod::tree);
    chain.options.joint.method = JointMethod::sweep;
    CHECK(substeps_of(chain) > 8);
    CHECK(says(why(chain), "joint 0 carries 1.01e+03 times its lighter body"));
    // A load that hangs on two ways is not known of either.
    Joint other;
    other.body_b = BodyId(9), other.frame_b.position = {0.5, 0, 0};
    other.frame_a.position = {9.5, 0, 0};
    chain.add(other);
    CHECK(substeps_of(chain) == 4);
  }
}

TEST_CASE("rows of light links under a load have the substeps that whipping needs",
          "[fast][plan]") {
  for (Space space : {Space::planar, Space::spatial}) {
    const auto loaded = [space](double ratio, int links = 10) {
      Scene chain = chain_of(space, links);
      Shape& last = chain.bodies.back().shapes[0];
      last.density = ratio * chain.options.density, last.filter.mask = 0;
      return chain;
    };
    const auto method = [](const Scene& scene) {
      return compile(scene).resolved().joint.method.value_or(JointMethod::sweep);
    };
    for (const double ratio : {1.0, 4.9}) CHECK(method(loaded(ratio)) == JointMethod::sweep);
    for (const double ratio : {5.0, 10.0, 99.0}) {
      // 35 for each radian that a fall of 10 m, at 14 m/s, turns a link of 1 m by in a step
      CHECK(method(loaded(ratio)) == JointMethod::tree);
      CHECK(substeps_of(loaded(ratio)) == 9);
    }
    CHECK(says(why(loaded(10), "joint.method"),
               "10 joints in a row carry loads of 10 times the mass of their links"));
    CHECK(says(why(loaded(10)), "a row of 10 light joints whips"));
    CHECK(*compile(loaded(10)).resolved().contact.frequency == 60);
    CHECK(substeps_of(loaded(100)) == 4);                // not thrown up
    CHECK(method(loaded(10, 4)) == JointMethod::sweep);  // no row
    Scene slow = loaded(10);
    slow.options.gravity /= 100;
    CHECK(substeps_of(slow) == 4);
    slow.options.gravity.setZero();
    CHECK(substeps_of(slow) == 4);
    Scene fine = loaded(10);
    fine.options.dt /= 2;
    CHECK(substeps_of(fine) == 5);
    // Of two, the one that is thrown up counts, whichever is longer.
    Scene both = loaded(200, 12);
    const int others = static_cast<int>(both.bodies.size());
    for (Body body : loaded(10).bodies) both.add(std::move(body));
    for (Joint joint : loaded(10).joints) {
      if (joint.body_a) joint.body_a = BodyId(joint.body_a.index() + others);
      joint.body_b = BodyId(joint.body_b.index() + others);
      both.add(joint);
    }
    for (Body& body : both.bodies) body.shapes[0].filter.mask = 0;
    CHECK(substeps_of(loaded(200, 12)) == 4);
    CHECK(substeps_of(both) == 9);
    Scene swept = loaded(10);
    swept.options.joint.method = JointMethod::sweep;
    CHECK(substeps_of(swept) == 4);
  }
}

TEST_CASE("joints carry the side that they part", "[fast][plan]") {
  Scene free = chain_of(Space::spatial, 5);
  free.joints.erase(free.joints.begin());
  const double mass = mass_properties(free, free.bodies[0]).mass;
  // Nothing holds it: each joint the lighter side.
  CHECK(carried_masses(free) == std::vector<double>{mass, 2 * mass, 2 * mass, mass});
  CHECK(carried_masses(chain_of(Space::spatial, 3)) ==
        std::vector<double>{3 * mass, 2 * mass, mass});
  // What does not move is as good as the world; two joints between two bodies share.
  Scene fixed = chain_of(Space::spatial, 4);
  fixed.bodies[1].motion = Motion::fixed;
  CHECK(carried_masses(fixed) == std::vector<double>{0, 0, 2 * mass, mass});
  fixed.add(fixed.joints[3]);
  CHECK(carried_masses(fixed) == std::vector<double>{0, 0, 2 * mass, 0, 0});
}

TEST_CASE("what is given is not chosen", "[fast][plan]") {
  Scene scene = column(Space::spatial, 20, 0.1);
  scene.options.substeps = 3;
  scene.options.contact.frequency = 30;
  scene.options.contact.slop = 0.01;
  scene.options.length_unit = 2;
  const Plan plan = compile(scene);
  CHECK(*plan.resolved().substeps == 3);
  CHECK(*plan.resolved().contact.frequency == 30);
  CHECK(*plan.resolved().contact.slop == 0.01);
  CHECK(*plan.resolved().length_unit == 2);
  CHECK(why(scene).empty());
  CHECK(!plan.scene().options.contact.push_out_speed);  // the scene stays as it was described
  // As given or as chosen: the same worlds.
  Scene chosen = column(Space::spatial, 20, 0.1), given = chosen;
  given.options = compile(chosen).resolved();
  CHECK(compile(given).fingerprint() == compile(chosen).fingerprint());
  // Contacts are as stiff as the scene needs them, however many substeps are taken.
  given = chosen, given.options.substeps = 8;
  CHECK(compile(given).resolved().contact.frequency ==
        compile(chosen).resolved().contact.frequency);
}

TEST_CASE("a frequency that is given asks for substeps that carry it", "[fast][plan]") {
  Scene scene = column(Space::spatial, 1, 1);
  scene.options.contact.frequency = 240;
  CHECK(substeps_of(scene) == 16);
  CHECK(says(why(scene), "contact.frequency is 240 Hz"));
}

TEST_CASE("the worst of all worlds decides", "[fast][plan]") {
  Scene scene = column(Space::spatial, 2, 1, 1);
  CHECK(substeps_of(scene) == 4);
  Variation density = vary(Parameter::density, 1000, 4e5);
  density.shape = ShapeId(BodyId(2), 0);
  scene.variations.push_back(density);
  CHECK(substeps_of(scene) == 12);
  // Each body draws for itself: the upper one may be heavy and the lower one light.
  scene.variations.back().shape = {}, scene.variations.back().body = {};
  CHECK(substeps_of(scene) == 12);
}

}  // namespace manyworlds::test
