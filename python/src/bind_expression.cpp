// Expression with Python's operators; functions and terms with plain indices. Names, axes by letter
// and what else is convenient are the package's business (manyworlds/terms.py and
// tasks.py).
#include <array>
#include <cmath>
#include <string_view>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bind.hpp"
#include "expression_graph.hpp"
#include "quantities.hpp"
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

// `narrows`: what any two objects have, which here is an Expression.
template <class F>
void binary(nb::class_<Expression>& c, const char* name, F f, bool narrows = false) {
  const std::string operand_type = narrows ? "object" : "Expression | float";
  const std::string signature =
      "def " + std::string(name) + "(self, other: " + operand_type + ", /) -> Expression";
  c.def(
      name,
      [f](E self, nb::handle other) -> nb::object {
        if (!is_operand(other)) return nb::borrow(nb::handle(Py_NotImplemented));
        return nb::cast(f(self, operand(other)));
      },
      nb::is_operator(), nb::sig(signature.c_str()));
}
// With the operand on the left, too.
template <class F>
void binary(nb::class_<Expression>& c, const char* name, const char* reflected, F f) {
  binary(c, name, f);
  binary(c, reflected, [f](E self, E other) { return f(other, self); });
}

// Whole powers up to 64 are products, and 0.5 is the square root: exacter than others.
Expression power(E self, nb::handle exponent) {
  if (nb::isinstance<Expression>(exponent)) return pow(self, operand(exponent));
  const double n = from_python<double>(exponent, "the exponent");
  if (n == 0.5) return sqrt(self);
  if (!(std::abs(n) <= 64) || n != static_cast<int>(n)) return pow(self, n);
  if (n == 0) return 1;
  Expression out = self;
  for (int i = 1; i < std::abs(static_cast<int>(n)); ++i) out = out * self;
  return n < 0 ? 1 / out : out;
}

// A class as a namespace: stubs have no place for a module within a module.
struct FunctionsOfExpressions {};
using Functions = nb::class_<FunctionsOfExpressions>;

template <class F>
void one(Functions& m, const char* name, F f) {
  m.def_static(
      name, [f](nb::handle a) { return f(operand(a)); }, nb::arg("a"));
}
template <class F>
void two(Functions& m, const char* name, const char* second, F f) {
  m.def_static(
      name, [f](nb::handle a, nb::handle b) { return f(operand(a), operand(b)); }, nb::arg("a"),
      nb::arg(second));
}
template <class F>
void two(Functions& m, const char* name, F f) {
  two(m, name, "b", f);
}

void bind_operators(nb::class_<Expression>& c) {
  binary(c, "__add__", "__radd__", [](E a, E b) { return a + b; });
  binary(c, "__sub__", "__rsub__", [](E a, E b) { return a - b; });
  binary(c, "__mul__", "__rmul__", [](E a, E b) { return a * b; });
  binary(c, "__truediv__", "__rtruediv__", [](E a, E b) { return a / b; });
  binary(c, "__mod__", "__rmod__", [](E a, E b) { return mod(a, b); });
  binary(c, "__and__", "__rand__", [](E a, E b) { return a & b; });
  binary(c, "__or__", "__ror__", [](E a, E b) { return a | b; });
  binary(c, "__lt__", [](E a, E b) { return a < b; });
  binary(c, "__le__", [](E a, E b) { return a <= b; });
  binary(c, "__gt__", [](E a, E b) { return a > b; });
  binary(c, "__ge__", [](E a, E b) { return a >= b; });
  binary(
      c, "__eq__", [](E a, E b) { return equal(a, b); }, true);
  binary(
      c, "__ne__", [](E a, E b) { return !equal(a, b); }, true);
  c.def("__neg__", [](E a) { return -a; })
      .def("__pos__", [](E a) { return a; })
      .def("__invert__", [](E a) { return !a; })
      .def("__abs__", [](E a) { return abs(a); })
      .def("__pow__", &power, nb::arg("exponent"))
      .def(
          "__rpow__", [](E self, nb::handle base) { return pow(operand(base), self); },
          nb::arg("base"))
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

// What pickles and repr() are made of.
void bind_values(nb::module_& m, nb::class_<Expression>& c) {
  m.def("expression_graph", &values_of, nb::arg("roots"),
        nb::sig("def expression_graph(roots: Sequence[Expression]) -> "
                "tuple[list[tuple[str | int | float, ...]], list[int]]"),
        "(nodes, roots): expressions as plain values, without duplicates.");
  m.def("expressions_of_graph", &from_values, nb::arg("nodes"), nb::arg("roots"),
        "The expressions of a graph. Raises TypeError and ValueError.");
  c.def(
       "__repr__", [](E a) { return "<manyworlds.Expression " + text_of(a, 400) + ">"; },
       "The text of str(), cut to about 400 characters.")
      .def(
          "__str__", [](E a) { return to_string(a); },
          "The expression in Python's syntax. Beyond 20,000 characters, deeply nested "
          "subexpressions are \"...\".");
}

Observed observed_named(const std::string& name) {
  std::vector<std::string> known;
  for (const ObservedInfo& what : kObservedInfo) {
    if (name == what.name) return Observed(&what - kObservedInfo);
    known.emplace_back(what.name);
  }
  throw nb::value_error(("the observed number " + unknown_name(name, known)).c_str());
}

// Of what has it: "world", "body", "shape" (`body` and `shape`), "joint", "control", "attractor".
Expression parameter_of(nb::handle parameter, const std::string& owner, int index, int shape,
                        int component) {
  const auto of = from_python<Parameter>(parameter, "the parameter");
  if (owner == "world") return terms::parameter(of, component);
  if (owner == "body") return terms::parameter(of, BodyId(index), component);
  if (owner == "shape") return terms::parameter(of, ShapeId(BodyId(index), shape), component);
  if (owner == "joint") return terms::parameter(of, JointId(index), component);
  if (owner == "attractor") return terms::attractor_parameter(of, index, component);
  return terms::parameter(of, ControlId(index), component);
}

using RandomTerm = Expression (*)(std::string_view, Every, E, E);
void bind_random(Functions& m, const char* name, RandomTerm term, const char* first,
                 const char* second) {
  m.def_static(
      name,
      [term](const std::string& of, nb::handle every, nb::handle a, nb::handle b) {
        return term(of, from_python<Every>(every, "every"), operand(a), operand(b));
      },
      nb::arg("name"), nb::arg("every"), nb::arg(first), nb::arg(second));
}

void bind_terms(Functions& m) {
  const auto of_body = [&m](const char* name, auto term) {
    m.def_static(
        name, [term](int body, int axis) { return term(BodyId(body), axis); }, nb::arg("body"),
        nb::arg("axis"));
  };
  of_body("position", terms::position);
  of_body("velocity", terms::velocity);
  of_body("angular_velocity", terms::angular_velocity);
  m.def_static(
      "angle", [](int body) { return terms::angle(BodyId(body)); }, nb::arg("body"));
  m.def_static(
      "direction",
      [](int body, int of, int axis) { return terms::direction(BodyId(body), of, axis); },
      nb::arg("body"), nb::arg("of"), nb::arg("axis"));
  m.def_static(
      "observed",
      [](const std::string& what, int item, int component) {
        return terms::observed(observed_named(what), item, component);
      },
      nb::arg("what"), nb::arg("item"), nb::arg("component"));
  m.def_static("generalized_position", &terms::generalized_position, nb::arg("coordinate"));
  m.def_static("generalized_velocity", &terms::generalized_velocity, nb::arg("dof"));
  m.def_static("action", &terms::action, nb::arg("index"));
  m.def_static(
      "control", [](int index) { return terms::control(ControlId(index)); }, nb::arg("index"));
  m.def_static("age", &terms::age);
  m.def_static("lost", &terms::lost);
  bind_random(m, "uniform", terms::uniform, "low", "high");
  bind_random(m, "normal", terms::normal, "mean", "deviation");
  m.def_static("parameter", &parameter_of, nb::arg("parameter"), nb::arg("owner"), nb::arg("index"),
               nb::arg("shape"), nb::arg("component"));
  m.def_static(
      "level", [](const std::string& name) { return terms::level(name); }, nb::arg("name"));
  m.def_static(
      "memory", [](const std::string& name) { return terms::memory(name); }, nb::arg("name"));
  m.def_static("time_step", &terms::time_step);
  one(m, "previous", terms::previous);
  m.def_static(
      "delayed", [](nb::handle a, int steps) { return terms::delayed(operand(a), steps); },
      nb::arg("a"), nb::arg("steps"));
  m.def_static(
      "delayed_by",
      [](nb::handle a, nb::handle steps, int max_steps) {
        return terms::delayed(operand(a), operand(steps), max_steps);
      },
      nb::arg("a"), nb::arg("steps"), nb::arg("max_steps"));
  one(m, "held", terms::held);
  one(m, "largest", terms::largest);
  one(m, "latched", terms::latched);
  one(m, "summed", terms::summed);
  two(m, "smoothed", "factor", terms::smoothed);
  two(m, "smoothed_over", "time_constant", terms::smoothed_over);
  one(m, "phase", terms::phase);
}

}  // namespace

void bind_expression(nb::module_& parent) {
  parent.def(
      "item_of",
      [](const std::string& what) {
        return word_of(info(info(observed_named(what)).observer).item);
      },
      nb::arg("what"), "Owner of an observed field: \"world\", \"body\", \"joint\", ...");
  nb::class_<Expression> c(parent, "Expression",
                           "A value of every world, computed after each step of a task.");
  c.def(
      "__init__",
      [](Expression* self, nb::handle number) { new (self) Expression(operand(number)); },
      nb::arg("number") = 0);
  bind_operators(c);
  bind_values(parent, c);
  Functions m(parent, "expressions", "Functions and terms of expressions.");
  one(m, "sin", [](E a) { return sin(a); });
  one(m, "cos", [](E a) { return cos(a); });
  one(m, "exp", [](E a) { return exp(a); });
  one(m, "log", [](E a) { return log(a); });
  one(m, "tanh", [](E a) { return tanh(a); });
  one(m, "arccos", [](E a) { return acos(a); });
  one(m, "sign", [](E a) { return sign(a); });
  two(m, "mod", [](E a, E b) { return mod(a, b); });
  two(m, "power", [](E a, E b) { return pow(a, b); });
  one(m, "sqrt", [](E a) { return sqrt(a); });
  one(m, "floor", [](E a) { return floor(a); });
  two(m, "minimum", [](E a, E b) { return min(a, b); });
  two(m, "maximum", [](E a, E b) { return max(a, b); });
  two(m, "arctan2", [](E y, E x) { return atan2(y, x); });
  m.def_static(
      "where",
      [](nb::handle condition, nb::handle yes, nb::handle no) {
        return select(operand(condition), operand(yes), operand(no));
      },
      nb::arg("condition"), nb::arg("yes"), nb::arg("no"));
  m.def_static(
      "clip",
      [](nb::handle a, nb::handle low, nb::handle high) {
        return clamp(operand(a), operand(low), operand(high));
      },
      nb::arg("a"), nb::arg("low"), nb::arg("high"));
  bind_terms(m);
}

}  // namespace manyworlds::python
