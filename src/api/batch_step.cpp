// Batch: stepping, at once or with questions in between whether to go on.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

constexpr double kPause = 0.06;  // s, between two questions
constexpr double kMaxGrowth = 4;

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

void check_steps(const char* what, int n) {
  if (n < 0) reject(std::string(what) + " is " + std::to_string(n) + ", must be >= 0");
}

}  // namespace

// As many steps at a time as take about kPause: at first by the slowest steps that were ever seen,
// since worlds that slept may be awake now, then by what the last ones took. A call that is shorter
// is in one piece, and so is one that does not ask.
int Batch::Impl::step(int n, std::span<const std::uint8_t> mask, Asked& go_on, const Visit& visit) {
  const FloatMode mode;  // the caller's may trap
  int taken = 0;
  if (!go_on) {
    core->step(*executor, n, visit, mask);
    taken = n;
  }
  double at_once = slowest_step > 0 ? kPause / slowest_step : 1;
  while (taken < n) {
    const int few = static_cast<int>(std::clamp<double>(at_once, 1, n - taken));
    const double start = now();
    // What rests by now has to tell observers what it would have told them in one call.
    if (taken > 0) core->look_again();
    core->step(*executor, few,
               {visit.visitor, visit.begins && taken == 0, visit.ends && taken + few == n}, mask);
    const double seconds = std::max(now() - start, 1e-9);
    // Where nothing sleeps, a step that was held up once is forgotten again.
    const double slow_before = options.sleep ? slowest_step : slowest_step / 2;
    if (mask.empty()) slowest_step = std::max(slow_before, seconds / few);
    at_once = std::min(kPause / seconds, kMaxGrowth) * few;
    taken += few;
    if (taken < n && !go_on()) break;
  }
  core->end_steps(mask);
  return taken;
}

int Batch::Impl::step_all(const Batch& batch, int n, Asked& go_on) {
  if (n == 0) return 0;
  const int taken = step(n, {}, go_on);
  steps += taken;
  tell_step(batch, taken);
  return taken;
}

int Batch::step(int n, const GoOn& go_on) {
  check_steps("n", n);
  Asked asked(go_on);
  const int taken = impl_->step_all(*this, n, asked);
  asked.rethrow();
  return taken;
}

int Batch::step(std::span<const std::uint8_t> mask, int n, const GoOn& go_on) {
  impl_->check_mask(mask);
  check_steps("n", n);
  if (n == 0) return 0;
  Asked asked(go_on);
  const int taken = impl_->step(n, mask, asked);
  impl_->for_each_masked(mask,
                         [this](int, int, int world) { impl_->tell(*this, Input::reset, world); });
  asked.rethrow();
  return taken;
}

int Batch::step_to(double clock, int max_steps, const GoOn& go_on) {
  const FloatMode mode;
  if (!std::isfinite(clock)) reject("clock is " + std::to_string(clock) + " s, must be finite");
  check_steps("max_steps", max_steps);
  // The accumulator: host time that no step has used up yet.
  const double due = clock - impl_->clock;
  const double slack = 1e-9 * impl_->dt;
  const double whole = std::floor((due + slack) / impl_->dt);
  if (whole < 1) return 0;
  const int n = static_cast<int>(std::min(whole, static_cast<double>(max_steps)));
  Asked asked(go_on);
  const int taken = impl_->step_all(*this, n, asked);
  // Time beyond max_steps is dropped, but for the fraction of a step that is still to come.
  impl_->clock += (taken < n ? taken : whole) * impl_->dt;
  asked.rethrow();
  return taken;
}

double Batch::time() const {
  const FloatMode mode;
  return FloatMode::done(static_cast<double>(impl_->steps) * impl_->dt);
}
std::int64_t Batch::steps() const { return impl_->steps; }

std::int64_t Batch::group_steps() const { return impl_->core->group_steps(); }
void Batch::profile(bool on) { impl_->core->profile(on); }
std::vector<StageTime> Batch::take_stage_times() { return impl_->core->take_stage_times(); }

}  // namespace manyworlds
