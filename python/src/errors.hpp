// Exceptions of the library as Python sees them.
#pragma once

#include <nanobind/nanobind.h>

#include <exception>
#include <string_view>

namespace manyworlds::python {

// `Error` becomes a ValueError of that name; what() may hold file names, which need not be UTF-8.
template <class Error>
void bind_error(nanobind::module_& m, const char* name, const char* doc) {
  // Kept for as long as the interpreter runs, whatever becomes of the module.
  PyObject* type = nanobind::exception<Error>(m, name, PyExc_ValueError).inc_ref().ptr();
  nanobind::setattr(type, "__doc__", nanobind::str(doc));
  nanobind::register_exception_translator(
      [](const std::exception_ptr& thrown, void* payload) {
        try {
          std::rethrow_exception(thrown);
        } catch (const Error& error) {
          const std::string_view text = error.what();
          PyObject* decoded =
              PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
          if (decoded == nullptr) return;
          PyErr_SetObject(static_cast<PyObject*>(payload), decoded);
          Py_DECREF(decoded);
        }
      },
      type);
}

}  // namespace manyworlds::python
