// Batch: steps that ask now and then whether to go on.
#include <algorithm>
#include <chrono>

#include "src/api/batch_data.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace {

constexpr double kPause = 0.06;  // s, between two questions
constexpr double kMostGrowth = 4;

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

// As many steps at a time as take about kPause: at first by the slowest steps that were ever seen,
// since worlds that slept may be awake now, then by what the last ones took. A call that is shorter
// is in one piece.
int Batch::Impl::step(int n, std::span<const std::uint8_t> mask, const GoOn& go_on,
                      const Visit& visit) {
  const FloatMode mode;  // the caller's may trap
  double at_once = slowest_step > 0 ? kPause / slowest_step : 1;
  int taken = 0;
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
    at_once = std::min(kPause / seconds, kMostGrowth) * few;
    taken += few;
    if (taken < n && !go_on()) break;
  }
  core->end_steps(mask);
  return taken;
}

}  // namespace manyworlds
