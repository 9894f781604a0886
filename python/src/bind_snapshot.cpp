#include <nanobind/stl/filesystem.h>

#include <cstring>

#include "bind.hpp"
#include "errors.hpp"
#include "manyworlds/snapshot.hpp"

namespace nb = nanobind;

namespace manyworlds::python {

namespace {

nb::bytes bytes_of(const Snapshot& snapshot) {
  return nb::bytes(snapshot.bytes().data(), snapshot.bytes().size());
}

Snapshot from_bytes(const nb::bytes& data) {
  std::vector<std::byte> bytes(data.size());
  if (!bytes.empty()) std::memcpy(bytes.data(), data.data(), bytes.size());
  const nb::gil_scoped_release release;
  return Snapshot::from_bytes(std::move(bytes));
}

}  // namespace

void bind_snapshot(nb::module_& m) {
  bind_error<SnapshotError>(
      m, "SnapshotError",
      "A truncated or corrupt snapshot, or one of another plan, task or precision.");

  nb::class_<Snapshot>(
      m, "Snapshot",
      "The complete state of worlds of a Batch, created by Batch.save().\n\n"
      "It does not depend on lanes, threads or indices of worlds. Worlds continue with bitwise "
      "equal\n"
      "results in every batch of the plan. Can be pickled.")
      .def_prop_ro("worlds", &Snapshot::worlds, "Number of worlds.")
      .def_prop_ro("steps", &Snapshot::steps, "Number of steps of the batch.")
      .def_prop_ro("time", &Snapshot::time, "Simulated time of the batch, s.")
      .def_prop_ro("nbytes", &Snapshot::size, "Size in bytes.")
      .def("bytes", &bytes_of, "The contents of a file, for from_bytes().")
      .def_static("from_bytes", &from_bytes, nb::arg("data"),
                  "A snapshot from bytes(). Raises SnapshotError for truncated or corrupt data.")
      .def("save", &Snapshot::save, nb::arg("file"), nb::call_guard<nb::gil_scoped_release>(),
           "Writes a file, atomically. Raises SnapshotError.")
      .def_static("load", &Snapshot::load, nb::arg("file"),
                  nb::call_guard<nb::gil_scoped_release>(),
                  "Reads a file that save() wrote. Raises SnapshotError.")
      .def(
          "__eq__",
          [](const Snapshot& a, nb::handle b) {
            return nb::isinstance<Snapshot>(b) && nb::cast<const Snapshot&>(b).bytes() == a.bytes();
          },
          nb::arg("other").none())
      .def("__getstate__", &bytes_of)
      .def("__setstate__",
           [](Snapshot& self, const nb::bytes& data) { new (&self) Snapshot(from_bytes(data)); })
      .def("__repr__", [](const Snapshot& s) {
        return nb::str("<manyworlds.Snapshot: {} worlds, {} steps, {} bytes>")
            .format(s.worlds(), s.steps(), s.size());
      });
}

}  // namespace manyworlds::python
