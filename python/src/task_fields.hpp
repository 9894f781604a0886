// The members of tasks, as scene_fields.hpp has those of scenes. Where the library wants an
// expression, Python may write a number.
#pragma once

#include "manyworlds/environment.hpp"
#include "scene_fields.hpp"

namespace manyworlds::python {

template <>
struct Names<Every> {
  static constexpr const char* kind = "Every";
  static constexpr Named<Every> all[] = {{Every::episode, "episode"}, {Every::step, "step"}};
};

template <>
struct Names<Autoreset> {
  static constexpr const char* kind = "Autoreset";
  static constexpr Named<Autoreset> all[] = {{Autoreset::next_step, "next_step"},
                                             {Autoreset::same_step, "same_step"},
                                             {Autoreset::disabled, "disabled"}};
};

template <>
struct Converter<Expression> {
  static Expression read(nb::handle value, const Place& place) {
    if (nb::isinstance<Expression>(value)) return nb::cast<Expression>(value);
    if (PyBool_Check(value.ptr())) return value.is(Py_True) ? 1 : 0;
    return read_number(value, place);
  }
  static nb::object write(const Expression& value) { return nb::cast(value); }
};

template <>
struct Described<Action> {
  static constexpr const char* name = "Action";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("low", s.low), visit("high", s.high);
    visit("clamped", s.clamped);
  }
};
template <>
struct Described<Observation> {
  static constexpr const char* name = "Observation";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("value", s.value), visit("low", s.low), visit("high", s.high);
  }
};
template <>
struct Described<Reward> {
  static constexpr const char* name = "Reward";
  static void fields(auto&& visit, auto& s) { visit("name", s.name), visit("value", s.value); }
};
template <>
struct Described<Info> {
  static constexpr const char* name = "Info";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("value", s.value);
    visit("of_steps_alone", s.of_steps_alone);
  }
};
template <>
struct Described<Level> {
  static constexpr const char* name = "Level";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("begin", s.begin), visit("next", s.next);
  }
};
template <>
struct Described<Memory> {
  static constexpr const char* name = "Memory";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("begin", s.begin), visit("next", s.next);
  }
};
template <>
struct Described<InitialParameter> {
  static constexpr const char* name = "InitialParameter";
  static void fields(auto&& visit, auto& s) {
    visit("parameter", s.parameter), visit("value", s.value);
  }
};
template <>
struct Described<Task> {
  static constexpr const char* name = "Task";
  static void fields(auto&& visit, auto& s) {
    visit("name", s.name), visit("scene", s.scene), visit("frame_skip", s.frame_skip);
    visit("choices", s.choices), visit("actions", s.actions), visit("controls", s.controls);
    visit("observations", s.observations), visit("rewards", s.rewards);
    visit("terminated", s.terminated), visit("truncated", s.truncated);
    visit("max_steps", s.max_steps), visit("solved_at", s.solved_at), visit("infos", s.infos);
    visit("levels", s.levels), visit("memories", s.memories);
    visit("initial_parameters", s.initial_parameters);
    visit("rays", s.rays), visit("points", s.points);
  }
};

}  // namespace manyworlds::python
