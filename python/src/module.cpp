// The extension module manyworlds._core. What people use is the package around it, which checks
// arguments and prepares arrays; this module is memory safe by itself, whatever it is given.
#include "bind.hpp"

NB_MODULE(_core, m) {
  m.doc() = "Compiled part of manyworlds. Private: use the package manyworlds.";
  namespace mw = manyworlds::python;
  mw::bind_names(m);
  mw::bind_scene(m);
  mw::bind_plan(m);
  mw::bind_query(m);
  mw::bind_snapshot(m);
  mw::bind_batch(m);
  mw::bind_expression(m);
  mw::bind_environment(m);
  mw::bind_gymnasium(m);
}
