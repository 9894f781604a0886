#include <cmath>

#include "tools/invariants/similarity.hpp"

namespace manyworlds::invariants {

Precision precision_of(const std::vector<BodyNow>& moving) {
  for (const BodyNow& b : moving) {
    const Vec3 rounded = b.velocity.cast<float>().cast<double>();
    if (rounded != b.velocity) return Precision::f64;
  }
  return Precision::f32;
}

SideWorlds::SideWorlds(const Scene& plan, Precision precision, int worlds)
    : batch_(compile(plan),
             [&] {
               BatchOptions options;
               options.worlds = worlds, options.threads = 1, options.precision = precision;
               return options;
             }()),
      bodies_(plan.bodies.size()) {
  for (int w = 0; w < worlds; ++w) {
    for (const Body& b : plan.bodies) {
      now_.push_back({b.position, b.rotation.normalized(), b.linear_velocity, b.angular_velocity});
    }
  }
  read();
}

void SideWorlds::put(int world, const Scene& initial) {
  const bool planar = initial.space == Space::planar;
  std::vector<double> x, q, v, w;
  for (int row = 0; row < batch_.bodies(world); ++row) {
    const Body& body = initial.at(batch_.body_in_row(row));
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
  batch_.write(Field::position, world, x);
  batch_.write(Field::linear_velocity, world, v);
  if (batch_.size(Field::orientation) > 0) batch_.write(Field::orientation, world, q);
  if (batch_.size(Field::angular_velocity) > 0) batch_.write(Field::angular_velocity, world, w);
  read();
}

void SideWorlds::step(int steps) {
  batch_.step(steps);
  read();
}

const BodyNow& SideWorlds::now(int world, int body) const {
  return now_[static_cast<std::size_t>(world) * bodies_ + static_cast<std::size_t>(body)];
}

void SideWorlds::read() {
  const bool planar = batch_.plan().scene().space == Space::planar;
  for (const auto& [field, out] : {std::pair(Field::position, &x_),
                                   {Field::orientation, &q_},
                                   {Field::linear_velocity, &v_},
                                   {Field::angular_velocity, &w_}}) {
    out->resize(batch_.size(field));
    batch_.read(field, *out);
  }
  const int rows = batch_.bodies();
  for (int i = 0; i < rows * batch_.worlds(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto body = static_cast<std::size_t>(batch_.body_in_row(i % rows).index());
    BodyNow& b = now_[static_cast<std::size_t>(i / rows) * bodies_ + body];
    const auto vector = [&](const std::vector<double>& all) {
      const double* from = all.data() + k * (planar ? 2 : 3);
      return Vec3(from[0], from[1], planar ? 0 : from[2]);
    };
    b.position = vector(x_), b.velocity = vector(v_);
    if (planar) {
      b.rotation = Quat(Eigen::AngleAxisd(std::atan2(q_[2 * k + 1], q_[2 * k]), Vec3::UnitZ()));
      b.spin = Vec3(0, 0, w_[k]);
    } else {
      b.rotation = Quat(q_[4 * k], q_[4 * k + 1], q_[4 * k + 2], q_[4 * k + 3]);
      b.spin = vector(w_);
    }
  }
}

}  // namespace manyworlds::invariants
