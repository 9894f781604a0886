// The caller's floating-point mode changes nothing: every public call that computes is made in
// several modes and compared with what it gives in the default one. (Those of recordings and MJCF
// are in tests/record and tests/mjcf.) over 400 lines because it is the one list of calls that
// compute.
#include <catch2/catch.hpp>

#include <limits>
#include <utility>

#include "manyworlds/environment.hpp"
#include "manyworlds/hull.hpp"
#include "manyworlds/mesh.hpp"
#include "manyworlds/query.hpp"
#include "manyworlds/scenes.hpp"
#include "manyworlds/tasks.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/float_modes.hpp"
#include "tests/support/meshes.hpp"
#include "tests/support/tables.hpp"
#include "tests/support/varied.hpp"

namespace manyworlds::test {
namespace {

// Numbers on which rounding and denormals show.
constexpr double kThird = 1.0 / 3, kTiny = 3e-310;

void add(StateBytes& out, const MassProperties& m) {
  out.add(m.mass);
  out.add(m.center);
  out.add(m.inertia);
}
void add(StateBytes& out, const Frame& f) {
  out.add(f.position);
  out.add(f.rotation.coeffs());
}
void add(StateBytes& out, const std::vector<Issue>& issues) {
  out.add(issues.size());
  for (const Issue& issue : issues) out.add(to_string(issue));
}
void add(StateBytes& out, const Scene& scene) {
  for (const Body& b : scene.bodies) {
    out.add(b.position);
    out.add(b.rotation.coeffs());
    for (const Shape& s : b.shapes) out.add(s.position);
    if (b.mass_properties) add(out, *b.mass_properties);
  }
  for (const Joint& j : scene.joints) add(out, j.frame_a), add(out, j.frame_b);
  out.add(scene.options.dt);
}
StateBytes bytes_of(const Batch& batch) {
  StateBytes out;
  const Snapshot saved = batch.save();
  for (const std::byte b : saved.bytes()) out.add(b);
  for (const Field field :
       {Field::position, Field::orientation, Field::linear_velocity, Field::angular_velocity}) {
    std::vector<double> values(batch.size(field));
    batch.read(field, values);
    out.add(values);
  }
  return out;
}

Scene sensitive_scene() {
  Scene scene = varied_crowd(Space::spatial, true);
  scene.bodies[4].linear_velocity.x() = kTiny;
  scene.bodies[5].position.x() += kThird;
  scene.bodies[5].shapes[0].position.x() = 0.1;  // off the body frame
  scene.attractors.push_back({{0, kThird, 1}, 0.1, 0.3});
  scene.controls.push_back(
      {"thrust", ControlKind::thrust, {}, BodyId(4), {0, 0, 0.1}, {1, kThird, 0}, -1, 1, 0});
  return scene;
}

BatchOptions options(int worlds = 3) {
  BatchOptions out = options_of(widest_tables().back(), worlds, 5);
  out.threads = 2;
  out.observe.what = {Observer::contacts, Observer::motion, Observer::penetration};
  out.observe.rays = {{{0, 0.1, 3}, {0.1, kThird, -1}, 10, {}, ~0u}};
  return out;
}

Batch moved_batch() {
  Batch batch(compile(sensitive_scene()), options());
  batch.step(30);
  return batch;
}

// A call on a batch, and all of the batch after it.
ModeEntry on_batch(const char* name, std::function<void(Batch&)> call) {
  return {name, [call = std::move(call)](const InMode& in_mode) {
            Batch batch = moved_batch();
            in_mode([&] { call(batch); });
            batch.step(2);
            return bytes_of(batch);
          }};
}
// What a call on a batch gives.
ModeEntry from_batch(const char* name, std::function<void(const Batch&, StateBytes&)> call) {
  return {name, [call = std::move(call)](const InMode& in_mode) {
            const Batch batch = moved_batch();
            StateBytes out;
            in_mode([&] { call(batch, out); });
            return out;
          }};
}
ModeEntry plain(const char* name, std::function<void(StateBytes&, const InMode&)> call) {
  return {name, [call = std::move(call)](const InMode& in_mode) {
            StateBytes out;
            call(out, in_mode);
            return out;
          }};
}

std::vector<ModeEntry> scene_entries() {
  return {
      plain("validate",
            [](StateBytes& out, const InMode& in_mode) {
              Scene scene = sensitive_scene();
              scene.options.dt = -kThird;
              scene.bodies[3].shapes[0].density = kTiny;
              std::vector<Issue> issues;
              in_mode([&] { issues = validate(scene); });
              add(out, issues);
            }),
      plain("compile, fingerprint, report",
            [](StateBytes& out, const InMode& in_mode) {
              const Scene scene = sensitive_scene();
              in_mode([&] {
                const Plan plan = compile(scene);
                out.add(plan.fingerprint());
                out.add(plan.report().bytes_per_world);
              });
            }),
      plain("mass_properties",
            [](StateBytes& out, const InMode& in_mode) {
              const Scene scene = sensitive_scene();
              for (const Body& body : scene.bodies) {
                if (body.motion != Motion::dynamic) continue;
                MassProperties m;
                in_mode([&] { m = mass_properties(scene, body); });
                add(out, m);
              }
            }),
      plain("frame_in_world, joint_at",
            [](StateBytes& out, const InMode& in_mode) {
              const Scene scene = contraption(Space::spatial);
              const Frame frame{{0.1, kThird, 0.7}, Quat(1, 0.1, 0.2, 0.3)};
              Frame found;
              Joint joint;
              in_mode([&] {
                found = frame_in_world(scene, BodyId(3), frame);
                joint = joint_at(scene, BodyId(1), BodyId(3), frame, HingeJoint{});
              });
              add(out, found);
              add(out, joint.frame_a);
              add(out, joint.frame_b);
            }),
      plain("make_hull",
            [](StateBytes& out, const InMode& in_mode) {
              std::vector<Vec3> points = wedge_hull(kThird).vertices;
              points.push_back(Vec3(0.01, 0.02, 0.03));
              Hull hull;
              in_mode([&] { hull = make_hull(points); });
              for (const Vec3& v : hull.vertices) out.add(v);
            }),
      plain("meshes",
            [](StateBytes& out, const InMode& in_mode) {
              TriangleMesh mesh = box_mesh(Vec3(kThird, 0.7, 1.1));
              MassProperties m;
              in_mode([&] {
                out.add(validate(mesh).size());
                out.add(volume(mesh));
                m = mass_properties(mesh, 777.7);
              });
              add(out, m);
              mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
              std::vector<Issue> issues;
              in_mode([&] { issues = validate(mesh); });
              add(out, issues);
            }),
      plain("scenes and tasks with a name",
            [](StateBytes& out, const InMode& in_mode) {
              std::vector<Scene> made;
              in_mode([&] {
                for (const auto& entry : scenes::all()) made.push_back(entry.make());
                for (const auto& entry : tasks::all()) made.push_back(entry.make().scene);
                made.push_back(*scenes::sized("bin-boxes:30"));
              });
              for (const Scene& scene : made) add(out, scene);
            }),
  };
}

std::vector<ModeEntry> query_entries() {
  static const Pose kA{{0.1, 0.2, kThird}, Quat(1, 0.1, 0.2, 0.3)},
      kB{{0.9, 0.5, 0.4}, Quat::Identity()};
  const auto shapes = [] {
    return std::pair(shape_of(Box{{0.5, 0.4, kThird}}), shape_of(Hull{wedge_hull(0.5)}));
  };
  return {
      plain("distance, overlap",
            [shapes](StateBytes& out, const InMode& in_mode) {
              const auto pair = shapes();
              const auto &a = pair.first, &b = pair.second;
              Separation s;
              bool over = false;
              in_mode([&] {
                s = distance(a, kA, b, kB);
                over = overlap(a, kA, b, kB);
              });
              out.add(s.distance);
              out.add(s.point_a);
              out.add(s.normal);
              out.add(over);
            }),
      plain("manifold",
            [shapes](StateBytes& out, const InMode& in_mode) {
              const auto pair = shapes();
              const auto &a = pair.first, &b = pair.second;
              std::vector<ManifoldPoint> points;
              in_mode([&] { points = manifold(a, kA, b, kB, 0.5); });
              for (const ManifoldPoint& p : points) out.add(p.point), out.add(p.separation);
            }),
      plain("ray_cast",
            [shapes](StateBytes& out, const InMode& in_mode) {
              const Shape b = shapes().second;
              const Ray ray{{0.8, 0.4, 5}, {0.01, 0.02, -1}, 10, {}, ~0u};
              std::optional<RayHit> hit;
              in_mode([&] { hit = ray_cast(b, kB, ray); });
              REQUIRE(hit);
              out.add(hit->distance);
              out.add(hit->normal);
            }),
  };
}

std::vector<ModeEntry> batch_entries() {
  static const std::vector<std::uint8_t> kSome = {1, 0, 1};
  static const Vec3 kPush(0.1, kThird, 0.7), kPoint(0.3, 0.1, kThird);
  const auto values = [](const Batch& batch, Field field) {
    std::vector<double> out(batch.size(field));
    batch.read(field, out);
    for (double& x : out) x = x * 1.1 + kTiny;
    return out;
  };
  return {
      {"constructor",
       [](const InMode& in_mode) {
         const Plan plan = compile(sensitive_scene());
         std::optional<Batch> batch;
         in_mode([&] { batch.emplace(plan, options()); });
         return bytes_of(*batch);
       }},
      on_batch("step", [](Batch& b) { b.step(3); }),
      on_batch("step of some", [](Batch& b) { b.step(kSome, 3); }),
      on_batch("reset", [](Batch& b) { b.reset(); }),
      on_batch("reset of some", [](Batch& b) { b.reset(kSome); }),
      on_batch("reset with seeds",
               [](Batch& b) {
                 b.reset(kSome, std::vector<std::uint64_t>{7, 8, 9});
               }),
      on_batch("add_force", [](Batch& b) { b.add_force(1, BodyId(4), kPush); }),
      on_batch("add_torque", [](Batch& b) { b.add_torque(1, BodyId(4), kPush); }),
      on_batch("add_force_at", [](Batch& b) { b.add_force_at(1, BodyId(4), kPush, kPoint); }),
      on_batch("add_impulse", [](Batch& b) { b.add_impulse(1, BodyId(4), kPush); }),
      on_batch("add_angular_impulse", [](Batch& b) { b.add_angular_impulse(1, BodyId(4), kPush); }),
      on_batch("add_impulse_at", [](Batch& b) { b.add_impulse_at(1, BodyId(4), kPush, kPoint); }),
      on_batch("spawn",
               [](Batch& b) {
                 b.spawn(1, BodyId(4), {kPoint, Quat(1, 0.1, 0.2, 0.3), kPush, kPush});
               }),
      on_batch("set_enabled, wake, copy_world",
               [](Batch& b) {
                 b.set_enabled(0, BodyId(3), false);
                 b.wake(1);
                 b.copy_world(1, 2);
               }),
      on_batch("save, restore",
               [](Batch& b) {
                 const Snapshot saved = Snapshot::from_bytes(b.save().bytes());
                 b.reset();
                 b.restore(saved);
                 b.restore(saved, 0, 1);
               }),
      on_batch("set_rays, look",
               [](Batch& b) {
                 const std::vector<Ray> rays = {{kPoint, kPush, 7, BodyId(4), ~0u}};
                 b.set_rays(rays);
                 b.set_rays(1, rays);
                 b.look();
               }),
      {"step_to, time",
       [](const InMode& in_mode) {
         Batch batch = moved_batch();
         StateBytes out;
         in_mode([&] {
           out.add(batch.step_to(0.2501, 100));
           out.add(batch.time());
         });
         return out;
       }},
      {"write",
       [values](const InMode& in_mode) {
         Batch batch = moved_batch();
         for (const Field field : {Field::position, Field::orientation, Field::linear_velocity,
                                   Field::angular_velocity}) {
           const std::vector<double> all = values(batch, field);
           const std::vector<float> narrow(all.begin(), all.end());
           const std::span<const double> one = std::span(all).subspan(0, all.size() / 3);
           in_mode([&] {
             batch.write(field, narrow);
             batch.write(field, all);
             batch.write(field, 1, one);
           });
         }
         return bytes_of(batch);
       }},
      {"set_initial",
       [values](const InMode& in_mode) {
         Batch batch = moved_batch();
         const std::vector<double> all = values(batch, Field::position);
         in_mode([&] {
           batch.set_initial(Field::position, all);
           batch.reset();
         });
         return bytes_of(batch);
       }},
      {"parameters",
       [](const InMode& in_mode) {
         Batch batch = moved_batch();
         std::vector<double> read(batch.size(Parameter::density));
         in_mode([&] {
           batch.read(Parameter::density, read);
           batch.write(Parameter::density, read);
         });
         StateBytes out = bytes_of(batch);
         out.add(read);
         return out;
       }},
      {"controls",
       [](const InMode& in_mode) {
         Batch batch = moved_batch();
         const std::vector<double> set = {0.1, kThird, 5};
         std::vector<float> read(3);
         in_mode([&] {
           batch.set_controls(set);
           batch.read_controls(std::span<float>(read));
         });
         batch.step();
         StateBytes out = bytes_of(batch);
         out.add(read);
         return out;
       }},
      from_batch("read",
                 [](const Batch& b, StateBytes& out) {
                   for (const Field f : {Field::position, Field::orientation}) {
                     std::vector<float> narrow(b.size(f));
                     std::vector<double> wide(b.size(f));
                     b.read(f, narrow);
                     b.read(f, wide);
                     out.add(narrow);
                     out.add(wide);
                   }
                 }),
      from_batch("hash, status, energy",
                 [](const Batch& b, StateBytes& out) {
                   out.add(b.hash());
                   out.add(b.status(1));
                   const Energy e = b.energy(1);
                   out.add(e.kinetic);
                   out.add(e.potential);
                   out.add(b.awake_fraction());
                 }),
      from_batch("contacts",
                 [](const Batch& b, StateBytes& out) {
                   for (const Contact& c : b.contacts(1)) out.add(c.point), out.add(c.separation);
                   const ContactSummary s = b.measure_contacts();
                   out.add(s.points_per_world);
                   out.add(s.manifolds_per_world);
                   out.add(s.max_penetration);
                   out.add(s.mean_occupancy);
                 }),
      from_batch("observers",
                 [](const Batch& b, StateBytes& out) {
                   for (const Observed what : {Observed::kinetic_energy, Observed::momentum,
                                               Observed::penetration, Observed::ray_distance}) {
                     std::vector<float> narrow(b.size(what));
                     b.read(what, narrow);
                     out.add(narrow);
                   }
                   for (const StepContact& c : b.step_contacts(1)) out.add(c.normal_impulse);
                   for (const RayHit& hit : b.ray_hits(1)) out.add(hit.normal);
                 }),
  };
}

std::vector<ModeEntry> task_entries() {
  return {
      plain("validate of a task",
            [](StateBytes& out, const InMode& in_mode) {
              Task task = tasks::find("Pendulum")->make();
              task.actions[0].low = kThird + 1;
              task.actions[0].high = kThird;
              std::vector<Issue> issues;
              in_mode([&] { issues = validate(task); });
              add(out, issues);
            }),
      {"Environment",
       [](const InMode& in_mode) {
         Task task = tasks::find("Pendulum")->make();
         const std::vector<float> actions = {0.1f, 0.3f, 5};
         const std::vector<std::uint8_t> some = {0, 1, 1};
         std::vector<float> seen(3 * task.observations.size());
         std::vector<double> rewards(3);
         StateBytes out;
         std::optional<Environment> environment;
         in_mode([&] {
           // Made within: what a user writes in his own mode are exact numbers.
           task.rewards.push_back({"", sin(terms::age()) * 2 - square(terms::age())});
           environment.emplace(task, EnvironmentOptions{.worlds = 3, .threads = 2});
           environment->step(actions, {.observations = seen, .rewards = rewards});
           out.add(seen);
           out.add(rewards);
           const EnvironmentSnapshot saved = environment->save();
           environment->reset(some, std::vector<std::uint64_t>{1, 2, 3}, seen);
           out.add(seen);
           environment->reset(some, seen);
           environment->copy_world(0, 1);
           environment->restore(saved);
           environment->restore(saved, 0, 2);
           environment->begin(some, seen);
           out.add(seen);
         });
         StateBytes after = bytes_of(environment->batch());
         CHECK(!after.empty());
         return out;
       }},
  };
}

}  // namespace

TEST_CASE("the caller's floating-point mode changes no bit of scenes and plans", "[fast][mode]") {
  check_modes(scene_entries());
}
TEST_CASE("the caller's floating-point mode changes no bit of a query", "[fast][mode]") {
  check_modes(query_entries());
}
TEST_CASE("the caller's floating-point mode changes no bit of a batch", "[fast][mode]") {
  check_modes(batch_entries());
}
TEST_CASE("the caller's floating-point mode changes no bit of an environment", "[fast][mode]") {
  check_modes(task_entries());
}

}  // namespace manyworlds::test
