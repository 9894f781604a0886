// Steps as pages ask: in real time, slower, faster, or not at all.
#include <algorithm>
#include <cmath>

#include "src/base/pimpl.hpp"
#include "src/live/impl.hpp"

namespace manyworlds {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kWatched = 0.008;   // s that a step() call may take while a page waits for frames
constexpr double kUnwatched = 0.05;  // s, otherwise: what a page waits for an answer
constexpr double kBehind = 0.1;      // s of real time that are made up for, and no more
constexpr double kMeasured = 0.5;    // s over which the speed that is reached is a mean

class Loop {
 public:
  Loop(Live::Impl& live, Batch& batch, const LiveClock& clock)
      : live_(live), batch_(batch), clock_(clock), dt_(batch.plan().scene().options.dt) {
    live_.asked = {.paused = clock.paused, .speed = clock.speed};
    live_.controls_set = clock.controls_set;
    last_ = measured_ = Clock::now();
    tell();
    live_.changed();
    live_.next_all = {};  // with the clock as it is now
    live_.show(batch);
  }
  ~Loop() { live_.controls_set = {}; }

  std::int64_t run(const GoOn& go_on) {
    Clock::time_point ask = Clock::now();
    while (true) {
      if (const Clock::time_point now = Clock::now(); now >= ask) {
        if (go_on && !go_on()) return taken_;
        ask = now + std::chrono::milliseconds(60);
      }
      live_.obey(batch_);
      const int due = steps_due();
      if (due > 0) step(due);
      tell();
      live_.show(batch_);
      if (due == 0) live_.hub.wait(pause());
    }
  }

 private:
  // How many steps the next call should have; 0: none yet.
  int steps_due() {
    const Clock::time_point now = Clock::now();
    const double passed = Seconds(now - last_).count();
    last_ = now;
    if (live_.asked.paused) {
      owed_ = 0;
      return std::min(live_.asked.steps, 1);
    }
    const int most = in_time();
    if (std::isinf(live_.asked.speed)) {
      owed_ = 0;
      return most;
    }
    owed_ = std::min(owed_ + passed * live_.asked.speed, kBehind * live_.asked.speed + dt_);
    return std::min(most, static_cast<int>(owed_ / dt_ + 1e-9));
  }

  // Steps of a call that is not too long. Forces of drags are worked out anew for each step.
  int in_time() const {
    if (!live_.drags.empty()) return 1;
    const double longest = live_.server->pages() > 0 ? kWatched : kUnwatched;
    return std::clamp(static_cast<int>(longest / std::max(step_seconds_, 1e-9)), 1, 1000);
  }

  void step(int due) {
    int n = due;
    if (clock_.before) n = std::clamp(clock_.before(batch_), 1, n);
    live_.pull(batch_, n);
    const Clock::time_point before = Clock::now();
    batch_.step(n);
    const double each = Seconds(Clock::now() - before).count() / n;
    step_seconds_ = step_seconds_ == 0 ? each : 0.8 * step_seconds_ + 0.2 * each;
    taken_ += n, measured_steps_ += n;
    if (live_.asked.paused) {
      live_.asked.steps = std::max(0, live_.asked.steps - n);
    } else {
      owed_ -= n * dt_;
    }
  }

  // How long nothing is to be done.
  Clock::duration pause() const {
    const double longest = 0.05;
    if (live_.asked.paused) return std::chrono::duration_cast<Clock::duration>(Seconds(longest));
    const double left = (dt_ - owed_) / live_.asked.speed;
    return std::chrono::duration_cast<Clock::duration>(Seconds(std::clamp(left, 2e-4, longest)));
  }

  void tell() {
    live_.clockwork.paused = live_.asked.paused;
    live_.clockwork.speed = live_.asked.speed;
    const Clock::time_point now = Clock::now();
    const double passed = Seconds(now - measured_).count();
    if (passed < kMeasured) return;
    live_.clockwork.reached = static_cast<double>(measured_steps_) * dt_ / passed;
    measured_ = now, measured_steps_ = 0;
  }

  Live::Impl& live_;
  Batch& batch_;
  const LiveClock& clock_;
  double dt_;
  double step_seconds_ = 0;  // of one step, lately
  double owed_ = 0;          // s of simulated time that real time is ahead
  std::int64_t taken_ = 0, measured_steps_ = 0;
  Clock::time_point last_, measured_;
};

}  // namespace

std::int64_t Live::run(Batch& batch, const LiveClock& clock, const GoOn& go_on) {
  if (!(clock.speed > 0)) throw std::invalid_argument("live: speed must be > 0");
  const FloatMode mode;
  Impl& impl = *impl_;
  if (!impl.server) throw std::invalid_argument("live: the view is closed");
  return Loop(impl, batch, clock).run(go_on);
}

}  // namespace manyworlds
