#include "src/scene/variations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/base/enum_names.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {

namespace {

Body& body_of(Scene& scene, int body) { return scene.bodies[static_cast<std::size_t>(body)]; }
const Body& body_of(const Scene& scene, int body) {
  return scene.bodies[static_cast<std::size_t>(body)];
}
Shape& shape_of(Scene& scene, int body, int shape) {
  return body_of(scene, body).shapes[static_cast<std::size_t>(shape)];
}
const Shape& shape_of(const Scene& scene, int body, int shape) {
  return body_of(scene, body).shapes[static_cast<std::size_t>(shape)];
}

int sizes_of(const Geometry& geometry) { return traits_of(geometry).sizes(); }

void set_mass(Scene& scene, int body, double mass) {
  MassProperties m = mass_properties(scene, body_of(scene, body));
  m.inertia *= mass / m.mass;
  m.mass = mass;
  body_of(scene, body).mass_properties = m;
}

int numbers_of(const Scene& scene, Parameter parameter, int body, int shape) {
  return parameter == Parameter::size ? sizes_of(shape_of(scene, body, shape).geometry)
                                      : info(parameter).numbers;
}

}  // namespace

const ParameterInfo& info(Parameter parameter) {
  static constexpr std::array kInfo = {
#define MW_PARAMETER_INFO(name, owner, numbers, unit, meaning) \
  ParameterInfo{#name, ParameterInfo::owner, numbers, unit, meaning},
      MW_PARAMETERS(MW_PARAMETER_INFO)
#undef MW_PARAMETER_INFO
  };
  static_assert(kInfo.size() == kParameterCount);
  return kInfo[static_cast<std::size_t>(checked_enum(parameter))];
}

bool can_vary(const Scene& scene, Parameter parameter, int body, int shape) {
  const auto owner = info(parameter).owner;
  if (owner == ParameterInfo::world) return true;
  const Body& b = body_of(scene, body);
  if (owner == ParameterInfo::body) return b.motion == Motion::dynamic;
  switch (parameter) {
    case Parameter::size:
      return b.motion != Motion::fixed && sizes_of(shape_of(scene, body, shape).geometry) > 0;
    case Parameter::density: return b.motion == Motion::dynamic && !b.mass_properties;
    default: return true;
  }
}

std::vector<VariedNumber> varied_numbers(const Scene& scene) {
  std::vector<VariedNumber> out;
  const auto add = [&](std::size_t i, int body, int shape) {
    const Variation& v = scene.variations[i];
    if (!can_vary(scene, v.parameter, body, shape)) return;
    for (int c = 0; c < numbers_of(scene, v.parameter, body, shape); ++c) {
      out.push_back({static_cast<int>(i), v.parameter, body, shape, c, v.low[c], v.high[c]});
    }
  };
  for (std::size_t i = 0; i < scene.variations.size(); ++i) {
    const Variation& v = scene.variations[i];
    const auto owner = info(v.parameter).owner;
    if (owner == ParameterInfo::world) add(i, -1, -1);
    for (int b = 0; owner != ParameterInfo::world && b < static_cast<int>(scene.bodies.size());
         ++b) {
      if (body_of(v) && body_of(v) != BodyId(b)) continue;
      const int shapes = static_cast<int>(body_of(scene, b).shapes.size());
      if (owner == ParameterInfo::body) add(i, b, -1);
      for (int s = 0; owner == ParameterInfo::shape && s < shapes; ++s) {
        if (!v.shape || v.shape.index() == s) add(i, b, s);
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const VariedNumber& a, const VariedNumber& b) {
    return a.parameter < b.parameter;
  });
  return out;
}

double get_number(const Scene& scene, Parameter parameter, int body, int shape, int component) {
  switch (parameter) {
    case Parameter::size: {
      const Geometry& geometry = shape_of(scene, body, shape).geometry;
      return component < sizes_of(geometry) ? traits_of(geometry).size(geometry, component) : 0;
    }
    case Parameter::density:
      return shape_of(scene, body, shape).density.value_or(scene.options.density);
    case Parameter::mass:
      return body_of(scene, body).motion == Motion::dynamic
                 ? mass_properties(scene, body_of(scene, body)).mass
                 : 0;
    case Parameter::friction: return shape_of(scene, body, shape).material.friction;
    case Parameter::restitution: return shape_of(scene, body, shape).material.restitution;
    case Parameter::gravity: return scene.options.gravity[component];
    case Parameter::gravity_scale: return body_of(scene, body).gravity_scale;
    case Parameter::linear_drag: return body_of(scene, body).linear_drag;
    case Parameter::angular_drag: return body_of(scene, body).angular_drag;
  }
  return 0;
}

void set_number(Scene& scene, const VariedNumber& n, double value) {
  switch (n.parameter) {
    case Parameter::size: {
      Geometry& geometry = shape_of(scene, n.body, n.shape).geometry;
      traits_of(geometry).resize(geometry, n.component, value);
      break;
    }
    case Parameter::density: shape_of(scene, n.body, n.shape).density = value; break;
    case Parameter::mass: set_mass(scene, n.body, value); break;
    case Parameter::friction: shape_of(scene, n.body, n.shape).material.friction = value; break;
    case Parameter::restitution:
      shape_of(scene, n.body, n.shape).material.restitution = value;
      break;
    case Parameter::gravity: scene.options.gravity[n.component] = value; break;
    case Parameter::gravity_scale: body_of(scene, n.body).gravity_scale = value; break;
    case Parameter::linear_drag: body_of(scene, n.body).linear_drag = value; break;
    case Parameter::angular_drag: body_of(scene, n.body).angular_drag = value; break;
  }
}

}  // namespace manyworlds
