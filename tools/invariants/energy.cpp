// Energy of single hits: what Newton's law of restitution determines, without and with friction.
#include <algorithm>
#include <cmath>
#include <string>

#include "tools/invariants/energy_hits.hpp"

namespace manyworlds::invariants {
namespace {

// ---- judges
// ---------------------------------------------------------------------------------------

// Deviation of the kinetic energy from its value at the start.
Judge elastic_judge(const DrawnHit& drawn) {
  return [bodies = std::vector{drawn.hit.a, drawn.hit.b}, start = 0.0](const Seen& seen) mutable {
    const double now = energy_of(bodies, seen.now);
    if (seen.step == 0) start = now;
    return std::abs(now / start - 1);
  };
}

// Velocity and angular momentum do not change after the hit. So they give the velocities at the
// moment of touch, whatever the rotation since then.
void read_after(const Seen& seen, const Hit& touch, Rigid& a, Rigid& b) {
  a = touch.a, b = touch.b;
  for (const auto& [body, i] : {std::pair(&a, 0), std::pair(&b, 1)}) {
    if (body->inv_mass == 0) continue;
    Rigid now = *body;
    read_state(seen.now[static_cast<std::size_t>(i)], now);
    body->velocity = now.velocity, body->momentum = now.momentum;
  }
}
bool is_after(const Seen& seen, const Hit& hit) {
  return !hit.points.empty() && seen.step > std::floor(hit.lead) + 1;
}

// Largest speed along the normal at a point with an impulse, and of approach at the others.
Judge plastic_judge(const DrawnHit& drawn) {
  std::vector<double> impulses = drawn.hit.frictionless_impulses();
  const double most = impulses.empty() ? 0 : *std::max_element(impulses.begin(), impulses.end());
  for (double& p : impulses) p /= most;
  return [touch = drawn.hit, after = drawn.hit, impulses](const Seen& seen) mutable {
    // Hits of two are so slow that rounding of the distance moves them by a step.
    if (!is_after(seen, touch) || (touch.a.inv_mass > 0 && !seen.last)) return 0.0;
    read_after(seen, touch, after.a, after.b);
    double worst = 0;
    for (std::size_t i = 0; i < impulses.size(); ++i) {
      const double approach = after.approach_at(touch.points[i]) / touch.speed;
      worst = std::max(worst, impulses[i] > 1e-3 ? std::abs(approach) : approach);
    }
    return worst;
  };
}

// Distance from the expected state after the hit: root of the energy of the difference over the
// energy that the hit turns over.
Judge closed_form_judge(const DrawnHit& drawn, const Vec3& impulse) {
  Hit expected = drawn.hit;
  if (!expected.points.empty()) expected.push(impulse);
  return [touch = drawn.hit, expected, after = drawn.hit](const Seen& seen) mutable {
    if (!is_after(seen, touch)) return 0.0;
    read_after(seen, touch, after.a, after.b);
    double energy = 0;
    for (const auto& [is, shall] : {std::pair(&after.a, &expected.a), {&after.b, &expected.b}}) {
      if (is->inv_mass == 0) continue;
      is->velocity -= shall->velocity, is->momentum -= shall->momentum;
      energy += is->energy();
    }
    const Vec3 u = touch.approach();
    return std::sqrt(2 * energy / u.dot(touch.response().fullPivLu().solve(u)));
  };
}

// Of a ball on a plane or two balls: the impulse along the normal does not depend on friction.
Vec3 impulse_of_balls(const Hit& hit) {
  if (hit.points.empty()) return Vec3::Zero();
  const Vec3 u = hit.approach(), slip = u - u.dot(hit.normal) * hit.normal;
  const double normal = -(1 + hit.restitution) * u.dot(hit.normal) * hit.reduced_mass();
  if (slip.isZero()) return normal * hit.normal;
  const Vec3 along = slip.normalized();
  const double stops = slip.norm() / along.dot(hit.response() * along);
  return normal * hit.normal - std::min(stops, hit.friction * normal) * along;
}

// With friction that keeps the contact from slipping all along.
Vec3 sticking_impulse(const Hit& hit) {
  return hit.points.empty() ? Vec3(Vec3::Zero()) : hit.impulse_without_slip();
}

// Between the energy at the start and what an impact that stops all motion at the contact leaves.
Judge bounds_judge(const DrawnHit& drawn) {
  double least = 0;
  if (drawn.hit.points.size() == 1) {
    Hit stopped = drawn.hit;
    stopped.push(stopped.response().fullPivLu().solve(-stopped.approach()));
    least = stopped.a.energy() + stopped.b.energy();
  }
  return [bodies = std::vector{drawn.hit.a, drawn.hit.b}, start = 0.0, least,
          end = std::floor(drawn.hit.lead) + 2](const Seen& s) mutable {
    const double now = energy_of(bodies, s.now);
    if (s.step == 0) start = now;
    // A body that slides may hit again later.
    return std::max(now - start, s.step <= end ? least - now : 0.0) / start;
  };
}

// ---- families
// -------------------------------------------------------------------------------------

enum class What { elastic, plastic, balls, sticks, bounds };

Drawn hit_world(Random& kind, Random& state, const Scale& scale, const HitOptions& options,
                What what) {
  DrawnHit drawn = draw_hit(kind, state, scale, options);
  // All points of a face act like one below the centre of mass.
  if (drawn.hit.flat && what == What::sticks) drawn.hit.points = {drawn.hit.b.position};
  Drawn out;
  switch (what) {
    case What::elastic: out.judge = elastic_judge(drawn); break;
    case What::plastic: out.judge = plastic_judge(drawn); break;
    case What::balls: out.judge = closed_form_judge(drawn, impulse_of_balls(drawn.hit)); break;
    case What::sticks: out.judge = closed_form_judge(drawn, sticking_impulse(drawn.hit)); break;
    case What::bounds: out.judge = bounds_judge(drawn); break;
  }
  out.scene = std::move(drawn.scene), out.steps = kHitSteps;
  return out;
}

Family hit_family(const std::string& id, const std::string& title, const HitOptions& options,
                  What what) {
  Family f;
  f.id = id + (options.space == Space::planar ? " 2D" : " 3D");
  f.law = Law::energy;
  f.title = title + ", resolved by the step";
  switch (what) {
    case What::elastic:
      f.criterion = "relative change of the kinetic energy", f.limit = 0.02;
      break;
    case What::plastic:
      f.criterion =
          "largest normal speed after the impact at the points that touch, over the "
          "speed of approach";
      f.limit = 0.01;
      break;
    case What::balls:
    case What::sticks:
      f.criterion =
          "difference of the velocities after the impact from the closed form, as the "
          "root of its energy over that of the contact velocity";
      f.limit = 0.01;
      break;
    case What::bounds:
      f.criterion =
          "kinetic energy above that of the start, or below what an impact leaves that "
          "stops all motion at the contact, over that of the start";
      f.limit = 0.01;
      break;
  }
  if (what == What::balls) f.limit_f64 = 1e-4;
  f.draw = [options, what](Random& kind, Random& state, const Scale& scale) {
    return hit_world(kind, state, scale, options, what);
  };
  return f;
}

void add_families(std::vector<Family>& out, Space space) {
  const auto add = [&](const char* id, const char* title, HitOptions options, What what) {
    options.space = space;
    out.push_back(hit_family(id, title, options, what));
  };
  const auto with = [](bool plane, double restitution, double friction) {
    HitOptions o;
    o.plane = plane, o.restitution = restitution, o.friction = friction;
    return o;
  };
  HitOptions o = with(true, 1, 0);
  o.attitude = Attitude::tilted;
  add("elastic hit on plane", "elastic frictionless hit of a body on a plane", o, What::elastic);
  o.attitude = Attitude::flat;
  add("elastic flat hit", "elastic frictionless hit of a body exactly flat on a plane", o,
      What::elastic);
  add("elastic hit of two", "elastic frictionless hit of two bodies", with(false, 1, 0),
      What::elastic);

  o = with(true, 0, 0);
  o.attitude = Attitude::flat, o.gravity = true;
  add("plastic flat hit", "plastic frictionless hit of a body exactly flat on a plane", o,
      What::plastic);
  // Without spin, so that the pose of the touch is that of the start of the step.
  o.attitude = Attitude::tilted, o.gravity = false, o.spins = false, o.fastest_ellipsoid = 5e-4;
  add("plastic hit on plane", "plastic frictionless hit of a body on a plane", o, What::plastic);
  // Faces that rotate can keep touching: slow ones, so that nothing rotates within the step.
  o = with(false, 0, 0);
  o.slowest = 2e-4, o.fastest = o.fastest_ellipsoid = 1e-3;
  add("plastic hit of two", "slow plastic frictionless hit of two bodies", o, What::plastic);

  o = with(true, -1, -1);
  o.attitude = Attitude::flat, o.no_slip = true;
  add("flat hit with friction", "hit of a body that falls exactly flat on a plane with friction", o,
      What::sticks);

  for (const bool plane : {true, false}) {
    const std::string of = plane ? " on plane" : " of two";
    o = with(plane, -1, -1);
    o.balls = true;
    add(("ball hit" + of).c_str(), "hit of balls with friction and spin, e 0 to 1", o, What::balls);
    o.balls = false, o.no_slip = true, o.spins = false;
    add(("hit without slip" + of).c_str(), "hit of bodies that friction keeps from slipping", o,
        What::sticks);
    o.no_slip = false, o.spins = true, o.attitude = plane ? Attitude::tilted : Attitude::any;
    add(("hit with friction" + of).c_str(), "hit of bodies with friction, e 0 to 1", o,
        What::bounds);
  }
}

}  // namespace

std::vector<Family> energy_families() {
  std::vector<Family> out;
  add_families(out, Space::planar);
  add_families(out, Space::spatial);
  for (auto& more : {several_energy_families(), pile_energy_families()}) {
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

}  // namespace manyworlds::invariants
