// The lanes' sweeps against dense references: the same iterates as Gauss-Seidel, over-relaxed or
// with conjugate steps, on the complementarity problem that the contacts of a step pose, and its
// solution by pivoting (src/lcp).
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "src/lcp/problem.hpp"
#include "tests/support/joints.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

// Frictionless balls and boxes of many masses in a heap, and some of them flying at it.
Scene heap(Space space) {
  Scene scene = empty_scene(space, 10);
  scene.options.substeps = 1;
  scene.options.solver.push_out_share = 0;
  scene.options.contact.restitution_threshold = 1e6;
  scene.options.contact.cast_against_fixed = false;
  scene.add(ground(space, 0));
  const bool planar = space == Space::planar;
  for (int i = 0; i < 9; ++i) {
    const int layer = i / 3, column = i % 3;
    const Vec3 place = Vec3(0.98 * column + 0.3 * layer, planar ? 0 : 0.1 * i, 0) +
                       (0.5 + 0.97 * layer) * up_of(space);
    const bool round = (i + layer) % 2 == 0;
    Body body = body_of(shape_of(round ? round_of(space, 0.5) : cube_of(space, 0.48), 0), place);
    body.linear_velocity = Vec3(0.3 * (i % 4) - 0.5, planar ? 0 : 0.2, 0) - 0.4 * up_of(space);
    body.shapes[0].density = 300 + 400 * i;
    scene.add(body);
  }
  return scene;
}

// What the contacts of the first step ask for: rows of Jacobians, in the order of the solver.
struct ContactProblem {
  Eigen::MatrixXd jacobian;  // [contact][6 body]
  Eigen::VectorXd inv_mass;  // [6 body], diagonal (bodies have not turned yet)
  Eigen::VectorXd free;      // velocities without contacts
  lcp::Problem lcp;
};

ContactProblem problem_of(const Plan& plan, const Batch& begun, const Batch& done) {
  const Scene& scene = plan.scene();
  const int bodies = plan.bodies();
  const std::vector<StepContact> points = done.step_contacts(0);
  const auto n = static_cast<Eigen::Index>(points.size());
  ContactProblem out;
  out.jacobian = Eigen::MatrixXd::Zero(n, 6 * bodies);
  out.inv_mass = out.free = Eigen::VectorXd::Zero(6 * bodies);
  const bool planar = scene.space == Space::planar;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto row = plan.find_row(BodyId(static_cast<int>(i)));
    if (!row) continue;
    const int b = *row;
    const MassProperties mass = mass_properties(scene, scene.bodies[i]);
    out.inv_mass.segment<3>(6 * b).setConstant(1 / mass.mass);
    if (planar) out.inv_mass[6 * b + 2] = 0;
    for (int c = planar ? 2 : 0; c < 3; ++c) {
      out.inv_mass[6 * b + 3 + c] = 1 / mass.inertia(c, c);
    }
    out.free.segment<3>(6 * b) =
        scene.bodies[i].linear_velocity + scene.options.dt * scene.options.gravity;
  }
  Eigen::VectorXd gap(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const StepContact& p = points[static_cast<std::size_t>(k)];
    gap[k] = std::max(p.separation, 0.0);
    for (const auto& [body, sign] : {std::pair(p.body_a, -1.0), std::pair(p.body_b, 1.0)}) {
      const auto row = plan.find_row(body);
      if (!row) continue;
      const int b = *row;
      const Vec3 arm = p.point - position(begun, 0, b);
      out.jacobian.row(k).segment<3>(6 * b) = sign * p.normal;
      out.jacobian.row(k).segment<3>(6 * b + 3) = sign * arm.cross(p.normal);
    }
  }
  const Eigen::MatrixXd& j = out.jacobian;
  out.lcp.m = j * out.inv_mass.asDiagonal() * j.transpose();
  out.lcp.q = j * out.free + gap / scene.options.dt;
  out.lcp.low = Eigen::VectorXd::Zero(n);
  out.lcp.high = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  return out;
}

// Velocities of all bodies, [6 body].
Eigen::VectorXd velocities(const Batch& batch) {
  Eigen::VectorXd out(6 * batch.bodies(0));
  for (int b = 0; b < batch.bodies(0); ++b) {
    out.segment<3>(6 * b) = velocity(batch, 0, b);
    out.segment<3>(6 * b + 3) = spin(batch, 0, b);
  }
  return out;
}

void sweep(const lcp::Problem& p, double relaxation, Eigen::VectorXd& z) {
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double w = p.m.row(i).dot(z) + p.q[i];
    z[i] = std::max(0.0, z[i] - relaxation * w / p.m(i, i));
  }
}

// The impulses after so many sweeps, as the papers have it.
Eigen::VectorXd iterate(const lcp::Problem& p, const Options& options) {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(p.q.size()), way = z;
  double square = 0;
  for (int i = 0; i < iterations_of(options.solver); ++i) {
    const Eigen::VectorXd before = z;
    sweep(p, options.solver.method == Solver::sor ? options.solver.relaxation : 1, z);
    if (options.solver.method != Solver::nncg || i + 1 == iterations_of(options.solver)) continue;
    const Eigen::VectorXd step = z - before;
    const double now = step.squaredNorm(), ratio = square > 0 ? now / square : 0;
    const double beta = ratio > 1 ? 0 : ratio;
    square = now;
    z += beta * way;
    way = beta * way + step;
  }
  return z;
}

}  // namespace

TEST_CASE("each sweep of a lane is a sweep of the dense reference", "[fast][solver][lcp]") {
  if (!has_table(double_table())) return;
  for (Space space : kSpaces) {
    for (Solver solver : {Solver::sequential_impulse, Solver::sor, Solver::nncg}) {
      for (int iterations : {1, 2, 3, 7, 20, 1000}) {
        Scene scene = heap(space);
        scene.options.solver.method = solver;
        scene.options.solver.iterations = iterations;
        const Plan plan = compile(scene);
        BatchOptions options = options_of(double_table());
        options.observe.what = {Observer::contacts};
        const Batch begun(plan, options);
        Batch batch(plan, options);
        batch.step();
        const ContactProblem p = problem_of(plan, begun, batch);
        REQUIRE(p.lcp.q.size() > 12);
        const Eigen::VectorXd z = iterate(p.lcp, scene.options);
        const Eigen::VectorXd wanted =
            p.free + p.inv_mass.asDiagonal() * p.jacobian.transpose() * z;
        const double error = (velocities(batch) - wanted).cwiseAbs().maxCoeff();
        INFO(to_string(solver) << ", sweeps " << iterations << ", contacts " << p.lcp.q.size());
        CHECK(error < 1e-11);
        if (iterations < 1000) continue;
        const lcp::Solution direct = lcp::solve_dantzig(p.lcp);
        REQUIRE(direct.solved);
        const Eigen::VectorXd exact =
            p.free + p.inv_mass.asDiagonal() * p.jacobian.transpose() * direct.z;
        CHECK((velocities(batch) - exact).cwiseAbs().maxCoeff() < 1e-6);
      }
    }
  }
}

}  // namespace manyworlds::test
