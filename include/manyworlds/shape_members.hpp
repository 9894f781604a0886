// The members of shapes (members.hpp).
#pragma once

#include "manyworlds/member_list.hpp"
#include "manyworlds/shape.hpp"

namespace manyworlds {

template <>
struct Members<Sphere> {
  static constexpr const char* name = "Sphere";
  static void visit(auto& value, auto&& visit) {
    auto& [radius] = value;
    visit("radius", radius);
  }
};
template <>
struct Members<Box> {
  static constexpr const char* name = "Box";
  static void visit(auto& value, auto&& visit) {
    auto& [half_extents] = value;
    visit("half_extents", half_extents);
  }
};
template <>
struct Members<Plane> {
  static constexpr const char* name = "Plane";
  static void visit(auto& value, auto&& visit) {
    auto& [normal, offset] = value;
    visit("normal", normal), visit("offset", offset);
  }
};
template <>
struct Members<Capsule> {
  static constexpr const char* name = "Capsule";
  static void visit(auto& value, auto&& visit) {
    auto& [radius, half_length] = value;
    visit("radius", radius), visit("half_length", half_length);
  }
};
template <>
struct Members<Cylinder> {
  static constexpr const char* name = "Cylinder";
  static void visit(auto& value, auto&& visit) {
    auto& [radius, half_length] = value;
    visit("radius", radius), visit("half_length", half_length);
  }
};
template <>
struct Members<Ellipsoid> {
  static constexpr const char* name = "Ellipsoid";
  static void visit(auto& value, auto&& visit) {
    auto& [radii] = value;
    visit("radii", radii);
  }
};
template <>
struct Members<Hull> {
  static constexpr const char* name = "Hull";
  static void visit(auto& value, auto&& visit) {
    auto& [vertices] = value;
    visit("vertices", vertices);
  }
};
template <>
struct Members<Circle> {
  static constexpr const char* name = "Circle";
  static void visit(auto& value, auto&& visit) {
    auto& [radius] = value;
    visit("radius", radius);
  }
};
template <>
struct Members<Polygon> {
  static constexpr const char* name = "Polygon";
  static void visit(auto& value, auto&& visit) {
    auto& [vertices, radius] = value;
    visit("vertices", vertices);
    visit("radius", radius, counted_if(radius != 0, "the default: no rounding"));
  }
};
template <>
struct Members<HalfPlane> {
  static constexpr const char* name = "HalfPlane";
  static void visit(auto& value, auto&& visit) {
    auto& [normal, offset] = value;
    visit("normal", normal), visit("offset", offset);
  }
};
template <>
struct Members<Segment> {
  static constexpr const char* name = "Segment";
  static void visit(auto& value, auto&& visit) {
    auto& [a, b] = value;
    visit("a", a), visit("b", b);
  }
};
template <>
struct Members<Terrain> {
  static constexpr const char* name = "Terrain";
  static void visit(auto& value, auto&& visit) {
    auto& [points, loop] = value;
    visit("points", points), visit("loop", loop);
  }
};
template <>
struct Members<HeightField> {
  static constexpr const char* name = "HeightField";
  static void visit(auto& value, auto&& visit) {
    auto& [heights, columns, cell] = value;
    visit("heights", heights), visit("columns", columns), visit("cell", cell);
  }
};
template <>
struct Members<Compliance> {
  static constexpr const char* name = "Compliance";
  static void visit(auto& value, auto&& visit) {
    auto& [time_constant, damping_ratio, min_impedance, max_impedance, width, midpoint, power] =
        value;
    visit("time_constant", time_constant), visit("damping_ratio", damping_ratio);
    visit("min_impedance", min_impedance), visit("max_impedance", max_impedance);
    visit("width", width), visit("midpoint", midpoint), visit("power", power);
  }
};
template <>
struct Members<SoftContact> {
  static constexpr const char* name = "SoftContact";
  static void visit(auto& value, auto&& visit) {
    auto& [dimensions, compliance, margin, gap, priority, weight] = value;
    visit("dimensions", dimensions), visit("compliance", compliance), visit("margin", margin);
    visit("gap", gap), visit("priority", priority), visit("weight", weight);
  }
};
template <>
struct Members<Material> {
  static constexpr const char* name = "Material";
  static void visit(auto& value, auto&& visit) {
    auto& [friction, restitution, rolling_resistance, torsional_resistance, soft] = value;
    visit("friction", friction), visit("restitution", restitution);
    visit("rolling_resistance", rolling_resistance);
    visit("torsional_resistance", torsional_resistance);
    visit("soft", soft, counted_if(soft != SoftContact{}, kOfNewton));
  }
};
template <>
struct Members<Filter> {
  static constexpr const char* name = "Filter";
  static void visit(auto& value, auto&& visit) {
    auto& [category, mask] = value;
    visit("category", category), visit("mask", mask);
  }
};
template <>
struct Members<Shape> {
  static constexpr const char* name = "Shape";
  static void visit(auto& value, auto&& visit) {
    auto& [geometry, position, rotation, density, material, filter, name_] = value;
    visit("geometry", geometry), visit("position", position), visit("rotation", rotation);
    visit("density", density), visit("material", material), visit("filter", filter);
    visit("name", name_, not_counted(kName));
  }
};

}  // namespace manyworlds
