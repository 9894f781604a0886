// What the files of this folder are made of. Used only there.
#pragma once

#include <algorithm>
#include <numbers>
#include <string>

#include "src/scene/shape/shape.hpp"
#include "src/scene/surface.hpp"

namespace manyworlds {

// Answers for a geometry G. Those that only some have are empty for the others.
template <class G>
class TraitsOf : public GeometryTraits {
 public:
  using GeometryTraits::GeometryTraits;

  void check(detail::Checker& checker, const Geometry& g) const final { examine(checker, of(g)); }
  MassProperties mass_properties(const Geometry& g, double density, Space space) const final {
    return mass_of(of(g), density, space);
  }
  int sizes() const override {
    G any{};
    return static_cast<int>(numbers(any).size());
  }
  double size(const Geometry& g, int component) const override {
    G copy = of(g);
    return *numbers(copy)[static_cast<std::size_t>(component)];
  }
  void resize(Geometry& g, int component, double value) const override {
    *numbers(std::get<G>(g))[static_cast<std::size_t>(component)] = value;
  }
  double reach(const Geometry& g) const final { return reach_of(of(g)); }
  std::vector<Convex> convex_parts(const Geometry& g, const Vec3& x, const Mat3& r,
                                   Space space) const final {
    return parts_of(of(g), x, r, space);
  }
  ShapeForm form(const Geometry& g, const PolygonChoice& choice) const final {
    return form_of(of(g), choice);
  }
  Surface surface(const Geometry& g, const SurfaceOptions& options) const final {
    return surface_of(of(g), options);
  }

 protected:
  virtual void examine(detail::Checker& checker, const G& g) const = 0;
  virtual MassProperties mass_of(const G&, double, Space) const {
    return {0, Vec3::Zero(), Mat3::Zero()};
  }
  virtual std::vector<double*> numbers(G&) const { return {}; }  // of its size
  virtual double reach_of(const G&) const { return 0; }
  virtual std::vector<Convex> parts_of(const G& g, const Vec3& x, const Mat3& r,
                                       Space space) const = 0;
  virtual ShapeForm form_of(const G&, const PolygonChoice&) const {
    return {kernels::ShapeKind::plane};
  }
  virtual Surface surface_of(const G& g, const SurfaceOptions& options) const = 0;

 private:
  static const G& of(const Geometry& g) { return std::get<G>(g); }
};

#define MW_GEOMETRY(G)                   \
  template <>                            \
  const GeometryTraits& traits_of<G>() { \
    static const G##Traits kTraits;      \
    return kTraits;                      \
  }

namespace detail {

inline constexpr double kPi = std::numbers::pi;

// Vertices closer than this share of the extent are the same to float32.
inline constexpr double kSameVertex = 1e-6;
// Smallest sine of the exterior angle at a vertex: below it, the normals of two edges cannot be
// told apart and contact features would flicker between them.
inline constexpr double kMinCornerSine = 1e-5;

// |value| <= kLargestSize; for offsets and coordinates, which may have any sign.
bool check_coordinate(Checker& checker, std::string_view field, double value);
bool check_point(Checker& checker, const std::string& field, const Vec2& point);
bool check_point(Checker& checker, const std::string& field, const Vec3& point);
void check_unit(Checker& checker, std::string_view field, double length);
template <class Vec>
bool check_distinct(Checker& checker, const std::vector<Vec>& vertices, double extent) {
  // Along a line that no shape prefers: what is far apart there need not be compared.
  const auto place = [&](std::size_t i) {
    return vertices[i].dot(Vec3(0.48, 0.6, 0.64).head<Vec::RowsAtCompileTime>());
  };
  std::vector<std::size_t> order(vertices.size()), same_as(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = same_as[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return place(i) < place(j); });
  const double least = kSameVertex * extent;
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      // Twice: rounding must not hide what is just as far as that.
      if (place(order[b]) - place(order[a]) > 2 * least) break;
      if ((vertices[order[a]] - vertices[order[b]]).norm() > least) continue;
      const auto [first, second] = std::minmax(order[a], order[b]);
      same_as[second] = std::min(same_as[second], first);
    }
  }
  bool good = true;
  for (std::size_t i = 0; i < same_as.size(); ++i) {
    if (same_as[i] == i) continue;
    checker.add(element_name("vertices", i), "is " + vector_text(vertices[i]) + " m, the same as " +
                                                 element_name("vertices", same_as[i]) +
                                                 "; vertices must be distinct");
    good = false;
  }
  return good;
}

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
inline Vec3 in_plane(const Vec2& p) { return {p.x(), p.y(), 0}; }

// Diagonal tensor about z: a planar body has one moment. The other two repeat it, so that the
// matrix stays positive definite for whoever inverts it.
inline Mat3 planar_inertia(double moment) { return moment * Mat3::Identity(); }

// Half the extent of vertices along an axis, and vertices stretched along it to have another.
template <class Vertices>
double half_extent(const Vertices& vertices, int axis) {
  const auto less = [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; };
  const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(), less);
  return ((*high)[axis] - (*low)[axis]) / 2;
}
template <class Vertices>
void stretch(Vertices& vertices, int axis, double value) {
  const double before = half_extent(vertices, axis);
  if (value == before) return;
  for (auto& v : vertices) v[axis] *= value / before;
}

}  // namespace detail
}  // namespace manyworlds
