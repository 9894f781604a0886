// What acts on worlds from outside: forces and impulses, bodies and joints that come and go, rays.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

namespace {

enum class External { force, torque, impulse, angular_impulse };

}  // namespace

template <>
struct Names<External> {
  static constexpr Named<External> all[] = {{External::force, "force"},
                                            {External::torque, "torque"},
                                            {External::impulse, "impulse"},
                                            {External::angular_impulse, "angular_impulse"}};
};

namespace {

// Calls f(world, body or joint, index in an array [world][body]).
template <class F>
void for_each_pair(const Ids& worlds, const Ids& items, F f) {
  std::size_t at = 0;
  for (const std::int32_t world : span_of(worlds)) {
    for (const std::int32_t item : span_of(items)) f(world, item, at++);
  }
}

Vec3 vector_at(const In<double>& numbers, std::size_t i) {
  return Eigen::Map<const Vec3>(numbers.data() + 3 * i);
}

// values and points: (worlds, bodies, 3).
void apply_external(HeldBatch& self, nb::object kind, const Ids& worlds, const Ids& bodies,
                    const In<double>& values, const std::optional<In<double>>& points) {
  const External what = from_python<External>(kind, "kind");
  const std::size_t wanted = 3 * worlds.size() * bodies.size();
  check_size("values", values.size(), wanted);
  if (points) check_size("points", points->size(), wanted);
  self.run([&](Batch& b) {
    for_each_pair(worlds, bodies, [&](int world, int index, std::size_t i) {
      const BodyId body(index);
      const Vec3 value = vector_at(values, i);
      if (value.isZero(0)) return;  // would wake a world for nothing
      switch (what) {
        case External::force:
          if (points) return b.add_force_at(world, body, value, vector_at(*points, i));
          return b.add_force(world, body, value);
        case External::impulse:
          if (points) return b.add_impulse_at(world, body, value, vector_at(*points, i));
          return b.add_impulse(world, body, value);
        case External::torque: return b.add_torque(world, body, value);
        case External::angular_impulse: return b.add_angular_impulse(world, body, value);
      }
    });
  });
}

// states: (worlds, 13): position, rotation w x y z, linear and angular velocity.
void spawn(HeldBatch& self, const Ids& worlds, int body, const In<double>& states) {
  check_size("states", states.size(), 13 * worlds.size());
  self.run([&](Batch& b) {
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      const double* s = states.data() + 13 * i;
      b.spawn(worlds.data()[i], BodyId(body),
              {{s[0], s[1], s[2]},
               {s[3], s[4], s[5], s[6]},
               {s[7], s[8], s[9]},
               {s[10], s[11], s[12]}});
    }
  });
}

template <class Handle>
using Setter = void (Batch::*)(int, Handle, bool);
template <class Handle>
using Getter = bool (Batch::*)(int, Handle) const;

// values: (worlds, items), items by their indices in the scene.
template <class Handle, Setter<Handle> set>
void set_flags(HeldBatch& self, const Ids& worlds, const Ids& items, const In<bool>& values) {
  check_size("values", values.size(), worlds.size() * items.size());
  self.run([&](Batch& b) {
    for_each_pair(worlds, items, [&](int world, int item, std::size_t i) {
      (b.*set)(world, Handle(item), values.data()[i]);
    });
  });
}

// The body of a column of an array of flags: bodies by their rows.
void in_column(const Batch& b, int world, int column, BodyId& out) {
  out = b.body_in_row(column, b.kind_of(world));
}
void in_column(const Batch&, int, int column, JointId& out) { out = JointId(column); }

// out: (worlds, columns), the same in all worlds.
template <class Handle, Getter<Handle> get>
void get_flags(HeldBatch& self, const Out<bool>& out, int kind) {
  self.run([&](Batch& b) {
    const KindRange& of = self.range(kind);
    const std::size_t worlds = static_cast<std::size_t>(of.worlds);
    const int items = static_cast<int>(out.size() / worlds);
    check_size("out", out.size(), worlds * static_cast<std::size_t>(items));
    bool* to = out.data();
    for (int w = of.first; w < of.first + of.worlds; ++w) {
      for (int i = 0; i < items; ++i) {
        Handle item;
        in_column(b, w, i, item);
        *to++ = (b.*get)(w, item);
      }
    }
  });
}

void wake(HeldBatch& self, const Ids& worlds) {
  self.run([&](Batch& b) {
    for (const std::int32_t world : span_of(worlds)) b.wake(world);
  });
}

void set_rays(HeldBatch& self, nb::object rays, std::optional<int> world) {
  const Plan plan = self.with([&](Batch& b) { return b.plan(world ? b.kind_of(*world) : 0); });
  const auto all = from_python<std::vector<Ray>>(rays, "rays", &plan.scene());
  self.run([&](Batch& b) {
    if (world) {
      b.set_rays(*world, all);
    } else {
      b.set_rays(all);
    }
  });
}

}  // namespace

void bind_batch_inputs(nb::class_<HeldBatch>& c) {
  const auto ids = nb::arg("worlds").noconvert();
  const auto kind = nb::arg("kind") = 0;
  c.def("apply_external", &apply_external, nb::arg("kind"), ids, nb::arg("bodies").noconvert(),
        nb::arg("values").noconvert(), nb::arg("points").none(),
        "Adds forces, torques or impulses, (worlds, bodies, 3); rows of zeros do nothing.")
      .def("spawn", &spawn, ids, nb::arg("body"), nb::arg("states").noconvert(),
           "Enables a body with a state of 13 values in each of the worlds.")
      .def("set_enabled", &set_flags<BodyId, &Batch::set_enabled>, ids,
           nb::arg("bodies").noconvert(), nb::arg("values").noconvert(),
           "Enables and disables bodies, (worlds, bodies).")
      .def("enabled", &get_flags<BodyId, &Batch::enabled>, nb::arg("out").noconvert(), kind,
           "Fills which bodies are enabled, (worlds, bodies).")
      .def("set_joints_enabled", &set_flags<JointId, &Batch::set_joint_enabled>, ids,
           nb::arg("joints").noconvert(), nb::arg("values").noconvert(),
           "Enables and disables joints, (worlds, joints).")
      .def("joints_enabled", &get_flags<JointId, &Batch::joint_enabled>, nb::arg("out").noconvert(),
           kind, "Fills which joints are enabled, (worlds, joints).")
      .def("asleep", &get_flags<BodyId, static_cast<Getter<BodyId>>(&Batch::asleep)>,
           nb::arg("out").noconvert(), kind, "Fills which bodies are asleep, (worlds, bodies).")
      .def("wake", &wake, ids, "Wakes all bodies of these worlds.")
      .def("set_rays", &set_rays, nb::arg("rays"), nb::arg("world").none(),
           "Replaces the rays, in one world or in all.");
}

}  // namespace manyworlds::python
