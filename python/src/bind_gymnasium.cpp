// Gymnasium's tasks of models: which there are, and a task of a scene and arguments.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "bind.hpp"
#include "manyworlds/gymnasium.hpp"
#include "task_fields.hpp"

namespace manyworlds::python {

namespace {

using gymnasium::Argument;

// A Python value of what an argument is.
nb::object value_of(const Argument& argument) {
  const auto [first, second] = argument.value;
  switch (argument.kind) {
    case Argument::Kind::integer: return nb::int_(static_cast<int>(first));
    case Argument::Kind::number: return nb::float_(first);
    case Argument::Kind::flag: return nb::bool_(first != 0);
    case Argument::Kind::range: return nb::make_tuple(first, second);
  }
  return nb::none();
}

void read(Argument& argument, nb::handle value) {
  const Place place{nullptr, argument.name, -1};
  switch (argument.kind) {
    case Argument::Kind::integer:
      argument.value[0] = static_cast<double>(read_integer(value, place, -(1 << 30), 1 << 30));
      return;
    case Argument::Kind::number: argument.value[0] = read_number(value, place); return;
    case Argument::Kind::flag: argument.value[0] = from_python<bool>(value, argument.name); return;
    case Argument::Kind::range: {
      const auto ends = read_elements(value, place, 2, "two numbers");
      for (std::size_t i = 0; i < 2; ++i) {
        argument.value[i] = read_number(ends[i], place.element(i));
      }
    }
  }
}

nb::object make_gymnasium_task(const std::string& name, nb::object scene,
                               const nb::dict& arguments) {
  const gymnasium::Entry* entry = gymnasium::find(name);
  if (!entry) throw nb::value_error(("there is no task '" + name + "'").c_str());
  std::vector<Argument> values = entry->arguments;
  for (Argument& value : values) {
    if (arguments.contains(value.name)) read(value, arguments[value.name]);
  }
  return to_python(entry->make(from_python<Scene>(scene, "scene"), values));
}

}  // namespace

void bind_gymnasium(nb::module_& m) {
  m.def(
      "gymnasium_tasks",
      [] {
        nb::dict out;
        for (const gymnasium::Entry& entry : gymnasium::all()) {
          nb::dict arguments;
          for (const Argument& argument : entry.arguments) {
            arguments[argument.name] = value_of(argument);
          }
          out[entry.name] = nb::make_tuple(entry.model, arguments);
        }
        return out;
      },
      "Gymnasium's tasks by name: model, and arguments with their defaults.");
  m.def("gymnasium_task", &make_gymnasium_task, nb::arg("name"), nb::arg("scene"),
        nb::arg("arguments"), "A Gymnasium task for a model. Unknown arguments are ignored.");
}

}  // namespace manyworlds::python
