// Rays against height fields, by small steps over their surface.
#include <catch2/catch.hpp>

#include <optional>

#include "manyworlds/query.hpp"
#include "tests/support/approx.hpp"
#include "tests/support/height_field.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

TEST_CASE("rays hit the triangles of a height field", "[fast][field][query]") {
  Random random(3);
  const HeightField field = field_of(9, 8, {0.7, 0.5}, hills);
  const Shape shape = shape_of(field);
  manyworlds::Pose pose;
  pose.position = {0.4, 0.1, -0.2};
  pose.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()));
  int hits = 0;
  for (int i = 0; i < 600; ++i) {
    Ray ray;
    ray.origin = Vec3(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(0.5, 3));
    ray.direction =
        i % 10 == 0 ? Vec3(0, 0, -1)
                    : (Vec3(random.uniform(-2.5, 2.5), random.uniform(-1.5, 1.5), 0) - ray.origin);
    ray.direction.normalize();
    ray.origin = pose.position + pose.rotation * ray.origin;
    ray.direction = pose.rotation * ray.direction;
    ray.length = 20;
    // By small steps: where it first is in the solid.
    std::optional<double> expected;
    const auto local = [&](double s) {
      return Vec3(pose.rotation.conjugate() * (ray.origin + s * ray.direction - pose.position));
    };
    const auto within = [&](double s) {
      const Vec3 p = local(s);
      return std::abs(p.x()) <= 0.7 * 4 && std::abs(p.y()) <= 0.5 * 3.5 &&
             p.z() <= surface(field, p.x(), p.y());
    };
    for (double s = 0; s < 20 && !expected; s += 1e-3) {
      if (within(s)) expected = s;
    }
    const auto hit = ray_cast(shape, pose, ray);
    INFO("ray " << i << " expected " << expected.value_or(-1));
    // A ray that grazes an edge may go either way.
    if (!expected) continue;
    REQUIRE(hit);
    CHECK(hit->distance <= *expected + 1e-4);
    if (hit->distance < *expected - 2e-3) CHECK(within(hit->distance + 1e-5));
    CHECK(hit->normal.norm() == Approx(1));
    CHECK(hit->normal.dot(ray.direction) < 0);
    hits += *expected > 0 ? 1 : 0;
  }
  CHECK(hits > 300);
}

TEST_CASE("in a batch rays see height fields", "[fast][field][observe]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::spatial, 0);
    scene.add(land(field_of(9, 8, {0.7, 0.5}, hills)));
    scene.add(body_of(shape_of(Sphere{0.1}), {0, 0, 5}));
    BatchOptions options = options_of(table, 3);
    for (int i = 0; i < 5; ++i) {
      Ray ray;
      ray.origin = {0.4 * i - 0.9, 0.2, 3}, ray.direction = {0, 0, -1}, ray.length = 10;
      options.observe.rays.push_back(ray);
    }
    Batch batch(compile(scene), options);
    batch.look();
    const auto hits = batch.ray_hits(1);
    for (std::size_t i = 0; i < 5; ++i) {
      const double x = 0.4 * static_cast<double>(i) - 0.9;
      const double z = surface(std::get<HeightField>(scene.bodies[0].shapes[0].geometry), x, 0.2);
      CHECK(hits[i].body == BodyId(0));
      CHECK(hits[i].distance == approx(3 - z, 1e-5));
    }
  }
}

}  // namespace manyworlds::test
