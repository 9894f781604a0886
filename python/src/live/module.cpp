// The extension module manyworlds._live: a batch in a browser while it steps. A module of its own,
// so that programs without a page have no server in them.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <string>
#include <utility>

#include "manyworlds/live.hpp"
#include "python/src/errors.hpp"
#include "python/src/held_batch.hpp"

namespace manyworlds::python {

namespace nb = nanobind;

namespace {

// It keeps the batch alive, also after its close(), and takes turns with it.
class HeldLive {
 public:
  HeldLive(const HeldBatch& batch, const LiveOptions& options)
      : batch_(batch), live_(batch_.run([&](Batch& b) { return Live(b, options); })) {}
  ~HeldLive() { close(); }

  void apply(int steps) {
    batch_.run([&](Batch& b) { live_.apply(b, steps); });
  }
  void show() {
    batch_.run([&](Batch& b) { live_.show(b); });
  }
  void close() {
    const nb::gil_scoped_release release;
    live_.close();
  }
  const Live& live() const { return live_; }

 private:
  HeldBatch batch_;
  Live live_;
};

void make_live(HeldLive* self, const HeldBatch& batch, const std::filesystem::path& page,
               const std::string& title, int port, int worlds, int max_worlds,
               const std::filesystem::path& folder, bool parameters) {
  new (self) HeldLive(batch, {.page = page,
                              .title = title,
                              .port = port,
                              .worlds = worlds,
                              .max_worlds = max_worlds,
                              .folder = folder,
                              .parameters = parameters});
}

}  // namespace

NB_MODULE(_live, m) {
  m.doc() = "A batch in a browser while it steps. Private: use manyworlds.view.";
  nb::module_::import_("manyworlds._core");  // which has Batch
  bind_error<LiveError>(m, "LiveError", "The page cannot be served.");
  nb::class_<HeldLive>(m, "Live", "Private: use manyworlds.view.")
      .def("__init__", &make_live, nb::arg("batch"), nb::arg("page"), nb::arg("title"),
           nb::arg("port"), nb::arg("worlds"), nb::arg("max_worlds"), nb::arg("folder"),
           nb::arg("parameters"))
      .def("apply", &HeldLive::apply, nb::arg("steps"),
           "Applies requests of pages before a call of this number of steps.")
      .def("show", &HeldLive::show, "Sends the current state to pages.")
      .def("close", &HeldLive::close, "Stops the server.")
      .def_prop_ro("url", [](const HeldLive& self) { return self.live().url(); })
      .def_prop_ro("port", [](const HeldLive& self) { return self.live().port(); })
      .def_prop_ro("pages", [](const HeldLive& self) { return self.live().pages(); });
}

}  // namespace manyworlds::python
