// Floating-point modes that a caller may be in, and whether a call gives the same bytes in all.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace manyworlds::test {

// What a call gave, byte by byte.
class StateBytes {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void add(const std::string& text) { bytes_ += text + '\0'; }
  template <class T>
  void add(const std::vector<T>& values) {
    for (const T& value : values) add(value);
  }
  // Vectors and matrices.
  template <class Matrix>
  requires requires(const Matrix& m) { m.derived(); }
  void add(const Matrix& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) add(m(i));
  }
  bool operator==(const StateBytes&) const = default;
  bool empty() const { return bytes_.empty(); }

 private:
  std::string bytes_;
};

// Runs what it is given in a mode; see check_modes().
using InMode = std::function<void(const std::function<void()>&)>;

// A call, or several that belong together. It prepares what it wants, makes the calls by `in_mode`
// and gives what they gave.
struct ModeEntry {
  const char* name;
  std::function<StateBytes(const InMode& in_mode)> call;
};

// Each entry gives in every mode the bytes that it gives in the default one, and leaves the mode,
// and the exceptions that were raised in it, as they were.
void check_modes(const std::vector<ModeEntry>& entries);

}  // namespace manyworlds::test
