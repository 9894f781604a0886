// The fingerprint of a plan: equal for plans that step worlds alike and store them alike. Names do
// not count; everything else of a scene does.
#include <bit>

#include "src/base/hash.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

class Printer {
 public:
  void add(double x) { hasher_.add(x); }
  void add(bool x) { hasher_.add(std::uint64_t{x}); }
  void add(int x) { hasher_.add(static_cast<std::uint64_t>(x)); }
  template <class Of>
  void add(Id<Of> id) {
    add(id.index());
  }
  void add(std::uint32_t x) { hasher_.add(std::uint64_t{x}); }
  template <class E>
  requires std::is_enum_v<E>
  void add(E x) { add(static_cast<int>(x)); }
  void add(const Vec2& v) { add(v.x()), add(v.y()); }
  void add(const Vec3& v) { add(v.x()), add(v.y()), add(v.z()); }
  void add(const Quat& q) { add(q.w()), add(q.x()), add(q.y()), add(q.z()); }
  void add(const Mat3& m) {
    for (int i = 0; i < 9; ++i) add(m(i / 3, i % 3));
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<int>(values.size()));
    for (const T& value : values) add(value);
  }
  void add(const Eigen::AlignedBox3d& box) { add(Vec3(box.min())), add(Vec3(box.max())); }

  void add(const Sphere& s) { add(s.radius); }
  void add(const Box& b) { add(b.half_extents); }
  void add(const Plane& p) { add(p.normal), add(p.offset); }
  void add(const Circle& c) { add(c.radius); }
  void add(const Polygon& p) {
    add(p.vertices);
    if (p.radius != 0) add(p.radius);
  }
  void add(const HalfPlane& p) { add(p.normal), add(p.offset); }
  void add(const Capsule& c) { add(c.radius), add(c.half_length); }
  void add(const Cylinder& c) { add(c.radius), add(c.half_length); }
  void add(const Hull& h) { add(h.vertices); }
  void add(const Segment& s) { add(s.a), add(s.b); }
  void add(const HeightField& f) { add(f.heights), add(f.columns), add(f.cell); }
  void add(const Terrain& t) { add(t.points), add(t.loop); }
  void add(const Shape& s) {
    add(static_cast<int>(s.geometry.index()));
    std::visit([this](const auto& geometry) { add(geometry); }, s.geometry);
    add(s.position), add(s.rotation), add(s.density);
    add(s.material.friction), add(s.material.restitution);
    add(s.filter.category), add(s.filter.mask);
  }
  void add(const MassProperties& m) { add(m.mass), add(m.center), add(m.inertia); }
  // Where a body begins does not matter to a world that has begun.
  void add(const Body& b) {
    add(b.motion), add(b.shapes), add(b.mass_properties);
    add(b.gravity_scale), add(b.linear_drag), add(b.angular_drag);
    if (b.motion == Motion::fixed) add(b.position), add(b.rotation);
  }
  void add(const Options& o) {
    add(o.dt), add(o.substeps), add(o.gravity), add(o.wind), add(o.density), add(o.length_unit);
    add(o.contact_frequency), add(o.contact_damping_ratio), add(o.push_out_speed), add(o.slop);
    add(o.restitution_threshold), add(o.restitution_sweeps), add(o.friction_in_bias_pass);
    add(o.cast_against_fixed), add(o.cast_between_moving);
    add(o.joint_frequency), add(o.joint_damping_ratio), add(o.joint_pull_speed);
    add(o.sleep_speed), add(o.time_to_sleep), add(o.contact_capacity), add(o.bounds);
    if (o.solver != Solver::tgs_soft || iterations_of(o) != 1) add(o.solver), add(iterations_of(o));
    if (o.solver == Solver::sor) add(o.relaxation);
    if (has_hard_rows(o.solver)) add(o.push_out_share), add(o.split_impulse);
    if (flies(o)) add(o.integrator), add(o.rotation), add(o.angular_momentum);
  }
  void add(const Frame& f) { add(f.position), add(f.rotation); }
  void add(const Spring& s) {
    add(s.stiffness), add(s.damping), add(s.frequency), add(s.damping_ratio);
  }
  void add(const Limit& l) { add(l.low), add(l.high), add(l.spring); }
  void add(const Drive& d) {
    add(d.target_position), add(d.target_speed), add(d.spring), add(d.max_force);
  }
  void add(const BallJoint& j) { add(j.cone), add(j.twist); }
  void add(const HingeJoint& j) { add(j.limit), add(j.drive); }
  void add(const SliderJoint& j) { add(j.limit), add(j.drive); }
  void add(const FixedJoint&) {}
  void add(const DistanceJoint& j) { add(j.length), add(j.limit), add(j.spring); }
  void add(const WheelJoint& j) { add(j.suspension), add(j.travel), add(j.drive); }
  void add(const PulleyJoint& j) { add(j.ground_a), add(j.ground_b), add(j.ratio), add(j.length); }
  void add(const TargetJoint& j) { add(j.spring), add(j.max_force); }
  void add(const Joint& j) {
    add(static_cast<int>(j.type.index()));
    std::visit([this](const auto& type) { add(type); }, j.type);
    add(j.body_a), add(j.body_b), add(j.frame_a), add(j.frame_b), add(j.collide);
    add(j.break_force), add(j.break_torque);
  }
  void add(const Attractor& a) { add(a.position), add(a.strength), add(a.softening); }
  // What a world begins with does not matter to one that has begun.
  void add(const Control& c) {
    add(c.kind), add(c.joint), add(c.body), add(c.point), add(c.direction), add(c.low), add(c.high);
  }
  // How a number is drawn does not matter to a world that has it.
  void add(const VariedNumber& n) {
    add(n.parameter), add(n.body), add(n.shape), add(n.component), add(n.low), add(n.high);
  }
  std::uint64_t value() const { return hasher_.value(); }

 private:
  Hasher hasher_;
};

}  // namespace

std::uint64_t fingerprint(const PlanData& plan) {
  Printer printer;
  printer.add(plan.scene.space);
  printer.add(plan.scene.bodies);
  printer.add(plan.scene.joints);
  printer.add(plan.scene.controls);
  printer.add(plan.scene.attractors);
  printer.add(plan.scene.options);
  printer.add(plan.varied);
  for (const bool in : plan.in) printer.add(in);
  for (const int capacity : plan.capacity) printer.add(capacity);
  if (plan.sparse) printer.add(plan.sparse);  // keys of contacts mean something else
  return printer.value();
}

}  // namespace manyworlds
