#include "convert.hpp"

#include <nanobind/stl/string.h>

namespace manyworlds::python {

namespace {

nb::object class_named(const char* name) { return nb::module_::import_("manyworlds").attr(name); }

// "int", "numpy.ndarray", and the bare name of a class that is written in Python. The stable ABI
// has no tp_name, which says the same.
std::string type_of(nb::handle value) {
  const nb::handle type = value.type();
  const std::string name = nb::cast<std::string>(type.attr("__name__"));
  const auto flags = PyType_GetFlags(reinterpret_cast<PyTypeObject*>(type.ptr()));
  const bool is_static = (flags & Py_TPFLAGS_HEAPTYPE) == 0;
  const std::string module =
      is_static ? nb::cast<std::string>(type.attr("__module__")) : std::string("builtins");
  return module == "builtins" ? name : module + "." + name;
}

}  // namespace

void wrong_type(const Place& place, nb::handle found, const std::string& expected) {
  throw nb::type_error(
      (place.text() + " is of type " + type_of(found) + "; expected " + expected).c_str());
}

void wrong_value(const Place& place, const std::string& what) {
  throw nb::value_error((place.text() + " " + what).c_str());
}

double read_number(nb::handle value, const Place& place) {
  if (PyFloat_CheckExact(value.ptr())) return PyFloat_AsDouble(value.ptr());
  if (PyBool_Check(value.ptr())) wrong_type(place, value, "a number");
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1 && PyErr_Occurred()) {
    const bool too_large = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    if (too_large) wrong_value(place, "exceeds the range of a float64");
    wrong_type(place, value, "a number");
  }
  return number;
}

long long read_integer(nb::handle value, const Place& place, long long low, long long high) {
  const nb::object number =
      PyBool_Check(value.ptr()) ? nb::object() : nb::steal(PyNumber_Index(value.ptr()));
  if (!number.is_valid()) {
    PyErr_Clear();
    wrong_type(place, value, "an integer");
  }
  int overflow = 0;
  const long long out = PyLong_AsLongLongAndOverflow(number.ptr(), &overflow);
  if (overflow != 0 || out < low || out > high) {
    wrong_value(place, std::string("is ") + nb::str(number).c_str() + ", must be " +
                           std::to_string(low) + " to " + std::to_string(high));
  }
  return out;
}

bool read_bool(nb::handle value, const Place& place) {
  if (PyBool_Check(value.ptr())) return value.ptr() == Py_True;
  const std::string type = type_of(value);
  if (type == "numpy.bool" || type == "numpy.bool_") return PyObject_IsTrue(value.ptr()) == 1;
  wrong_type(place, value, "a bool");
}

std::string read_text(nb::handle value, const Place& place) {
  if (!PyUnicode_Check(value.ptr())) wrong_type(place, value, "a str");
  Py_ssize_t size = 0;
  const char* text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (!text) {
    PyErr_Clear();
    wrong_value(place, "is not valid Unicode");
  }
  return {text, static_cast<std::size_t>(size)};
}

std::vector<nb::object> read_elements(nb::handle value, const Place& place, int count,
                                      const char* expected) {
  const auto wanted = [&] {
    return count < 0 ? std::string(expected) : std::to_string(count) + " " + expected;
  };
  if (PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()) ||
      !PySequence_Check(value.ptr())) {
    wrong_type(place, value, wanted());
  }
  const nb::object list = nb::steal(PySequence_List(value.ptr()));
  if (!list.is_valid()) {  // an array without dimensions, say
    PyErr_Clear();
    wrong_type(place, value, wanted());
  }
  const Py_ssize_t size = PyList_Size(list.ptr());
  if (count >= 0 && size != count) {
    wrong_value(place, "has " + std::to_string(size) + " elements; expected " + wanted());
  }
  std::vector<nb::object> out;
  out.reserve(static_cast<std::size_t>(size));
  for (Py_ssize_t i = 0; i < size; ++i) {
    out.push_back(nb::borrow(PyList_GetItem(list.ptr(), i)));
  }
  return out;
}

nb::object make_dataclass(const char* name, const nb::dict& members) {
  return class_named(name)(**members);
}

bool is_dataclass(nb::handle value, const char* name) {
  return nb::isinstance(value, class_named(name));
}

void check_dataclass(nb::handle value, const Place& place, const char* name) {
  if (!is_dataclass(value, name)) wrong_type(place, value, std::string("manyworlds.") + name);
}

}  // namespace manyworlds::python
