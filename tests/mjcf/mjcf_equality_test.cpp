// Equality constraints from MJCF as joints: their frames, judged by the residuals that MuJoCo
// computes, and their motion.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "manyworlds/mjcf.hpp"

#include "tests/mjcf/mujoco_reference.hpp"

namespace manyworlds {
namespace {

struct Place {
  Vec3 position;
  Quat rotation;
};

struct EqualityReference : test::Reference {
  using test::Reference::Reference;
  void place(int free_body, const Place& at) {
    mjtNum* q = data->qpos + 7 * free_body;
    for (int i = 0; i < 3; ++i) q[i] = at.position[i];
    q[3] = at.rotation.w(), q[4] = at.rotation.x(), q[5] = at.rotation.y(), q[6] = at.rotation.z();
  }
  Vec3 position(int free_body) const {
    const mjtNum* q = data->qpos + 7 * free_body;
    return {q[0], q[1], q[2]};
  }
  // Of the equalities, the largest component.
  double residual(int rows) {
    mj_forward(model.get(), data.get());
    REQUIRE(data->ne == rows);
    double most = 0;
    for (int i = 0; i < rows; ++i) most = std::max(most, std::abs(data->efc_pos[i]));
    return most;
  }
};

const std::string kGeom = "<geom type='box' size='.1 .07 .04' contype='0' conaffinity='0'/>";
// The first free body has a part welded to it, and sites are on parts.
const std::string kTwo =
    "<worldbody><site name='w' pos='.3 .2 .1' euler='10 20 30'/>"
    "<body name='shelf' pos='0 0 1' euler='0 0 40'><body name='hook' pos='.1 .2 .3' "
    "euler='50 0 0'/></body>"
    "<body name='p' pos='.1 .2 .3' euler='10 20 30'><freejoint/>" +
    kGeom + "<body name='part' pos='.4 .1 0' euler='0 30 60'>" + kGeom +
    "<site name='s' pos='.1 0 .2' euler='20 0 10'/></body></body>"
    "<body name='q' pos='.5 -.3 .2' euler='-40 10 80'><freejoint/>" +
    kGeom + "<site name='t' pos='0 .3 .1' euler='0 70 0'/></body></worldbody>";

std::string with(const std::string& equality, const std::string& option = "") {
  return "<mujoco>" + option + kTwo + "<equality>" + equality + "</equality></mujoco>";
}

std::string only_warning(const std::string& xml) {
  const std::vector<std::string> warnings = load_mjcf_string(xml).warnings;
  REQUIRE(warnings.size() == 1);
  return warnings[0];
}

// Two bars in a row, the first one hinged to the world at the origin by `connect`s.
const std::string kBars =
    "<worldbody><body name='a' pos='.25 0 0'><freejoint/>"
    "<geom type='capsule' size='.02' fromto='-.2 0 0 .2 0 0' contype='0' conaffinity='0'/></body>"
    "<body name='b' pos='.75 0 0'><freejoint/>"
    "<geom type='box' size='.2 .03 .05' contype='0' conaffinity='0'/></body></worldbody>";

BatchOptions one_world() {
  BatchOptions options;
  options.worlds = 1;
  options.threads = 1;
  options.precision = Precision::f64;
  return options;
}

Vec3 read_vec3(const Batch& batch, Field field, int body) {
  std::vector<double> all(static_cast<std::size_t>(3 * batch.bodies()));
  batch.read(field, 0, all);
  const std::size_t at = static_cast<std::size_t>(3 * body);
  return {all[at], all[at + 1], all[at + 2]};
}

Quat read_rotation(const Batch& batch, int body) {
  std::vector<double> all(static_cast<std::size_t>(4 * batch.bodies()));
  batch.read(Field::orientation, 0, all);
  const std::size_t at = static_cast<std::size_t>(4 * body);
  return {all[at], all[at + 1], all[at + 2], all[at + 3]};
}

}  // namespace

TEST_CASE("where a joint's frames coincide MuJoCo's equality is satisfied", "[mjcf][fast]") {
  struct Case {
    std::string equality;
    bool weld;
  };
  const std::vector<Case> table = {
      {"<connect name='e' body1='p' body2='q' anchor='.1 .2 .3'/>", false},
      {"<connect name='e' body1='part' body2='q' anchor='.1 .2 .3'/>", false},
      {"<connect name='e' body1='q' anchor='.1 .2 .3'/>", false},
      {"<connect name='e' body1='hook' body2='q' anchor='.1 .2 .3'/>", false},
      {"<connect name='e' site1='s' site2='t'/>", false},
      {"<connect name='e' site1='t' site2='w'/>", false},
      {"<weld name='e' body1='p' body2='q'/>", true},
      {"<weld name='e' body1='p' body2='q' anchor='.1 .2 .3'/>", true},
      {"<weld name='e' body1='q' body2='part' anchor='.1 .2 .3'/>", true},
      {"<weld name='e' body1='q' body2='part' relpose='.1 .2 .3 .5 .5 -.5 .5'/>", true},
      {"<weld name='e' body1='part' body2='q' anchor='.3 -.1 0' relpose='.1 .2 .3 .5 1 -.5 .5'/>",
       true},
      {"<weld name='e' body1='p'/>", true},
      {"<weld name='e' body1='p' anchor='.1 .2 .3' relpose='.3 0 .1 .5 1 -.5 .5'/>", true},
      {"<weld name='e' site1='s' site2='t'/>", true},
      {"<weld name='e' site1='w' site2='s'/>", true},
      {"<weld name='e' body1='p' body2='q' anchor='.1 .2 .3' torquescale='0'/>", false},
  };
  const Quat lean(Eigen::AngleAxisd(0.8, Vec3(1, -2, 1).normalized()));
  for (const Case& c : table) {
    INFO(c.equality);
    const std::string xml = with(c.equality);
    const MjcfResult result = load_mjcf_string(xml);
    for (const std::string& warning : result.warnings) {
      CHECK_THAT(warning, Catch::Contains("equalities: start up to"));
    }
    const Scene& scene = result.scene;
    CHECK(validate(scene).empty());
    REQUIRE(scene.bodies.size() == 2);  // nothing of the shelf can be touched
    REQUIRE(scene.joints.size() == 1);
    const Joint& joint = scene.joints[0];
    CHECK(joint.name == "e");
    CHECK(joint.collide);
    CHECK(std::holds_alternative<FixedJoint>(joint.type) == c.weld);
    CHECK(std::holds_alternative<BallJoint>(joint.type) == !c.weld);

    const Place a =
        !joint.body_a ? Place{Vec3::Zero(), Quat::Identity()} : Place{{0.7, 0.1, -0.4}, Quat(lean)};
    // B as the joint wants it; `turned`: about the anchor.
    const auto b = [&](const Quat& turned) {
      const Quat rotation =
          a.rotation * joint.frame_a.rotation * turned * joint.frame_b.rotation.inverse();
      const Vec3 anchor = a.position + a.rotation * joint.frame_a.position;
      return Place{anchor - rotation * joint.frame_b.position, rotation};
    };
    EqualityReference reference(xml);
    const bool torqueless = c.equality.find("torquescale") != std::string::npos;
    const int rows = c.weld || torqueless ? 6 : 3;
    const auto residual = [&](const Place& at) {
      if (joint.body_a) reference.place(joint.body_a.index(), a);
      reference.place(joint.body_b.index(), at);
      return reference.residual(rows);
    };
    const Quat turned(Eigen::AngleAxisd(0.5, Vec3(2, 1, 1).normalized()));
    CHECK(residual(b(Quat::Identity())) < 1e-12);
    CHECK((residual(b(turned)) < 1e-12) == !c.weld);
    Place moved = b(Quat::Identity());
    moved.position.x() += 0.1;
    CHECK(residual(moved) > 0.01);
  }
}

TEST_CASE("joints of equalities without effect are left out", "[mjcf][fast]") {
  CHECK_THAT(only_warning(with("<connect name='e' body1='p' body2='q' anchor='0 0 0' "
                               "active='false'/>")),
             Catch::Contains("equality 'e', line 1: is inactive and left out"));
  for (const std::string equality : {"<weld name='e' body1='p' body2='part'/>",
                                     "<connect name='e' body1='hook' anchor='0 0 0'/>"}) {
    CHECK(load_mjcf_string(with(equality)).scene.joints.empty());
    CHECK_THAT(only_warning(with(equality)), Catch::Contains("connects one body to itself"));
  }
  const MjcfResult off = load_mjcf_string(
      with("<weld name='e' body1='p' body2='q'/>", "<option><flag equality='disable'/></option>"));
  CHECK(off.scene.joints.empty());
  CHECK(off.warnings.empty());
}

TEST_CASE("joined bodies collide unless a contact exclude says otherwise", "[mjcf][fast]") {
  const auto bodies = [](const std::string& part, const std::string& excluded) {
    const std::string ball = "<freejoint/><geom size='.3'/>";
    return "<mujoco><worldbody><geom size='.1'/><body name='a'>" + ball +
           "</body><body name='b' pos='.5 0 0'>" + ball + "<body name='c'>" + part +
           "</body></body></worldbody><contact><exclude name='x' " + excluded +
           "/></contact><equality><connect body1='b' body2='a' anchor='.2 0 0'/>"
           "<connect body1='b' anchor='0 0 0'/></equality></mujoco>";
  };
  const std::string seen = "<geom size='.1' contype='0' conaffinity='0'/>";
  const Scene scene = load_mjcf_string(bodies(seen, "body1='a' body2='b'")).scene;
  REQUIRE(scene.joints.size() == 2);
  CHECK_FALSE(scene.joints[0].collide);
  CHECK(scene.joints[1].collide);
  // Of parts of bodies, and of bodies that no joint holds together.
  const auto refused = Catch::Contains(
      "exclude 'x': contact excludes are not simulated yet; "
      "expected excludes only between two free bodies");
  const std::string solid = "<geom size='.1'/>";
  CHECK_THROWS_WITH(load_mjcf_string(bodies(solid, "body1='a' body2='b'")), refused);
  CHECK_THROWS_WITH(load_mjcf_string(bodies(solid, "body1='a' body2='c'")), refused);
  CHECK_THROWS_WITH(load_mjcf_string(bodies(seen, "body1='a' body2='c'")), refused);
  CHECK_THROWS_WITH(load_mjcf_string(bodies(seen, "body1='b' body2='world'")), refused);
}

TEST_CASE("softness of equalities is a warning", "[mjcf][fast]") {
  const std::string weld = "<weld name='e' body1='p' body2='q' ";
  for (const std::string attribute :
       {"solref='0.1 1'", "solimp='0.8 0.9 0.01'", "torquescale='2'"}) {
    INFO(attribute);
    const std::string warning = only_warning(with(weld + attribute + "/>"));
    CHECK_THAT(warning, Catch::Contains("equality 'e', line 1: " +
                                        attribute.substr(0, attribute.find('='))) &&
                            Catch::Contains("joint stiffness follows JointOptions::frequency"));
  }
}

TEST_CASE("joints that begin apart close as slowly as in MuJoCo", "[mjcf]") {
  const std::string kind = GENERATE("connect", "weld");
  const auto xml = [&](const std::string& gap) {
    return "<mujoco><option timestep='.002' gravity='0 0 0'/><worldbody>"
           "<body name='a'><freejoint/><geom type='box' size='.1 .1 .1'/>"
           "<site name='s' pos='.1 0 0'/></body>"
           "<body name='b' pos='.2 0 0'><freejoint/><geom type='box' size='.1 .1 .1'/><site "
           "name='t' "
           "pos='" +
           gap + "'/></body></worldbody><equality><" + kind +
           " site1='s' site2='t'/></equality></mujoco>";
  };
  const MjcfResult together = load_mjcf_string(xml("-.1 0 0"));
  CHECK(together.warnings.empty());
  CHECK(std::isinf(together.scene.options.joint.pull_speed));

  const MjcfResult apart = load_mjcf_string(xml("-.1 .6 0"));
  REQUIRE(apart.warnings.size() == 1);
  CHECK_THAT(apart.warnings[0], Catch::Contains("equalities: start up to 0.6 m and 0 rad apart"));
  Batch batch(compile(apart.scene), one_world());
  double fastest = 0;
  for (int step = 0; step < 250; ++step) {
    batch.step(1);
    fastest = std::max(fastest, read_vec3(batch, Field::linear_velocity, 0).norm());
  }
  CHECK(fastest < 6);  // 0.6 m in 0.1 s
  const auto site = [&](BodyId body, const Frame& frame) -> Vec3 {
    const int row = batch.row(body);
    return read_vec3(batch, Field::position, row) + read_rotation(batch, row) * frame.position;
  };
  const Joint& joint = apart.scene.joints.at(0);
  CHECK((site(joint.body_a, joint.frame_a) - site(joint.body_b, joint.frame_b)).norm() < 2e-3);
}

TEST_CASE("a double pendulum of connects swings as in MuJoCo", "[mjcf]") {
  const std::string connects =
      "<equality><connect body1='a' anchor='-.25 0 0' solref='.001 1' solimp='.9999 .9999 .01'/>"
      "<connect body1='a' body2='b' anchor='.25 0 0' solref='.001 1' solimp='.9999 .9999 .01'/>"
      "</equality>";
  const std::string xml =
      "<mujoco><option timestep='0.0001' gravity='0 3 -9.81' integrator='RK4'/>" + kBars +
      connects + "</mujoco>";
  const double seconds = 0.5;
  EqualityReference reference(xml);
  for (int i = 0; i < 5000; ++i) mj_step(reference.model.get(), reference.data.get());

  std::vector<double> apart;
  for (const double dt : {0.002, 0.001}) {
    Scene scene = load_mjcf_string(xml).scene;
    REQUIRE(scene.joints.size() == 2);
    scene.options.dt = dt;
    Batch batch(compile(scene), one_world());
    batch.step(static_cast<int>(std::lround(seconds / dt)));
    double most = 0;
    for (int body = 0; body < 2; ++body) {
      const Vec3 x = read_vec3(batch, Field::position, body);
      most = std::max(most, (x - reference.position(body)).norm());
    }
    apart.push_back(most);
  }
  INFO(apart[0] << " " << apart[1]);
  CHECK((reference.position(1) - Vec3(0.75, 0, 0)).norm() > 0.5);
  CHECK(apart[1] < 2e-3);
  CHECK(apart[1] < 0.7 * apart[0]);  // what is left is the order of the integrator
}

TEST_CASE("a welded pair flies as one body", "[mjcf][fast]") {
  const Scene loaded =
      load_mjcf_string("<mujoco><option timestep='0.005' gravity='0 0 -9.81'/>" + kBars +
                       "<equality><weld name='glue' body1='a' body2='b'/>"
                       "</equality></mujoco>")
          .scene;
  Scene scene = loaded;
  const MassProperties a = *scene.bodies[0].mass_properties, b = *scene.bodies[1].mass_properties;
  const Vec3 center =
      (a.mass * scene.bodies[0].position + b.mass * scene.bodies[1].position) / (a.mass + b.mass);
  const Vec3 velocity(1, 0.5, 2), spin(0, 0, 3);  // about a principal axis of the pair
  for (Body& body : scene.bodies) {
    body.linear_velocity = velocity + spin.cross(body.position - center);
    body.angular_velocity = spin;
  }
  Batch batch(compile(scene), one_world());
  const double seconds = 1, substep = 0.005 / *compile(scene).resolved().substeps;
  batch.step(200);
  const Quat turn(Eigen::AngleAxisd(spin.z() * seconds, Vec3::UnitZ()));
  // Bodies on joints take gravity in substeps: g t (t + h) / 2.
  const Vec3 at =
      center + velocity * seconds - Vec3(0, 0, 0.5 * 9.81 * seconds * (seconds + substep));
  for (int body = 0; body < 2; ++body) {
    const Body& start = scene.bodies[static_cast<std::size_t>(body)];
    const Vec3 expected = at + turn * (start.position - center);
    CHECK((read_vec3(batch, Field::position, body) - expected).norm() < 2e-4);
    CHECK(read_rotation(batch, body).angularDistance(turn * start.rotation) < 1e-3);
  }
}

}  // namespace manyworlds
