// Which bodies of a model with joints collide, judged by the contacts that MuJoCo makes.
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "manyworlds/mjcf.hpp"
#include "tests/mjcf/mujoco_reference.hpp"

namespace manyworlds::test {
namespace {

using Names = std::set<std::pair<std::string, std::string>>;  // of bodies

// Balls that all overlap: two chains with welded parts, a static body with a child, a free ball.
std::string model_with_contacts(const std::string& option, const std::string& contact) {
  const auto body = [](const std::string& name, const std::string& inside) {
    return "<body name='" + name + "' pos='.01 0 0'>" + inside + "<geom size='1'";
  };
  const std::string hinge = "<joint axis='0 1 0'/>";
  return "<mujoco>" + option + "<worldbody><geom size='1'/>" + body("a", hinge) + "/>" +
         body("a1", "") + "/>" + body("a2", hinge) + "/>" + body("a3", "") + "/>" +
         body("a4", hinge) + "/></body></body></body>" + body("a5", "") +
         " contype='0' conaffinity='2'/></body></body></body>" + body("s", "") + "/>" +
         body("t", hinge) + "/>" + body("t1", hinge + "<joint axis='1 0 0'/>") +
         "/></body></body></body>" + body("f", "<freejoint/>") +
         " contype='3'/></body></worldbody><contact>" + contact + "</contact></mujoco>";
}

void add(Names& names, std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  names.emplace(std::move(a), std::move(b));
}

Names mujocos(const std::string& xml) {
  const Reference reference(xml);
  const mjModel& m = *reference.model;
  Names names;
  for (int c = 0; c < reference.data->ncon; ++c) {
    const auto name = [&](int side) {
      const int geom = reference.data->contact[c].geom[side];
      return mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[geom]);
    };
    add(names, name(0), name(1));
  }
  return names;
}

bool collide(const Shape& a, const Shape& b) {
  return (a.filter.category & b.filter.mask) != 0 && (b.filter.category & a.filter.mask) != 0;
}

Names ours(const Scene& scene) {
  std::set<std::pair<int, int>> apart;
  for (const Exclusion& e : scene.exclusions) {
    apart.insert(std::minmax(e.body_a.index(), e.body_b.index()));
  }
  for (const Joint& j : scene.joints) {
    if (j.body_a && !j.collide) apart.insert(std::minmax(j.body_a.index(), j.body_b.index()));
  }
  Names names;
  const int count = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int k = i + 1; k < count; ++k) {
      const Body &a = scene.at(BodyId(i)), &b = scene.at(BodyId(k));
      const bool moves = a.motion == Motion::dynamic || b.motion == Motion::dynamic;
      if (!moves || apart.contains({i, k})) continue;
      if (collide(a.shapes.at(0), b.shapes.at(0))) add(names, a.name, b.name);
    }
  }
  return names;
}

}  // namespace

TEST_CASE("the bodies of trees that collide are MuJoCo's", "[mjcf][robots][fast]") {
  const std::string option = GENERATE("", "<option><flag filterparent='disable'/></option>");
  const std::string contact =
      GENERATE("",
               "<exclude body1='t1' body2='a3'/><exclude body1='f' body2='world'/>"
               "<exclude body1='s' body2='world'/><exclude body1='a' body2='a2'/>");
  const std::string xml = model_with_contacts(option, contact);
  const Scene scene = load_mjcf_string(xml).scene;
  const Names names = ours(scene);
  CHECK(names.size() > 20);
  CHECK(names == mujocos(xml));
  // What a joint keeps apart needs no exclusion.
  for (const Exclusion& e : scene.exclusions) {
    for (const Joint& joint : scene.joints) {
      if (!joint.body_a || joint.collide) continue;
      CHECK(std::minmax(joint.body_a.index(), joint.body_b.index()) !=
            std::minmax(e.body_a.index(), e.body_b.index()));
    }
  }
}

TEST_CASE("bodies that never collide need no exclusion", "[mjcf][robots][fast]") {
  const Scene scene =
      load_mjcf_string(model_with_contacts("<option><flag contact='disable'/></option>", "")).scene;
  CHECK(scene.exclusions.empty());
}

}  // namespace manyworlds::test
