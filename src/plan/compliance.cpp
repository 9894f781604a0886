#include "src/plan/compliance.hpp"

#include <algorithm>
#include <cmath>

namespace manyworlds {

namespace {

constexpr double kMinImpedance = 1e-4, kMaxImpedance = 0.9999, kTiny = 1e-15;

}  // namespace

int power_of(const Compliance& compliance) {
  return static_cast<int>(
      std::max(1.0, std::round(compliance.power)));  // what mixing leaves of one
}

kernels::Compliance<double> compile(const Compliance& compliance, double dt) {
  kernels::Compliance<double> out{};
  const auto clamped = [](double d) { return std::clamp(d, kMinImpedance, kMaxImpedance); };
  const double low = clamped(compliance.min_impedance), high = clamped(compliance.max_impedance);
  const double width = std::max(0.0, compliance.width), middle = clamped(compliance.midpoint);
  const double power = power_of(compliance);
  out.least = low, out.gain = high - low;
  if (low == high || width <= kTiny) {
    out.least = (low + high) / 2, out.gain = 0;
  } else {
    out.inverse_width = 1 / width;
  }
  out.middle = middle;
  out.rising = std::pow(middle, 1 - power), out.falling = std::pow(1 - middle, 1 - power);

  // One number of each format: MuJoCo takes its default.
  double first = compliance.time_constant, second = compliance.damping_ratio;
  if ((first > 0) != (second > 0))
    first = Compliance{}.time_constant, second = Compliance{}.damping_ratio;
  if (first <= 0) {
    out.stiffness = -first / (high * high), out.damping = -second / high;
    return out;
  }
  const double time = std::max(first, 2 * dt);
  out.stiffness = 1 / std::max(kTiny, high * high * time * time * second * second);
  out.damping = 2 / std::max(kTiny, high * time);
  return out;
}

}  // namespace manyworlds
