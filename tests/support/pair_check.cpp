#include "tests/support/pair_check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr int kWorlds = 512;

double reach(const Shape& shape) {  // no point of the shape is farther from the body's origin
  double r = 0;
  if (const auto* s = std::get_if<Sphere>(&shape.geometry)) r = s->radius;
  if (const auto* c = std::get_if<Circle>(&shape.geometry)) r = c->radius;
  if (const auto* b = std::get_if<Box>(&shape.geometry)) r = b->half_extents.norm();
  if (const auto* c = std::get_if<Capsule>(&shape.geometry)) r = c->radius + c->half_length;
  if (const auto* c = std::get_if<Cylinder>(&shape.geometry))
    r = std::hypot(c->radius, c->half_length);
  if (const auto* e = std::get_if<Ellipsoid>(&shape.geometry)) r = e->radii.maxCoeff();
  if (const auto* h = std::get_if<Hull>(&shape.geometry))
    for (const Vec3& v : h->vertices) r = std::max(r, v.norm());
  if (const auto* s = std::get_if<Segment>(&shape.geometry)) r = std::max(s->a.norm(), s->b.norm());
  if (const auto* t = std::get_if<Terrain>(&shape.geometry))
    for (const Vec2& v : t->points) r = std::max(r, v.norm());
  if (const auto* p = std::get_if<Polygon>(&shape.geometry))
    for (const Vec2& v : p->vertices) r = std::max(r, v.norm() + p->radius);
  return r + shape.position.norm();
}

// How far apart the pair should be: mostly about to touch, often deep, sometimes clear.
double wanted_separation(Random& random, double size) {
  const double kind = random.uniform(0, 1);
  if (kind < 0.4) return random.uniform(-0.02, 0.04);
  if (kind < 0.8) return random.uniform(-0.4 * size, 0.01);
  return random.uniform(0.021, 0.3);
}

// Moves the last body along a random ray from the other until the separation is the wanted one,
// or as deep as that ray goes.
void place(const Scene& scene, std::vector<Pose>& pose, Random& random) {
  const bool planar = scene.space == Space::planar;
  std::size_t mover = 1;
  for (std::size_t i = 0; i < 2; ++i) {
    if (scene.bodies[i].motion != Motion::dynamic) {
      mover = 1 - i;
      continue;
    }
    pose[i].rotation = planar ? random.planar_rotation() : random.rotation();
    pose[i].position = random.in_cube(1);
    if (planar) pose[i].position.z() = 0;
  }
  const std::size_t base = 1 - mover;
  const Shape& fixed_shape = scene.bodies[base].shapes[0];
  const Shape& moved_shape = scene.bodies[mover].shapes[0];
  const Solid still = make_solid(fixed_shape, pose[base], scene.space);
  const Vec3 ray = still.kind == Solid::Kind::half_space
                       ? still.normal
                       : (planar ? random.planar_direction() : random.direction());
  const Vec3 from = still.kind == Solid::Kind::half_space
                        ? pose[base].position + (planar ? 1.0 : 0.5) * random.in_cube(1)
                        : still.center;
  const auto at = [&](double t) {
    Pose p = pose[mover];
    const Vec3 shape_center = p.rotation.normalized() * moved_shape.position;
    p.position = from + t * ray - shape_center;
    if (planar) p.position.z() = 0;
    return p;
  };
  const double size = std::min(reach(moved_shape), 0.5);
  const double wanted = wanted_separation(random, size);
  const double far = reach(fixed_shape) + reach(moved_shape) + 3;
  double low = still.kind == Solid::Kind::half_space ? -far : 0, high = far;
  for (int i = 0; i < 14; ++i) {  // to a fraction of a millimetre
    const double middle = 0.5 * (low + high);
    (separation(still, make_solid(moved_shape, at(middle), scene.space)) < wanted ? low : high) =
        middle;
  }
  pose[mover] = at(high);
}

}  // namespace

void write_poses(Batch& batch, const std::vector<std::vector<Pose>>& poses) {
  const Space space = space_of(batch);
  const Plan& plan = batch.plan(0);
  std::vector<double> x, q;
  for (const auto& world : poses) {
    for (int i = 0; i < plan.bodies(); ++i) {
      const Pose& p = world[static_cast<std::size_t>(plan.body_in_row(i).index())];
      x.insert(x.end(), {p.position.x(), p.position.y()});
      if (space == Space::planar) {
        const double angle = 2 * std::atan2(p.rotation.z(), p.rotation.w());
        q.insert(q.end(), {std::cos(angle), std::sin(angle)});
      } else {
        x.push_back(p.position.z());
        q.insert(q.end(), {p.rotation.w(), p.rotation.x(), p.rotation.y(), p.rotation.z()});
      }
    }
  }
  batch.write(Field::position, x);
  batch.write(Field::orientation, q);
}

namespace {

class Judge {
 public:
  Judge(const Scene& scene, const Table& table, const PairPromise& promise, PairResult& result)
      : scene_(scene),
        promise_(promise),
        result_(result),
        tight_(pick(table, 2e-5, 1e-9) + promise.twin) {}

  void judge(const std::vector<Pose>& pose, const std::vector<Contact>& contacts) {
    pose_ = &pose;
    contacts_ = &contacts;
    const double margin = 4 * kPairSlop;
    const Solid first = make_solid(scene_.bodies[0].shapes[0], pose[0], scene_.space);
    const Solid second = make_solid(scene_.bodies[1].shapes[0], pose[1], scene_.space);
    truth_ = separation(first, second);
    ++result_.poses;
    if (is_behind(0, first, second) || is_behind(1, second, first)) return;
    if (truth_ < 0) ++result_.overlapping;
    if (!contacts.empty()) ++result_.with_contacts;

    if (truth_ < -tight_ && contacts.empty()) return deviation("overlap without contact", truth_);
    if (truth_ > promise_.reach * margin + tight_ && !contacts.empty())
      return deviation("contact beyond the margin", contacts[0].separation);
    if (contacts.empty()) return;
    if (static_cast<int>(contacts.size()) > promise_.max_points)
      deviation("too many points", static_cast<double>(contacts.size()));

    const bool in_order = contacts[0].body_a == BodyId(0);
    const Solid& a = in_order ? first : second;
    const Solid& b = in_order ? second : first;
    double depth = 1e9;  // of the manifold that comes closest
    for (const Contact& c : contacts) {
      const double own = deepest_along(c.normal);
      if (std::abs(own - truth_) < std::abs(depth - truth_)) depth = own;
      check_point(a, b, c);
      // No point can be deeper than the shapes overlap along its normal.
      const double along = separation_along(a, b, c.normal.normalized());
      if (!(c.separation > along - 2 * tight_))
        deviation("deeper than along its normal", c.separation - along);
    }
    check_depth(a, b, depth);
  }

 private:
  // A shape whose middle is behind a terrain is not touched, and a capsule whose axis is may see
  // more of one link than of another.
  bool is_behind(std::size_t ground, const Solid& terrain, const Solid& other) const {
    return std::holds_alternative<Terrain>(scene_.bodies[ground].shapes[0].geometry) &&
           (signed_distance(terrain, other.center) < tight_ ||
            (other.kind == Solid::Kind::capsule && truth_ < tight_ - other.radius));
  }
  void check_point(const Solid& a, const Solid& b, const Contact& c) {
    const int a_index = c.body_a.index(), b_index = c.body_b.index();
    if (a_index + b_index != 1 || c.shape_a.index() != 0 || c.shape_b.index() != 0)
      deviation("wrong bodies", a_index);
    if (scene_.at(c.body_b).motion == Motion::fixed) deviation("the fixed body is B", b_index);
    // Double precision does not follow from the name of the field: the normal is checked at the
    // precision of the batch.
    if (!(std::abs(c.normal.norm() - 1) < tight_)) deviation("normal not unit", c.normal.norm());
    if (scene_.space == Space::planar && (c.normal.z() != 0 || c.point.z() != 0))
      deviation("leaves the plane", c.normal.z());
    // Half way between the surfaces along the normal. Apart, the nearest points of two edges' lines
    // may lie beyond the edges' ends.
    const double half = std::max(0.5 * std::abs(c.separation), 1.5 * truth_) + 2 * tight_;
    const double in_a = signed_distance(a, c.point), in_b = signed_distance(b, c.point);
    if (!(in_a < half && in_b < half)) deviation("point off the shapes", std::max(in_a, in_b));
  }

  // A terrain has a manifold for each link, with a normal of its own; each sees what is over its
  // link, and overlaps along other normals are deeper.
  double deepest_along(const Vec3& normal) const {
    double deepest = 1e9;
    for (const Contact& c : *contacts_)
      if (c.normal == normal) deepest = std::min(deepest, c.separation);
    return deepest;
  }

  void check_depth(const Solid& a, const Solid& b, double deepest) {
    const double allowed = promise_.bias + promise_.bias_relative * std::abs(truth_);
    if (truth_ < -tight_) {
      if (promise_.local_below > 0 && truth_ < -promise_.local_below &&
          deepest < truth_ - allowed - tight_) {
        ++result_.local;
      } else if (!(std::abs(deepest - truth_) < allowed + tight_)) {
        deviation("wrong depth", deepest);
      }
    } else {
      // A separating axis gives at most the distance, and never an overlap.
      if (!(deepest > -2 * tight_)) deviation("disjoint shapes reported as overlapping", deepest);
    }
    if (const auto exact = exact_normal(a, b)) {
      ++result_.normals_checked;
      // 1e-3 is exact_normal's clearance: rounding of positions turns a normal by up to
      // rounding / clearance.
      for (const Contact& c : *contacts_) {
        if (!((c.normal - *exact).norm() < tight_ / 1e-3 * 0.2))
          deviation("wrong normal", (c.normal - *exact).norm());
      }
      if (!(std::abs(deepest - truth_) < 2 * tight_ + promise_.left_out))
        deviation("wrong separation", deepest);
    }
  }

  void deviation(const char* what, double value) {
    if (++result_.deviations > 5) return;
    std::ostringstream s;
    s.precision(12);
    s << what << ": " << value << ", true separation " << truth_ << "\n";
    for (std::size_t i = 0; i < 2; ++i) {
      const Pose& p = (*pose_)[i];
      s << "  body " << i << " x " << p.position.transpose() << " q " << p.rotation.w() << ' '
        << p.rotation.vec().transpose() << "\n";
      describe(s, scene_.bodies[i].shapes[0]);
    }
    for (const Contact& c : *contacts_)
      s << "  contact " << c.body_a.index() << '-' << c.body_b.index() << " s " << c.separation
        << " n " << c.normal.transpose() << " p " << c.point.transpose() << " id " << c.feature
        << "\n";
    result_.report += s.str();
  }
  static void describe(std::ostream& s, const Shape& shape) {
    s << "    shape at " << shape.position.transpose() << " q " << shape.rotation.w() << ' '
      << shape.rotation.vec().transpose();
    if (const auto* box = std::get_if<Box>(&shape.geometry))
      s << " box " << box->half_extents.transpose();
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) s << " r " << sphere->radius;
    if (const auto* circle = std::get_if<Circle>(&shape.geometry)) s << " r " << circle->radius;
    if (const auto* capsule = std::get_if<Capsule>(&shape.geometry))
      s << " r " << capsule->radius << " half " << capsule->half_length;
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape.geometry))
      s << " radii " << ellipsoid->radii.transpose();
    if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry))
      s << " disc " << cylinder->radius << " half " << cylinder->half_length;
    if (const auto* hull = std::get_if<Hull>(&shape.geometry))
      for (const Vec3& v : hull->vertices) s << " (" << v.transpose() << ")";
    if (const auto* polygon = std::get_if<Polygon>(&shape.geometry))
      for (const Vec2& v : polygon->vertices)
        s << " (" << v.x() << ", " << v.y() << ") r " << polygon->radius;
    s << "\n";
  }

  const Scene& scene_;
  const PairPromise& promise_;
  PairResult& result_;
  double tight_;
  double truth_ = 0;
  const std::vector<Pose>* pose_ = nullptr;
  const std::vector<Contact>* contacts_ = nullptr;
};

}  // namespace

PairResult check_pair(const Scene& scene, const Table& table, const PairPromise& promise, int poses,
                      Random& random) {
  PairResult result;
  Batch batch(compile(scene), options_of(table, kWorlds));
  Judge judge(scene, table, promise, result);
  const auto start = [](const Body& b) { return Pose{b.position, b.rotation.normalized()}; };
  std::vector<std::vector<Pose>> all(kWorlds, {start(scene.bodies[0]), start(scene.bodies[1])});
  while (result.poses < poses) {
    for (auto& pose : all) place(scene, pose, random);
    write_poses(batch, all);
    for (int w = 0; w < kWorlds; ++w) {
      std::vector<Pose> seen = all[static_cast<std::size_t>(w)];
      const Plan& plan = batch.plan(0);
      for (int i = 0; i < plan.bodies(); ++i)  // what the batch stored, after its rounding
        seen[static_cast<std::size_t>(plan.body_in_row(i).index())] = {position(batch, w, i),
                                                                       rotation(batch, w, i)};
      judge.judge(seen, batch.contacts(w));
    }
  }
  return result;
}

Polygon random_polygon(Random& random, int vertices) {
  // Points on an ellipse in angular order are convex; corners keep a distance from each other.
  const double rx = random.uniform(0.2, 0.6), ry = random.uniform(0.2, 0.6);
  const Vec2 center(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  Polygon p;
  const double phase = random.uniform(0, 2 * kPi);
  for (int i = 0; i < vertices; ++i) {
    const double angle = phase + 2 * kPi * (i + random.uniform(-0.3, 0.3)) / vertices;
    p.vertices.push_back(center + Vec2(rx * std::cos(angle), ry * std::sin(angle)));
  }
  return p;
}

Box random_box(Random& random) {
  return {{random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(0.1, 0.6)}};
}

Capsule random_capsule(Random& random) {
  return {random.uniform(0.1, 0.4), random.uniform(0.05, 0.6)};
}

Cylinder random_cylinder(Random& random) {
  return {random.uniform(0.1, 0.5), random.uniform(0.1, 0.6)};
}

// Points of an ellipsoid are corners of their hull, all of them.
Hull random_hull(Random& random, int vertices) {
  const Vec3 radii(random.uniform(0.2, 0.6), random.uniform(0.2, 0.6), random.uniform(0.2, 0.6));
  const Vec3 center = random.in_cube(0.1);
  Hull hull;
  while (static_cast<int>(hull.vertices.size()) < vertices) {
    const Vec3 v = center + radii.cwiseProduct(random.direction());
    bool apart = true;
    for (const Vec3& w : hull.vertices) apart &= (v - w).norm() > 0.08;
    if (apart) hull.vertices.push_back(v);
  }
  return hull;
}

Body random_body(Geometry geometry, Motion motion, bool offset, Space space, Random& random) {
  Body body = body_of(shape_of(std::move(geometry)), Vec3::Zero(), motion);
  const bool planar = space == Space::planar;
  const auto flat = [&](Vec3 v) { return planar ? Vec3(v.x(), v.y(), 0) : v; };
  if (offset) {
    body.shapes[0].position = flat(random.in_cube(0.3));
    body.shapes[0].rotation = planar ? random.planar_rotation() : random.rotation();
  }
  if (motion == Motion::fixed) {
    body.position = flat(random.in_cube(1));
    body.rotation = planar ? random.planar_rotation() : random.rotation();
  }
  return body;
}

namespace {

void merge(PairResult& sum, const PairResult& more) {
  sum.poses += more.poses;
  sum.overlapping += more.overlapping;
  sum.with_contacts += more.with_contacts;
  sum.normals_checked += more.normals_checked;
  sum.local += more.local;
  sum.deviations += more.deviations;
  if (sum.report.size() < 3000) sum.report += more.report;
}

}  // namespace

PairResult check_random_pairs(const RandomPair& pair, Space space, const Table& table,
                              const PairPromise& promise, int scenes, int poses, Random random) {
  PairResult sum;
  for (int i = 0; i < scenes; ++i) {
    Scene scene = empty_scene(space, 0);
    scene.options.contact.slop = kPairSlop;
    const bool offset = i % 2 == 1;
    scene.add(random_body(pair.first(random), pair.first_motion, offset, space, random));
    scene.add(random_body(pair.second(random), Motion::dynamic, offset, space, random));
    if (i % 4 >= 2) std::swap(scene.bodies[0], scene.bodies[1]);
    merge(sum, check_pair(scene, table, promise, poses, random));
  }
  return sum;
}

}  // namespace manyworlds::test
