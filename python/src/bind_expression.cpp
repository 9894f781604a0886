// Expression with Python's operators; functions and terms with plain indices. Names, axes by letter
// and what else is convenient are the package's business (manyworlds/tasks.py).
#include <array>

#include "bind.hpp"
#include "task_fields.hpp"

namespace manyworlds::python {

namespace {

using E = const Expression&;

// An operand of an operator; others are Python's to judge (NotImplemented).
bool is_operand(nb::handle value) {
  return nb::isinstance<Expression>(value) || PyFloat_Check(value.ptr()) ||
         PyLong_Check(value.ptr()) || nb::hasattr(value, "__float__");
}
Expression operand(nb::handle value) { return from_python<Expression>(value, "the operand"); }

template <class F>
void binary(nb::class_<Expression>& c, const char* name, F f) {
  c.def(
      name,
      [f](E self, nb::handle other) -> nb::object {
        if (!is_operand(other)) return nb::borrow(nb::handle(Py_NotImplemented));
        return nb::cast(f(self, operand(other)));
      },
      nb::is_operator());
}
// With the operand on the left, too.
template <class F>
void binary(nb::class_<Expression>& c, const char* name, const char* reflected, F f) {
  binary(c, name, f);
  binary(c, reflected, [f](E self, E other) { return f(other, self); });
}

Expression power(E self, nb::handle exponent) {
  const double n = from_python<double>(exponent, "the exponent");
  if (n == 0.5) return sqrt(self);
  if (!(n >= 0 && n <= 64) || n != static_cast<int>(n)) {
    throw nb::value_error("expressions have the powers 0 to 64 and 0.5; use exp for others");
  }
  if (n == 0) return 1;
  Expression out = self;
  for (int i = 1; i < static_cast<int>(n); ++i) out = out * self;
  return out;
}

template <class F>
void one(nb::module_& m, const char* name, F f) {
  m.def(
      name, [f](nb::handle a) { return f(operand(a)); }, nb::arg("a"));
}
template <class F>
void two(nb::module_& m, const char* name, F f) {
  m.def(
      name, [f](nb::handle a, nb::handle b) { return f(operand(a), operand(b)); }, nb::arg("a"),
      nb::arg("b"));
}

void bind_operators(nb::class_<Expression>& c) {
  binary(c, "__add__", "__radd__", [](E a, E b) { return a + b; });
  binary(c, "__sub__", "__rsub__", [](E a, E b) { return a - b; });
  binary(c, "__mul__", "__rmul__", [](E a, E b) { return a * b; });
  binary(c, "__truediv__", "__rtruediv__", [](E a, E b) { return a / b; });
  binary(c, "__and__", "__rand__", [](E a, E b) { return a & b; });
  binary(c, "__or__", "__ror__", [](E a, E b) { return a | b; });
  binary(c, "__lt__", [](E a, E b) { return a < b; });
  binary(c, "__le__", [](E a, E b) { return a <= b; });
  binary(c, "__gt__", [](E a, E b) { return a > b; });
  binary(c, "__ge__", [](E a, E b) { return a >= b; });
  binary(c, "__eq__", [](E a, E b) { return equal(a, b); });
  binary(c, "__ne__", [](E a, E b) { return !equal(a, b); });
  c.def("__neg__", [](E a) { return -a; })
      .def("__pos__", [](E a) { return a; })
      .def("__invert__", [](E a) { return !a; })
      .def("__abs__", [](E a) { return abs(a); })
      .def("__pow__", &power, nb::arg("exponent"))
      .def("__hash__",
           [](nb::handle self) { return reinterpret_cast<std::intptr_t>(self.ptr()) >> 4; })
      .def("__copy__", [](nb::object self) { return self; })
      .def(
          "__deepcopy__", [](nb::object self, nb::handle) { return self; }, nb::arg("memo"))
      .def("__bool__", [](E) -> bool {
        throw nb::type_error(
            "an Expression has no truth value while a task is composed: use & | ~ for and, or, "
            "not, "
            "where(...) for if, and (a < b) & (b < c) for a < b < c");
      });
  c.attr("__array_ufunc__") = nb::none();  // NumPy numbers leave operators to us
}

void bind_terms(nb::module_& m) {
  m.def("position", &terms::position, nb::arg("body"), nb::arg("axis"));
  m.def("velocity", &terms::velocity, nb::arg("body"), nb::arg("axis"));
  m.def("angular_velocity", &terms::angular_velocity, nb::arg("body"), nb::arg("axis"));
  m.def("angle", &terms::angle, nb::arg("body"));
  m.def("direction", &terms::direction, nb::arg("body"), nb::arg("of"), nb::arg("axis"));
  m.def("joint_position", &terms::joint_position, nb::arg("joint"), nb::arg("coordinate"));
  m.def("joint_speed", &terms::joint_speed, nb::arg("joint"), nb::arg("coordinate"));
  m.def("touching", &terms::touching, nb::arg("body"));
  m.def("ray_distance", &terms::ray_distance, nb::arg("ray"));
  m.def("action", &terms::action, nb::arg("index"));
  m.def("control", &terms::control, nb::arg("index"));
  m.def("age", &terms::age);
  m.def("lost", &terms::lost);
  one(m, "previous", terms::previous);
  one(m, "held", terms::held);
  one(m, "largest", terms::largest);
}

}  // namespace

void bind_expression(nb::module_& parent) {
  nb::class_<Expression> c(parent, "Expression",
                           "A number of every world, worked out after each step of a task.");
  c.def(
      "__init__",
      [](Expression* self, nb::handle number) { new (self) Expression(operand(number)); },
      nb::arg("number") = 0);
  bind_operators(c);
  nb::module_ m = parent.def_submodule("expressions", "Functions and terms of expressions.");
  one(m, "sin", [](E a) { return sin(a); });
  one(m, "cos", [](E a) { return cos(a); });
  one(m, "exp", [](E a) { return exp(a); });
  one(m, "sqrt", [](E a) { return sqrt(a); });
  one(m, "floor", [](E a) { return floor(a); });
  two(m, "minimum", [](E a, E b) { return min(a, b); });
  two(m, "maximum", [](E a, E b) { return max(a, b); });
  two(m, "arctan2", [](E y, E x) { return atan2(y, x); });
  m.def(
      "where",
      [](nb::handle condition, nb::handle yes, nb::handle no) {
        return select(operand(condition), operand(yes), operand(no));
      },
      nb::arg("condition"), nb::arg("yes"), nb::arg("no"));
  m.def(
      "clip",
      [](nb::handle a, nb::handle low, nb::handle high) {
        return clamp(operand(a), operand(low), operand(high));
      },
      nb::arg("a"), nb::arg("low"), nb::arg("high"));
  bind_terms(m);
}

}  // namespace manyworlds::python
