#include "src/scene/checks.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace manyworlds::detail {
namespace {

constexpr std::array<const char*, 3> kAxis = {".x", ".y", ".z"};

std::string component(std::string_view field, int axis) {
  return std::string(field) + kAxis[static_cast<std::size_t>(axis)];
}

// "is -0.2 m"
std::string found(double value, std::string_view unit) {
  std::string text = "is " + number_text(value);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

}  // namespace

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string vector_text(const Vec2& value) {
  return "(" + number_text(value.x()) + ", " + number_text(value.y()) + ")";
}

std::string vector_text(const Vec3& value) {
  return "(" + number_text(value.x()) + ", " + number_text(value.y()) + ", " +
         number_text(value.z()) + ")";
}

std::string element_name(std::string_view field, std::size_t index) {
  return std::string(field) + "[" + std::to_string(index) + "]";
}

Checker Checker::at(const std::string& part) const {
  return {*issues_, space_, part_.empty() ? part : part_ + ", " + part};
}

void Checker::add(std::string_view field, std::string message) {
  std::string place = part_;
  if (!place.empty()) place += ": ";
  place += field;
  issues_->push_back({std::move(place), std::move(message)});
}

bool Checker::finite(std::string_view field, double value, std::string_view unit) {
  if (std::abs(value) <= kLargestFinite) return true;
  add(field, found(value, unit) + ", must be finite" +
                 (std::isfinite(value) ? " in float32 (up to 3.4e38)" : ""));
  return false;
}

bool Checker::not_negative(std::string_view field, double value, std::string_view unit) {
  if (value < 0 || std::isnan(value)) {
    add(field, found(value, unit) + ", must be >= 0");
    return false;
  }
  return finite(field, value, unit);
}

bool Checker::positive(std::string_view field, double value, std::string_view unit, double smallest,
                       double largest) {
  if (value >= smallest && value <= largest) return true;
  std::string expected = ", must be > 0";
  if (value > 0) {
    expected = ", must be between " + number_text(smallest) + " and " + number_text(largest);
  }
  add(field, found(value, unit) + expected);
  return false;
}

bool Checker::between(std::string_view field, double value, double low, double high) {
  if (value >= low && value <= high) return true;
  add(field,
      found(value, "") + ", must be between " + number_text(low) + " and " + number_text(high));
  return false;
}

bool Checker::zero_in_plane(std::string_view field, double value, std::string_view unit) {
  if (!finite(field, value, unit)) return false;
  if (value == 0) return true;
  add(field, found(value, unit) + ", must be 0 in a planar scene");
  return false;
}

bool Checker::finite(std::string_view field, const Vec3& value, std::string_view unit) {
  bool good = true;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = planar() && axis == 2;
    const std::string name = component(field, axis);
    good &= flat ? zero_in_plane(name, value[axis], unit) : finite(name, value[axis], unit);
  }
  return good;
}

bool Checker::not_negative(std::string_view field, const Vec3& value, std::string_view unit) {
  bool good = true;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = planar() && axis == 2;
    const std::string name = component(field, axis);
    good &= flat ? zero_in_plane(name, value[axis], unit) : not_negative(name, value[axis], unit);
  }
  return good;
}

bool Checker::finite_axial(std::string_view field, const Vec3& value, std::string_view unit) {
  bool good = true;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = planar() && axis != 2;
    const std::string name = component(field, axis);
    good &= flat ? zero_in_plane(name, value[axis], unit) : finite(name, value[axis], unit);
  }
  return good;
}

bool Checker::not_negative_axial(std::string_view field, const Vec3& value, std::string_view unit) {
  bool good = true;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = planar() && axis != 2;
    const std::string name = component(field, axis);
    good &= flat ? zero_in_plane(name, value[axis], unit) : not_negative(name, value[axis], unit);
  }
  return good;
}

bool Checker::rotation(std::string_view field, const Quat& value) {
  // Below this length nothing but rounding is left of the direction that was meant.
  constexpr double kZeroLength = 1e-12;
  constexpr double kAboutZ = 1e-9;  // largest x and y of a unit quaternion about z

  const std::string prefix(field);
  bool good = finite(prefix + ".w", value.w(), "");
  good &= finite(prefix + ".x", value.x(), "");
  good &= finite(prefix + ".y", value.y(), "");
  good &= finite(prefix + ".z", value.z(), "");
  if (!good) return false;

  const double length = value.norm();
  if (length < kZeroLength) {
    add(field, "is a quaternion of length " + number_text(length) + ", must not be zero");
    return false;
  }
  if (planar() && std::hypot(value.x(), value.y()) > kAboutZ * length) {
    add(field, "rotates about another axis than z, must be about z in a planar scene");
    return false;
  }
  return true;
}

std::string named_part(const char* what, std::size_t index, const std::string& name) {
  std::string part = std::string(what) + " " + std::to_string(index);
  return name.empty() ? part : part + " '" + name + "'";
}

}  // namespace manyworlds::detail
