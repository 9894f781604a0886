// Tasks that have a name, what is wrong with a task, and Environment: actions in, arrays out.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bind.hpp"
#include "held_batch.hpp"
#include "interrupts.hpp"
#include "manyworlds/tasks.hpp"
#include "task_fields.hpp"

namespace manyworlds::python {

namespace {

class HeldEnvironment : public Held<Environment> {
 public:
  HeldEnvironment(const Task& task, const EnvironmentOptions& options)
      : Held(std::make_shared<Environment>(task, options), "Environment") {}
};

template <class T>
using MaybeOut = std::optional<Out<T>>;

template <class T>
std::span<T> span_or_none(const MaybeOut<T>& array) {
  return array ? span_of(*array) : std::span<T>();
}
std::span<std::uint8_t> flags(const MaybeOut<bool>& array) {
  if (!array) return {};
  return {reinterpret_cast<std::uint8_t*>(array->data()), array->size()};
}

void make(HeldEnvironment* self, nb::object task, nb::object worlds, nb::object threads,
          std::uint64_t seed, nb::object precision, nb::object isa, nb::object autoreset,
          bool check) {
  const Task t = from_python<Task>(task, "task");
  EnvironmentOptions options;
  options.worlds = from_python<int>(worlds, "worlds");
  options.threads = from_python<int>(threads, "threads");
  options.seed = seed;
  options.precision = from_python<Precision>(precision, "precision");
  options.isa = from_python<std::optional<Isa>>(isa, "isa");
  options.autoreset = from_python<Autoreset>(autoreset, "autoreset");
  options.check = check;
  const nb::gil_scoped_release release;
  new (self) HeldEnvironment(t, options);
}

// Observations are wanted as float32 or as float64, or not.
using ObservationsOut = std::optional<std::variant<Out<float>, Out<double>>>;

template <class T>
std::span<T> span_if(const ObservationsOut& array) {
  const auto* of = array ? std::get_if<Out<T>>(&*array) : nullptr;
  return of ? span_of(*of) : std::span<T>();
}

StepArrays arrays_of(const ObservationsOut& observations, const MaybeOut<double>& rewards,
                     const MaybeOut<bool>& terminated, const MaybeOut<bool>& truncated,
                     const MaybeOut<double>& reward_terms,
                     const ObservationsOut& final_observations, const MaybeOut<double>& infos,
                     const MaybeOut<double>& final_infos, const MaybeOut<bool>& lost) {
  return {.observations = span_if<float>(observations),
          .final_observations = span_if<float>(final_observations),
          .rewards = span_or_none(rewards),
          .reward_terms = span_or_none(reward_terms),
          .terminated = flags(terminated),
          .truncated = flags(truncated),
          .observations_f64 = span_if<double>(observations),
          .final_observations_f64 = span_if<double>(final_observations),
          .infos = span_or_none(infos),
          .final_infos = span_or_none(final_infos),
          .lost = flags(lost)};
}

BeginArrays arrays_of(const ObservationsOut& observations, const MaybeOut<double>& infos) {
  BeginArrays out;
  out.observations = span_if<float>(observations);
  out.observations_f64 = span_if<double>(observations);
  out.infos = span_or_none(infos);
  return out;
}

// f(environment, go on), without the GIL. What is over by then is taken to its end, so that a
// signal rarely meets the middle of a step.
// Returns how many expressions have not been finite so far.
template <class F>
int run_step(HeldEnvironment& self, F f) {
  constexpr std::chrono::milliseconds kWhole(150);
  int faults = 0;
  self.run([&](Environment& e) {
    Interrupts::during([&](const GoOn& go_on) { return f(e, go_on); }, kWhole);
    faults = e.non_finite_expressions();
  });
  return faults;
}

template <class T>
int step(HeldEnvironment& self, const In<T>& actions, const ObservationsOut& observations,
         const MaybeOut<double>& rewards, const MaybeOut<bool>& terminated,
         const MaybeOut<bool>& truncated, const MaybeOut<double>& reward_terms,
         const ObservationsOut& final_observations, const MaybeOut<double>& infos,
         const MaybeOut<double>& final_infos, const MaybeOut<bool>& lost) {
  const StepArrays out = arrays_of(observations, rewards, terminated, truncated, reward_terms,
                                   final_observations, infos, final_infos, lost);
  return run_step(self, [&](Environment& e, const GoOn& go_on) {
    return e.step(span_of(actions), out, go_on);
  });
}

int finish_step(HeldEnvironment& self, const ObservationsOut& observations,
                const MaybeOut<double>& rewards, const MaybeOut<bool>& terminated,
                const MaybeOut<bool>& truncated, const MaybeOut<double>& reward_terms,
                const ObservationsOut& final_observations, const MaybeOut<double>& infos,
                const MaybeOut<double>& final_infos, const MaybeOut<bool>& lost) {
  const StepArrays out = arrays_of(observations, rewards, terminated, truncated, reward_terms,
                                   final_observations, infos, final_infos, lost);
  return run_step(self,
                  [&](Environment& e, const GoOn& go_on) { return e.finish_step(out, go_on); });
}

void def_steps(nb::class_<HeldEnvironment>& c) {
  const auto out = [](const char* array) { return nb::arg(array).noconvert().none(); };
  const auto def = [&](const char* name, auto f, const char* text, auto... actions) {
    c.def(name, f, actions..., out("observations"), out("rewards"), out("terminated"),
          out("truncated"), out("reward_terms"), out("final_observations"), out("infos"),
          out("final_infos"), out("lost"), text);
  };
  const char* const text =
      "Takes one step of the task in all worlds, without the GIL. Fills the arrays that are not "
      "None. Returns the number of expressions with non-finite values so far.";
  const auto actions = nb::arg("actions").noconvert();
  def("step_choices", &step<std::int64_t>, text, actions);
  def("step_numbers", &step<float>, text, actions);
  def("finish_step", &finish_step, "Completes a step that was ended early.");
}

// As run_step().
template <class F>
int run_beginning(HeldEnvironment& self, F f) {
  int faults = 0;
  self.run([&](Environment& e) {
    f(e);
    faults = e.non_finite_expressions();
  });
  return faults;
}

int reset(HeldEnvironment& self, const In<std::uint8_t>& mask,
          const std::optional<In<std::uint64_t>>& seeds, const ObservationsOut& observations,
          const MaybeOut<double>& infos) {
  const BeginArrays out = arrays_of(observations, infos);
  return run_beginning(self, [&](Environment& e) {
    if (seeds) {
      e.reset(span_of(mask), span_of(*seeds), out);
    } else {
      e.reset(span_of(mask), out);
    }
  });
}

int begin(HeldEnvironment& self, const In<std::uint8_t>& mask, const ObservationsOut& observations,
          const MaybeOut<double>& infos) {
  const BeginArrays out = arrays_of(observations, infos);
  return run_beginning(self, [&](Environment& e) { e.begin(span_of(mask), out); });
}

// (expression, world, step, value) of the first fault of each expression.
nb::list non_finite(HeldEnvironment& self) {
  nb::list out;
  for (const NonFinite& f : self.with([](Environment& e) { return e.non_finite(); })) {
    out.append(nb::make_tuple(f.expression, f.world, f.step, f.value));
  }
  return out;
}

void evaluate(HeldEnvironment& self, nb::handle expression, const Out<double>& out) {
  const auto e = from_python<Expression>(expression, "expression");
  self.run([&](Environment& environment) { environment.evaluate(e, span_of(out)); });
}

// A FloatingPointError with the members of NonFinite.
void bind_non_finite_error(nb::module_& m) {
  PyObject* type =
      nb::exception<NonFiniteError>(m, "NonFiniteError", PyExc_FloatingPointError).inc_ref().ptr();
  nb::setattr(
      type, "__doc__",
      nb::str("An observation, a reward or an end of Environment(check=True) is not finite. "
              "Members: `expression`, `world`, `step` (of the world's episode), `value`."));
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void* payload) {
        try {
          std::rethrow_exception(thrown);
        } catch (const NonFiniteError& error) {
          const NonFinite& f = error.fault();
          nb::object made = nb::handle(static_cast<PyObject*>(payload))(nb::str(error.what()));
          made.attr("expression") = nb::str(f.expression.c_str(), f.expression.size());
          made.attr("world") = f.world;
          made.attr("step") = f.step;
          made.attr("value") = f.value;
          PyErr_SetObject(static_cast<PyObject*>(payload), made.ptr());
        }
      },
      type);
}

using MemoryIn = In<double>;

nb::tuple save(HeldEnvironment& self) {
  EnvironmentSnapshot saved = self.run([](Environment& e) { return e.save(); });
  const auto worlds = static_cast<std::size_t>(saved.worlds.worlds());
  const std::size_t numbers = saved.memory.size() / worlds;
  return nb::make_tuple(std::move(saved.worlds), saved.task,
                        owned(std::move(saved.memory), {worlds, numbers}));
}

// With `pairs`: world pairs[2 i] of the snapshot into world pairs[2 i + 1].
void restore(HeldEnvironment& self, const Snapshot& worlds, std::uint64_t task,
             const MemoryIn& memory, const std::optional<Ids>& pairs) {
  const auto numbers = span_of(memory);
  const EnvironmentSnapshot saved{worlds, task, {numbers.begin(), numbers.end()}};
  self.run([&](Environment& e) {
    if (!pairs) return e.restore(saved);
    const auto p = span_of(*pairs);
    for (std::size_t i = 0; i + 1 < p.size(); i += 2) e.restore(saved, p[i], p[i + 1]);
  });
}

// The environment's own batch: it keeps the environment alive, and takes turns with it.
HeldBatch* batch_of(HeldEnvironment& self) {
  return self.with([&](Environment& e) {
    const auto owner = self.share();
    return new HeldBatch(std::shared_ptr<Batch>(owner, &e.batch()), self.busy());
  });
}

nb::object load(const std::string& name) {
  if (const tasks::Entry* entry = tasks::find(name)) return to_python(entry->make());
  std::vector<std::string> known;
  for (const tasks::Entry& entry : tasks::all()) known.emplace_back(entry.name);
  throw nb::value_error(("the task " + unknown_name(name, known)).c_str());
}

void bind_tasks(nb::module_& m) {
  m.def("load_task", &load, nb::arg("name"), "The task with this name.");
  m.def(
      "task_names",
      [] {
        std::vector<std::pair<std::string, std::string>> out;
        for (const tasks::Entry& entry : tasks::all()) out.emplace_back(entry.name, entry.summary);
        return out;
      },
      "(name, summary) of every named task.");
  m.def(
      "validate_task",
      [](nb::object task) {
        std::vector<std::pair<std::string, std::string>> out;
        for (const Issue& issue : validate(from_python<Task>(task, "task"))) {
          out.emplace_back(issue.place, issue.message);
        }
        return out;
      },
      nb::arg("task"), "All issues of a task and its scene as (place, message).");
  m.def(
      "default_task_values",
      [] {
        nb::dict out;
        out["Action"] = to_python(Action{});
        out["Info"] = to_python(Info{});
        out["Level"] = to_python(Level{});
        out["Memory"] = to_python(Memory{});
        out["InitialParameter"] = to_python(InitialParameter{});
        out["Task"] = to_python(Task{});
        return out;
      },
      "The library's default values of a task's dataclasses, by their names.");
}

}  // namespace

void bind_environment(nb::module_& m) {
  bind_tasks(m);
  bind_non_finite_error(m);
  nb::class_<HeldEnvironment> c(m, "Environment",
                                "A task in many worlds. Private: use manyworlds.Environment.");
  c.def("__init__", &make, nb::arg("task"), nb::arg("worlds"), nb::arg("threads"), nb::arg("seed"),
        nb::arg("precision"), nb::arg("isa").none(), nb::arg("autoreset"), nb::arg("check") = false)
      .def("close", &HeldEnvironment::close)
      .def_prop_ro("closed", &HeldEnvironment::closed)
      .def_prop_ro(
          "actions",
          [](HeldEnvironment& s) { return s.with([](Environment& e) { return e.actions(); }); })
      .def_prop_ro(
          "steps_left",
          [](HeldEnvironment& s) { return s.with([](Environment& e) { return e.steps_left(); }); })
      .def("reset", &reset, nb::arg("mask").noconvert(), nb::arg("seeds").noconvert().none(),
           nb::arg("observations").noconvert().none(), nb::arg("infos").noconvert().none())
      .def("begin", &begin, nb::arg("mask").noconvert(), nb::arg("observations").noconvert().none(),
           nb::arg("infos").noconvert().none())
      .def(
          "read_levels",
          [](HeldEnvironment& self, const Out<double>& out) {
            self.run([&](Environment& e) { e.read_levels(span_of(out)); });
          },
          nb::arg("out").noconvert())
      .def(
          "write_levels",
          [](HeldEnvironment& self, const In<std::uint8_t>& mask, const In<double>& in) {
            self.run([&](Environment& e) { e.write_levels(span_of(mask), span_of(in)); });
          },
          nb::arg("mask").noconvert(), nb::arg("levels").noconvert())
      .def(
          "copy_world",
          [](HeldEnvironment& self, int source, int target) {
            self.run([&](Environment& e) { e.copy_world(source, target); });
          },
          nb::arg("source"), nb::arg("target"))
      .def("save", &save, "(Snapshot of all worlds, fingerprint of the task, its memories).")
      .def("restore", &restore, nb::arg("worlds"), nb::arg("task"), nb::arg("memory").noconvert(),
           nb::arg("pairs").noconvert().none(),
           "Restores all worlds, or pairs (world of the snapshot, world of the environment).")
      .def("non_finite", &non_finite,
           nb::sig("def non_finite(self) -> list[tuple[str, int, int, float]]"),
           "(expression, world, step, value) of the first fault of each expression.")
      .def("evaluate", &evaluate, nb::arg("expression"), nb::arg("out").noconvert(),
           "The value of an expression in every world.")
      .def("batch", &batch_of, nb::rv_policy::take_ownership);
  def_steps(c);
}

}  // namespace manyworlds::python
