// Which features a step needs, and why.
#include <algorithm>

#include "src/plan/pair_kinds.hpp"
#include "src/plan/reshaped.hpp"

namespace manyworlds {

namespace {

class Chooser {
 public:
  explicit Chooser(PlanData& plan) : plan_(plan) {}

  void set(Feature feature, bool needed, const char* why_in, const char* why_out) {
    const auto i = static_cast<std::size_t>(feature);
    const auto& keep = plan_.options.keep;
    const bool kept = std::find(keep.begin(), keep.end(), feature) != keep.end();
    plan_.in[i] = needed || kept;
    plan_.why[i] = needed ? why_in : kept ? "kept on request" : why_out;
  }

 private:
  PlanData& plan_;
};

bool is_isotropic(const PlanBody& body) {
  return body.inertia.maxCoeff() - body.inertia.minCoeff() <= 1e-9 * body.inertia.maxCoeff();
}

// test(material of A, material of B), for pairs that can touch.
template <class Test>
bool any_pair(const PlanData& plan, const Scene& scene, Test test) {
  const auto material = [&](const auto& shape) -> const Material& {
    return scene.bodies[static_cast<std::size_t>(shape.scene_body)]
        .shapes[static_cast<std::size_t>(shape.shape)]
        .material;
  };
  for (const PlanClass& c : plan.classes) {
    for (std::size_t i = 0; i < c.a.size(); ++i) {
      const auto a = static_cast<std::size_t>(c.a[i]), b = static_cast<std::size_t>(c.b[i]);
      const Material& of_a =
          is_fixed(c.list) ? material(plan.fixed[a]) : material(plan.colliders[a]);
      if (test(of_a, material(plan.colliders[b]))) return true;
    }
  }
  return false;
}

}  // namespace

void choose_features(PlanData& plan) {
  const Scene& scene = plan.scene;
  const bool planar = scene.space == Space::planar;
  // A feature is in when any world may need it.
  const std::vector<Scene> possible = extremes(plan);
  const Scene& most = possible.back();
  Chooser choose(plan);

  bool round = true, isotropic = true;
  for (const PlanCollider& c : plan.colliders) {
    round = round && info(c.kind).ball && c.offset.isZero(0) &&
            !plan.bodies[static_cast<std::size_t>(c.body)].shifted;
  }
  for (const PlanBody& b : plan.bodies) {
    isotropic = isotropic && is_isotropic(b) && (round || !may_be_reshaped(plan, b.scene_body));
  }
  const bool joints = !scene.joints.empty();
  // A body without shapes has an orientation that users may read.
  round = round && plan.colliders.size() >= plan.bodies.size();
  const bool thrust = !plan.thrusts.empty(), trees = plan.has_trees();
  plan.orientations_matter = !(round && isotropic) || joints || thrust || trees;
  choose.set(Feature::orientation, plan.orientations_matter,
             trees    ? "links have orientations"
             : joints ? "joint frames depend on it"
             : thrust ? "the direction of thrust depends on it"
                      : "shapes or inertia tensors depend on it",
             "every moving body is a centred ball");
  // Joints are solved with full tensors only: few jointed bodies are isotropic.
  choose.set(
      Feature::inertia, !planar && (!isotropic || joints || trees),
      trees       ? "links have inertia tensors"
      : isotropic ? "joints use inertia tensors"
                  : "a body has unequal moments of inertia",
      planar ? "planar bodies have one moment of inertia" : "all inertia tensors are isotropic");
  // A kept tensor needs the orientation that rotates it.
  if (plan.has(Feature::inertia) && !plan.has(Feature::orientation)) {
    choose.set(Feature::orientation, true, "the kept inertia tensors depend on it", "");
  }
  const bool tensor = !planar && plan.has(Feature::inertia);
  plan.inertia_kind = planar   ? kernels::InertiaKind::planar
                      : tensor ? kernels::InertiaKind::tensor
                               : kernels::InertiaKind::isotropic;

  choose.set(Feature::joints, joints, "the scene has joints", "no joints");
  const bool contacts = any_pair(plan, most, [](const auto&, const auto&) { return true; });
  choose.set(Feature::contacts, contacts, "some shapes can touch", "no pair of shapes can touch");
  choose.set(Feature::friction,
             any_pair(plan, most,
                      [trees](const auto& a, const auto& b) {
                        return (a.friction > 0 && b.friction > 0) ||
                               trees;  // which have the larger one
                      }),
             "some pairs have friction", "no pair has friction");
  choose.set(
      Feature::restitution,
      any_pair(plan, most,
               [](const auto& a, const auto& b) { return a.restitution > 0 || b.restitution > 0; }),
      "some pairs bounce", "no pair bounces");

  choose.set(
      Feature::resistance,
      any_pair(plan, most, [&](const auto& a, const auto& b) { return resists(a) || resists(b); }),
      "some pairs resist rolling or spinning", "no pair resists rolling or spinning");

  const double friction = plan.colliders.empty() ? 0 : plan.colliders.front().material.friction;
  const auto differs = [&](const auto& shape) { return shape.material.friction != friction; };
  plan.uniform_friction = std::none_of(plan.colliders.begin(), plan.colliders.end(), differs) &&
                          std::none_of(plan.fixed.begin(), plan.fixed.end(), differs);
  for (const VariedNumber& n : plan.varied) {
    plan.uniform_friction = plan.uniform_friction && n.parameter != Parameter::friction;
  }

  bool drag = false, gravity = false;
  for (const Scene& s : possible) {
    Vec3 common = Vec3::Zero();
    for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
      const PlanBody& b = plan.bodies[i];
      if (b.inv_mass > 0) {
        const Body& body = s.bodies[static_cast<std::size_t>(b.scene_body)];
        plan.slows = plan.slows || body.linear_drag > 0;
        drag = drag || body.linear_drag > 0 || body.angular_drag > 0;
        const Vec3 g = s.options.gravity * body.gravity_scale + body.linear_drag * s.options.wind;
        gravity = gravity || !g.isZero(0);
        if (i == 0) common = g;
        plan.uniform_gravity = plan.uniform_gravity && g == common;
      } else {
        plan.uniform_gravity = plan.uniform_gravity && common.isZero(0);
      }
    }
  }
  const auto is_wind = [](const VariedNumber& n) { return n.parameter == Parameter::wind; };
  const bool wind =
      !scene.options.wind.isZero(0) || std::any_of(plan.varied.begin(), plan.varied.end(), is_wind);
  for (const VariedNumber& n : plan.varied) {
    const bool of_bodies = n.parameter == Parameter::gravity_scale || (is_wind(n) && plan.slows) ||
                           (n.parameter == Parameter::linear_drag && wind);
    plan.uniform_gravity = plan.uniform_gravity && !of_bodies;
  }
  choose.set(Feature::drag, drag, "some bodies have drag", "no body has drag");
  choose.set(Feature::gravity, gravity, "gravity or wind acts on some bodies",
             "no gravity and no wind");
}

}  // namespace manyworlds
