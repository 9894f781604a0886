// Hulls of many corners in contacts: against their twins, against the round shapes that they come
// near, and the same bits everywhere.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "manyworlds/query.hpp"
#include "src/scene/convex_hull.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/large_hulls.hpp"
#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/varied_bits.hpp"

namespace manyworlds::test {
namespace {

// A convex shape as the points whose hull it is, and normals to try first.
struct Cloud {
  Eigen::Matrix<double, Eigen::Dynamic, 3> points;
  std::vector<Vec3> normals;
  double radius = 0;
  double reach(const Vec3& n) const { return (points * n).maxCoeff() + radius; }
};
Cloud cloud_of(const Geometry& geometry) {
  std::vector<Vec3> points = {Vec3::Zero()};
  Cloud out;
  if (const auto* hull = std::get_if<Hull>(&geometry)) {
    points = hull->vertices;
    const auto solid = detail::convex_hull(points);
    for (const detail::HullFace& f : solid->faces) {
      out.normals.push_back(f.normal);
    }
  } else if (const auto* box = std::get_if<Box>(&geometry)) {
    points.clear();
    for (int i = 0; i < 8; ++i) {
      points.push_back(
          box->half_extents.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    }
    for (int c = 0; c < 3; ++c) {
      out.normals.push_back(Vec3::Unit(c));
      out.normals.push_back(-Vec3::Unit(c));
    }
  } else if (const auto* capsule = std::get_if<Capsule>(&geometry)) {
    const Vec3 end(0, 0, capsule->half_length);
    points = {-end, end};
    out.radius = capsule->radius;
  } else {
    out.radius = std::get<Sphere>(geometry).radius;
  }
  out.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    out.points.row(static_cast<Eigen::Index>(i)) = points[i];
  }
  return out;
}
Cloud placed(Cloud cloud, const Pose& pose) {
  const Mat3 r = pose.rotation.toRotationMatrix();
  cloud.points = (cloud.points * r.transpose()).rowwise() + pose.position.transpose();
  for (Vec3& n : cloud.normals) n = r * n;
  return cloud;
}
double separation_along(const Cloud& a, const Cloud& b, const Vec3& n) {
  return -b.reach(-n) - a.reach(n);
}
// The largest over all directions, or nearly so: all normals of faces and an even spread of
// directions, and from the best of those in ever smaller steps.
double largest_separation(const Cloud& a, const Cloud& b) {
  std::vector<std::pair<double, Vec3>> looks;
  const auto look = [&](const Vec3& n) { looks.emplace_back(separation_along(a, b, n), n); };
  for (const Vec3& n : a.normals) look(n);
  for (const Vec3& n : b.normals) look(-n);
  constexpr int kSpread = 200;
  for (int i = 0; i < kSpread; ++i) {
    const double z = 1 - (2 * i + 1.0) / kSpread, angle = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    look({r * std::cos(angle), r * std::sin(angle), z});
  }
  std::partial_sort(looks.begin(), looks.begin() + 4, looks.end(),
                    [](const auto& x, const auto& y) { return x.first > y.first; });
  double out = looks[0].first;
  for (int start = 0; start < 4; ++start) {
    auto [s, n] = looks[static_cast<std::size_t>(start)];
    for (double step = 0.1; step > 1e-6;) {
      const Vec3 u = n.unitOrthogonal(), v = n.cross(u), from = n;
      const double before = s;
      for (int k = 0; k < 8; ++k) {
        const double angle = k * M_PI / 4 + step;
        const Vec3 m = (from + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
        const double there = separation_along(a, b, m);
        if (there > s) s = there, n = m;
      }
      if (!(s > before)) step *= 0.5;
    }
    out = std::max(out, s);
  }
  return out;
}

struct Tally {
  int poses = 0, overlapping = 0, local = 0, deviations = 0;
  std::string report;
  void deviation(const std::string& what, double found, double truth) {
    if (++deviations <= 5) {
      report += what + ": " + std::to_string(found) + ", true " + std::to_string(truth) + "\n";
    }
  }
};

// What is promised for hulls of few corners (collide_convex_test.cpp) for any of `second` against
// large ones: faces win over what is better by half a slop and, in overlap, 5 % of the depth. Deep
// in one another a shape may be on a hill of its own.
void judge(const std::vector<Contact>& contacts, const Cloud& first, const Cloud& second,
           Tally& tally) {
  const double tight = 3e-5, margin = 4 * kPairSlop, deep = 0.02;
  const double truth = largest_separation(first, second);
  ++tally.poses;
  tally.overlapping += truth < 0;
  if (truth < -tight && contacts.empty()) return tally.deviation("no contact", 0, truth);
  if (contacts.empty()) return;
  if (truth > 1.5 * margin + tight) return tally.deviation("contact too far", 0, truth);
  const bool in_order = contacts[0].body_a == BodyId(0);
  const Cloud &a = in_order ? first : second, &b = in_order ? second : first;
  double deepest = 1e9;
  for (const Contact& c : contacts) deepest = std::min(deepest, c.separation);
  const double along = separation_along(a, b, contacts[0].normal);
  if (deepest < along - tight) tally.deviation("deeper than along its normal", deepest, along);
  const double allowed = 0.5 * kPairSlop / 0.95 + 0.5 * kPairSlop + 0.06 * std::abs(truth) + tight;
  if (deepest > std::max(truth, 0.0) + allowed) tally.deviation("too shallow", deepest, truth);
  if (truth > 0) {
    if (deepest < -2 * tight) tally.deviation("overlap of what is apart", deepest, truth);
  } else if (along < truth - allowed) {
    if (truth > -deep) return tally.deviation("too deep", along, truth);
    ++tally.local;
  }
}

void check_large(Motion motion, ShapeMaker maker) {
  constexpr int kPoses = 48;
  for (const Table& table : widest_tables()) {
    Random random(20261130);
    Tally tally;
    for (int kind = 0; kind < kLargeHulls; ++kind) {
      Scene scene = empty_scene(Space::spatial);
      scene.options.contact.slop = kPairSlop;
      scene.add(body_of(shape_of(large_hull(kind, random.integer(70, 500), random)), Vec3::Zero(),
                        motion));
      scene.add(body_of(shape_of(maker(random)), Vec3::Zero()));
      const Cloud hull = cloud_of(scene.bodies[0].shapes[0].geometry),
                  other = cloud_of(scene.bodies[1].shapes[0].geometry);
      Batch batch(compile(scene), options_of(table, kPoses));
      std::vector<std::vector<Pose>> poses;
      for (int i = 0; i < kPoses; ++i) {
        Pose still, moved;
        if (motion != Motion::fixed) still = {random.in_cube(0.5), random.rotation()};
        moved.rotation = random.rotation();
        const Vec3 way = random.direction();
        // How far apart their middles are if one plane across `way` touches both.
        const double apart = placed(hull, still).reach(way) - still.position.dot(way) +
                             placed(other, moved).reach(-way);
        moved.position = still.position + way * (apart * random.uniform(0.3, 1.02));
        poses.push_back({still, moved});
      }
      write_poses(batch, poses);
      for (int i = 0; i < kPoses; ++i) {
        const auto& p = poses[static_cast<std::size_t>(i)];
        judge(batch.contacts(i), placed(hull, p[0]), placed(other, p[1]), tally);
      }
    }
    INFO(name(table) << ": " << tally.deviations << " deviations, " << tally.local << " local in "
                     << tally.poses << " poses\n"
                     << tally.report);
    CHECK(tally.deviations == 0);
    CHECK(tally.local <= tally.poses / 100);
    CHECK(tally.overlapping > tally.poses / 3);
  }
}
Geometry any_large_hull(Random& r) {
  return large_hull(r.integer(0, kLargeHulls - 1), r.integer(70, 300), r);
}

}  // namespace

TEST_CASE("a large hull touches a sphere where it is", "[slow][collide]") {
  check_large(Motion::dynamic, any_sphere);
}
TEST_CASE("a large hull touches a capsule where it is", "[slow][collide]") {
  check_large(Motion::dynamic, any_capsule);
}
TEST_CASE("a large hull touches a box where it is", "[slow][collide]") {
  check_large(Motion::fixed, any_box);
}
TEST_CASE("a large hull touches a small one where it is", "[slow][collide]") {
  check_large(Motion::fixed, any_hull);
}
TEST_CASE("a large hull touches another where it is", "[slow][collide]") {
  check_large(Motion::dynamic, any_large_hull);
}

// The deepest point on a plane is the lowest corner.
TEST_CASE("a large hull touches a plane with its lowest corner", "[fast][collide]") {
  for (const Table& table : widest_tables()) {
    Random random(3);
    for (int kind = 0; kind < kLargeHulls; ++kind) {
      Scene scene = empty_scene(Space::spatial);
      scene.add(body_of(shape_of(Plane{}), Vec3::Zero(), Motion::fixed));
      scene.options.contact.slop = kPairSlop;
      scene.add(
          body_of(shape_of(large_hull(kind, random.integer(70, 3000), random)), Vec3::Zero()));
      const Cloud hull = cloud_of(scene.bodies[1].shapes[0].geometry);
      Batch batch(compile(scene), options_of(table, 64));
      std::vector<std::vector<Pose>> poses;
      for (int i = 0; i < 64; ++i)
        poses.push_back({Pose{}, {random.in_cube(0.3), random.rotation()}});
      write_poses(batch, poses);
      for (int i = 0; i < 64; ++i) {
        const double lowest =
            -placed(hull, poses[static_cast<std::size_t>(i)][1]).reach(-Vec3::UnitZ());
        const std::vector<Contact> contacts = batch.contacts(i);
        if (lowest > 0.01) continue;
        INFO(name(table) << " kind " << kind);
        REQUIRE(!contacts.empty());
        double deepest = 1;
        for (const Contact& c : contacts) deepest = std::min(deepest, c.separation);
        CHECK(deepest == approx(lowest, 0.1 * kPairSlop + 1e-5));
      }
    }
  }
}

// compile() computes distances of bodies at rest, too.
TEST_CASE("the distance between large hulls is the largest separation", "[fast][query]") {
  Random random(9);
  int local = 0, touching = 0;
  constexpr int kPairs = 36;
  for (int i = 0; i < kPairs; ++i) {
    Shape first = shape_of(large_hull(i % kLargeHulls, 100, random));
    Shape second = shape_of(large_hull(i / 6 % kLargeHulls, 130, random));
    const Pose a{random.in_cube(0.5), random.rotation()}, b{random.in_cube(0.5), random.rotation()};
    const Cloud of_a = placed(cloud_of(first.geometry), a),
                of_b = placed(cloud_of(second.geometry), b);
    const double truth = largest_separation(of_a, of_b);
    const Separation s =
        distance(first, {a.position, a.rotation}, second, {b.position, b.rotation});
    CHECK(separation_along(of_a, of_b, s.normal) == approx(s.distance, 1e-9));
    touching += truth < 0;
    if (truth > 0) CHECK(s.distance > truth - 1e-5);
    local += s.distance < truth - 1e-5;
  }
  CHECK(touching > kPairs / 3);
  CHECK(touching < kPairs);
  CHECK(local <= kPairs / 20);
}

namespace {

// Dense blocks see one hull in all lanes, rows many; some hulls have maps and some none, and the
// sizes of one differ from world to world.
Scene pile_of_hulls(bool varied) {
  Random random(5);
  Scene scene = empty_scene(Space::spatial);
  scene.add(body_of(shape_of(Plane{}), Vec3::Zero(), Motion::fixed));
  scene.add(body_of(shape_of(large_hull(4, 90, random)), Vec3(0.2, 0, 0.1), Motion::fixed));
  for (int i = 0; i < 10; ++i) {
    const int corners[] = {12, 40, 66, 130, 180};
    const int kinds[] = {0, 3, 4, 4, 5, 0};
    Body body = body_of(shape_of(large_hull(kinds[i % 6], corners[i % 5], random)),
                        Vec3(0.4 * (i % 3), 0.2 * i, 1 + 0.8 * i));
    if (i == 7) body.shapes[0].geometry = Box{{0.2, 0.2, 0.2}};
    body.jitter.position = {0.1, 0.1, 0.1}, body.jitter.any_orientation = true;
    scene.add(std::move(body));
  }
  if (varied) {
    for (const int body : {5, 6, 11}) {
      Variation size = vary_three(Parameter::size, Vec3::Constant(0.2), Vec3::Constant(0.5));
      size.body = BodyId(body);
      scene.variations.push_back(size);
    }
  }
  return scene;
}

}  // namespace

TEST_CASE("a pile of large hulls has the same bits everywhere", "[fast][bits]") {
  for (const bool varied : {false, true}) {
    const Plan plan = compile(pile_of_hulls(varied));
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
          BatchOptions options = options_of(table, 18, 2);
          options.layout = layout;
          const auto found = hashes_after(plan, options, 70);
          INFO(name(table) << ' ' << to_string(layout) << ' ' << varied);
          if (reference.empty()) reference = found;
          CHECK(found == reference);
          options.worlds = 3, options.seed += 14, options.threads = 1;
          const auto some = hashes_after(plan, options, 70);
          CHECK(std::equal(some.begin(), some.end(), reference.begin() + 14));
        }
      }
    }
  }
}

// Prisms with caps of 75 sides among them, whose outlines are reduced.
TEST_CASE("a world with hulls of its own size is one of the scene that has them, bit for bit",
          "[fast][parameters][bits]") {
  check_worlds_are_those_of_scenes(pile_of_hulls(true), "", 3, 40);
}

}  // namespace manyworlds::test
