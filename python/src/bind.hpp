// What module.cpp registers, one function per concept. A new concept is one file bind_<concept>.cpp
// and one line here and there.
#pragma once

#include <nanobind/nanobind.h>

namespace manyworlds::python {

class HeldBatch;  // held_batch.hpp

void bind_names(nanobind::module_& m);     // the enumerations' names
void bind_scene(nanobind::module_& m);     // scenes from and to Python, checks, scenes with a name
void bind_plan(nanobind::module_& m);      // Plan
void bind_query(nanobind::module_& m);     // queries on single shapes
void bind_snapshot(nanobind::module_& m);  // Snapshot, SnapshotError
void bind_batch(nanobind::module_& m);     // Batch: construction, shape, stepping, resets
void bind_expression(nanobind::module_& m);   // Expression, its functions and terms
void bind_environment(nanobind::module_& m);  // tasks, Environment
void bind_gymnasium(nanobind::module_& m);    // tasks of Gymnasium's models

// The rest of Batch, by what it is about.
void bind_batch_state(nanobind::class_<HeldBatch>& c);  // fields as arrays, in place; controls
void bind_batch_inputs(
    nanobind::class_<HeldBatch>& c);  // forces, bodies and joints that come and go
void bind_batch_results(nanobind::class_<HeldBatch>& c);  // status, hashes, energy, contacts
void bind_batch_rollout(nanobind::class_<HeldBatch>& c);  // many steps in one call

}  // namespace manyworlds::python
