// The named scenes: valid, findable, and the standard ones as the benchmark defines them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "manyworlds/plan.hpp"
#include "manyworlds/scenes.hpp"
#include "scenes/cradle.hpp"

namespace manyworlds {
namespace {

Scene make(const char* name) {
  const scenes::Entry* entry = scenes::find(name);
  REQUIRE(entry != nullptr);
  return entry->make();
}

std::vector<const Body*> dynamic_bodies(const Scene& scene) {
  std::vector<const Body*> result;
  for (const Body& body : scene.bodies) {
    if (body.motion == Motion::dynamic) result.push_back(&body);
  }
  return result;
}

template <class G>
int count(const Scene& scene) {
  int n = 0;
  for (const Body& body : scene.bodies) {
    for (const Shape& shape : body.shapes) n += std::holds_alternative<G>(shape.geometry);
  }
  return n;
}

// m; of the first shape, from the body frame.
double radius_around(const Body& body) {
  const Geometry& geometry = body.shapes[0].geometry;
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return sphere->radius;
  if (const auto* circle = std::get_if<Circle>(&geometry)) return circle->radius;
  if (const auto* box = std::get_if<Box>(&geometry)) return box->half_extents.norm();
  double farthest = 0;
  for (const Vec2& v : std::get<Polygon>(geometry).vertices) {
    farthest = std::max(farthest, v.norm());
  }
  return farthest;
}

}  // namespace

TEST_CASE("every scene of the catalogue is valid and named as listed", "[fast][scene]") {
  std::set<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) {
    const Scene scene = entry.make();
    CAPTURE(entry.name);
    for (const Issue& issue : validate(scene)) FAIL_CHECK(to_string(issue));
    CHECK(scene.name == entry.name);
    CHECK(names.insert(entry.name).second);
    CHECK(std::string(entry.summary).find('\n') == std::string::npos);
    CHECK_FALSE(dynamic_bodies(scene).empty());
    std::set<std::string> bodies;
    for (const Body& body : scene.bodies) CHECK(bodies.insert(body.name).second);
  }
  CHECK(std::count_if(scenes::all().begin(), scenes::all().end(),
                      [](const scenes::Entry& entry) { return entry.standard; }) == 12);
}

TEST_CASE("bodies start inside the bounds however they are drawn", "[fast][scene]") {
  for (const scenes::Entry& entry : scenes::all()) {
    const Scene scene = entry.make();
    if (!scene.options.bounds) continue;
    for (const Body* body : dynamic_bodies(scene)) {
      CAPTURE(entry.name, body->name);
      CHECK(scene.options.bounds->contains(body->position + body->jitter.position));
      CHECK(scene.options.bounds->contains(body->position - body->jitter.position));
    }
  }
}

TEST_CASE("unknown names get the nearest known one", "[fast][scene]") {
  CHECK(scenes::find("bin-boxs") == nullptr);
  CHECK(scenes::nearest("bin-boxs") == "bin-boxes");
  CHECK(scenes::nearest("bin2D") == "bin2d");
  CHECK(scenes::nearest("stack") == "stack10");
  CHECK(scenes::nearest("newtons-cradle") == "newton-cradle");
  CHECK(scenes::nearest("mixedpile2d") == "mixed-pile2d");
  CHECK(scenes::nearest("domino") == "domino");
}

TEST_CASE("standard scenes share gravity, density, friction and step", "[fast][scene]") {
  const std::set<std::string> own = {"car2d", "lunar-lander", "ragdoll"};
  for (const scenes::Entry& entry : scenes::all()) {
    // The scenes that other engines have, too.
    if (!entry.standard || own.contains(entry.name)) continue;
    const Scene scene = entry.make();
    const bool planar = scene.space == Space::planar;
    const bool ball = scene.name.substr(0, 4) == "ball";
    CAPTURE(entry.name);
    CHECK(scene.options.gravity == (planar ? Vec3(0, -10, 0) : Vec3(0, 0, -10)));
    CHECK(scene.options.density == (planar ? 1 : 1000));
    CHECK(scene.options.dt == 1.0 / 60.0);
    CHECK(*compile(scene).resolved().substeps == 4);
    CHECK(scene.options.bounds.has_value());
    for (const Body& body : scene.bodies) {
      CHECK(body.linear_drag == 0);
      CHECK(body.angular_drag == 0);
      for (const Shape& shape : body.shapes) {
        CHECK(shape.material.friction == 0.6);
        CHECK(shape.material.restitution == (ball && body.motion == Motion::dynamic ? 0.9 : 0.0));
        CHECK_FALSE(shape.density.has_value());
      }
    }
  }
}

TEST_CASE("chains have ten links of 1 m, joined at their ends", "[fast][scene][joint]") {
  for (const char* name : {"chain2d", "chain3d"}) {
    CAPTURE(name);
    const Scene scene = make(name);
    REQUIRE(scene.bodies.size() == 10);
    REQUIRE(scene.joints.size() == 10);
    for (int i = 0; i < 10; ++i) {
      const Body& link = scene.bodies[static_cast<std::size_t>(i)];
      const Capsule& capsule = std::get<Capsule>(link.shapes[0].geometry);
      CHECK(capsule.radius == 0.1);
      CHECK(capsule.half_length == 0.4);
      const Vec3 along = scene.space == Space::planar ? Vec3::UnitY() : Vec3::UnitZ();
      CHECK((link.shapes[0].rotation * along).cross(Vec3::UnitX()).norm() < 1e-15);
      CHECK(link.position == Vec3(i + 0.5, 0, 0));
      CHECK(link.jitter.linear_velocity ==
            (scene.space == Space::planar ? Vec3(0, 0.1, 0) : Vec3(0.1, 0.1, 0.1)));
      CHECK(link.shapes[0].filter.mask == 0);
      const Joint& joint = scene.joints[static_cast<std::size_t>(i)];
      CHECK(joint.body_a == BodyId(i - 1));
      CHECK(joint.body_b == BodyId(i));
      CHECK(joint.frame_a.position == Vec3(i == 0 ? 0 : 0.5, 0, 0));
      CHECK(joint.frame_b.position == Vec3(-0.5, 0, 0));
    }
  }
}

TEST_CASE("bin2d has 20 circles and 20 squares on 8 columns", "[fast][scene]") {
  const Scene scene = make("bin2d");
  const std::vector<const Body*> bodies = dynamic_bodies(scene);
  REQUIRE(bodies.size() == 40);
  CHECK(count<Circle>(scene) == 20);
  CHECK(count<Polygon>(scene) == 20);
  CHECK(count<HalfPlane>(scene) == 3);
  CHECK(bodies[0]->position.isApprox(Vec3(-4.2, 1, 0), 1e-15));
  CHECK(bodies[39]->position.isApprox(Vec3(4.2, 6.8, 0), 1e-15));
  CHECK(std::holds_alternative<Circle>(bodies[0]->shapes[0].geometry));   // c + r = 0
  CHECK(std::holds_alternative<Polygon>(bodies[1]->shapes[0].geometry));  // 1
  CHECK(std::holds_alternative<Polygon>(bodies[8]->shapes[0].geometry));  // 0 + 1
  CHECK(std::holds_alternative<Circle>(bodies[9]->shapes[0].geometry));   // 1 + 1
  CHECK(radius_around(*bodies[0]) == 0.5);
  CHECK(mass_properties(scene, *bodies[1]).mass == Approx(0.64));
  for (const Body* body : bodies) {
    CHECK(body->jitter.position == Vec3(0.05, 0.05, 0));
    CHECK(body->jitter.angle == 1.5);
  }
}

TEST_CASE("bins have their inner faces where the benchmark wants them", "[fast][scene]") {
  // Depth of a point below the nearest face of the bin, m.
  const auto depth = [](const Scene& scene, const Vec3& p) {
    double least = 1e9;
    for (const Shape& shape : scene.bodies[0].shapes) {
      if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
        least = std::min(least, plane->normal.dot(p) - plane->offset);
      } else {
        const auto& half = std::get<HalfPlane>(shape.geometry);
        least = std::min(least, half.normal.dot(p.head<2>()) - half.offset);
      }
    }
    return least;
  };
  const Scene flat = make("bin2d");
  CHECK(depth(flat, {0, 1, 0}) == 1);
  CHECK(depth(flat, {5, 1, 0}) == 0);
  CHECK(depth(flat, {-5.5, 1, 0}) == -0.5);
  CHECK(depth(flat, {0, 50, 0}) == 5);  // walls at x = +-5
  for (const char* name : {"bin-spheres", "bin-boxes", "mixed-pile"}) {
    const Scene scene = make(name);
    CHECK(depth(scene, {0, 0, 50}) == 2);
    CHECK(depth(scene, {2, 0, 1}) == 0);
    CHECK(depth(scene, {0, -2, 1}) == 0);
    CHECK(depth(scene, {-1.5, 0, 1}) == 0.5);
    CHECK(depth(scene, {0, 1.75, 1}) == 0.25);
    CHECK(depth(scene, {0, 0, -0.25}) == -0.25);
  }
}

TEST_CASE("pyramid2d has rows of 5 to 1 centred on x = 0", "[fast][scene]") {
  const Scene scene = make("pyramid2d");
  const std::vector<const Body*> bodies = dynamic_bodies(scene);
  REQUIRE(bodies.size() == 15);
  CHECK(bodies[0]->position.isApprox(Vec3(-2.2, 0.5, 0), 1e-15));
  CHECK(bodies[4]->position.isApprox(Vec3(2.2, 0.5, 0), 1e-15));
  CHECK(bodies[5]->position.isApprox(Vec3(-1.65, 1.5, 0), 1e-15));
  CHECK(bodies[14]->position.isApprox(Vec3(0, 4.5, 0), 1e-15));
  for (const Body* body : bodies) {
    CHECK(body->jitter.position == Vec3(0.01, 0, 0));
    CHECK(mass_properties(scene, *body).mass == Approx(1));
  }
}

TEST_CASE("the 3D bins hold 20 bodies on layers of 9", "[fast][scene]") {
  for (const char* name : {"bin-spheres", "bin-boxes"}) {
    const Scene scene = make(name);
    const bool boxes = scene.name == "bin-boxes";
    const std::vector<const Body*> bodies = dynamic_bodies(scene);
    REQUIRE(bodies.size() == 20);
    CHECK(bodies[0]->position.isApprox(Vec3(-1.3, -1.3, 1), 1e-15));
    CHECK(bodies[5]->position.isApprox(Vec3(1.3, 0, 1), 1e-15));
    CHECK(bodies[19]->position.isApprox(Vec3(0, -1.3, 3.8), 1e-15));
    for (const Body* body : bodies) {
      CHECK(body->jitter.position == Vec3(0.05, 0.05, 0.05));
      CHECK(body->jitter.any_orientation == boxes);
      CHECK(radius_around(*body) == Approx(boxes ? 0.4 * std::sqrt(3.0) : 0.5));
    }
  }
}

TEST_CASE("stack10 stands and the balls hang where they should", "[fast][scene]") {
  const Scene stack = make("stack10");
  const std::vector<const Body*> boxes = dynamic_bodies(stack);
  REQUIRE(boxes.size() == 10);
  for (int i = 0; i < 10; ++i) {
    const Body& box = *boxes[static_cast<std::size_t>(i)];
    CHECK(box.position == Vec3(0, 0, 0.5 + i));
    CHECK(box.jitter.position == Vec3(0.005, 0.005, 0));
    CHECK(mass_properties(stack, box).mass == Approx(1000));
  }
  const Scene planar_ball = make("ball2d");
  CHECK(dynamic_bodies(planar_ball)[0]->position == Vec3(0, 5, 0));
  CHECK(dynamic_bodies(planar_ball)[0]->jitter.position == Vec3(0, 1, 0));
  const Scene spatial_ball = make("ball3d");
  CHECK(dynamic_bodies(spatial_ball)[0]->position == Vec3(0, 0, 5));
  CHECK(dynamic_bodies(spatial_ball)[0]->jitter.position == Vec3(0, 0, 1));
}

TEST_CASE("free-flight bodies can never touch and have three different moments", "[fast][scene]") {
  const Scene scene = make("free-flight");
  CHECK(scene.options.gravity == Vec3::Zero());
  REQUIRE(scene.bodies.size() == 20);
  for (const Body& body : scene.bodies) {
    CHECK(body.shapes[0].filter.mask == 0);
    const Mat3 inertia = mass_properties(scene, body).inertia;
    CHECK(inertia(0, 0) != inertia(1, 1));
    CHECK(inertia(1, 1) != inertia(2, 2));
    CHECK(inertia(0, 0) != inertia(2, 2));
  }
}

TEST_CASE("scenes that must start apart do", "[fast][scene]") {
  for (const char* name : {"billiards", "mixed-pile2d", "bin-spheres"}) {
    const Scene scene = make(name);
    const std::vector<const Body*> bodies = dynamic_bodies(scene);
    CAPTURE(name);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Body& a = *bodies[i];
        const Body& b = *bodies[j];
        // Two draws can bring the centres this much closer.
        const double closer = (a.jitter.position + b.jitter.position).norm();
        const double distance = (a.position - b.position).norm();
        CHECK(distance - closer > radius_around(a) + radius_around(b));
      }
    }
  }
}

TEST_CASE("billiards is a regulation table", "[fast][scene]") {
  const Scene scene = make("billiards");
  const std::vector<const Body*> balls = dynamic_bodies(scene);
  REQUIRE(balls.size() == 16);
  CHECK(mass_properties(scene, *balls[3]).mass == Approx(0.17));
  CHECK(balls[15]->linear_velocity == Vec3(8, 0, 0));
  CHECK(balls[0]->position == Vec3(0.635, 0, 0));
  // The cue ball meets the apex ball and nothing before it.
  for (std::size_t i = 1; i < 15; ++i) CHECK(balls[i]->position.x() > balls[0]->position.x());
}

TEST_CASE("the first domino starts by turning about its lower edge", "[fast][scene]") {
  const Scene scene = make("domino");
  const std::vector<const Body*> dominoes = dynamic_bodies(scene);
  REQUIRE(dominoes.size() == 15);
  const Body& first = *dominoes[0];
  const Vec3 half = std::get<Box>(first.shapes[0].geometry).half_extents;
  const Vec3 edge(half.x(), 0, -half.z());
  CHECK((first.linear_velocity + first.angular_velocity.cross(edge)).norm() < 1e-15);
  const Vec3 top(half.x(), 0, half.z());
  CHECK((first.linear_velocity + first.angular_velocity.cross(top)).x() > 0);
  // Kinetic energy about the edge exceeds what it takes to lift the centre over it.
  const MassProperties mp = mass_properties(scene, first);
  const double inertia = mp.inertia(1, 1) + mp.mass * edge.squaredNorm();
  const double rise = edge.norm() - half.z();
  CHECK(0.5 * inertia * first.angular_velocity.squaredNorm() > 2 * mp.mass * 10 * rise);
  // Each reaches the next one.
  CHECK(dominoes[1]->position.x() - first.position.x() < 2 * half.z());
}

TEST_CASE("newton_cradle sets balls and gap as asked", "[fast][scene]") {
  for (const int moving : {1, 2, 4}) {
    for (const double gap : {0.0, 1e-3}) {
      const Scene scene = scenes::newton_cradle(moving, gap);
      CHECK(validate(scene).empty());
      REQUIRE(scene.bodies.size() == 5);
      for (int i = 0; i < 5; ++i) {
        const Body& ball = scene.bodies[static_cast<std::size_t>(i)];
        CHECK(ball.position.x() == Approx(i * (1 + gap)).epsilon(1e-15));
        CHECK(ball.linear_velocity == Vec3(i < moving ? 1 : 0, 0, 0));
        CHECK(ball.shapes[0].material.restitution == 1);
        CHECK(ball.shapes[0].material.friction == 0);
      }
    }
  }
}

TEST_CASE("the mixed piles mix", "[fast][scene]") {
  const Scene pile = make("mixed-pile");
  CHECK(dynamic_bodies(pile).size() == 26);
  CHECK(count<Sphere>(pile) == 12 + 2);
  CHECK(count<Box>(pile) == 12 + 1 + 2);
  CHECK(std::count_if(pile.bodies.begin(), pile.bodies.end(), [](const Body& body) {
          return body.motion == Motion::dynamic && body.shapes.size() > 1;
        }) == 2);
  // One body at least has its centre of mass away from its frame.
  const std::vector<const Body*> bodies = dynamic_bodies(pile);
  CHECK(std::any_of(bodies.begin(), bodies.end(), [&](const Body* body) {
    return mass_properties(pile, *body).center.norm() > 0.05;
  }));

  std::set<std::size_t> corners;
  const Scene flat = make("mixed-pile2d");
  for (const Body& body : flat.bodies) {
    for (const Shape& shape : body.shapes) {
      if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
        corners.insert(polygon->vertices.size());
      }
    }
  }
  CHECK(corners == std::set<std::size_t>{3, 4, 6});
  CHECK(count<Circle>(flat) == 10);
}

}  // namespace manyworlds
