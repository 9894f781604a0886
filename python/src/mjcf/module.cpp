// The extension module manyworlds._mjcf: scenes from MJCF files. A module of its own because it
// needs MuJoCo's library, which whoever wants it installs.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "manyworlds/mjcf.hpp"
#include "python/src/errors.hpp"
#include "python/src/scene_fields.hpp"

namespace manyworlds::python {

namespace {

template <class Load>
std::pair<nb::object, std::vector<std::string>> loaded(Load load) {
  const MjcfResult result = [&] {
    const nb::gil_scoped_release release;
    return load();
  }();
  return {to_python(result.scene), result.warnings};
}

}  // namespace

NB_MODULE(_mjcf, m) {
  m.doc() = "MJCF files. Private: use manyworlds.mjcf.";
  bind_error<MjcfError>(m, "MjcfError");
  m.def(
      "load",
      [](const std::filesystem::path& file) { return loaded([&] { return load_mjcf(file); }); },
      nb::arg("file"), "The scene of a file, and what acts otherwise than in MuJoCo.");
  m.def(
      "load_string",
      [](nb::object xml) {
        const std::string text = from_python<std::string>(xml, "xml");
        return loaded([&] { return load_mjcf_string(text); });
      },
      nb::arg("xml").none(), "The same of a text.");
}

}  // namespace manyworlds::python
