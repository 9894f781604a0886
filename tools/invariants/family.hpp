// Families of random scenes, each with the law of mechanics that its worlds are held to. A world
// follows from its seed alone, so `report invariants` shows a broken one again, and the tests run
// the same families in small.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "tools/base/random.hpp"

namespace manyworlds::invariants {

using tools::Random;

// ---- what a law looks at ------------------------------------------------------------------------

struct BodyNow {
  Vec3 position = Vec3::Zero();  // m, of the body frame, world
  Quat rotation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();  // m/s, of the centre of mass, world
  Vec3 spin = Vec3::Zero();      // rad/s, world
};

// One world after a step. Bodies are numbered as in the scene; fixed ones keep the state there.
struct Seen {
  int step = 0;  // 0: before the first
  bool last = false;
  double time = 0;  // s
  Precision precision = Precision::f32;
  std::vector<BodyNow> now, before;        // after this step, and after the one before it
  std::vector<BodyNow> twin;               // of the world beside it (Drawn::twin), else empty
  Energy energy = {};                      // J
  std::vector<StepContact> contacts = {};  // of this step, if Drawn::contacts
  std::uint64_t hash = 0, twin_hash = 0;   // of all states
  bool asleep = false;                     // the whole world
};

// How far a world is from the law after a step, in the unit of the family: at most
// Family::limit, or the world breaks the law. The largest value of all steps counts, and what is
// not finite breaks it. Called for every step in turn, from 0 on; it may keep what it needs.
using Judge = std::function<double(const Seen&)>;

// ---- families -----------------------------------------------------------------------------------

// Lengths and times of a world. Speeds go with sqrt(gravity length).
struct Scale {
  double length = 1;      // m, of a typical body
  double gravity = 9.81;  // m/s^2
  double dt = 1.0 / 60;   // s, of a step
  double speed() const { return std::sqrt(gravity * length); }
  double time() const { return std::sqrt(length / gravity); }
};

// How scales are drawn. `similar`: 1 mm to 100 m, gravity from a tenth to ten times the Earth's,
// and the step is 1/60 s times sqrt(length / 1 m * 9.81 m/s^2 / gravity), so that worlds of all
// sizes do the same. `earth`: 1 cm to 100 m at 9.81 m/s^2 and 1/60 s.
enum class Units { similar, earth };
Scale draw_scale(Random& random, Units units);
const char* to_string(Units units);

// One world.
struct Drawn {
  Scene scene;
  int steps = 120;  // equal in all worlds of a kind
  Judge judge;
  // Stepped beside the world, for laws that compare the two: the same scene but for the initial
  // states.
  std::optional<Scene> twin = {};
  bool contacts = false;  // Seen::contacts
  bool sleep = false;     // BatchOptions::sleep
};

enum class Law {
  symmetry,
  momentum,
  energy,
  friction,
  rest,
  penetration,
  similarity,
  independence,
  joints
};
const char* to_string(Law law);

struct Family {
  std::string id;  // unique, in words: "flat drop"
  Law law;
  std::string title;      // the scenes, in a phrase
  std::string criterion;  // what is measured
  std::string unit;       // of value and limit, empty for ratios
  double limit = 0;       // in float32
  double limit_f64 = 0;   // in float64; 0: as in float32
  // A world. What its scene is made of comes from `kind`; the states in which its bodies start from
  // `state`. Worlds that share `kind` share a plan, one lane each.
  std::function<Drawn(Random& kind, Random& state, const Scale& scale)> draw = {};
  // false: worlds beyond the limit are reported only (ratios of mass beyond 100, for example).
  bool required = true;
};

using Draw = decltype(Family::draw);
using DrawInSpace =
    std::function<Drawn(Space space, Random& kind, Random& state, const Scale& scale)>;

// The family in the plane and in space, with " 2D" and " 3D" at the end of its id.
std::vector<Family> in_both_spaces(const Family& family, const DrawInSpace& draw);

// All, in the order of the report.
std::vector<Family> families();
std::vector<Family> symmetry_families();
std::vector<Family> momentum_families();
std::vector<Family> energy_families();
std::vector<Family> friction_families();
std::vector<Family> rest_families();
std::vector<Family> penetration_families();
std::vector<Family> similarity_families();  // and refinement
std::vector<Family> independence_families();
std::vector<Family> joint_families();

// ---- runs ---------------------------------------------------------------------------------------

inline constexpr int kWorldsPerKind = 16;

struct RunOptions {
  std::uint64_t seed = 1;
  int kinds = 64;
  int first_kind = 0;
  Units units = Units::similar;
  Precision precision = Precision::f32;
};

struct Outcome {
  int worlds = 0, broken = 0;
  int silent = 0;  // beyond ten times the limit, and not flagged by its status
  int lost = 0;    // of the worlds that keep the law: frozen or out of bounds
  double worst = 0;
  int worst_world = 0;  // kind * kWorldsPerKind + world of the kind
};

// Worlds `first_kind` kWorldsPerKind and on. Throws tools::Interrupted.
Outcome run(const Family& family, const RunOptions& options);

// The judge's value of world number `world` after each step, from step 0 on; infinity where it is
// not finite. The world runs among those of its kind, as in run(). Throws tools::Interrupted.
std::vector<double> values_of(const Family& family, const RunOptions& options, int world);

// World number `world` of a family.
Drawn draw_world(const Family& family, const RunOptions& options, int world);
// A batch of one world, which observes contacts, with the plan that it had among others of its
// kind.
Batch batch_of(const Family& family, const RunOptions& options, int world);

}  // namespace manyworlds::invariants
