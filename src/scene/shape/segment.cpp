// Segments: lines that are solid from either side.
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

class SegmentTraits final : public TraitsOf<Segment> {
 public:
  SegmentTraits() : TraitsOf({.name = "segment", .in_plane = true, .ground = true}) {}

 protected:
  void examine(Checker& checker, const Segment& s) const override {
    const bool good = detail::check_point(checker, "a", s.a);
    if (!detail::check_point(checker, "b", s.b) || !good) return;
    if ((s.b - s.a).norm() >= detail::kMinSize) return;
    checker.add("b", "is " + detail::vector_text(s.b) + " m, the same as a; must be apart from it");
  }
  std::vector<Convex> parts_of(const Segment& s, const Vec3& x, const Mat3& r,
                               Space space) const override {
    return {segment_of(x + r * detail::in_plane(s.a), x + r * detail::in_plane(s.b), 0, space)};
  }
  // A capsule without thickness.
  ShapeForm form_of(const Segment& s, const PolygonChoice&) const override {
    const Vec2 middle = (s.a + s.b) / 2, span = s.b - s.a, along = span.normalized();
    ShapeForm f{kernels::ShapeKind::capsule};
    f.offset = detail::in_plane(middle);
    f.rotation.topLeftCorner<2, 2>() << along.y(), along.x(), -along.x(), along.y();
    f.half.x() = f.radius = span.norm() / 2;
    return f;
  }
  Surface surface_of(const Segment& s, const SurfaceOptions&) const override {
    Surface out;
    out.lines.push_back({detail::in_plane(s.a), detail::in_plane(s.b)});
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Segment)

}  // namespace manyworlds
