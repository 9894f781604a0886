#include "fuzz/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fuzz/check.hpp"

namespace manyworlds::fuzz {

Input input(SceneBytes& bytes) {
  Input out;
  out.kind = bytes.integer(0, 14);
  out.world = bytes.integer(0, 7);
  out.body = bytes.integer(0, 7);
  out.value = bytes.vector(100);
  out.point = bytes.vector(2);
  out.number = bytes.number(-2, 2);
  return out;
}

namespace {

void change(const Input& in, Batch& batch) {
  const int world = in.world % batch.worlds();
  if (in.kind == 11) return batch.copy_world(in.world % batch.worlds(), in.body % batch.worlds());
  if (in.kind == 12) return batch.wake(world);
  if (in.kind == 13) {
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(batch.worlds()), 0);
    mask[static_cast<std::size_t>(world)] = 1;
    return batch.reset(mask);
  }
  if (in.kind == 14) {
    std::vector<double> controls(static_cast<std::size_t>(batch.controls(world)));
    for (std::size_t i = 0; i < controls.size(); ++i) controls[i] = in.value[i % 3];
    return batch.set_controls(world, controls);
  }
  if (batch.bodies(world) == 0) return;
  const BodyId body = batch.body_in_row(in.body % batch.bodies(world), batch.kind_of(world));
  switch (in.kind) {
    case 1: return batch.add_force(world, body, in.value);
    case 2: return batch.add_torque(world, body, in.value);
    case 3: return batch.add_force_at(world, body, in.value, in.point);
    case 4: return batch.add_impulse(world, body, in.value);
    case 5: return batch.add_angular_impulse(world, body, in.value);
    case 6: return batch.add_impulse_at(world, body, in.value, in.point);
    case 7: return batch.set_enabled(world, body, in.number > 0);
    case 8:
      try {
        batch.spawn(world, body, {in.point, Quat(in.number, 0, 0, 1), in.value, in.value});
      } catch (const std::invalid_argument&) {  // a rotation that is none
      }
      return;
    case 9:
    case 10: {
      const auto field = static_cast<Field>(in.body % kFieldCount);
      std::vector<double> values(batch.plan(batch.kind_of(world)).numbers(field));
      if (values.empty()) return;
      batch.read(field, world, values);
      const auto at = static_cast<std::size_t>(in.body) % values.size();
      values[at] = in.kind == 9 ? in.number : in.value.x();
      return batch.write(field, world, values);
    }
    default: return;
  }
}

BodyId in_row(const Batch& batch, int world, int row) {
  return batch.body_in_row(row, batch.kind_of(world));
}

// A body that sleeps or is disabled is not stepped, so its state is not checked.
bool all_step(const Batch& batch, int world) {
  for (int b = 0; b < batch.bodies(world); ++b) {
    const BodyId body = in_row(batch, world, b);
    if (!batch.enabled(world, body) || batch.asleep(world, body)) return false;
  }
  return !batch.asleep(world);
}

}  // namespace

void apply(const Input& in, Batch& batch) {
  try {
    change(in, batch);
  } catch (const std::invalid_argument&) {  // as the bodies of trees refuse some of it
    const Plan& plan = batch.plan(batch.kind_of(in.world % batch.worlds()));
    if (plan.scene().options.solver.method != Solver::newton) throw;
  }
}

void step_and_look(Batch& batch, int steps) {
  batch.step(steps);
  for (int w = 0; w < batch.worlds(); ++w) {
    for (int f = 0; f < kFieldCount; ++f) {
      const auto field = static_cast<Field>(f);
      std::vector<double> values(batch.size(field) / static_cast<std::size_t>(batch.worlds()));
      batch.read(field, w, values);
      const bool finite =
          std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
      require(finite || frozen(batch.status(w)) || !all_step(batch, w),
              "world " + std::to_string(w) + " is " + to_string(batch.status(w)) + ", its " +
                  info(field).name + " is not finite");
    }
    (void)batch.contacts(w);
    (void)batch.energy(w);
    for (int b = 0; b < batch.bodies(w); ++b) (void)batch.asleep(w, in_row(batch, w, b));
  }
  (void)batch.measure_contacts();
}

}  // namespace manyworlds::fuzz
