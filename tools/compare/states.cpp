#include "tools/compare/states.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace manyworlds::compare {
namespace {

enum Compared {
  kPosition,
  kRotation,
  kSpeed,
  kKinetic,  // of links
  kDistance,
  kPoint,
  kNormal,  // of contacts
  kFreeAcceleration,
  kFreeNextQ,
  kFreeNextV,
  kAcceleration,
  kNextQ,
  kNextV,
  kCompared
};
constexpr std::array<const char*, kCompared> kNames = {"link position",
                                                       "link orientation",
                                                       "link velocity",
                                                       "kinetic energy",
                                                       "contact distance",
                                                       "contact point",
                                                       "contact normal",
                                                       "qacc, unconstrained",
                                                       "next qpos, unconstrained",
                                                       "next qvel, unconstrained",
                                                       "qacc, constrained",
                                                       "next qpos, constrained",
                                                       "next qvel, constrained"};

double gate_of(int compared, Precision precision) {
  const bool constrained = compared >= kAcceleration;
  if (precision == Precision::f64) return constrained ? 1e-6 : 1e-8;
  return constrained ? 1e-3 : 1e-5;
}

void write(Batch& batch, const std::vector<Sample>& samples) {
  std::vector<double> q, v, u;
  const auto add = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const Sample& s : samples) add(q, s.q), add(v, s.v), add(u, s.u);
  batch.write(Field::generalized_position, std::span<const double>(q));
  batch.write(Field::generalized_velocity, std::span<const double>(v));
  if (!u.empty()) batch.set_controls(std::span<const double>(u));
}

// Ours and MuJoCo's numbers of the bodies that have a state.
class Links {
 public:
  Links(const Batch& batch, const Pair& pair, int world, const Sample& sample) {
    const std::vector<double> x = read(batch, Field::position, world);
    const std::vector<double> q = read(batch, Field::orientation, world);
    const std::vector<double> v = read(batch, Field::linear_velocity, world);
    const std::vector<double> w = read(batch, Field::angular_velocity, world);
    for (std::size_t to = 0; to < pair.links().size(); ++to) {
      const auto from = static_cast<std::size_t>(batch.row(pair.links()[to].body));
      // A rotation has two quaternions.
      double dot = 0;
      for (std::size_t k = 0; k < 4; ++k) dot += q[4 * from + k] * sample.rotation[4 * to + k];
      for (std::size_t k = 0; k < 4; ++k) {
        add(rotation, dot < 0 ? -q[4 * from + k] : q[4 * from + k], sample.rotation[4 * to + k]);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        add(position, x[3 * from + k], sample.position[3 * to + k]);
        add(speed, w[3 * from + k], sample.speed[6 * to + k]);
        add(speed, v[3 * from + k], sample.speed[6 * to + 3 + k]);
      }
    }
  }
  using Both = std::pair<std::vector<double>, std::vector<double>>;
  Both position, rotation, speed;

 private:
  static void add(Both& both, double ours, double theirs) {
    both.first.push_back(ours), both.second.push_back(theirs);
  }
};

// Each of MuJoCo's contacts beside the nearest one of ours that is not taken: distance, point and
// normal, the worst of each, in m, m and 1.
std::array<double, 3> worst_of(std::vector<Contact> ours, const std::vector<Touch>& theirs) {
  std::array<double, 3> worst{};
  for (const Touch& touch : theirs) {
    const auto nearest =
        std::min_element(ours.begin(), ours.end(), [&](const Contact& a, const Contact& b) {
          const auto apart = [&](const Contact& c) {
            return (c.point - touch.point).norm() + std::abs(c.separation - touch.distance) +
                   1e-3 * (1 - std::abs(c.normal.dot(touch.normal)));
          };
          return apart(a) < apart(b);
        });
    const double sign = nearest->normal.dot(touch.normal) < 0 ? -1 : 1;
    worst[0] = std::max(worst[0], std::abs(nearest->separation - touch.distance));
    worst[1] = std::max(worst[1], (nearest->point - touch.point).norm());
    worst[2] = std::max(worst[2], (sign * nearest->normal - touch.normal).norm());
    ours.erase(nearest);
  }
  return worst;
}

double difference(const Links::Both& both) { return compare::difference(both.first, both.second); }

}  // namespace

const Quantity& StateComparison::at(const std::string& name) const {
  for (const Quantity& quantity : quantities) {
    if (quantity.name == name) return quantity;
  }
  throw std::out_of_range("there is no quantity '" + name + "'");
}

std::vector<std::string> StateComparison::failures() const {
  std::vector<std::string> out;
  const std::string precision = to_string(kernels.precision);
  for (const Quantity& quantity : quantities) {
    if (quantity.holds()) continue;
    char text[100];
    std::snprintf(text, sizeof text, "differs by %.2g; expected at most %.2g", quantity.most(),
                  quantity.gate);
    out.push_back(precision + ": " + quantity.name + " " + text);
  }
  if (100 * other_contacts > states) {
    out.push_back(precision + ": different number of contacts in " +
                  std::to_string(other_contacts) + " of " + std::to_string(states) +
                  " states; expected at most 1 %");
  }
  return out;
}

StateComparison compare_states(const Pair& pair, const std::vector<Sample>& samples,
                               const Kernels& kernels) {
  Batch batch(compile(pair.scene(kernels.precision)),
              options_of(kernels, static_cast<int>(samples.size())));
  write(batch, samples);
  StateComparison out{kernels, 0, 0, 0, 0, 0, 0, {}};
  for (int k = 0; k < kCompared; ++k) {
    out.quantities.push_back(
        {kNames[static_cast<std::size_t>(k)], gate_of(k, kernels.precision), {}});
  }
  const auto add = [&](Compared which, double value) {
    out.quantities[static_cast<std::size_t>(which)].differences.push_back(value);
  };
  std::vector<bool> stepped;
  for (int i = 0; i < batch.worlds(); ++i) {
    pair.pause();
    const Sample& s = samples[static_cast<std::size_t>(i)];
    const Links links(batch, pair, i, s);
    add(kPosition, difference(links.position)), add(kRotation, difference(links.rotation));
    add(kSpeed, difference(links.speed));
    add(kKinetic, compare::difference({batch.energy(i).kinetic}, {s.kinetic}));
    const std::vector<Contact> contacts = batch.contacts(i);
    ++out.states, out.contacts += static_cast<int>(s.touches.size()), out.rows += s.rows;
    stepped.push_back(false);
    if (s.other_points) {
      ++out.other_points;
    } else if (contacts.size() != s.touches.size()) {
      ++out.other_contacts;
    } else if (s.uncertain) {
      ++out.uncertain;
    } else {
      stepped.back() = true;
      if (contacts.empty()) continue;
      const std::array<double, 3> worst = worst_of(contacts, s.touches);
      add(kDistance, worst[0]), add(kPoint, worst[1]), add(kNormal, worst[2]);
    }
  }
  batch.step();
  for (int i = 0; i < batch.worlds(); ++i) {
    if (!stepped[static_cast<std::size_t>(i)]) continue;
    const Sample& s = samples[static_cast<std::size_t>(i)];
    const bool constrained = s.rows > 0;
    if (!s.a.empty()) {
      add(constrained ? kAcceleration : kFreeAcceleration,
          compare::difference(read(batch, Field::generalized_acceleration, i), s.a));
    }
    add(constrained ? kNextQ : kFreeNextQ,
        compare::difference(read(batch, Field::generalized_position, i), s.next_q));
    add(constrained ? kNextV : kFreeNextV,
        compare::difference(read(batch, Field::generalized_velocity, i), s.next_v));
  }
  for (Quantity& quantity : out.quantities) {
    std::sort(quantity.differences.begin(), quantity.differences.end());
  }
  return out;
}

}  // namespace manyworlds::compare
