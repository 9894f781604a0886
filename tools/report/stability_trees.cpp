// Trees of joints under loads: arms, chains, legs, fingers.
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "tools/report/stability.hpp"
#include "tools/report/swung_chain.hpp"

namespace manyworlds::report {
namespace {

std::string text_of(double x) { return fmt::format("{:g}", x); }

double gap_of(const Seen& s, int w) { return s.worst_gap(w); }

// 1 kg at the end of 1 m, ever more compact: hinged, welded, driven.
Scene arms() {
  Scene scene = empty(Space::spatial, 10);
  int place = 0;
  for (const double inertia : {1e-2, 1e-4, 1e-6}) {
    const Frame root{{0, 2.0 * place, 0}, scenes::z_to_y()};
    const Drive drive{0, 0, Spring{2000, 50, 0, 0}};
    const auto hang = [&](const Vec3& reach, JointType type) {
      Body body = lump(Space::spatial, 1, Vec3::Constant(inertia), root.position + reach);
      body.jitter.linear_velocity = {0.01, 0, 0.01};
      const BodyId id = scene.add(body);
      scene.add(joint_at(scene, {}, id, root, std::move(type)));
    };
    hang(-Vec3::UnitZ(), HingeJoint{});
    hang(Vec3::UnitX(), FixedJoint{});
    hang(Vec3::UnitX(), HingeJoint{std::nullopt, drive});
    ++place;
  }
  return scene;
}
Trial arms_gap() {
  Trial t = trial("J1 gap", "1 kg of 1e-2 to 1e-6 kg m^2 on arms of 1 m: hinged, welded, driven",
                  "gap of a joint", "m", 1e-3, 5);
  t.scene = arms, t.value = gap_of;
  return t;
}
Trial arms_energy() {
  Trial t = trial("J1 energy", "the same", "energy gained", "J", 0.01, 5);
  t.scene = arms;
  t.value = [](const Seen& s, int w) { return s.energy(w) - s.start_energy(w); };
  return t;
}

Trial chain_gap(double load) {
  Trial t = trial("J2 gap " + text_of(load),
                  "ten links under " + text_of(load) + " times a link, swung from the horizontal",
                  "gap of a joint, in links", "", 0.01, 10);
  t.scene = [load] { return swung_chain(load); };
  t.value = [](const Seen& s, int w) { return s.worst_gap(w) / kLink; };
  return t;
}
Trial chain_gain(double load) {
  Trial t = chain_gap(load);
  t.id = "J2 gain " + text_of(load), t.title = "the same";
  t.criterion = "energy gain, in M g L", t.limit = 1e-3;
  t.value = [load](const Seen& s, int w) { return gain_of_chain(s, w, load); };
  return t;
}
Trial chain_loss(double load) {
  Trial t = chain_gap(load);
  t.id = "J2 loss " + text_of(load), t.title = "the same";
  t.criterion = "energy loss, in M g L", t.limit = 0.1;
  t.value = [load](const Seen& s, int w) { return -gain_of_chain(s, w, load); };
  if (load < 1000) t.seconds = kLashing;
  return t;
}

Trial legs(double times) {
  Trial t = trial("J3 " + text_of(times),
                  "four welded legs under " + text_of(times) + " times their mass", "penetration",
                  "m", 1e-3, 5);
  t.from = 2;
  t.scene = [times] {
    Scene scene = scenes::welded_table(Space::spatial, 1.2 * times);
    scene.bodies[1].jitter.position = {0, 0, 0.01};
    for (std::size_t i = 2; i < scene.bodies.size(); ++i) scene.bodies[i].jitter.with = BodyId(1);
    return scene;
  };
  t.value = [](const Seen& s, int w) {
    double lowest = std::numeric_limits<double>::infinity();
    for (int b = 0; b < s.bodies(); ++b) {
      const Vec3 down = s.rotation(w, b).inverse() * Vec3::UnitZ();
      const Vec3 half = b == 0 ? Vec3(0.3, 0.3, 0.05) : Vec3(0.02, 0.02, 0.05);
      lowest = std::min(lowest, s.position(w, b).z() - half.dot(down.cwiseAbs()));
    }
    return -lowest;
  };
  return t;
}

// Arms of ten driven links each, from soft to stiff, under loads that the soft ones drop.
Trial driven_arms() {
  Trial t = trial("J4", "arms of 10 driven hinges, 200 to 20,000 N m/rad, under 1 to 100 kg",
                  "gap of a joint, in links", "", 0.01, 10);
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    for (const double gain : {200.0, 2000.0, 20000.0}) {
      for (const double load : {1.0, 10.0, 100.0}) {
        const Drive drive{0, 0, Spring{gain, gain / 20, 0, 0}};
        scenes::add_rods(scene, 10, 0.2, load, HingeJoint{std::nullopt, drive});
      }
    }
    for (Body& link : scene.bodies) link.jitter.linear_velocity = {0, 0.05, 0};
    return scene;
  };
  t.value = [](const Seen& s, int w) { return s.worst_gap(w) / 0.2; };
  return t;
}

// Every stiffness that is asked for, on chains of every length.
Trial frequencies() {
  Trial t = trial("J5", "joints of 10 to 1000 Hz on chains of 3 to 40 links",
                  "fraction of worlds lost", "", 0, 5);
  t.scene = [] { return swung_chain(1); };
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    double lost = 0, all = 0;
    for (const double frequency : {10.0, 60.0, 240.0, 1000.0}) {
      for (const int links : {3, 10, 40}) {
        Scene scene = swung_chain(1, links);
        scene.options = plan.scene().options;
        scene.options.joint.frequency = frequency;
        Batch batch(compile(scene), options);
        batch.step(300);
        for (int w = 0; w < batch.worlds(); ++w) lost += batch.status(w) == Status::ok ? 0 : 1;
        all += batch.worlds();
      }
    }
    return lost / all;
  };
  return t;
}

// A chain at rest that breaks at 1.05 times what it bears.
Trial hung_chain() {
  Trial t = trial("J6", "ten links at rest on joints that break at 1.05 times their loads",
                  "fall after 2 s", "m", 0.01, 2);
  t.at_end = true;
  t.scene = [] {
    Scene scene = empty(Space::planar, 10);
    for (int i = 0; i < kLinks; ++i) {
      scene.add(
          lump(Space::planar, 1, Vec3::Constant(kLink * kLink / 12), {0, -(i + 0.5) * kLink, 0}));
      Joint joint =
          joint_at(scene, BodyId(i - 1), BodyId(i), frame_at(0, -i * kLink), HingeJoint{});
      joint.break_force = 1.05 * 10 * (kLinks - i);
      scene.add(joint);
    }
    return scene;
  };
  t.value = [](const Seen& s, int w) { return -s.moved(w, kLinks - 1).y(); };
  return t;
}

Trial gripper() {
  Trial t = trial("J7", "fingers of 50 g on a hand on an arm grip a box of 2 kg with 60 N",
                  "slip in 10 s", "m", 1e-3, 11);
  t.from = 1;
  t.scene = [] {
    Scene scene = scenes::gripper(2);
    scene.bodies.back().jitter.position = {2e-3, 0, 2e-3};
    return scene;
  };
  // Against the hand, across the fingers, from where it was when the grip was closed. Along them
  // two forces of a size hold it nowhere.
  t.whole = [](const Plan& plan, const BatchOptions& options) {
    Batch batch(plan, options);
    const double dt = plan.scene().options.dt;
    batch.step(static_cast<int>(std::lround(1 / dt)));
    Seen start(batch), now(batch);
    batch.step(static_cast<int>(std::lround(10 / dt)));
    now.look(11);
    const auto place = [](const Seen& s, int w) {
      const Vec3 from_hand = s.position(w, scenes::kGripped) - s.position(w, scenes::kHand);
      return Vec3(s.rotation(w, scenes::kHand).inverse() * from_hand);
    };
    double most = 0;
    for (int w = 0; w < batch.worlds(); ++w) {
      if (batch.status(w) != Status::ok) return std::numeric_limits<double>::infinity();
      const Vec3 slip = place(now, w) - place(start, w);
      most = std::max(most, std::hypot(slip.x(), slip.z()));
    }
    return most;
  };
  return t;
}

}  // namespace

std::vector<Trial> tree_trials() {
  std::vector<Trial> out = {arms_gap(), arms_energy()};
  for (const double load : {10.0, 100.0, 1000.0}) {
    out.push_back(chain_gap(load));
    out.push_back(chain_gain(load));
    out.push_back(chain_loss(load));
  }
  for (const double times : {10.0, 100.0}) out.push_back(legs(times));
  for (const Trial& t : {driven_arms(), frequencies(), hung_chain(), gripper()}) out.push_back(t);
  return out;
}

}  // namespace manyworlds::report
