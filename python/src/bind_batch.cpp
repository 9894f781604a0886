#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "interrupts.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

namespace {

// A property that is a member function of Batch.
template <auto member>
auto property() {
  return [](HeldBatch& self) { return self.with([](Batch& b) { return (b.*member)(); }); };
}

std::vector<Batch::Kind> kinds_of(nb::handle value) {
  std::vector<Batch::Kind> out;
  const Place place{nullptr, "kinds", -1};
  for (const nb::object& pair : read_elements(value, place, -1, "a list of (Plan, worlds)")) {
    const Place at = place.element(out.size());
    const auto parts = read_elements(pair, at, 2, "a Plan and a number");
    if (!nb::isinstance<Plan>(parts[0])) wrong_type(at, parts[0], "a Plan");
    out.push_back({nb::cast<Plan>(parts[0]), from_python<int>(parts[1], "worlds")});
  }
  return out;
}

void make(HeldBatch* self, nb::object plans, nb::object threads, std::uint64_t seed,
          nb::object precision, nb::object isa, nb::object layout, bool sleep, nb::object observe,
          nb::object rays, nb::object points, nb::object contacts_per_world,
          nb::object audit_every) {
  BatchOptions options;
  const std::vector<Batch::Kind> kinds = kinds_of(plans);
  options.threads = from_python<int>(threads, "threads");
  options.seed = seed;
  options.precision = from_python<Precision>(precision, "precision");
  options.isa = from_python<std::optional<Isa>>(isa, "isa");
  options.layout = from_python<ContactLayout>(layout, "layout");
  options.sleep = sleep;
  options.observe.what = from_python<std::vector<Observer>>(observe, "observe");
  const Scene* scene = kinds.empty() ? nullptr : &kinds.front().plan.scene();
  options.observe.rays = from_python<std::vector<Ray>>(rays, "rays", scene);
  options.observe.points = from_python<std::vector<Point>>(points, "points", scene);
  options.observe.contacts_per_world = from_python<int>(contacts_per_world, "contacts_per_world");
  options.audit_every = from_python<int>(audit_every, "audit_every");
  const nb::gil_scoped_release release;
  new (self) HeldBatch(kinds, options);
}

void step(HeldBatch& self, int n, const std::optional<In<std::uint8_t>>& mask) {
  if (n < 0) throw nb::value_error(("n is " + std::to_string(n) + ", must be >= 0").c_str());
  self.run([&](Batch& b) {
    Interrupts::during([&](const GoOn& go_on) {
      return mask ? b.step(span_of(*mask), n, go_on) : b.step(n, go_on);
    });
  });
}

int step_to(HeldBatch& self, double clock, int max_steps) {
  return self.run([&](Batch& b) {
    return Interrupts::during(
        [&](const GoOn& go_on) { return b.step_to(clock, max_steps, go_on); });
  });
}

void reset(HeldBatch& self, const std::optional<In<std::uint8_t>>& mask,
           const std::optional<In<std::uint64_t>>& seeds, std::optional<int> keyframe) {
  self.run([&](Batch& b) {
    if (keyframe && mask) {
      b.reset(span_of(*mask), KeyframeId(*keyframe));
    } else if (keyframe) {
      b.reset(KeyframeId(*keyframe));
    } else if (mask && seeds) {
      b.reset(span_of(*mask), span_of(*seeds));
    } else if (mask) {
      b.reset(span_of(*mask));
    } else {
      b.reset();
    }
  });
}

}  // namespace

void bind_batch(nb::module_& m) {
  nb::class_<HeldBatch> c(m, "Batch", "Worlds that step together. Private: use manyworlds.Batch.");
  c.def("__init__", &make, nb::arg("kinds"), nb::arg("threads"), nb::arg("seed"),
        nb::arg("precision"), nb::arg("isa").none(), nb::arg("layout"), nb::arg("sleep"),
        nb::arg("observe"), nb::arg("rays"), nb::arg("points"), nb::arg("contacts_per_world"),
        nb::arg("audit_every"))
      .def("close", &HeldBatch::close, "Frees the worlds. Later calls raise ValueError.")
      .def_prop_ro("closed", &HeldBatch::closed)
      .def_prop_ro("worlds", property<&Batch::worlds>())
      .def_prop_ro("threads", property<&Batch::threads>())
      .def_prop_ro("seed", property<&Batch::seed>())
      .def(
          "seeds",
          [](HeldBatch& s, const Out<std::uint64_t>& out) {
            s.with([&](Batch& b) {
              check_size("out", out.size(), static_cast<std::size_t>(b.worlds()));
              for (int w = 0; w < b.worlds(); ++w) out.data()[w] = b.seed_of(w);
            });
          },
          nb::arg("out").noconvert(), "Fills the seeds of worlds, (worlds).")
      .def_prop_ro("lanes", property<&Batch::lanes>())
      .def_prop_ro("kernel_table", property<&Batch::kernel_table>())
      .def_prop_ro("bytes_per_world", property<&Batch::bytes_per_world>())
      .def_prop_ro("scratch_bytes", property<&Batch::scratch_bytes>())
      .def_prop_ro("time", property<&Batch::time>())
      .def_prop_ro("steps", property<&Batch::steps>())
      .def_prop_ro("sleeps", property<&Batch::sleeps>())
      .def_prop_ro("isa",
                   [](HeldBatch& s) { return s.with([](Batch& b) { return name_of(b.isa()); }); })
      .def_prop_ro(
          "precision",
          [](HeldBatch& s) { return s.with([](Batch& b) { return name_of(b.precision()); }); })
      .def("step", &step, nb::arg("n"), nb::arg("mask").none(),
           "Takes n steps, of all worlds or of those in the mask, without the GIL; a signal ends "
           "it.")
      .def("step_to", &step_to, nb::arg("clock"), nb::arg("max_steps"),
           "Takes whole steps up to a time in s, without the GIL. Returns their number.")
      .def("reset", &reset, nb::arg("mask").none(), nb::arg("seeds").none(),
           nb::arg("keyframe").none(),
           "Starts all worlds at their first episode, or worlds of the mask at their next episode. "
           "With seeds, at the first episode of other seeds. With a keyframe, without seeds.");
  bind_batch_state(c);
  bind_batch_inputs(c);
  bind_batch_results(c);
  bind_batch_rollout(c);
}

}  // namespace manyworlds::python
