// Where in a value from Python something is wrong: a chain on the stack, written out only when an
// error needs it.
#pragma once

#include <cstddef>
#include <string>

namespace manyworlds {
struct Scene;
}

namespace manyworlds::python {

struct Place {
  const Place* up = nullptr;
  const char* name = "";         // of a member, or of the whole
  std::ptrdiff_t index = -1;     // of an element, >= 0
  const Scene* scene = nullptr;  // whose names are meant

  Place member(const char* of) const { return {this, of, -1, scene}; }
  Place element(std::size_t i) const { return {this, "", static_cast<std::ptrdiff_t>(i), scene}; }

  std::string text() const {  // "scene.bodies[3].shapes[0].geometry"
    const std::string before = up ? up->text() : "";
    if (index >= 0) return before + "[" + std::to_string(index) + "]";
    return before.empty() ? name : before + "." + name;
  }
};

}  // namespace manyworlds::python
