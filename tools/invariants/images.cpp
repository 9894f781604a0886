#include "tools/invariants/images.hpp"

#include <algorithm>
#include <cmath>

namespace manyworlds::invariants {

Vec3 Image::vector(const Vec3& v) const {
  if (mirror) return {-v.x(), v.y(), v.z()};
  Vec3 out = v;
  for (int i = 0; i < quarters; ++i) out = Vec3(-out.y(), out.x(), out.z());
  return out;
}
Vec3 Image::axial(const Vec3& w) const {
  if (mirror) return {w.x(), -w.y(), -w.z()};
  return vector(w);
}
Quat Image::rotation(const Quat& q) const {
  if (mirror) return {q.w(), q.x(), -q.y(), -q.z()};
  // By half turns exactly, (0, 0, 0, 1) q; by a quarter but for rounding.
  if (quarters == 2) return {-q.z(), -q.y(), q.x(), q.w()};
  const double half = std::sqrt(0.5);
  return Quat(half, 0, 0, quarters == 1 ? half : -half) * q;
}
Geometry Image::geometry(const Geometry& g) const {
  if (!mirror) return g;
  Geometry out = g;
  if (auto* hull = std::get_if<Hull>(&out)) {
    for (Vec3& v : hull->vertices) v.x() = -v.x();
  }
  if (auto* polygon = std::get_if<Polygon>(&out)) {
    for (Vec2& v : polygon->vertices) v.x() = -v.x();
    std::reverse(polygon->vertices.begin(), polygon->vertices.end());
  }
  return out;
}

BodyId add_image(Scene& scene, BodyId body, const Image& image) {
  Body other = scene.at(body);
  other.position = image.vector(other.position);
  other.rotation = image.rotation(other.rotation);
  other.linear_velocity = image.vector(other.linear_velocity);
  other.angular_velocity = image.axial(other.angular_velocity);
  for (Shape& shape : other.shapes) {
    shape.geometry = image.geometry(shape.geometry);
    if (!image.mirror) continue;
    shape.position = image.vector(shape.position);
    shape.rotation = image.rotation(shape.rotation);
  }
  return scene.add(other);
}

Joint image_of(const Joint& joint, BodyId a, BodyId b, const Image& image) {
  Joint out = joint;
  out.body_a = a, out.body_b = b;
  const auto map = [&](Frame& frame, bool world) {
    if (!world && !image.mirror) return;  // the bodies' frames turn with them
    frame.position = image.vector(frame.position);
    frame.rotation = image.rotation(frame.rotation);
  };
  map(out.frame_a, !joint.body_a), map(out.frame_b, !joint.body_b);
  return out;
}

Judge image_judge(std::vector<ImagePair> pairs, const Image& image, const Scale& scale,
                  double start) {
  struct Memory {
    double fastest = 0;
    bool grown = false;
  };
  return [pairs = std::move(pairs), image, scale, start, memory = Memory()](const Seen& s) mutable {
    if (memory.grown) return 0.0;
    for (const BodyNow& b : s.now) {
      memory.fastest = std::max({memory.fastest, b.velocity.norm(), b.spin.norm() * scale.length});
    }
    if (memory.fastest == 0) return 0.0;
    double apart = 0;
    for (std::size_t i = 0; i < s.twin.size(); ++i) {
      apart = std::max({apart, (s.twin[i].velocity - s.now[i].velocity).norm(),
                        (s.twin[i].spin - s.now[i].spin).norm() * scale.length});
    }
    apart /= memory.fastest;
    double most = 0;
    for (const ImagePair& pair : pairs) {
      const BodyNow& a = s.now[static_cast<std::size_t>(pair.a.index())];
      const BodyNow& b = s.now[static_cast<std::size_t>(pair.b.index())];
      most = std::max({most, (b.velocity - image.vector(a.velocity)).norm(),
                       (b.spin - image.axial(a.spin)).norm() * scale.length});
    }
    most /= memory.fastest;
    memory.grown = apart > 10 * start;
    return memory.grown ? std::max(0.0, most - 10 * apart) : most;
  };
}

Scene perturbed(const Scene& scene, const Scale& scale, Random& random) {
  Scene out = scene;
  for (Body& body : out.bodies) {
    if (body.motion != Motion::dynamic) continue;
    const Vec3 x = draw_direction(random, scene.space), v = draw_direction(random, scene.space);
    body.position += kPerturbation * scale.length * x;
    body.linear_velocity +=
        kPerturbation * std::max(scale.speed(), body.linear_velocity.norm()) * v;
  }
  return out;
}

}  // namespace manyworlds::invariants
