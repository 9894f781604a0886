#include "tests/support/changed_members.hpp"

#include "manyworlds/members.hpp"

namespace manyworlds::test {

namespace {

// Walks over all that may change, in the same order whatever it holds, up to the one that is to be
// changed.
class Walk {
 public:
  explicit Walk(int change) : change_(change) {}

  bool done() const { return done_; }
  const std::string& member() const { return place_; }
  bool counts() const { return counts_; }

  template <HasMembers Struct>
  void visit(Struct& value) {
    Members<Struct>::visit(value, [&](const char* name, auto& member, Counted counted = {}) {
      if (done_) return;
      const bool outer = counts_;
      counts_ = counts_ && counted.yes;
      enter(name, member);
      if (!done_) counts_ = outer;
    });
  }

 private:
  template <class T>
  void enter(const std::string& name, T& value) {
    const std::size_t length = place_.size();
    place_ += (place_.empty() ? "" : "/") + name;
    visit(value);
    if (!done_) place_.resize(length);
  }
  bool is_here() { return !done_ && at_++ == change_ && (done_ = true); }

  void visit(double& x) {
    if (is_here()) x = x == 0.375 ? 0.5 : 0.375;
  }
  void visit(bool& x) {
    if (is_here()) x = !x;
  }
  void visit(int& x) {
    if (is_here()) ++x;
  }
  void visit(std::uint32_t& x) {
    if (is_here()) x ^= 4;
  }
  void visit(std::string& x) {
    if (is_here()) x += "x";
  }
  template <class Of>
  void visit(Id<Of>& x) {
    if (is_here()) x = Id<Of>(x.index() + 1);
  }
  void visit(ShapeId& x) {
    if (is_here()) x = ShapeId(x.body(), x.index() + 1);
  }
  template <class E>
  requires std::is_enum_v<E>
  void visit(E& x) {
    if (is_here()) x = static_cast<E>(static_cast<int>(x) == 0 ? 1 : 0);
  }
  template <int rows, int columns>
  void visit(Eigen::Matrix<double, rows, columns>& m) {
    for (int i = 0; i < m.size() && !done_; ++i) enter(std::to_string(i), m.data()[i]);
  }
  void visit(Quat& q) {
    for (double* x : {&q.w(), &q.x(), &q.y(), &q.z()}) visit(*x);
  }
  void visit(Eigen::AlignedBox3d& box) { visit(box.min()), visit(box.max()); }
  template <class T>
  void visit(std::optional<T>& value) {
    if (is_here()) {
      value ? value.reset() : void(value.emplace());
    } else if (value) {
      visit(*value);
    }
  }
  template <class T>
  void visit(std::vector<T>& values) {
    if (is_here()) values.emplace_back();
    for (std::size_t i = 0; i < values.size() && !done_; ++i) enter(std::to_string(i), values[i]);
  }
  template <class... Ts>
  void visit(std::variant<Ts...>& value) {
    std::visit([this](auto& alternative) { this->visit(alternative); }, value);
  }

  int change_, at_ = 0;
  bool done_ = false, counts_ = true;
  std::string place_;
};

Joint joint_of(const JointType& type) {
  Joint joint;
  joint.name = "joint";
  joint.type = type;
  joint.body_a = BodyId(0), joint.body_b = BodyId(1);
  joint.break_force = 100, joint.break_torque = 10;
  return joint;
}

}  // namespace

Scene scene_with_everything(Solver solver) {
  Scene scene;
  scene.name = "everything";
  const Geometry shapes[] = {Sphere{},
                             Box{},
                             Plane{},
                             Circle{},
                             Polygon::box(1, 2),
                             HalfPlane{},
                             Capsule{},
                             Segment{},
                             Terrain{{{0, 0}, {1, 0}}, false},
                             Cylinder{},
                             Hull{{Vec3(1, 0, 0), Vec3(0, 1, 0)}},
                             HeightField{{1, 2, 3, 4}, 2, {1, 1}},
                             Ellipsoid{}};
  static_assert(std::size(shapes) == std::variant_size_v<Geometry>);
  for (const Motion motion : {Motion::dynamic, Motion::fixed}) {
    Body body;
    body.name = "body";
    body.motion = motion;
    for (const Geometry& geometry : shapes) {
      Shape shape;
      shape.geometry = geometry;
      shape.density = 2;
      body.shapes.push_back(shape);
    }
    body.mass_properties = MassProperties{};
    body.jitter.with = BodyId(0);
    scene.add(body);
  }
  const Spring spring{1, 2, 3, 4};
  const Limit limit{-1, 1, spring};
  const Drive drive{1, 2, spring, 3};
  const JointType types[] = {BallJoint{1.0, limit},
                             HingeJoint{limit, drive},
                             SliderJoint{limit, drive},
                             FixedJoint{},
                             DistanceJoint{1.0, limit, spring},
                             WheelJoint{spring, limit, drive},
                             PulleyJoint{Vec3(1, 2, 3), Vec3(4, 5, 6), 1, 2.0},
                             TargetJoint{spring, 12}};
  static_assert(std::size(types) == std::variant_size_v<JointType>);
  for (const JointType& type : types) scene.add(joint_of(type));
  // What counts if it is not as it always was: once as it was, and once not.
  Joint later = joint_of(HingeJoint{Limit{-1, 1, {}, {0.1, 0.5, 0.1, 0.2, 0.3, 0.4, 3}, 0.1}, {}});
  later.after = JointId(1);
  later.dynamics = {1, 2, 3, 4, 5};
  scene.add(later);
  scene.bodies[0].shapes[0].material.soft = {1, {0.1, 0.5, 0.1, 0.2, 0.3, 0.4, 3}, 1, 2, 3, 4};
  scene.add(Control{});
  Control force;
  force.kind = ControlKind::joint_force, force.joint = JointId(1);
  force.actuator = {2, {1, 2, 3}, {4, 5, 6}, -7, 8};
  scene.add(force);
  scene.attractors.emplace_back();
  scene.variations.push_back(vary(Parameter::friction, 0.1, 0.9));
  if (solver != Solver::tgs_soft) scene.exclusions.push_back({BodyId(0), BodyId(1)});
  if (solver == Solver::newton) {
    scene.add(
        joint_of(BallJoint{.limit = Limit{0, 1, {}, {0.1, 0.5, 0.1, 0.2, 0.3, 0.4, 3}, 0.1}}));
    const Limit end{-1, 1, {}, {0.1, 0.5, 0.1, 0.2, 0.3, 0.4, 3}, 0.1};
    scene.tendons.push_back({"cord", {{JointId(1), 0.5}, {JointId(2), -2}}, end});
  }
  scene.keyframes.push_back({"key", {1, 2}, {3, 4}, {5, 6}});
  scene.coordinate_draws.push_back({true, 1, {-1, -2}, {3, 4}, true, true, 0.1, 7});
  scene.sites.push_back({"site", BodyId(0), Vec3(1, 2, 3)});
  scene.options.contact_capacity = 7;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-1, -2, -3), Vec3(1, 2, 3));
  scene.options.joint.frequency = 30;
  if (solver == Solver::tgs_soft) return scene;
  scene.options.solver.method = solver;
  scene.options.solver.iterations = 7;
  scene.options.integrator = Integrator::runge_kutta4;
  scene.options.rotation = Rotation::exponential;
  return scene;
}

std::vector<Change> changes_of(const Scene& scene) {
  std::vector<Change> out;
  for (int i = 0;; ++i) {
    Change change{{}, false, scene};
    Walk before(i);
    before.visit(change.scene);
    if (!before.done()) return out;
    change.member = before.member();
    // Whether it counts may be for the change itself to say.
    Walk after(i);
    Scene changed = change.scene;
    after.visit(changed);
    change.counts = before.counts() || (after.member() == before.member() && after.counts());
    out.push_back(std::move(change));
  }
}

}  // namespace manyworlds::test
