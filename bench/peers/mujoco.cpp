#include "bench/peers/mujoco.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace manyworlds::peers {
namespace {

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using Model = std::shared_ptr<const mjModel>;

// MuJoCo has no restitution. Its contacts are springs with dampers, given as -stiffness and
// -damping per mass, which bounce with e = exp(-pi z / sqrt(1 - z^2)): z = 0.0335 for 0.9. At a
// frequency of 60 rad/s steps of 1/60 s still make that 0.902; at 90 they no longer do.
constexpr double kBounce = 60, kDampingRatio = 0.0335;

std::string text(const std::array<double, 3>& v) {
  std::ostringstream out;
  out << v[0] << ' ' << v[1] << ' ' << v[2];
  return out.str();
}

std::string geom(const Body& body) {
  std::ostringstream out;
  if (body.form == Form::ball) {
    out << "<geom type='sphere' size='" << body.radius << "'/>";
  } else if (body.form == Form::box) {
    out << "<geom type='box' size='" << text({body.half, body.half, body.half}) << "'/>";
  } else {
    out << "<geom type='capsule' size='" << body.radius << "' fromto='" << -body.half << " 0 0 "
        << body.half << " 0 0'/>";
  }
  return out.str();
}

// Planes for floor and walls, and a tree of bodies for a chain: what a user of MuJoCo would write.
std::string mjcf(const World& world) {
  std::ostringstream out;
  out.precision(12);
  out << "<mujoco><option timestep='" << kStep << "' gravity='0 0 " << -kGravity << "'";
  // Steps of 1/60 s are too long for Euler and for both implicit integrators: the chain explodes.
  if (world.chain) out << " integrator='RK4'";
  out << "/><default><geom friction='" << kFriction << " 0.005 0.0001' density='" << kDensity
      << "'";
  if (world.chain) out << " contype='0' conaffinity='0'";
  if (world.restitution > 0) {
    out << " solref='" << -kBounce * kBounce << ' ' << -2 * kDampingRatio * kBounce << "'";
  }
  out << "/></default><worldbody>";
  if (world.floor > 0) out << "<geom type='plane' size='0 0 1'/>";
  if (world.inner > 0) {
    const double w = world.inner;
    const std::array<double, 3> normals[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (const auto& n : normals) {
      out << "<geom type='plane' size='0 0 1' pos='" << text({-w * n[0], -w * n[1], 0})
          << "' zaxis='" << text(n) << "'/>";
    }
  }
  for (std::size_t i = 0; i < world.bodies.size(); ++i) {
    const Body& body = world.bodies[i];
    if (world.chain) {
      out << "<body pos='" << (i == 0 ? 0.5 : 1.0) << " 0 0'><joint type='ball' pos='-0.5 0 0'/>"
          << geom(body);
    } else {
      out << "<body><freejoint/>" << geom(body) << "</body>";
    }
  }
  for (std::size_t i = 0; world.chain && i < world.bodies.size(); ++i) out << "</body>";
  out << "</worldbody></mujoco>";
  return out.str();
}

Model compiled(const World& world) {
  char error[500] = "";
  mjSpec* spec = mj_parseXMLString(mjcf(world).c_str(), nullptr, error, sizeof error);
  if (spec == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + error);
  mjModel* model = mj_compile(spec, nullptr);
  const std::string why = model == nullptr ? mjs_getError(spec) : "";
  mj_deleteSpec(spec);
  if (model == nullptr) throw std::runtime_error("MuJoCo: " + why);
  return Model(model, FreeModel{});
}

// The joint velocities into which impulses at the joints would change those of the links:
// M qvel = sum of J^T m v over the links.
void start_chain(const World& from, const mjModel* m, mjData* data) {
  mj_forward(m, data);
  std::vector<mjtNum> momentum(static_cast<std::size_t>(m->nv), 0);
  for (int i = 1; i < m->nbody; ++i) {
    mjtNum p[3], none[3] = {0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = m->body_mass[i] * from.bodies[static_cast<std::size_t>(i - 1)].velocity[k];
    }
    mj_applyFT(m, data, p, none, data->xipos + 3 * i, i, momentum.data());
  }
  mj_solveM(m, data, data->qvel, momentum.data(), 1);
}

std::string settings(const World& world) {
  if (world.chain) {
    return "float64, Runge-Kutta 4, because Euler explodes; coordinates of joints, which have no "
           "gap";
  }
  std::string out = "float64, all defaults: Newton solver, pyramidal cones, semi-implicit Euler";
  if (world.restitution > 0) out += "; solref that bounces to 0.9, by sinking in";
  if (world.inner > 0) out += "; planes as walls";
  return out;
}

void die(const char* message) {
  std::fprintf(stderr, "MuJoCo: %s\n", message);
  std::exit(1);
}

}  // namespace

MujocoWorld::MujocoWorld(Model model, const World& from)
    : model_(std::move(model)), data_(mj_makeData(model_.get())) {
  if (!data_) throw std::runtime_error("MuJoCo: no memory for another world");
  if (from.chain) {
    start_chain(from, model_.get(), data_.get());
    return;
  }
  for (std::size_t i = 0; i < from.bodies.size(); ++i) {
    std::copy_n(from.bodies[i].position.data(), 3, data_->qpos + 7 * i);
    std::copy_n(from.bodies[i].rotation.data(), 4, data_->qpos + 7 * i + 3);
  }
}

void MujocoWorld::step() { mj_step(model_.get(), data_.get()); }

std::vector<Pose> MujocoWorld::poses() {
  mj_kinematics(model_.get(), data_.get());  // a step leaves it where it was before
  std::vector<Pose> out;
  for (int i = 1; i < model_->nbody; ++i) {
    const mjtNum *x = data_->xpos + 3 * i, *q = data_->xquat + 4 * i;
    out.push_back({{x[0], x[1], x[2]}, 0, {q[0], q[1], q[2], q[3]}});
  }
  return out;
}

Engine mujoco_engine(const char* name) {
  mju_user_error = die;
  // Without one of its own it would write a file; a full arena would make a speed meaningless.
  mju_user_warning = die;
  Engine engine;
  engine.name = name;
  engine.version = mj_versionString();
  engine.planar = false;
  engine.settings = settings;
  // Worlds of one scene share its model.
  engine.make = [model = Model(), source = std::string()](const World& world) mutable {
    if (std::string wanted = mjcf(world); wanted != source) {
      model = compiled(world);
      source = std::move(wanted);
    }
    return std::make_unique<MujocoWorld>(model, world);
  };
  return engine;
}

}  // namespace manyworlds::peers
