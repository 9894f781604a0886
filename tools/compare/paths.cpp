#include "tools/compare/paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <limits>

namespace manyworlds::compare {
namespace {

// Steps worlds of a batch beside MuJoCo's and MuJoCo's moved ones.
class Side {
 public:
  Side(const Pair& pair, const Kernels& kernels, int paths, double speed)
      : m_(pair.mujoco()),
        batch_(compile(pair.scene(kernels.precision)), options_of(kernels, paths)),
        random_(pair.settings().seed, 1) {
    std::vector<double> v;
    for (int k = 0; k < paths * m_.nv; ++k) {
      // Which float32 holds, too.
      v.push_back(static_cast<double>(static_cast<float>(random_.uniform(-speed, speed))));
    }
    batch_.write(Field::generalized_velocity, std::span<const double>(v));
    for (int p = 0; p < paths; ++p) {
      theirs_.push_back(pair.make_data()), moved_.push_back(pair.make_data());
      for (mjData* d : {theirs_.back().get(), moved_.back().get()}) {
        std::copy_n(v.begin() + static_cast<std::ptrdiff_t>(p) * m_.nv, m_.nv, d->qvel);
      }
      const std::vector<mjtNum> by(static_cast<std::size_t>(m_.nv), kMoved);
      mj_integratePos(&m_, moved_.back()->qpos, by.data(), 1);
    }
  }

  void step(bool new_controls) {
    if (new_controls && m_.nu > 0) {
      std::vector<double> u;
      for (std::size_t p = 0; p < theirs_.size(); ++p) {
        draw_controls(m_, random_, theirs_[p]->ctrl);
        for (int k = 0; k < m_.nu; ++k) {
          theirs_[p]->ctrl[k] = static_cast<double>(static_cast<float>(theirs_[p]->ctrl[k]));
        }
        std::copy_n(theirs_[p]->ctrl, m_.nu, moved_[p]->ctrl);
        u.insert(u.end(), theirs_[p]->ctrl, theirs_[p]->ctrl + m_.nu);
      }
      batch_.set_controls(std::span<const double>(u));
    }
    batch_.step();
    for (const auto& d : theirs_) mj_step(&m_, d.get());
    for (const auto& d : moved_) mj_step(&m_, d.get());
  }

  // The largest of the differences of coordinates, each divided by what `scale` makes of MuJoCo's.
  using Scale = std::function<double(double)>;
  double ours(std::size_t path, const Scale& scale) const {
    const auto q = read(batch_, Field::generalized_position, static_cast<int>(path));
    return apart(q.data(), path, scale);
  }
  double own(std::size_t path, const Scale& scale) const {
    return apart(moved_[path]->qpos, path, scale);
  }
  double dt() const { return m_.opt.timestep; }

 private:
  double apart(const double* q, std::size_t path, const Scale& scale) const {
    double most = 0;
    for (int k = 0; k < m_.nq; ++k) {
      const double expected = theirs_[path]->qpos[k];
      const double error = std::abs(q[k] - expected) / scale(expected);
      if (!std::isfinite(error)) return std::numeric_limits<double>::infinity();
      most = std::max(most, error);
    }
    return most;
  }

  const mjModel& m_;
  Batch batch_;
  Random random_;
  std::vector<mjcf::DataPtr> theirs_, moved_;
};

}  // namespace

double Parting::median(std::vector<double> times) {
  if (times.empty()) return -1;
  for (double& time : times) {
    if (time < 0) time = std::numeric_limits<double>::infinity();
  }
  std::sort(times.begin(), times.end());
  const double middle = times[times.size() / 2];
  return std::isfinite(middle) ? middle : -1;
}

Parting compare_paths(const Pair& pair, const Kernels& kernels, int paths, int steps) {
  const mjcf::LogCapture log;
  Side side(pair, kernels, paths, 1);
  Parting out{kernels, steps, side.dt(), {}, {}};
  const auto count = static_cast<std::size_t>(paths);
  out.ours.assign(count, -1), out.own.assign(count, -1);
  const auto unscaled = [](double) { return 1.0; };
  for (int s = 0; s < steps; ++s) {
    pair.pause();
    side.step(s % 5 == 0);
    for (std::size_t p = 0; p < count; ++p) {
      const double time = (s + 1) * side.dt();
      if (out.ours[p] < 0 && side.ours(p, unscaled) > kApart) out.ours[p] = time;
      if (out.own[p] < 0 && side.own(p, unscaled) > kApart) out.own[p] = time;
    }
  }
  return out;
}

double FreePaths::most() const {
  return ours.empty() ? 0 : *std::max_element(ours.begin(), ours.end());
}

std::vector<std::string> FreePaths::failures() const {
  std::vector<std::string> out;
  for (std::size_t p = 0; p < ours.size(); ++p) {
    if (ours[p] <= std::max(kFollowed, own[p])) continue;
    char text[200];
    std::snprintf(text, sizeof text,
                  "f64: path %d without contacts differs by %.2g after %d steps; expected at most "
                  "%.2g (MuJoCo itself, moved by %.0e: %.2g)",
                  static_cast<int>(p), ours[p], steps, kFollowed, kMoved, own[p]);
    out.emplace_back(text);
  }
  return out;
}

FreePaths compare_free_paths(const Pair& pair, const Kernels& kernels, int paths, int steps) {
  const mjcf::LogCapture log;
  Side side(pair, kernels, paths, 0.5);
  for (int s = 0; s < steps; ++s) {
    pair.pause();
    side.step(s % 50 == 0);
  }
  FreePaths out{steps, {}, {}};
  const auto relative = [](double expected) { return 1 + std::abs(expected); };
  for (std::size_t p = 0; p < static_cast<std::size_t>(paths); ++p) {
    out.ours.push_back(side.ours(p, relative)), out.own.push_back(side.own(p, relative));
  }
  return out;
}

}  // namespace manyworlds::compare
