// `manyworlds report stability`: stiff and extreme scenes against criteria, with the default
// settings and others. Each case is run in many worlds that differ a little (Body::jitter, fixed
// seeds) and fails if one of them does.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/batch.hpp"

namespace manyworlds::report {

// State of all worlds at one time, read in one go.
class Seen {
 public:
  explicit Seen(const Batch& batch) : batch_(&batch) { look(0); }
  void look(double time);

  double time() const { return time_; }  // s
  const Batch& batch() const { return *batch_; }
  int bodies() const { return bodies_; }
  Vec3 position(int world, int body) const { return vector(x_, world, body); }
  Vec3 velocity(int world, int body) const { return vector(v_, world, body); }
  Vec3 spin(int world, int body) const { return vector(w_, world, body); }
  double fastest(int world) const;  // of the speeds of its bodies, m/s
  Quat rotation(int world, int body) const;
  // How far the anchors of a joint are apart, at most, m; not of joints that slide.
  double worst_gap(int world) const;
  Vec3 moved(int world, int body) const;  // since the start, m
  double energy(int world) const;         // J
  double start_energy(int world) const { return start_energy_[static_cast<std::size_t>(world)]; }

 private:
  Vec3 vector(const std::vector<double>& all, int world, int body) const;
  const Batch* batch_;
  double time_ = 0;
  int bodies_ = 0;
  std::vector<double> x_, q_, v_, w_, start_, start_energy_;
};

struct Trial {
  std::string id, title;
  std::string group = {};       // that it is shown in
  std::string criterion, unit;  // what must stay at or below the limit
  double limit = 0;
  double seconds = 10;  // simulated
  bool at_end = false;  // counts at the end only; else the largest of all times after `from`
  double from = 0;      // s
  std::function<Scene()> scene;
  // Of a world; not finite counts as failed.
  std::function<double(const Seen&, int)> value;
  std::function<void(Batch&, double)> act = {};  // before each step, with the time
  std::string note = {};                         // why it fails where it does
  // Length of a step if not 1/60 s.
  double dt = 1.0 / 60;
  // Where one batch does not tell: what counts, from a plan with the setting's options and a
  // batch's options. `seconds`, `at_end`, `value` and `act` are then the case's own affair.
  std::function<double(const Plan&, const BatchOptions&)> whole = {};
};

// The rest is for the case to say.
inline Trial trial(const std::string& id, const std::string& title, const std::string& criterion,
                   const std::string& unit, double limit, double seconds) {
  Trial t;
  t.id = id, t.title = title, t.criterion = criterion, t.unit = unit;
  t.limit = limit, t.seconds = seconds;
  return t;
}

struct Setting {
  std::string name;
  Precision precision = Precision::f32;
  double finer = 1;     // steps per step of the trial
  double substeps = 1;  // times as many as otherwise
  std::function<void(Options&)> choose = [](Options&) {};
};

struct Verdict {
  std::string id, title, group, criterion, unit, setting, note;
  double limit = 0, value = 0;  // of the worst world
  int lost = 0;                 // worlds whose status is not ok
  bool passed = false;
};

std::vector<Trial> stability_trials();
std::vector<Trial> contact_trials();    // B2 to B14, B33 to B44
std::vector<Trial> joint_trials();      // B15 to B24
std::vector<Trial> tree_trials();       // J1 to J7
std::vector<Trial> motion_trials();     // B26 to B32
std::vector<Trial> structure_trials();  // B7, B19, B24, B37
std::vector<Trial> law_trials();        // B42, B45, B46
std::vector<Trial> size_trials();       // C1 to C5, C8
std::vector<Trial> impact_trials();     // C6, C7, C9

struct StabilityOptions {
  std::vector<std::string> cases;  // ids; empty: all
  bool quick = false;              // 16 worlds instead of 64, fewer settings
};
std::vector<Verdict> run_stability(const StabilityOptions& options,
                                   const std::function<void(const std::string&, double)>& tell);

nlohmann::ordered_json to_json(const std::vector<Verdict>& verdicts);

}  // namespace manyworlds::report
