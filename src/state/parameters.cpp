// Numbers of the scene that differ from world to world: drawn or written, and everything that
// follows from them, derived by the code that derives it for a whole plan.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "src/scene/checks.hpp"
#include "src/state/worlds.hpp"

namespace manyworlds {

namespace {

using detail::number_text;

// Draws of variations lie beyond those of the initial state.
constexpr std::uint64_t kFirstDraw = std::uint64_t{1} << 40;

double drawn(const Variation& v, const VariedNumber& n, double uniform) {
  const double x = v.draw == Draw::uniform ? n.low + (n.high - n.low) * uniform
                                           : n.low * std::pow(n.high / n.low, uniform);
  return std::clamp(x, n.low, n.high);
}

}  // namespace

template <class Real>
void Worlds<Real>::make_parameters() {
  const Scene& scene = plan_.scene();
  const auto& varied = data().varied;
  for (std::size_t p = 0; p < number_at_.size(); ++p) {
    const auto parameter = static_cast<Parameter>(p);
    const auto numbers = static_cast<std::size_t>(info(parameter).numbers);
    owners_[p] = owners_of(scene, parameter);
    number_at_[p].assign(owners_[p].size() * numbers, -1);
    for (std::size_t i = 0; i < varied.size(); ++i) {
      const VariedNumber& n = varied[i];
      if (n.parameter != parameter) continue;
      const auto at = std::find(owners_[p].begin(), owners_[p].end(), n.of);
      const auto first = static_cast<std::size_t>(at - owners_[p].begin()) * numbers;
      number_at_[p][first + static_cast<std::size_t>(n.component)] = static_cast<int>(i);
    }
  }
  if (varied.empty()) return;
  own_ = std::make_unique<PlanData>(data());
  storage_.make_constants(data());
  const auto worlds = static_cast<std::size_t>(worlds_);
  if (data().varies.masses) {
    for (std::size_t w = 0; w < worlds; ++w) {
      own_bodies_.insert(own_bodies_.end(), data().bodies.begin(), data().bodies.end());
    }
  }
  if (data().varies.ranges) own_ranges_.resize(worlds * data().control_range.size());
  for (std::size_t w = 0; w < worlds; ++w) {
    for (const VariedNumber& n : varied) {
      const double own = get_number(scene, n.parameter, n.of, n.component);
      values_.push_back(std::clamp(own, n.low, n.high));
    }
  }
}

template <class Real>
void Worlds<Real>::draw_values(int world, const Draws& draws) {
  const auto& varied = data().varied;
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const VariedNumber& n = varied[i];
    const auto variation = static_cast<std::size_t>(n.variation);
    const Variation& v = plan_.scene().variations[variation];
    if (v.draw == Draw::none) continue;
    const std::uint64_t item = v.together ? static_cast<std::uint64_t>(n.component) : 4 + i;
    const std::uint64_t index = kFirstDraw + (std::uint64_t{variation} << 24) + item;
    values_of(world)[i] = drawn(v, n, draws.uniform(index));
  }
}

template <class Real>
void Worlds<Real>::apply_values(int world) {
  const auto& varied = data().varied;
  // From the scene as it is described: stretched polygons would add up their rounding, and a mass
  // that was set before would hide what sizes make.
  for (const VariedNumber& n : varied) {
    if (n.of.body < 0) continue;
    const auto b = static_cast<std::size_t>(n.of.body), s = static_cast<std::size_t>(n.of.shape);
    const Body& described = plan_.scene().bodies[b];
    Body& body = own_->scene.bodies[b];
    if (n.parameter == Parameter::size) body.shapes[s].geometry = described.shapes[s].geometry;
    const bool of_mass = n.parameter == Parameter::mass ||
                         n.parameter == Parameter::center_of_mass ||
                         n.parameter == Parameter::inertia_scale;
    if (of_mass) body.mass_properties = described.mass_properties;
  }
  set_numbers(own_->scene, varied, values_of(world));
  derive_again(*own_);
  if (!own_bodies_.empty()) {
    std::copy(own_->bodies.begin(), own_->bodies.end(),
              own_bodies_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(world) *
                                                                own_->bodies.size()));
  }
  for (std::size_t i = 0; data().varies.ranges && i < data().control_range.size(); ++i) {
    const Control& own = own_->scene.controls[i];
    own_ranges_[static_cast<std::size_t>(world) * data().control_range.size() + i] = {own.low,
                                                                                      own.high};
  }
  storage_.set_constants(*own_, lane_index_of(world));
}

template <class Real>
void Worlds<Real>::read(Parameter parameter, int world, double* out) const {
  for (std::size_t i = 0; i < parameter_size(parameter); ++i) out[i] = number(parameter, world, i);
}

template <class Real>
double Worlds<Real>::number(Parameter parameter, int world, std::size_t item) const {
  const auto p = static_cast<std::size_t>(parameter);
  const auto numbers = static_cast<std::size_t>(info(parameter).numbers);
  const NumberOwner& of = owners_[p][item / numbers];
  const int component = static_cast<int>(item % numbers), at = number_at_[p][item];
  // Sizes and densities make a mass and its centre, too, and what servos have gains.
  if (parameter == Parameter::mass) return body_of(world, item).mass;
  if (parameter == Parameter::center_of_mass && at < 0) {
    return body_of(world, item / numbers).center[component];
  }
  if (of.control >= 0 && is_of_newton(parameter)) {
    const auto kind = plan_.scene().controls[static_cast<std::size_t>(of.control)].kind;
    return get_number(kind, actuator_of(world, of.control), parameter, component);
  }
  return at >= 0 ? values_of(world)[at] : get_number(plan_.scene(), parameter, of, component);
}

template <class Real>
Actuator Worlds<Real>::actuator_of(int world, int control) const {
  Actuator out = plan_.scene().controls[static_cast<std::size_t>(control)].actuator;
  const auto& varied = data().varied;
  for (std::size_t i = 0; i < varied.size(); ++i) {
    const VariedNumber& n = varied[i];
    if (n.of.control != control || !is_of_newton(n.parameter)) continue;
    set_number(out, n.parameter, n.component, values_of(world)[i]);
  }
  return out;
}

template <class Real>
std::string Worlds<Real>::check(Parameter parameter, int world, const double* in) const {
  const auto& at = number_at_[static_cast<std::size_t>(parameter)];
  std::vector<double> now(at.size());
  read(parameter, world, now.data());
  const auto numbers = static_cast<std::size_t>(info(parameter).numbers);
  for (std::size_t i = 0; i < at.size(); ++i) {
    std::string place = std::string(info(parameter).name);
    const auto owner = info(parameter).owner;
    if (owner != ParameterInfo::world) {
      place += std::string(" of ") + to_string(owner) + ' ' + std::to_string(i / numbers);
    }
    if (numbers > 1) place += ", number " + std::to_string(i % numbers);
    if (at[i] < 0) {
      if (in[i] == now[i]) continue;
      return place + " is " + number_text(in[i]) + ", must be " + number_text(now[i]) +
             ": it does not vary (Scene::variations)";
    }
    const VariedNumber& n = data().varied[static_cast<std::size_t>(at[i])];
    if (in[i] >= n.low && in[i] <= n.high) continue;
    return place + " is " + number_text(in[i]) + ", must be between " + number_text(n.low) +
           " and " + number_text(n.high) + ", its declared range";
  }
  return {};
}

template <class Real>
void Worlds<Real>::write(Parameter parameter, int world, const double* in) {
  const auto& at = number_at_[static_cast<std::size_t>(parameter)];
  bool changed = false;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] < 0) continue;
    double& value = values_of(world)[at[i]];
    changed = changed || value != in[i];
    value = in[i];
  }
  const bool of_starts =
      parameter >= Parameter::initial_position && parameter <= Parameter::initial_angular_velocity;
  if (!changed || (of_starts && !data().varies.joints)) return;  // a reset reads them
  const int lane_index = lane_index_of(world);
  const bool moves = parameter == Parameter::size || parameter == Parameter::density ||
                     parameter == Parameter::shape_position ||
                     parameter == Parameter::shape_rotation ||
                     parameter == Parameter::center_of_mass;
  if (data().has_trees()) {  // whose links stay where their coordinates are
    apply_values(world);
    if (moves) place_links(world);
    return;
  }
  // A body whose centre of mass shifts stays where its own frame is.
  std::vector<double> positions, orientations;
  if (moves) {
    positions.resize(plan_.numbers(Field::position));
    orientations.resize(plan_.numbers(Field::orientation));
    read(Field::position, world, positions.data());
    read(Field::orientation, world, orientations.data());
  }
  apply_values(world);
  storage_.wake(lane_index);
  if (!moves) return;
  storage_.clear_contacts(lane_index);
  storage_.clear_joints(lane_index);
  const bool shifts = std::any_of(data().bodies.begin(), data().bodies.end(),
                                  [](const PlanBody& b) { return b.reshaped && !b.aligned; });
  if (!shifts) return;
  write(Field::orientation, world, orientations.data());
  write(Field::position, world, positions.data());
}

template <class Real>
void Worlds<Real>::set_next(Parameter parameter, int world, std::size_t item, double value) {
  const int at = number_at_[static_cast<std::size_t>(parameter)][item];
  const VariedNumber& n = data().varied[static_cast<std::size_t>(at)];
  if (std::isnan(value)) value = get_number(plan_.scene(), parameter, n.of, n.component);
  values_of(world)[at] = std::clamp(value, n.low, n.high);
}

template <class Real>
double Worlds<Real>::gravity(int world, int component) const {
  const auto& at = number_at_[static_cast<std::size_t>(Parameter::gravity)];
  const int i = at[static_cast<std::size_t>(component)];
  return i >= 0 ? values_of(world)[i] : plan_.scene().options.gravity[component];
}

template <class Real>
Attractor Worlds<Real>::attractor_of(int world, std::size_t index) const {
  Attractor out = plan_.scene().attractors[index];
  if (!data().varies.attractors) return out;
  for (std::size_t c = 0; c < 3; ++c) {
    out.position[static_cast<Eigen::Index>(c)] =
        number(Parameter::attractor_position, world, 3 * index + c);
  }
  out.strength = number(Parameter::attractor_strength, world, index);
  return out;
}

template <class Real>
double Worlds<Real>::gravity_scale(int world, int body) const {
  const auto& at = number_at_[static_cast<std::size_t>(Parameter::gravity_scale)];
  const int i = at[static_cast<std::size_t>(body)];
  const int scene_body = data().bodies[static_cast<std::size_t>(body)].scene_body;
  return i >= 0 ? values_of(world)[i]
                : plan_.scene().bodies[static_cast<std::size_t>(scene_body)].gravity_scale;
}

template <class Real>
std::size_t Worlds<Real>::world_bytes() const {
  return storage_.world_bytes() + data().varied.size() * sizeof(double);
}

template <class Real>
void Worlds<Real>::write_world(int world, std::byte* to) const {
  storage_.write_world(lane_index_of(world), to);
  if (data().varied.empty()) return;
  std::memcpy(to + storage_.world_bytes(), values_of(world), data().varied.size() * sizeof(double));
}

template <class Real>
std::string Worlds<Real>::check_world(const std::byte* from) const {
  const std::byte* values = from + storage_.world_bytes();
  for (std::size_t i = 0; i < data().varied.size(); ++i) {
    double value = 0;
    std::memcpy(&value, values + i * sizeof value, sizeof value);
    const VariedNumber& n = data().varied[i];
    if (!(value >= n.low && value <= n.high)) {
      return std::string(info(n.parameter).name) + " is outside its declared range";
    }
  }
  return storage_.check_world(from);
}

template <class Real>
void Worlds<Real>::read_world(int world, const std::byte* from) {
  storage_.read_world(lane_index_of(world), from);
  if (data().varied.empty()) return;
  std::memcpy(values_of(world), from + storage_.world_bytes(),
              data().varied.size() * sizeof(double));
  apply_values(world);
}

template <class Real>
void Worlds<Real>::copy_world(int from, int to) {
  storage_.copy(lane_index_of(from), lane_index_of(to));
  std::copy_n(values_of(from), data().varied.size(), values_of(to));
  for (std::size_t i = 0, n = data().control_range.size(); !own_ranges_.empty() && i < n; ++i) {
    own_ranges_[static_cast<std::size_t>(to) * n + i] =
        own_ranges_[static_cast<std::size_t>(from) * n + i];
  }
  for (std::size_t b = 0; !own_bodies_.empty() && b < data().bodies.size(); ++b) {
    own_bodies_[static_cast<std::size_t>(to) * data().bodies.size() + b] = body_of(from, b);
  }
}

#define MW_INSTANTIATE(Real)                                                     \
  template void Worlds<Real>::make_parameters();                                 \
  template void Worlds<Real>::draw_values(int, const Draws&);                    \
  template void Worlds<Real>::apply_values(int);                                 \
  template void Worlds<Real>::read(Parameter, int, double*) const;               \
  template double Worlds<Real>::number(Parameter, int, std::size_t) const;       \
  template std::string Worlds<Real>::check(Parameter, int, const double*) const; \
  template void Worlds<Real>::write(Parameter, int, const double*);              \
  template void Worlds<Real>::set_next(Parameter, int, std::size_t, double);     \
  template double Worlds<Real>::gravity(int, int) const;                         \
  template double Worlds<Real>::gravity_scale(int, int) const;                   \
  template Attractor Worlds<Real>::attractor_of(int, std::size_t) const;         \
  template std::size_t Worlds<Real>::world_bytes() const;                        \
  template void Worlds<Real>::write_world(int, std::byte*) const;                \
  template void Worlds<Real>::read_world(int, const std::byte*);                 \
  template std::string Worlds<Real>::check_world(const std::byte*) const;        \
  template void Worlds<Real>::copy_world(int, int);
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
