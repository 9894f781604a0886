// Which pairs of shapes have MuJoCo's contacts in Solver::newton: a body falls on a static one at
// a random attitude.
#include <catch2/catch.hpp>

#include "tests/mjcf/newton_comparison.hpp"

namespace manyworlds::test {
namespace {

struct Geom {
  const char *name, *text;
};
constexpr Geom kPlane{"plane", R"(type="plane" size="1 1 1")"};
constexpr Geom kSphere{"sphere", R"(type="sphere" size="0.15")"};
constexpr Geom kCapsule{"capsule", R"(type="capsule" size="0.08 0.2")"};
constexpr Geom kBox{"box", R"(type="box" size="0.2 0.15 0.1")"};
constexpr Geom kCylinder{"cylinder", R"(type="cylinder" size="0.12 0.15")"};
constexpr Geom kEllipsoid{"ellipsoid", R"(type="ellipsoid" size="0.2 0.15 0.1")"};

// The pendulum makes it a model with joints.
std::string falling(const Geom& a, const Geom& b) {
  return std::string(
             R"(<mujoco><compiler angle="radian"/><option timestep="0.005" ccd_tolerance="1e-12"/><worldbody>
    <body name="still" pos="0 0 0"><geom )") +
         a.text + R"(/></body>
    <body name="falling" pos="0.02 -0.03 0.35" euler="0.3 0.5 0.2"><freejoint/><geom )" +
         b.text +
         R"( density="500" friction="0.6"/></body>
    <body pos="9 0 9"><joint axis="0 1 0"/><geom type="sphere" size="0.1" pos="0 0 -1"/></body>
    </worldbody></mujoco>)";
}

compare::StateComparison compare_pair(const Geom& a, const Geom& b, const Table& table,
                                      bool every_shape = false) {
  compare::Settings settings = kConverged;
  settings.every_shape = every_shape;
  const compare::Pair pair = pair_of(falling(a, b), settings);
  return compare::compare_states(pair, compare::draw_samples(pair, table.precision, 300, 10, 120),
                                 kernels_of(table));
}

}  // namespace

// Left out are pairs whose contacts differ from MuJoCo's:
//   plane and cylinder: other points on the rim, in 7 % of states, and two in place of one in 3 %;
//   capsule and box: where an edge crosses the capsule, MuJoCo may have the same point twice;
//   box and box: at most four points of a face, where MuJoCo has up to eight; near where a face and
//     an edge are as deep as one another, the other of the two;
//   ellipsoids with all but planes, cylinders with all but spheres: MuJoCo iterates and stops 1e-6
//     away; cylinders with cylinders and boxes have other numbers of points, too.
TEST_CASE("pairs of simple shapes have MuJoCo's contacts", "[mjcf][robots]") {
  const std::pair<Geom, Geom> pairs[] = {
      {kPlane, kSphere},  {kPlane, kCapsule},  {kPlane, kBox},       {kPlane, kEllipsoid},
      {kSphere, kSphere}, {kSphere, kCapsule}, {kCapsule, kSphere},  {kCapsule, kCapsule},
      {kSphere, kBox},    {kBox, kSphere},     {kSphere, kCylinder},
  };
  for (const Table& table : widest_tables()) {
    for (const auto& [a, b] : pairs) {
      const compare::StateComparison c = compare_pair(a, b, table);
      INFO(a.name << " and " << b.name << ", " << name(table) << ": " << to_string(c));
      CHECK(acceleration(c).differences.size() > 20);
      CHECK(c.other_contacts <= 3);
      CHECK(acceleration(c).most() < pick(table, 1e-2, 1e-10));
      CHECK(next(c).most() < pick(table, 1e-2, 1e-10));
      CHECK(acceleration(c).median() < pick(table, 1e-4, 1e-12));
    }
  }
}

TEST_CASE("which pairs have other contacts than in MuJoCo", "[.pairs]") {
  const Geom all[] = {kPlane, kSphere, kCapsule, kBox, kCylinder, kEllipsoid};
  for (std::size_t i = 0; i < std::size(all); ++i) {
    for (std::size_t j = std::max<std::size_t>(i, 1); j < std::size(all); ++j) {
      const compare::StateComparison c = compare_pair(all[i], all[j], double_table(), true);
      WARN(all[i].name << " and " << all[j].name << ": " << to_string(c));
    }
  }
}

}  // namespace manyworlds::test
