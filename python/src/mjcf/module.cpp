// The extension module manyworlds._mjcf: scenes from MJCF files. A module of its own because it
// needs MuJoCo's library, which whoever wants it installs.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <map>

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

MjcfOptions options(const std::vector<std::filesystem::path>& roots,
                    const std::map<std::string, std::int64_t>& limits) {
  MjcfOptions result;
  result.roots = roots;
  for (const auto& [name, value] : limits) mjcf_limit(result.limits, name) = value;
  return result;
}

}  // namespace

NB_MODULE(_mjcf, m) {
  m.doc() = "MJCF files. Private: use manyworlds.mjcf.";
  bind_error<MjcfError>(m, "MjcfError",
                        "Errors and unsupported elements of an MJCF file, one per line.");
  m.def(
      "load",
      [](const std::filesystem::path& file, const std::vector<std::filesystem::path>& roots,
         const std::map<std::string, std::int64_t>& limits) {
        return loaded([&, with = options(roots, limits)] { return load_mjcf(file, with); });
      },
      nb::arg("file"), nb::arg("roots"), nb::arg("limits"),
      "The scene of a file, and its differences from MuJoCo.");
  m.def(
      "load_string",
      [](nb::object xml, const std::vector<std::filesystem::path>& roots,
         const std::map<std::string, std::int64_t>& limits) {
        const std::string text = from_python<std::string>(xml, "xml");
        return loaded([&, with = options(roots, limits)] { return load_mjcf_string(text, with); });
      },
      nb::arg("xml").none(), nb::arg("roots"), nb::arg("limits"), "As load, for a text.");
  m.def(
      "limits",
      [] {
        std::map<std::string, std::int64_t> values;
        MjcfLimits limits;
        for (const std::string& name : mjcf_limit_names()) values[name] = mjcf_limit(limits, name);
        return values;
      },
      "The default limits.");
}

}  // namespace manyworlds::python
