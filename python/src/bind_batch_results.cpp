// What came out: status, hashes, energy, contacts; snapshots.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "interrupts.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

// out: one number, or `each` of them, per world.
template <class T, class F>
void fill(HeldBatch& self, const Out<T>& out, std::size_t each, F f) {
  self.run([&](Batch& b) {
    check_size("out", out.size(), each * static_cast<std::size_t>(b.worlds()));
    for (int w = 0; w < b.worlds(); ++w) f(b, w, out.data() + static_cast<std::size_t>(w) * each);
  });
}

void status(HeldBatch& self, const Out<std::uint32_t>& out) {
  fill(self, out, 1, [](const Batch& b, int world, std::uint32_t* to) {
    *to = static_cast<std::uint32_t>(b.status(world));
  });
}

void hashes(HeldBatch& self, const Out<std::uint64_t>& out) {
  fill(self, out, 1, [](const Batch& b, int world, std::uint64_t* to) { *to = b.hash(world); });
}

void energy(HeldBatch& self, const Out<double>& out) {
  fill(self, out, 2, [](const Batch& b, int world, double* to) {
    const Energy e = b.energy(world);
    to[0] = e.kinetic, to[1] = e.potential;
  });
}

// Contacts as columns: integers (n, 5) body_a, body_b, shape_a, shape_b, feature, and numbers (n,
// k) normal, point, separation, normal impulse and, of those of the last step, friction impulse,
// twist.
struct Columns {
  std::vector<std::int32_t> integers;
  std::vector<double> numbers;

  void add(const auto& c) {
    for (const int i :
         {c.body_a.index(), c.body_b.index(), c.shape_a.index(), c.shape_b.index(), c.feature}) {
      integers.push_back(i);
    }
    add(c.normal);
    add(c.point);
    numbers.push_back(c.separation);
    numbers.push_back(c.normal_impulse);
  }
  void add(const Vec3& v) { numbers.insert(numbers.end(), v.begin(), v.end()); }
  nb::tuple arrays(std::size_t count, std::size_t width) {
    return nb::make_tuple(owned(std::move(integers), {count, 5}),
                          owned(std::move(numbers), {count, width}));
  }
};

nb::tuple contacts(HeldBatch& self, int world) {
  const auto all = self.run([world](Batch& b) { return b.contacts(world); });
  Columns columns;
  for (const Contact& c : all) columns.add(c);
  return columns.arrays(all.size(), 8);
}

nb::tuple step_contacts(HeldBatch& self, int world) {
  const auto all = self.run([world](Batch& b) { return b.step_contacts(world); });
  Columns columns;
  for (const StepContact& c : all) {
    columns.add(c);
    columns.add(c.friction_impulse);
    columns.numbers.push_back(c.twist_impulse);
  }
  return columns.arrays(all.size(), 12);
}

nb::dict measure_contacts(HeldBatch& self) {
  const ContactSummary s = self.run([](Batch& b) {
    return Interrupts::during([&](const GoOn& go_on) { return b.measure_contacts(go_on); });
  });
  nb::dict out;
  out["points_per_world"] = s.points_per_world;
  out["manifolds_per_world"] = s.manifolds_per_world;
  out["max_penetration"] = s.max_penetration;
  out["mean_occupancy"] = s.mean_occupancy;
  return out;
}

Snapshot save(HeldBatch& self, const std::optional<Ids>& worlds) {
  return self.run([&](Batch& b) { return worlds ? b.save(span_of(*worlds)) : b.save(); });
}

// With `pairs`: world pairs[2 i] of the snapshot into world pairs[2 i + 1] of the batch.
void restore(HeldBatch& self, const Snapshot& snapshot, const std::optional<Ids>& pairs) {
  self.run([&](Batch& b) {
    if (!pairs) return b.restore(snapshot);
    const auto p = span_of(*pairs);
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) b.restore(snapshot, p[i], p[i + 1]);
  });
}

}  // namespace

void bind_batch_results(nb::class_<HeldBatch>& c) {
  c.def("status", &status, nb::arg("out").noconvert(), "Fills status bits, (worlds).")
      .def("hashes", &hashes, nb::arg("out").noconvert(), "Fills hashes of the state, (worlds).")
      .def(
          "hash",
          [](HeldBatch& s, std::optional<int> world) {
            return s.run([world](Batch& b) { return world ? b.hash(*world) : b.hash(); });
          },
          nb::arg("world").none(), "Hash of a world, or of all.")
      .def("energy", &energy, nb::arg("out").noconvert(),
           "Fills kinetic and potential energy, (worlds, 2).")
      .def("contacts", &contacts, nb::arg("world"), "Columns of the contacts at the current state.")
      .def("step_contacts", &step_contacts, nb::arg("world"),
           "Columns of the last step's contacts.")
      .def("measure_contacts", &measure_contacts, "Four statistics of the contacts of all worlds.")
      .def(
          "look", [](HeldBatch& s) { s.run([](Batch& b) { b.look(); }); },
          "Updates observed motion, joints and rays.")
      .def("save", &save, nb::arg("worlds").none(), "A Snapshot of all or of some worlds.")
      .def("restore", &restore, nb::arg("snapshot"), nb::arg("pairs").none(),
           "Restores all worlds, or pairs (world of the snapshot, world of the batch).")
      .def(
          "copy_world",
          [](HeldBatch& s, int from, int to) { s.run([=](Batch& b) { b.copy_world(from, to); }); },
          nb::arg("source"), nb::arg("target"), "Copies a world's state.");
}

}  // namespace manyworlds::python
