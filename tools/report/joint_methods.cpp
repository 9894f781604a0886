// Trees against sweeps: what ten links under a load hold by either, in few substeps and many, and
// what that costs.
#include <algorithm>

#include <fmt/format.h>

#include "tools/base/interrupt.hpp"
#include "tools/report/plan_worth.hpp"
#include "tools/report/stability.hpp"
#include "tools/report/swung_chain.hpp"

namespace manyworlds::report {
namespace {

struct Swing {
  double seconds = 0;         // of the processor
  double gap = 0;             // of a joint, in links
  double gain = 0, loss = 0;  // of energy, of M g L, at most
  double early_loss = 0;      // until light chains lash
  int lost = 0;               // worlds
};

Swing swing_of(double load, JointMethod method, int substeps, bool quick) {
  Scene scene = swung_chain(load);
  scene.options.joint.method = method, scene.options.substeps = substeps;
  BatchOptions options;
  options.worlds = quick ? 16 : 64, options.threads = 1;
  Batch batch(compile(scene), options);
  Seen seen(batch);
  Swing out;
  for (int i = 0; i < 600; ++i) {
    const double start = processor_seconds();
    batch.step();
    out.seconds += processor_seconds() - start;
    const double time = (i + 1) * scene.options.dt;
    seen.look(time);
    for (int w = 0; w < batch.worlds(); ++w) {
      if (batch.status(w) != Status::ok) continue;
      const double rise = gain_of_chain(seen, w, load);
      out.gap = std::max(out.gap, seen.worst_gap(w) / kLink);
      out.gain = std::max(out.gain, rise), out.loss = std::max(out.loss, -rise);
      if (time <= kLashing) out.early_loss = out.loss;
    }
    tools::stop_if_interrupted();
  }
  for (int w = 0; w < batch.worlds(); ++w) out.lost += batch.status(w) == Status::ok ? 0 : 1;
  return out;
}

}  // namespace

std::vector<WorthRow> compare_joint_methods(bool quick) {
  std::vector<WorthRow> out;
  for (const double load : {1.0, 10.0, 100.0, 1000.0}) {
    const Swing usual = swing_of(load, JointMethod::sweep, 4, quick);
    for (const JointMethod method : {JointMethod::sweep, JointMethod::tree}) {
      for (const int substeps : {1, 2, 4, 8, 12}) {
        const bool same = method == JointMethod::sweep && substeps == 4;
        const Swing s = same ? usual : swing_of(load, method, substeps, quick);
        WorthRow row;
        row.scene = fmt::format(
            "ten links, the last with {:g} times the mass of the others, swept in 4 substeps",
            load);
        row.variant = fmt::format("{}, {} substeps", to_string(method), substeps);
        row.plain = 600 * (quick ? 16 : 64) / usual.seconds;
        row.worth = s.seconds / usual.seconds;
        row.must_be_same = false;
        row.holds =
            fmt::format("gap {:.2g} %, energy +{:.2g} -{:.2g} %, -{:.2g} % in {:g} s", 100 * s.gap,
                        100 * s.gain, 100 * s.loss, 100 * s.early_loss, kLashing);
        if (s.lost > 0) row.holds += fmt::format(", {} worlds lost", s.lost);
        out.push_back(row);
      }
    }
  }
  return out;
}

}  // namespace manyworlds::report
