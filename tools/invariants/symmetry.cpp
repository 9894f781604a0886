// Symmetry: a scene with a mirror plane or a rotation axis keeps it.
#include <algorithm>
#include <cmath>
#include <string>

#include "tools/invariants/images.hpp"

namespace manyworlds::invariants {
namespace {

using scenes::kPi;

Material draw_symmetric_material(Random& random) {
  const double restitution = random.chance(0.5) ? 0 : random.uniform(0, 1);
  const double friction = random.chance(0.25) ? 0 : random.uniform(0, 2);
  return {friction, restitution};
}

std::string in(const char* name, Space space) {
  return std::string(name) + (space == Space::planar ? " 2D" : " 3D");
}
Family family(const char* id, Space space, const char* title) {
  Family out;
  out.id = in(id, space), out.law = Law::symmetry, out.title = title;
  out.criterion = "difference of velocities from their image, relative to the largest speed";
  out.limit = 1e-4, out.limit_f64 = 1e-9;
  return out;
}

// A shape with two mirror planes, x and y, in a pose that keeps them. `under`: how far it reaches
// down.
Shape draw_symmetric(Random& random, Space space, double size, double& under) {
  const auto extent = [&] { return size * random.log_uniform(0.05, 1); };
  Shape out;
  const double a = extent(), b = extent(), c = extent();
  const int type = random.integer(0, space == Space::planar ? 3 : 6);
  const Quat onto_side(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()));
  under = c;
  if (space == Space::planar) {
    under = b;
    if (type == 0) out.geometry = Polygon::box(a, b);
    if (type == 1) out.geometry = Circle{b};
    if (type == 2) out.geometry = Capsule{a, b}, under = a + b;
    if (type == 3) {  // a hexagon on its edge, rounded or not
      out.geometry = Polygon{{{-a, -b}, {a, -b}, {1.5 * a, 0}, {a, b}, {-a, b}, {-1.5 * a, 0}},
                             random.chance(0.5) ? 0.2 * b : 0};
      under = b + std::get<Polygon>(out.geometry).radius;
    }
    return out;
  }
  if (type == 0) out.geometry = Box{{a, b, c}};
  if (type == 1) out.geometry = Cylinder{a, c};
  if (type == 2) out.geometry = Cylinder{c, a}, out.rotation = onto_side;
  if (type == 3) out.geometry = Capsule{a, c}, under = a + c;
  if (type == 4) out.geometry = Capsule{c, a}, out.rotation = onto_side;
  if (type == 5) out.geometry = Ellipsoid{{a, b, c}};
  if (type == 6) {  // a prism
    Hull hull;
    for (const double z : {-c, c}) {
      for (const double y : {-b, b}) {
        for (const double x : {-a, a}) hull.vertices.emplace_back(x, y, z);
      }
      hull.vertices.emplace_back(-1.5 * a, 0, z), hull.vertices.emplace_back(1.5 * a, 0, z);
    }
    out.geometry = hull;
  }
  return out;
}

// A plane, or the top of a box that reaches far.
Body draw_floor(Random& random, Space space, const Scale& scale, const Material& material) {
  if (random.chance(0.5)) return scenes::ground(space, material);
  const double half = 20 * scale.length;
  Shape top = scenes::shape_of(scenes::cube_of(space, half), material);
  return scenes::body_of(top, -half * scenes::up_of(space), Motion::fixed);
}

Drawn flat_drop(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  const Material material = draw_symmetric_material(kind);
  double under = 0;
  Shape shape = draw_symmetric(kind, space, scale.length, under);
  shape.material = material;
  out.scene.add(draw_floor(kind, space, scale, material));
  const double height = under + scale.length * state.log_uniform(0.01, 10);
  Body body = scenes::body_of(shape, height * scenes::up_of(space));
  body.linear_velocity = -scale.speed() * state.uniform(0, 2) * scenes::up_of(space);
  const BodyId id = out.scene.add(body);
  out.steps = 120;
  out.judge = [mirror = image_judge({{id, id}}, Image{}, scale, 0), scale,
               space](const Seen& s) mutable {
    const double first = mirror(s);
    if (space == Space::planar) return first;
    // The plane y = 0, and so no spin at all.
    const BodyNow& b = s.now[1];
    const double fastest =
        std::max({scale.speed(), s.before[1].velocity.norm(), b.velocity.norm()});
    return std::max(
        {first, std::abs(b.velocity.y()) / fastest, b.spin.norm() * scale.length / fastest});
  };
  return out;
}

// Balls at rest, touching or with gaps, that another hits along their mirror plane.
Drawn rack(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = free_scene(space, scale);
  const Material material = draw_symmetric_material(kind);
  const double radius = 0.5 * scale.length;
  const double gap = kind.chance(0.5) ? 0 : scale.length * kind.log_uniform(1e-4, 0.1);
  const int rows = kind.integer(2, 4);
  const double heavy = kind.chance(0.5) ? 1 : kind.log_uniform(0.1, 10);
  std::vector<ImagePair> pairs;
  const auto ball = [&](const Vec3& place) {
    return scenes::body_of(scenes::shape_of(scenes::round_of(space, radius), material), place);
  };
  const double apart = 2 * radius + gap;
  std::vector<Vec3> right;  // places at x > 0, besides those in the plane
  for (int row = 0; row < rows; ++row) {
    for (int i = row % 2; i <= row; i += 2) {
      const Vec3 place(0.5 * apart * i, apart * std::sqrt(0.75) * row, 0);
      if (i == 0) {
        const BodyId id = out.scene.add(ball(place));
        pairs.push_back({id, id});
      } else {
        right.push_back(place);
      }
    }
  }
  // The images last, so that the order of bodies is not symmetric.
  for (const Vec3& place : right) {
    const BodyId a = out.scene.add(ball(place));
    pairs.push_back({a, add_image(out.scene, a, Image{})});
  }
  Body cue = ball({0, -2 * radius - scale.length * state.log_uniform(0.01, 1), 0});
  cue.shapes[0].density = 1000 * heavy;
  cue.linear_velocity = {0, scale.length / scale.dt * state.log_uniform(0.01, 0.3), 0};
  const BodyId id = out.scene.add(cue);
  pairs.push_back({id, id});
  out.steps = 120;
  out.twin = perturbed(out.scene, scale, state);
  out.judge = image_judge(pairs, Image{}, scale, kPerturbation);
  return out;
}

// Bodies of any shape and their images; with gravity they fall on a floor, without it they meet.
Drawn images(Space space, bool mirror, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  const bool falls = kind.chance(0.5);
  out.scene = falls ? scene_of(space, scale) : free_scene(space, scale);
  const Material material = draw_symmetric_material(kind);
  if (falls) out.scene.add(draw_floor(kind, space, scale, material));
  Image image;
  image.mirror = mirror;
  if (!mirror) image.quarters = kind.chance(0.5) ? 1 : 2;
  const int around = mirror ? 2 : 4 / image.quarters, count = kind.integer(1, 3);
  std::vector<ImagePair> pairs;
  const double fast = scale.speed() * kind.log_uniform(0.1, 3);
  const Vec3 up = scenes::up_of(space);
  for (int i = 0; i < count; ++i) {
    Body body = scenes::body_of(scenes::shape_of(draw_shape(kind, space, scale.length), material),
                                Vec3::Zero());
    body.shapes[0].density = 1000 * kind.log_uniform(1, 100);
    const double out_to = scale.length * state.uniform(1.5, 3);
    body.position = out_to * Vec3::UnitX() + (2.5 * i + (falls ? 3 : 0)) * scale.length * up;
    body.rotation = draw_rotation(state, space);
    const Vec3 stray = draw_direction(state, space), axis = draw_axis(state, space);
    body.linear_velocity = fast * (0.3 * stray - Vec3::UnitX());
    body.angular_velocity = axis * state.uniform(0, 0.5) * fast / scale.length;
    BodyId last = out.scene.add(body);
    for (int k = 1; k < around; ++k) {
      const BodyId next = add_image(out.scene, last, image);
      pairs.push_back({last, next});
      last = next;
    }
  }
  out.steps = 90;
  out.twin = perturbed(out.scene, scale, state);
  out.judge = image_judge(pairs, image, scale, kPerturbation);
  return out;
}

// A square prism, or a regular polygon, on its edge or corner.
Drawn balanced(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  const Material material = {kind.uniform(0.2, 2), 0};
  out.scene.add(draw_floor(kind, space, scale, material));
  const double half = scale.length * kind.uniform(0.3, 1),
               deep = scale.length * kind.uniform(0.2, 2);
  Shape shape = scenes::shape_of(
      scenes::box_of(space, {half, space == Space::planar ? half : deep, half}), material);
  Body body = scenes::body_of(shape, std::sqrt(2.0) * half * scenes::up_of(space));
  const Vec3 axis = space == Space::planar ? Vec3::UnitZ() : Vec3::UnitY();
  body.rotation = Quat(Eigen::AngleAxisd(kPi / 4, axis));
  body.linear_velocity =
      -scale.speed() * (state.chance(0.5) ? 0 : state.uniform(0, 1)) * scenes::up_of(space);
  const BodyId id = out.scene.add(body);
  // A tilt grows tenfold in three of these times.
  out.steps = static_cast<int>(std::min(3 * scale.time() / scale.dt, 240.0));
  out.judge = [id, scale, fastest = scale.speed()](const Seen& s) mutable {
    const BodyNow& b = s.now[static_cast<std::size_t>(id.index())];
    fastest = std::max(fastest, b.velocity.norm());
    return std::max(std::abs(b.velocity.x()), b.spin.norm() * scale.length) / fastest;
  };
  return out;
}

// Pendulums of joints of every type and their mirror images.
Drawn joints(Space space, Random& kind, Random& state, const Scale& scale) {
  Drawn out;
  out.scene = scene_of(space, scale);
  const int links = kind.integer(1, 4);
  std::vector<ImagePair> pairs;
  BodyId before, image_before;
  const Image mirror;
  std::vector<std::pair<Joint, std::pair<BodyId, BodyId>>> mirrored;
  for (int i = 0; i < links; ++i) {
    Body body = scenes::body_of(scenes::shape_of(draw_shape(kind, space, 0.5 * scale.length), {}),
                                Vec3::Zero());
    body.shapes[0].filter.mask = 0;
    body.position = scale.length * Vec3(3.0 + i, 0, 0);
    body.rotation = draw_rotation(kind, space);  // joints keep it in their frames
    const Vec3 axis = draw_axis(state, space);
    body.angular_velocity = axis * scale.speed() / scale.length * state.uniform(0, 1);
    const BodyId id = out.scene.add(body);
    Frame frame;
    frame.position = body.position - 0.5 * scale.length * Vec3::UnitX();
    frame.rotation = draw_rotation(kind, space);
    const int type = kind.integer(0, space == Space::planar ? 2 : 3);
    JointType joint_type = HingeJoint{};
    if (type == 1) joint_type = FixedJoint{};
    if (type == 2) joint_type = SliderJoint{};
    if (type == 3) joint_type = BallJoint{};
    if (type == 2 && space == Space::planar) frame.rotation = Quat::Identity();
    const Joint joint = joint_at(out.scene, before, id, frame, joint_type);
    out.scene.add(joint);
    const BodyId other = add_image(out.scene, id, mirror);
    out.scene.add(image_of(joint, image_before, other, mirror));
    pairs.push_back({id, other});
    before = id, image_before = other;
  }
  out.steps = 90;
  out.twin = perturbed(out.scene, scale, state);
  out.judge = image_judge(pairs, mirror, scale, kPerturbation);
  return out;
}

}  // namespace

std::vector<Family> symmetry_families() {
  std::vector<Family> out;
  for (const Space space : {Space::planar, Space::spatial}) {
    const auto add = [&](const char* id, const char* title, auto draw) {
      Family f = family(id, space, title);
      f.draw = [draw, space](Random& kind, Random& state, const Scale& scale) {
        return draw(space, kind, state, scale);
      };
      out.push_back(f);
    };
    add("flat drop", "bodies that land exactly flat", flat_drop);
    add("rack", "balls, touching or not, hit along their mirror plane", rack);
    add("mirrored", "bodies and their mirror images that meet or fall",
        [](Space s, Random& kind, Random& state, const Scale& scale) {
          return images(s, true, kind, state, scale);
        });
    if (space == Space::spatial) {
      add("turned", "bodies and their images by a half or quarter turn that meet or fall",
          [](Space s, Random& kind, Random& state, const Scale& scale) {
            return images(s, false, kind, state, scale);
          });
    }
    add("on edge", "squares balanced on an edge", balanced);
    add("mirrored joints", "pendulums of joints and their mirror images", joints);
  }
  return out;
}

}  // namespace manyworlds::invariants
