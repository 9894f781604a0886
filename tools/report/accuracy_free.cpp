// Cases without contacts and joints: free rotation, an orbit, a spring (numerics.md A1 to A5).
#include <cmath>

#include "tools/report/accuracy.hpp"
#include "tools/report/reference.hpp"

namespace manyworlds::report {
namespace {

// A body that tumbles freely from rest at q = 1, and its orientation at the end.
Case tumbling(const std::string& id, const std::string& title, const Vec3& moments,
              const Vec3& spin, double seconds, const Quat& end) {
  Case c;
  c.id = id, c.title = title;
  c.metric = "orientation error at the end", c.unit = "rad";
  c.level = 1e-2;
  c.seconds = c.quick_seconds = seconds;
  c.steps = halvings(1.0 / 30, 9), c.quick_steps = halvings(1.0 / 60, 4);
  c.methods = all_integrators();
  c.methods.push_back({"runge-kutta4, momentum", [](Options& o) {
                         o.integrator = Integrator::runge_kutta4, o.substeps = 1;
                         o.angular_momentum = true;
                       }});
  c.scene = [=] {
    Scene scene = empty(Space::spatial, 0);
    scene.add(lump(Space::spatial, 1, moments, Vec3::Zero()));
    scene.bodies[0].angular_velocity = spin;
    return scene;
  };
  c.error = [=](const Batch& b, double) { return angle_between(rotation(b, 0, 0), end); };
  return c;
}

}  // namespace

std::vector<Case> free_cases() {
  std::vector<Case> out;
  out.push_back(tumbling("A1", "free body, three moments (OSRF)", {0.8083333, 0.6833333, 0.1416667},
                         {0.1, 5, 0.1}, 10,
                         Quat(0.225164563413958164, -0.619927562499452488, -0.277029150687194592,
                              0.698745723640310141)));
  // The rows of numerics.md App. A17 that name an engine's scheme; h = 1e-3.
  out.back().published = {{"Jolt's rule", 1e-3, 0.156}, {"Bullet's and Box3D's rule", 1e-3, 0.33}};
  out.push_back(tumbling("A2", "free box (MuJoCo)", Vec3(0.13, 0.10, 0.05) / 3, {1, 2, 3}, 5,
                         Quat(-0.3648637429868626, 0.0235633573425886834, 0.0212620010520073973,
                              -0.930519824912734775)));
  out.push_back(tumbling("A3", "free axisymmetric body (Drake)", {0.04, 0.04, 0.02}, {2, 4, 6}, 10,
                         Quat(-0.185871916511537869, 0.195938189833834226, -0.785967065292867107,
                              -0.556161513134346803)));

  Case kepler;
  kepler.id = "A4", kepler.title = "orbit of eccentricity 0.6, ten periods";
  kepler.metric = "position error at the end", kepler.unit = "m";
  kepler.level = 1e-2;
  kepler.seconds = kepler.quick_seconds = 20 * kPi;
  kepler.steps = halvings(2 * kPi / 100, 8), kepler.quick_steps = halvings(2 * kPi / 200, 4);
  kepler.methods = all_integrators();
  kepler.scene = [] {
    Scene scene = empty(Space::planar, 0);
    scene.add(lump(Space::planar, 1, Vec3::Ones(), {0.4, 0, 0}));
    scene.bodies[0].linear_velocity = {0, 2, 0};
    scene.attractors = {{Vec3::Zero(), 1, 0}};
    return scene;
  };
  kepler.error = [](const Batch& b, double) {
    return (position(b, 0, 0) - Vec3(0.4, 0, 0)).norm();
  };
  out.push_back(kepler);

  Case spring;
  spring.id = "A5", spring.title = "mass on a spring, ten swings";
  spring.metric = "largest error of cos(2 pi t)", spring.unit = "m";
  spring.level = 1e-2;
  spring.seconds = spring.quick_seconds = 10.25;
  spring.steps = halvings(1.0 / 20, 8), spring.quick_steps = halvings(1.0 / 40, 4);
  spring.methods = all_integrators();
  spring.scene = [] {
    Scene scene = empty(Space::planar, 0);
    scene.add(lump(Space::planar, 1, Vec3::Ones(), {1, 0, 0}));
    Joint joint;
    TargetJoint target;
    target.spring.stiffness = 4 * kPi * kPi;
    joint.type = target, joint.body_b = BodyId(0);
    scene.add(joint);
    return scene;
  };
  spring.over = Over::largest;
  spring.error = [](const Batch& b, double t) {
    return std::abs(position(b, 0, 0).x() - std::cos(2 * kPi * t));
  };
  out.push_back(spring);
  return out;
}

}  // namespace manyworlds::report
