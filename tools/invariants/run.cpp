// Runs families: the worlds of a kind side by side in the lanes of one batch.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "tools/base/interrupt.hpp"
#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {
namespace {

// FNV-1a, so that families draw apart from one another.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}
// SplitMix64: neighbouring seeds give unrelated numbers.
std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a + (b + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// The initial state of one scene in world `world` of a batch.
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

// The states of all worlds of a batch, read in one go.
class States {
 public:
  explicit States(const Batch& batch) : batch_(&batch) {}
  void read() {
    for (const auto& [field, out] : {std::pair(Field::position, &x_),
                                     {Field::orientation, &q_},
                                     {Field::linear_velocity, &v_},
                                     {Field::angular_velocity, &w_}}) {
      out->resize(batch_->size(field));
      batch_->read(field, *out);
    }
  }
  void copy(int world, std::vector<BodyNow>& out) const {
    const int bodies = batch_->bodies(world);
    const bool planar = batch_->plan().scene().space == Space::planar;
    for (int row = 0; row < bodies; ++row) {
      const auto i = static_cast<std::size_t>(world * bodies + row);
      BodyNow& b = out[static_cast<std::size_t>(batch_->body_in_row(row).index())];
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

 private:
  const Batch* batch_;
  std::vector<double> x_, q_, v_, w_;
};

std::vector<BodyNow> initial(const Scene& scene) {
  std::vector<BodyNow> out;
  for (const Body& b : scene.bodies) {
    out.push_back({b.position, b.rotation.normalized(), b.linear_velocity, b.angular_velocity});
  }
  return out;
}

BatchOptions batch_options(const Drawn& drawn, const RunOptions& options, int worlds) {
  BatchOptions out;
  out.worlds = worlds, out.threads = 1, out.precision = options.precision, out.sleep = drawn.sleep;
  if (drawn.contacts) out.observe.what = {Observer::contacts};
  return out;
}

struct Result {
  double worst = 0;
  Status status = Status::ok;
};

// All worlds of one kind. `values` gets every value of world `traced` of the kind.
std::vector<Result> run_kind(const Family& family, const RunOptions& options, int kind,
                             int traced = -1, std::vector<double>* values = nullptr) {
  std::vector<Drawn> drawn;
  for (int i = 0; i < kWorldsPerKind; ++i) {
    drawn.push_back(draw_world(family, options, kind * kWorldsPerKind + i));
  }
  const bool twins = drawn[0].twin.has_value();
  Batch batch(compile(drawn[0].scene),
              batch_options(drawn[0], options, kWorldsPerKind * (twins ? 2 : 1)));
  std::vector<Seen> seen(kWorldsPerKind);
  std::vector<Result> results(kWorldsPerKind);
  States states(batch);
  for (int w = 0; w < kWorldsPerKind; ++w) {
    const auto i = static_cast<std::size_t>(w);
    put_state(batch, w, drawn[i].scene);
    seen[i].now = initial(drawn[i].scene);
    if (!twins) continue;
    put_state(batch, kWorldsPerKind + w, *drawn[i].twin);
    seen[i].twin = initial(*drawn[i].twin);
  }
  const double dt = drawn[0].scene.options.dt;
  for (int step = 0; step <= drawn[0].steps; ++step) {
    if (step > 0) batch.step();
    states.read();
    for (int w = 0; w < kWorldsPerKind; ++w) {
      const auto i = static_cast<std::size_t>(w);
      Seen& s = seen[i];
      s.step = step, s.last = step == drawn[0].steps, s.time = step * dt;
      s.before = s.now;
      states.copy(w, s.now);
      s.energy = batch.energy(w), s.hash = batch.hash(w);
      if (drawn[0].contacts && step > 0) s.contacts = batch.step_contacts(w);
      if (drawn[0].sleep) s.asleep = batch.asleep(w);
      if (twins) {
        states.copy(kWorldsPerKind + w, s.twin);
        s.twin_hash = batch.hash(kWorldsPerKind + w);
      }
      if (step == 0) s.before = s.now;
      double value = drawn[i].judge(s);
      if (!std::isfinite(value)) value = std::numeric_limits<double>::infinity();
      results[i].worst = std::max(results[i].worst, value);
      if (w == traced) values->push_back(value);
    }
    if (tools::interrupted() != 0) break;
  }
  for (int w = 0; w < kWorldsPerKind; ++w) {
    results[static_cast<std::size_t>(w)].status = batch.status(w);
  }
  return results;
}

}  // namespace

Drawn draw_world(const Family& family, const RunOptions& options, int world) {
  const std::uint64_t seed = mix(options.seed, hash_of(family.id));
  const std::uint64_t kind_seed = mix(seed, static_cast<std::uint64_t>(world / kWorldsPerKind));
  Random kind(kind_seed), state(mix(kind_seed, static_cast<std::uint64_t>(world % kWorldsPerKind)));
  const Scale scale = draw_scale(kind, options.units);
  Drawn out = family.draw(kind, state, scale);
  out.scene.name = family.id;
  return out;
}

Batch batch_of(const Family& family, const RunOptions& options, int world) {
  const Drawn first = draw_world(family, options, world - world % kWorldsPerKind);
  Batch batch(compile(first.scene), batch_options(first, options, 1));
  put_state(batch, 0, draw_world(family, options, world).scene);
  return batch;
}

std::vector<double> values_of(const Family& family, const RunOptions& options, int world) {
  std::vector<double> values;
  run_kind(family, options, world / kWorldsPerKind, world % kWorldsPerKind, &values);
  tools::stop_if_interrupted();
  return values;
}

Outcome run(const Family& family, const RunOptions& options) {
  std::vector<std::vector<Result>> results(static_cast<std::size_t>(options.kinds));
  std::atomic<int> next = 0;
  std::exception_ptr failure;  // an exception that leaves a thread would end the program
  std::mutex failing;
  {
    std::vector<std::jthread> threads;
    const int count =
        std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, options.kinds);
    for (int t = 0; t < count; ++t) {
      threads.emplace_back([&] {
        for (int i = next++; i < options.kinds && tools::interrupted() == 0; i = next++) {
          try {
            results[static_cast<std::size_t>(i)] =
                run_kind(family, options, options.first_kind + i);
          } catch (...) {
            const std::lock_guard lock(failing);
            failure = std::current_exception();
            next = options.kinds;
          }
        }
      });
    }
  }
  if (failure) std::rethrow_exception(failure);
  tools::stop_if_interrupted();
  const double limit =
      options.precision == Precision::f64 && family.limit_f64 > 0 ? family.limit_f64 : family.limit;
  Outcome out;
  int world = options.first_kind * kWorldsPerKind;
  for (const auto& kind : results) {
    for (const Result& r : kind) {
      ++out.worlds;
      if (r.worst > limit)
        ++out.broken;
      else if (lost(r.status))
        ++out.lost;
      if (r.worst > 10 * limit && r.status == Status::ok) ++out.silent;
      if (r.worst > out.worst) out.worst = r.worst, out.worst_world = world;
      ++world;
    }
  }
  return out;
}

}  // namespace manyworlds::invariants
