// Observers in words: sizes, what is wrong with them.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/data/pair_keys.hpp"
#include "src/api/batch_data.hpp"
#include "src/api/observable.hpp"
#include "src/api/observer_results.hpp"
#include "src/base/enum_names.hpp"

namespace manyworlds {

bool observes(const Observers& observers, Observer observer) {
  if (observer == Observer::rays) return !observers.rays.empty();
  if (observer == Observer::points) return !observers.points.empty();
  return std::count(observers.what.begin(), observers.what.end(), observer) > 0;
}

std::size_t items_of(ObservedItem item, const PlanData& plan, const Observers& observers) {
  switch (item) {
    case ObservedItem::world: return 1;
    case ObservedItem::body: return plan.bodies.size();
    case ObservedItem::joint: return plan.scene.joints.size();
    case ObservedItem::coordinate: return plan.coordinates.size();
    case ObservedItem::dof: return plan.trees.dofs.size();
    case ObservedItem::tendon: return plan.scene.tendons.size();
    case ObservedItem::site: return plan.scene.sites.size();
    case ObservedItem::ray: return observers.rays.size();
    case ObservedItem::point: return observers.points.size();
  }
  return 0;
}

std::size_t observed_size(Observed what, const PlanData& plan, const Observers& observers) {
  return items_of(info(info(what).observer).item, plan, observers) *
         static_cast<std::size_t>(components(what, plan.scene.space));
}

void check_observers(const Observers& observers) {
  for (std::size_t i = 0; i < observers.what.size(); ++i) {
    const std::string place = "observe.what[" + std::to_string(i) + "]";
    const Observer observer = checked_enum(observers.what[i], place);
    if (is_given(info(observer).item) && !observes(observers, observer)) {
      reject(place + " is " + to_string(observer) + ", but observe." + to_string(observer) +
             " is empty; list them there");
    }
  }
  if (observers.contacts_per_world < 0) {
    reject("observe.contacts_per_world is " + std::to_string(observers.contacts_per_world) +
           ", must be >= 0");
  }
}

void check_observers(const Observers& observers, const Plan& plan) {
  for (std::size_t i = 0; i < observers.what.size(); ++i) {
    const Observer observer = observers.what[i];
    if (observable(observer, plan.scene())) continue;
    reject("observe.what[" + std::to_string(i) + "] is " + to_string(observer) + ": " +
           why_not_observable(observer, plan.scene()));
  }
}

namespace {

// Everything that is wrong with a list that users give, in one exception.
class ListChecker {
 public:
  ListChecker(const char* list, const Plan& plan) : list_(list), plan_(plan) {}

  void wrong(std::size_t i, const char* field, const auto& found, const std::string& expected) {
    if (wrong_) text_ << "; ";
    text_ << list_ << '[' << i << "]." << field << " is " << found << ", must be " << expected;
    wrong_ = true;
  }
  void check_finite(std::size_t i, const char* field, const Vec3& found) {
    if (!found.allFinite()) wrong(i, field, found.transpose(), "finite");
  }
  // `otherwise`: what to do where a fixed body is meant.
  void check_moving(std::size_t i, BodyId body, int least, const char* otherwise) {
    const int bodies = static_cast<int>(plan_.scene().bodies.size());
    if (!body || body.index() >= bodies) {
      const std::string from = std::to_string(least);
      return wrong(i, "body", body.index(), from + " to " + std::to_string(bodies - 1));
    }
    if (plan_.find_row(body)) return;
    wrong(i, "body", body_text(plan_.scene(), body),
          std::string("a body that can move: ") + otherwise);
  }
  void reject_wrong() const {
    if (wrong_) reject(text_.str());
  }

 private:
  const char* list_;
  const Plan& plan_;
  std::ostringstream text_;
  bool wrong_ = false;
};

}  // namespace

void check_rays(std::span<const Ray> rays, const Plan& plan) {
  const bool planar = plan.scene().space == Space::planar;
  ListChecker checker("rays", plan);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    Vec3 way = ray.direction;
    if (planar) way.z() = 0;
    checker.check_finite(i, "origin", ray.origin);
    if (!way.allFinite() || way.isZero(0)) {
      checker.wrong(i, "direction", ray.direction.transpose(),
                    planar ? "finite and not zero in the plane" : "finite and not zero");
    }
    if (!(ray.length > 0)) checker.wrong(i, "length", ray.length, "> 0 m");
    if (ray.body == BodyId()) continue;
    checker.check_moving(i, ray.body, -1, "for a fixed body, give the ray in world coordinates");
  }
  checker.reject_wrong();
}

void check_points(std::span<const Point> points, const Plan& plan) {
  ListChecker checker("points", plan);
  for (std::size_t i = 0; i < points.size(); ++i) {
    checker.check_finite(i, "position", points[i].position);
    checker.check_moving(i, points[i].body, 0, "points of a fixed body do not move");
  }
  checker.reject_wrong();
}

template <class Real>
PairIds ids_of(const PlanData& plan, const kernels::SceneConstants<Real>& t, std::int32_t key) {
  const kernels::PairOfKey pair = kernels::pair_of_key(t, key);
  const auto named = [&](const auto& a) {
    const PlanCollider& b = plan.colliders[static_cast<std::size_t>(pair.b)];
    return PairIds{{BodyId(a.scene_body), a.shape}, {BodyId(b.scene_body), b.shape}};
  };
  const auto a = static_cast<std::size_t>(pair.a);
  const bool fixed = is_fixed(t.pair_class[kernels::class_of_key(t, key)].list);
  return fixed ? named(plan.fixed[a]) : named(plan.colliders[a]);
}
template PairIds ids_of(const PlanData&, const kernels::SceneConstants<float>&, std::int32_t);
template PairIds ids_of(const PlanData&, const kernels::SceneConstants<double>&, std::int32_t);

}  // namespace manyworlds
