// Draws worlds of a planar scene as they stand after some time:
//   picture OUT.svg [SCENE] [SECONDS]      (default: mixed-pile2d, 10 s)
// Shows how to read states and what the shapes of a scene mean.
#include <manyworlds/manyworlds.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace mw = manyworlds;

namespace {

constexpr int kColumns = 4;
constexpr int kRows = 2;
constexpr double kGap = 0.6;  // m, between worlds
constexpr const char* kPalette[] = {"#e4572e", "#f3a712", "#29335c", "#669bbc", "#76b041"};

// Where the body frame of one body is: a rotation (c, s) and an origin.
struct Pose {
  double x, y, c, s;
  mw::Vec2 operator()(const mw::Vec2& p) const {
    return {x + c * p.x() - s * p.y(), y + s * p.x() + c * p.y()};
  }
};

// Canonical order is [world][body][component], so one number finds a body in every field.
std::vector<Pose> read_poses(const mw::Batch& batch) {
  std::vector<double> position(batch.size(mw::Field::position));
  std::vector<double> orientation(batch.size(mw::Field::orientation));
  batch.read(mw::Field::position, position);
  batch.read(mw::Field::orientation, orientation);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < position.size(); i += 2) {
    poses.push_back({position[i], position[i + 1], orientation[i], orientation[i + 1]});
  }
  return poses;
}

// A point of a shape, given in the shape's frame, in the frame of its body.
mw::Vec2 in_body(const mw::Shape& shape, const mw::Vec3& p) {
  return (shape.position + shape.rotation.normalized() * p).head<2>();
}

// What of the world to show, m; y up.
struct View {
  mw::Vec2 low, high;
  double width() const { return high.x() - low.x(); }
  double height() const { return high.y() - low.y(); }
};

// A chain of points of the shape.
void draw_line(std::ofstream& svg, const mw::Shape& shape, const Pose& pose,
               const std::vector<mw::Vec3>& line, const char* as) {
  svg << '<' << as << " points='";
  for (const mw::Vec3& point : line) {
    const mw::Vec2 x = pose(in_body(shape, point));
    svg << x.x() << ',' << x.y() << ' ';
  }
  svg << "'/>\n";
}

mw::Surface surface_of(const mw::Shape& shape, const View& view) {
  mw::SurfaceOptions options{.space = mw::Space::planar, .around = 32};
  // Ground without end, in the frame of its shape, to beyond what is shown.
  const double far = 2 * (view.width() + view.height());
  options.low.setConstant(-far), options.high.setConstant(far);
  return mw::surface(shape.geometry, options);
}

void draw_shape(std::ofstream& svg, const mw::Shape& shape, const Pose& pose, const View& view) {
  const mw::Surface surface = surface_of(shape, view);
  for (const auto& [first, count] : surface.faces) {
    const auto begin = surface.points.begin() + first;
    const bool ground = std::holds_alternative<mw::HalfPlane>(shape.geometry);
    draw_line(svg, shape, pose, {begin, begin + count},
              ground ? "polygon class='ground'" : "polygon");
  }
  if (surface.faces.empty()) {
    for (const auto& line : surface.lines) draw_line(svg, shape, pose, line, "polyline");
  }
  for (const auto& mark : surface.marks) {
    draw_line(svg, shape, pose, mark, "polyline class='mark'");
  }
}

View find_view(const mw::Batch& batch, const std::vector<Pose>& poses) {
  View view{{1e9, 1e9}, {-1e9, -1e9}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const int body = static_cast<int>(i) % batch.bodies();
    const mw::Scene& scene = batch.plan().scene();
    for (const mw::Shape& shape : scene.at(batch.body_in_row(body)).shapes) {
      if (std::holds_alternative<mw::HalfPlane>(shape.geometry)) continue;
      for (const mw::Vec3& p : surface_of(shape, {{0, 0}, {1, 1}}).points) {
        const mw::Vec2 x = poses[i](in_body(shape, p));
        view.low = view.low.cwiseMin(x), view.high = view.high.cwiseMax(x);
      }
    }
  }
  const mw::Vec2 border(0.3, 0.3);
  return {view.low - border, view.high + border};
}

void draw_world(std::ofstream& svg, const mw::Batch& batch, const Pose* poses, const View& view) {
  svg << "<rect class='sky' x='" << view.low.x() << "' y='" << view.low.y() << "' width='"
      << view.width() << "' height='" << view.height() << "'/>\n";
  const mw::Scene& scene = batch.plan().scene();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const mw::Body& body = scene.bodies[b];
    const auto row = batch.plan().find_row(mw::BodyId(static_cast<int>(b)));
    const mw::Mat3 fixed = body.rotation.normalized().toRotationMatrix();
    const Pose pose =
        row ? poses[*row] : Pose{body.position.x(), body.position.y(), fixed(0, 0), fixed(1, 0)};
    svg << "<g fill='" << (!row ? "#8d99ae" : kPalette[b % std::size(kPalette)]) << "'>";
    for (const mw::Shape& shape : body.shapes) draw_shape(svg, shape, pose, view);
    svg << "</g>\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 2 ? argv[2] : "mixed-pile2d";
  const double seconds = argc > 3 ? std::atof(argv[3]) : 10;
  const mw::scenes::Entry* entry = mw::scenes::find(name);
  if (argc < 2 || entry == nullptr || entry->make().space != mw::Space::planar) {
    std::fprintf(stderr, "usage: picture OUT.svg [PLANAR SCENE] [SECONDS]\n");
    return 2;
  }

  mw::Batch batch(mw::compile(entry->make()), {.worlds = kColumns * kRows});
  while (batch.time() < seconds) batch.step();

  const std::vector<Pose> poses = read_poses(batch);
  const View view = find_view(batch, poses);
  const double width = kColumns * (view.width() + kGap) - kGap;
  const double height = kRows * (view.height() + kGap) - kGap;
  std::ofstream svg(argv[1]);
  svg.precision(4);
  svg << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << width << ' ' << height
      << "' width='1000' height='" << 1000 * height / width << "'>\n"
      << "<style>polygon{stroke:#1d1f2a;stroke-width:.03}"
      << "polyline{fill:none;stroke:#1d1f2a;stroke-width:.06}"
      << ".mark{stroke-width:.03}.ground{fill:#8d99ae;stroke:none}.sky{fill:#f4f1ea}</style>\n"
      << "<clipPath id='view'><rect x='" << view.low.x() << "' y='" << view.low.y() << "' width='"
      << view.width() << "' height='" << view.height() << "'/></clipPath>\n";
  for (int world = 0; world < batch.worlds(); ++world) {
    const double x = (world % kColumns) * (view.width() + kGap) - view.low.x();
    const double y = (world / kColumns) * (view.height() + kGap) + view.high.y();
    svg << "<g transform='translate(" << x << ' ' << y
        << ") scale(1 -1)' clip-path='url(#view)'>\n";
    draw_world(svg, batch, poses.data() + world * batch.bodies(), view);
    svg << "</g>\n";
  }
  svg << "</svg>\n";
  svg.close();
  if (!svg) {
    std::fprintf(stderr, "picture: cannot write %s\n", argv[1]);
    return 1;
  }
  std::printf("%s: %d worlds of %s after %.2f s, hash %016llx\n", argv[1], batch.worlds(),
              name.c_str(), batch.time(), static_cast<unsigned long long>(batch.hash()));
  return 0;
}
