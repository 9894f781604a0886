#include "tools/compare/pair.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "src/mjcf/files_access.hpp"

namespace manyworlds::compare {

Pair::Pair(const MjcfFiles& files, const Settings& settings) : settings_(settings) {
  MjcfResult result = files.compile();
  scene_ = std::move(result.scene);
  warnings_ = std::move(result.warnings);
  if (scene_.options.solver.method != Solver::newton) {
    throw std::invalid_argument(
        "the model has only free joints, and is not stepped with MuJoCo's physics (" +
        std::string(to_string(scene_.options.solver.method)) +
        "); expected a hinge, a slide or a ball joint");
  }
  mujoco_ = mjcf::FilesAccess::mujoco_model(files);
  disabled_ = mujoco_->opt.disableflags;
  set_effort({settings.tolerance});
  // What has neither mass nor joints is part of its parent.
  int body = 0;
  for (int b = 1; b < mujoco_->nbody; ++b) {
    if (mujoco_->body_weldid[b] == 0) continue;
    if (mujoco_->body_mass[b] == 0 && mujoco_->body_jntnum[b] == 0) continue;
    while (body < static_cast<int>(scene_.bodies.size()) &&
           scene_.at(BodyId(body)).motion != Motion::dynamic) {
      ++body;
    }
    links_.push_back({b, BodyId(body++)});
  }
}

void Pair::set_effort(const Effort& effort) {
  effort_ = effort;
  mjOption& option = mujoco_->opt;
  option.solver = mjSOL_NEWTON, option.tolerance = effort.tolerance;
  option.iterations = effort.iterations;
  option.ls_iterations = effort.line_search_iterations, option.ls_tolerance = 1e-8;
  const int kept = option.disableflags & ~mjDSBL_EULERDAMP;
  const int explicit_damping = effort.implicit_damping ? disabled_ : mjDSBL_EULERDAMP;
  option.disableflags = kept | (explicit_damping & mjDSBL_EULERDAMP);
}

Scene Pair::scene(Precision precision) const {
  Scene scene = scene_;
  SolverOptions& solver = scene.options.solver;
  const bool doubles = precision == Precision::f64;
  solver.tolerance = doubles ? effort_.tolerance : std::max(effort_.tolerance, 1e-7);
  solver.iterations = effort_.iterations;
  solver.line_search_iterations = effort_.line_search_iterations;
  solver.implicit_damping &= effort_.implicit_damping;
  solver.line_search_tolerance = doubles ? 1e-8 : 1e-6;
  return scene;
}

mjcf::DataPtr Pair::make_data() const {
  mjcf::DataPtr data(mj_makeData(mujoco_.get()));
  if (!data) throw mjcf::MujocoFailure("MuJoCo could not create the model's data");
  return data;
}

void Pair::disable_contacts() {
  mujoco_->opt.disableflags |= mjDSBL_CONTACT;
  for (Body& body : scene_.bodies) {
    for (Shape& shape : body.shapes) shape.filter.mask = 0;
  }
}

bool Pair::same_points(int geom_a, int geom_b) const {
  if (settings_.every_shape) return true;
  if (geom_a < 0 || geom_b < 0) return false;
  const auto [first, second] = std::minmax(mujoco_->geom_type[geom_a], mujoco_->geom_type[geom_b]);
  switch (first) {
    case mjGEOM_PLANE: return second != mjGEOM_CYLINDER && second != mjGEOM_MESH;
    case mjGEOM_SPHERE: return second != mjGEOM_ELLIPSOID && second != mjGEOM_MESH;
    case mjGEOM_CAPSULE: return second == mjGEOM_CAPSULE;
    default: return false;
  }
}

void draw_controls(const mjModel& m, Random& random, mjtNum* controls) {
  for (int u = 0; u < m.nu; ++u) {
    const bool limited = m.actuator_ctrllimited[u] != 0;
    const double low = limited ? m.actuator_ctrlrange[2 * u] : -1;
    const double high = limited ? m.actuator_ctrlrange[2 * u + 1] : 1;
    const double beyond = 0.1 * (high - low);
    controls[u] = random.uniform(low - beyond, high + beyond);
  }
}

std::vector<Kernels> kernels() {
  Scene scene;
  Body ball;
  ball.shapes.emplace_back().geometry = Sphere{};
  scene.add(ball);
  const Plan plan = compile(scene);
  std::vector<Kernels> result;
  for (const Precision precision : {Precision::f64, Precision::f32}) {
    const std::vector<Isa> isas = available_isas();
    for (auto isa = isas.rbegin(); isa != isas.rend(); ++isa) {
      if (*isa > default_isa()) continue;
      try {
        const Batch batch(plan, options_of({precision, *isa}, 1));
        result.push_back({precision, batch.isa()});
        break;
      } catch (const std::invalid_argument&) {  // not built
      }
    }
  }
  return result;
}

BatchOptions options_of(const Kernels& kernels, int worlds) {
  BatchOptions options;
  options.worlds = worlds, options.threads = 1;
  options.precision = kernels.precision, options.isa = kernels.isa;
  return options;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0, size = 1;
  bool finite = a.size() == b.size();
  for (std::size_t k = 0; finite && k < a.size(); ++k) {
    finite = std::isfinite(a[k]) && std::isfinite(b[k]);
    most = std::max(most, std::abs(a[k] - b[k])), size = std::max(size, std::abs(b[k]));
  }
  return finite ? most / size : 1e9;
}

std::vector<double> read(const Batch& batch, Field field, int world) {
  std::vector<double> out(batch.size(field) / static_cast<std::size_t>(batch.worlds()));
  batch.read(field, world, out);
  return out;
}

}  // namespace manyworlds::compare
