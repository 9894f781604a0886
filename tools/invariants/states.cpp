#include "tools/invariants/states.hpp"

#include <cmath>

namespace manyworlds::invariants {

void put_state(Batch& batch, int world, const Scene& scene) {
  std::vector<double> x, q, v, w;
  const bool planar = scene.space == Space::planar;
  for (int row = 0; row < batch.bodies(world); ++row) {
    const Body& body = scene.at(batch.body_in_row(row));
    const Quat turn = body.rotation.normalized();
    const auto add = [&](std::vector<double>& all, const Vec3& value) {
      all.insert(all.end(), value.data(), value.data() + (planar ? 2 : 3));
    };
    add(x, body.position), add(v, body.linear_velocity);
    if (planar) {
      const double angle = 2 * std::atan2(turn.z(), turn.w());
      q.insert(q.end(), {std::cos(angle), std::sin(angle)});
      w.push_back(body.angular_velocity.z());
    } else {
      q.insert(q.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
      add(w, body.angular_velocity);
    }
  }
  batch.write(Field::position, world, x);
  batch.write(Field::linear_velocity, world, v);
  if (batch.size(Field::orientation) > 0) batch.write(Field::orientation, world, q);
  if (batch.size(Field::angular_velocity) > 0) batch.write(Field::angular_velocity, world, w);
}

std::vector<BodyNow> initial_states(const Scene& scene) {
  std::vector<BodyNow> out;
  for (const Body& b : scene.bodies) {
    out.push_back({b.position, b.rotation.normalized(), b.linear_velocity, b.angular_velocity});
  }
  return out;
}

void States::read(const Batch& batch) {
  for (const auto& [field, out] : {std::pair(Field::position, &x_),
                                   {Field::orientation, &q_},
                                   {Field::linear_velocity, &v_},
                                   {Field::angular_velocity, &w_}}) {
    out->resize(batch.size(field));
    batch.read(field, *out);
  }
}

void States::copy(const Batch& batch, int world, std::vector<BodyNow>& out) const {
  const int bodies = batch.bodies(world);
  const bool planar = batch.plan().scene().space == Space::planar;
  for (int row = 0; row < bodies; ++row) {
    const auto i = static_cast<std::size_t>(world * bodies + row);
    BodyNow& b = out[static_cast<std::size_t>(batch.body_in_row(row).index())];
    const auto vector = [&](const std::vector<double>& all) {
      const double* from = all.data() + i * (planar ? 2 : 3);
      return Vec3(from[0], from[1], planar ? 0 : from[2]);
    };
    b.position = vector(x_), b.velocity = vector(v_);
    if (planar) {
      b.rotation = Quat(Eigen::AngleAxisd(std::atan2(q_[2 * i + 1], q_[2 * i]), Vec3::UnitZ()));
      b.spin = Vec3(0, 0, w_[i]);
    } else {
      b.rotation = Quat(q_[4 * i], q_[4 * i + 1], q_[4 * i + 2], q_[4 * i + 3]);
      b.spin = vector(w_);
    }
  }
}

}  // namespace manyworlds::invariants
