#include "fuzz/scene_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace manyworlds::fuzz {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Borders of what validate() takes, of float32 and of the step's range, and what lies beyond.
constexpr std::array kSpecial = {
    0.0,    -0.0,   1.0,     -1.0,    kNan,    kInf,     -kInf,  1e308, -1e308, 5e-324,
    1e-308, 3.4e38, -3.4e38, 3.5e38,  1e-38,   1e-45,    1e30,   1e-30, 1e20,   -1e20,
    1e10,   1e8,    1.01e10, 1e-9,    0.99e-9, 1e5,      1.01e5, 1e6,   1e-6,   1e-12,
    1e-5,   1e3,    32767.0, 65536.0, 1e-3,    -1.2e-38, 1e15,   -1e10};

}  // namespace

// The first byte tells how wild it gets: half of the inputs stay within ordinary numbers.
SceneBytes::SceneBytes(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {
  const std::uint8_t first = byte();
  wildness_ = first < 128 ? 0 : static_cast<std::uint8_t>((first - 128) / 4);
}

double SceneBytes::number(double low, double high) {
  if (wildness_ > 0 && wild()) {
    const std::size_t kind = byte();
    if (kind < 3 * kSpecial.size()) return kSpecial[kind % kSpecial.size()];
    if (kind < 128) return std::bit_cast<double>(bytes_.ConsumeIntegral<std::uint64_t>());
    return (kind % 2 != 0 ? -1 : 1) * std::pow(10, integer(-46, 40));
  }
  const double unit = bytes_.ConsumeIntegral<std::uint16_t>() / 65536.0;
  return low + (high - low) * unit;
}

Vec3 SceneBytes::vector(double half) {
  const double x = number(-half, half), y = number(-half, half);
  return {x, y, number(-half, half)};
}
Vec3 SceneBytes::planar_vector(double half) {
  if (!planar_ || (wildness_ > 0 && wild())) return vector(half);
  const double x = number(-half, half);
  return {x, number(-half, half), 0};
}
Vec3 SceneBytes::axial_vector(double half) {
  if (!planar_ || (wildness_ > 0 && wild())) return vector(half);
  return {0, 0, number(-half, half)};
}

Quat SceneBytes::rotation() {
  if (byte() < 64) return Quat::Identity();
  const double w = number(-1, 1);
  const Vec3 axis = axial_vector(1);
  return {w, axis.x(), axis.y(), axis.z()};
}

std::string SceneBytes::name() { return bytes_.ConsumeRandomLengthString(rarely() ? 300 : 8); }

Polygon SceneBytes::polygon() {
  const int kind = byte();
  if (kind < 96) {
    const double half = number(0.1, 1);
    return Polygon::box(half, number(0.1, 1));
  }
  Polygon out;
  if (byte() > 192) out.radius = number(0.01, 0.5);
  const int n = kind < 224 ? integer(3, 8) : integer(0, 12);
  const double radius = number(0.1, 1), from = number(0, 7);
  for (int i = 0; i < n; ++i) {
    if (kind < 224) {
      const double angle = from + 6.28318 * (i + number(0, 0.5)) / n;
      out.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    } else {
      const double x = number(-1, 1);
      out.vertices.emplace_back(x, number(-1, 1));
    }
  }
  return out;
}

Hull SceneBytes::hull() {
  Hull out;
  const int n = rarely() ? integer(0, 70) : integer(4, 12);
  for (int i = 0; i < n; ++i) {
    const Vec3 v = vector(1);
    out.vertices.push_back(byte() > 200 && i > 0 ? Vec3(v.x(), v.y(), out.vertices[0].z()) : v);
  }
  return out;
}

HeightField SceneBytes::height_field() {
  HeightField out;
  out.columns = rarely() ? integer(0, 3) : integer(2, 7);
  const int n = rarely() ? integer(0, 60) : out.columns * integer(2, 7);
  for (int i = 0; i < n; ++i) out.heights.push_back(number(-0.6, 0.6));
  out.cell = {number(0.3, 2), number(0.3, 2)};
  return out;
}

Terrain SceneBytes::terrain() {
  Terrain out;
  out.loop = byte() > 200;
  int n = integer(2, 9);
  if (rarely()) n = rarely() ? 33000 : integer(0, 100);
  double x = -n / 2.0;
  for (int i = 0; i < n; ++i) {
    out.points.emplace_back(x, i < 100 ? number(-1, 1) : 0.0);
    x += i < 100 ? number(0.1, 2) : 1.0;
  }
  return out;
}

Geometry SceneBytes::geometry(bool fixed) {
  // Of the right space and motion, but for a few.
  const bool planar = rarely() ? !planar_ : planar_;
  const int moving = planar ? 3 : 6;
  const int kinds = fixed || rarely() ? moving + (planar ? 3 : 4) : moving;
  const int kind = integer(0, kinds - 1);
  const double a = number(0.05, 1), b = number(0.05, 1);
  if (planar) {
    switch (kind) {
      case 0: return Circle{a};
      case 1: return polygon();
      case 2: return Capsule{a, b};
      case 3: return HalfPlane{rarely() ? planar_vector(2).head<2>() : Vec2(0, 1), a - 1};
      case 4: return Segment{planar_vector(2).head<2>(), planar_vector(2).head<2>()};
      default: return terrain();
    }
  }
  switch (kind) {
    case 0: return Sphere{a};
    case 1: return Box{Vec3(a, b, number(0.05, 1))};
    case 2: return Capsule{a, b};
    case 3: return Cylinder{a, b};
    case 4: return hull();
    case 5: return Ellipsoid{Vec3(a, b, number(0.05, 1))};
    case 6: return Plane{rarely() ? vector(2) : Vec3(0, 0, 1), a - 1};
    case 7: return Plane{vector(1).normalized(), -b};
    case 8: return height_field();
    default: return Box{Vec3(3 * a, 3 * b, 0.1)};
  }
}

Shape SceneBytes::shape(bool fixed) {
  Shape out;
  out.geometry = geometry(fixed);
  if (byte() > 128) out.position = planar_vector(1);
  out.rotation = rotation();
  if (byte() > 192) out.density = number(1, 5000);
  out.material.friction = byte() > 192 ? 0 : number(0, 1.5);
  out.material.restitution = byte() > 128 ? number(0, 1) : 0;
  if (byte() > 192) {
    out.filter.category = bytes_.ConsumeIntegral<std::uint32_t>();
    out.filter.mask = bytes_.ConsumeIntegral<std::uint32_t>();
  }
  if (rarely()) out.name = name();
  return out;
}

MassProperties SceneBytes::mass_properties() {
  MassProperties out;
  out.mass = number(0.1, 100);
  out.center = planar_vector(0.5);
  const double a = number(1, 2), b = number(1, 2), c = number(1, 2);
  out.inertia = Vec3(a, b, c).asDiagonal();
  if (byte() > 128) {
    const double d = number(-0.3, 0.3);
    out.inertia(0, 1) = d;
    out.inertia(1, 0) = rarely() ? number(-1, 1) : d;
  }
  return out;
}

Body SceneBytes::body(int index) {
  Body out;
  const int kind = byte();
  const bool fixed = index == 0 ? kind < 240 : kind > 220;
  out.motion = fixed ? Motion::fixed : kind > 190 ? Motion::kinematic : Motion::dynamic;
  if (!fixed || rarely()) {
    out.enabled = byte() < 220;
    out.linear_velocity = planar_vector(10);
    out.angular_velocity = axial_vector(10);
    if (byte() > 128) {
      out.jitter.position = planar_vector(0.5).cwiseAbs();
      out.jitter.linear_velocity = planar_vector(1).cwiseAbs();
      out.jitter.angular_velocity = axial_vector(1).cwiseAbs();
      out.jitter.angle = number(0, 3);
      out.jitter.any_orientation = !planar_ && byte() > 128;
      if (rarely()) out.jitter.with = BodyId(integer(-2, 4));
    }
  }
  out.position = planar_vector(3);
  if (byte() < 128) (planar_ ? out.position.y() : out.position.z()) += index;
  out.rotation = rotation();
  const int shapes = rarely() ? integer(0, 20) : integer(1, 3);
  for (int i = 0; i < shapes && (i == 0 || !done()); ++i) out.shapes.push_back(shape(fixed));
  if (byte() > 200) out.mass_properties = mass_properties();
  if (byte() > 200) out.gravity_scale = number(-2, 2);
  if (byte() > 200) out.linear_drag = number(0, 10);
  if (byte() > 200) out.angular_drag = number(0, 10);
  if (rarely()) out.name = name();
  return out;
}

Control SceneBytes::control(int bodies, int joints) {
  Control out;
  out.kind = static_cast<ControlKind>(integer(0, 3));
  out.joint = JointId(integer(-1, joints - (rarely() ? 0 : 1)));
  out.body = BodyId(integer(0, bodies - (rarely() ? 0 : 1)));
  out.point = planar_vector(1);
  if (out.kind == ControlKind::torque && planar_) {
    out.direction = Vec3::UnitZ();
  } else if (byte() > 128) {
    out.direction = planar_vector(1);
  }
  out.low = number(-100, 0), out.high = number(0, 100);
  if (byte() > 128) out.initial = number(out.low, out.high);
  return out;
}

Variation SceneBytes::variation(int bodies) {
  Variation out;
  out.parameter = static_cast<Parameter>(integer(0, kParameterCount - 1));
  const auto owner = info(out.parameter).owner;
  const bool of_bodies = owner == ParameterInfo::body || owner == ParameterInfo::shape;
  if (rarely() || (of_bodies && byte() > 128)) out.body = BodyId(integer(0, bodies));
  if (rarely() || (owner == ParameterInfo::joint && byte() > 128))
    out.joint = JointId(integer(0, 2));
  if (rarely() || (owner == ParameterInfo::control && byte() > 128)) {
    out.control = ControlId(integer(0, 2));
  }
  if (rarely() || (owner == ParameterInfo::attractor && byte() > 128)) {
    out.attractor = integer(0, 2);
  }
  if (rarely() || (owner == ParameterInfo::shape && out.body && byte() > 128)) {
    out.shape = ShapeId(out.body, integer(0, 2));
  }
  const bool gravity = out.parameter == Parameter::gravity;
  out.low = gravity ? planar_vector(10) : Vec3::Constant(number(0.05, 0.5));
  out.high =
      out.low + (gravity ? planar_vector(1).cwiseAbs().eval() : Vec3::Constant(number(0, 0.5)));
  out.draw = static_cast<Draw>(rarely() ? 0 : integer(gravity ? 1 : 0, gravity ? 1 : 2));
  if (out.draw == Draw::none) {  // the scene's own number must be within
    out.low = rarely() ? out.low : Vec3::Constant(1e-6);
    out.high = Vec3::Constant(1e6);
    if (out.parameter == Parameter::restitution) out.low.setZero(), out.high.setOnes();
  }
  out.together = byte() > 128;
  return out;
}

Scene SceneBytes::scene() {
  Scene out;
  planar_ = byte() > 128;
  out.space = planar_ ? Space::planar : Space::spatial;
  out.options = options();
  const int most = rarely() ? 60 : 8;
  for (int i = 0; i < most && !done(); ++i) out.add(body(i));
  if (rarely()) out.name = name();
  for (int n = byte() > 128 ? integer(1, 6) : 0; n > 0 && !out.bodies.empty(); --n) {
    out.add(joint(static_cast<int>(out.bodies.size())));
  }
  for (int n = byte() > 128 ? integer(1, 4) : 0; n > 0 && !out.bodies.empty(); --n) {
    out.controls.push_back(
        control(static_cast<int>(out.bodies.size()), static_cast<int>(out.joints.size())));
  }
  for (int n = byte() > 200 ? integer(1, 3) : 0; n > 0; --n) {
    out.attractors.push_back({planar_vector(5), number(-50, 50), number(0, 1)});
  }
  for (int n = byte() > 128 ? integer(1, 4) : 0; n > 0 && !out.bodies.empty(); --n) {
    out.variations.push_back(variation(static_cast<int>(out.bodies.size()) - (rarely() ? 0 : 1)));
  }
  for (int n = byte() > 192 ? integer(1, 4) : 0; n > 0; --n) change_any(out);
  return out;
}

PlanOptions SceneBytes::plan_options() {
  PlanOptions out;
  out.broad_phase = static_cast<BroadPhase>(integer(0, 3));
  for (int f = 0; f < kFeatureCount; ++f) {
    if (byte() > 200) out.keep.push_back(static_cast<Feature>(f));
  }
  return out;
}

BatchOptions SceneBytes::batch_options() {
  BatchOptions out;
  out.worlds = integer(1, 3);
  out.threads = 1;
  out.seed = byte();
  out.layout = static_cast<ContactLayout>(integer(0, 2));
  out.sleep = byte() > 128;
  return out;
}

}  // namespace manyworlds::fuzz
