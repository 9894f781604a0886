// Solvers: what each is known to do to an overlap, a weight, a spring; momenta; piles and stacks;
// equal bits.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/approx.hpp"
#include "tests/support/contraption.hpp"
#include "tests/support/crowd.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

constexpr Solver kAllSolvers[] = {Solver::tgs_soft, Solver::sequential_impulse, Solver::sor,
                                  Solver::nncg, Solver::penalty};
constexpr Solver kHard[] = {Solver::sequential_impulse, Solver::sor, Solver::nncg};

// As each is usually taken: the hard ones with many sweeps and one substep, penalty with short
// ones.
void choose(Scene& scene, Solver solver) {
  scene.options.solver.method = solver;
  if (has_hard_rows(solver)) scene.options.substeps = 1;
  if (solver == Solver::penalty) scene.options.substeps = 16;
}

// The crowd's bodies, some of them jointed.
Scene everything(Space space, Solver solver) {
  Scene scene = contraption(space);
  const Scene more = crowd(space);
  for (Body body : more.bodies) {
    body.position += Vec3(0, 0, 0) + 3 * up_of(space) * (body.motion == Motion::dynamic);
    scene.add(body);
  }
  choose(scene, solver);
  scene.options.solver.split_impulse = solver == Solver::sor;
  scene.options.substeps = 2;
  return scene;
}

}  // namespace

TEST_CASE("hard rows remove a share of an overlap in a substep", "[fast][solver]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      for (Solver solver : kHard) {
        for (bool split : {false, true}) {
          Scene scene = empty_scene(space, 0);
          choose(scene, solver);
          scene.options.substeps = 2;
          scene.options.solver.split_impulse = split;
          const double slop = 0.005;
          scene.options.contact.slop = slop;
          scene.options.solver.relaxation = 1;  // a lone row is solved in one visit
          scene.add(ground(space, 0));
          scene.add(body_of(shape_of(round_of(space, 0.5), 0), (0.49 - slop) * up_of(space)));
          Batch batch(compile(scene), options_of(table));
          batch.step();
          const double h = scene.options.dt / 2, share = scene.options.solver.push_out_share;
          const double depth = 0.5 - up_of(space).dot(position(batch, 0, 0)),
                       speed = up_of(space).dot(velocity(batch, 0, 0));
          INFO(name(table) << ' ' << to_string(solver) << " split " << split);
          const double rounding = pick(table, 3e-7, 1e-15);
          if (split) {
            CHECK(depth == approx(slop + 0.01 * (1 - share) * (1 - share), rounding));
            CHECK(std::abs(speed) <= rounding);
          } else {  // the first substep's speed stays, so the second needs none
            CHECK(depth == approx(slop + 0.01 * (1 - 2 * share), rounding));
            CHECK(speed == Approx(share * 0.01 / h).epsilon(1e-4));
          }
        }
      }
    }
  }
}

TEST_CASE("penalty sags by what its springs say, joints included", "[fast][solver]") {
  if (!has_table(double_table())) return;
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    choose(scene, Solver::penalty);
    scene.options.contact.frequency = 5;  // doubled against fixed shapes
    scene.options.contact.damping_ratio = 1;
    scene.options.joint.frequency = 3;
    scene.options.joint.damping_ratio = 1;
    scene.add(ground(space));
    scene.add(body_of(shape_of(round_of(space, 0.5)), 0.5 * up_of(space)));
    const Vec3 peg = Vec3(3, 0, 0) + 2 * up_of(space);
    const BodyId hung = scene.add(body_of(shape_of(round_of(space, 0.1)), peg));
    scene.add(joint_at(scene, {}, hung, at(peg), FixedJoint{}));
    Batch batch(compile(scene), options_of(double_table()));
    batch.step(600);
    const double contact = 2 * kPi * 10, hold = 2 * kPi * 3;
    CHECK(0.5 - up_of(space).dot(position(batch, 0, 0)) ==
          Approx(10 / (contact * contact)).epsilon(1e-6));
    CHECK(up_of(space).dot(peg - position(batch, 0, 1)) ==
          Approx(10 / (hold * hold)).epsilon(1e-6));
    CHECK(max_speed(batch, 0) < 1e-9);
  }
}

TEST_CASE("contacts against fixed shapes have a frequency of their own", "[fast][solver]") {
  for (Space space : kSpaces) {
    const auto ball_on_ground = [&](std::optional<double> fixed_frequency) {
      Scene scene = empty_scene(space, 10);
      choose(scene, Solver::penalty);
      scene.options.contact.frequency = 5;
      scene.options.contact.fixed_frequency = fixed_frequency;
      scene.options.contact.damping_ratio = 1;
      scene.add(ground(space));
      scene.add(body_of(shape_of(round_of(space, 0.5)), 0.5 * up_of(space)));
      Batch batch(compile(scene), {.threads = 1});
      batch.step(600);
      return std::pair(0.5 - up_of(space).dot(position(batch, 0, 0)), batch.hash());
    };
    const auto [sag, hash] = ball_on_ground(7);
    CHECK(sag == Approx(10 / (4 * kPi * kPi * 49)).epsilon(1e-3));
    CHECK(ball_on_ground({}).second == ball_on_ground(10).second);
    CHECK(ball_on_ground({}).second != hash);
  }
}

TEST_CASE("no solver changes momentum", "[fast][solver]") {
  if (!has_table(double_table())) return;
  constexpr int kWorlds = 8;
  for (Space space : kSpaces) {
    for (Solver solver : kAllSolvers) {
      for (bool hinged : {false, true}) {
        Scene scene = crowd(space, 12);
        scene.options.gravity.setZero();
        scene.options.dt = 1.0 / 600;
        choose(scene, solver);
        scene.bodies.erase(scene.bodies.begin(), scene.bodies.begin() + 2);  // what is fixed
        for (Body& body : scene.bodies) body.linear_drag = body.angular_drag = 0;
        Joint hinge = joint_at(scene, BodyId(0), BodyId(1),
                               at(scene.bodies[0].position, hinge_axes(space)), HingeJoint{});
        hinge.collide = true;
        if (hinged) scene.add(hinge);
        Batch batch(compile(scene), options_of(double_table(), kWorlds));
        std::vector<Momenta> before;
        double size = 0;
        for (int w = 0; w < kWorlds; ++w) {
          before.push_back(momenta(batch, w));
          size = std::max(size, before.back().angular.norm());
        }
        const std::vector<double> start = values(batch, Field::linear_velocity);
        batch.step();
        INFO(to_string(solver) << " hinged " << hinged);
        CHECK(values(batch, Field::linear_velocity) != start);
        for (int w = 0; w < kWorlds; ++w) {
          const Momenta &was = before[static_cast<std::size_t>(w)], now = momenta(batch, w);
          CHECK((now.linear - was.linear).norm() < 1e-12 * (was.linear.norm() + 1e3));
          // Of the order of the step, since bodies turn, and of the impulses, which bounces add to;
          // a joint that begins apart turns them, too.
          if (!hinged) CHECK((now.angular - was.angular).norm() < 7.5e-4 * size);
        }
      }
    }
  }
}

TEST_CASE("every solver holds a stack and settles a pile", "[solver]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      for (Solver solver : kAllSolvers) {
        Scene stack = empty_scene(space, 10);
        choose(stack, solver);
        if (has_hard_rows(solver)) stack.options.solver.iterations = 30;
        stack.add(ground(space));
        for (int i = 0; i < 5; ++i) {
          Body cube = body_of(shape_of(cube_of(space, 0.5)), (0.5 + i) * up_of(space));
          cube.jitter.position = Vec3(0.01, 0, 0);
          stack.add(cube);
        }
        Batch batch(compile(stack), options_of(table, 8));
        batch.step(240);
        INFO(name(table) << ' ' << to_string(solver));
        for (int w = 0; w < 8; ++w) {
          CHECK(max_speed(batch, w) < 0.02);
          for (int b = 0; b < 5; ++b) {
            CHECK(up_of(space).dot(position(batch, w, b)) == approx(0.5 + b, 0.02 + 0.01 * b));
            CHECK(std::abs(position(batch, w, b).x()) < 0.05);
          }
        }
        Scene pile = crowd(space, 14);
        choose(pile, solver);
        Batch heap(compile(pile), options_of(table, 16));
        std::vector<double> energy(16, std::numeric_limits<double>::infinity());
        // See "few wedged piles gain energy under penalty".
        const double most = solver == Solver::penalty ? 1e-3 : 1e-4;
        for (int i = 0; i < 5; ++i) {  // balls roll away without end, faster nothing gets
          heap.step(120);
          for (int w = 0; w < 16; ++w) {
            const double now = energy_of(heap, w);
            double& last = energy[static_cast<std::size_t>(w)];
            CHECK(now < last + most * std::abs(now));
            last = now;
            CHECK(heap.status(w) == Status::ok);
            CHECK(max_penetration(heap, w) < 0.03);
          }
        }
      }
    }
  }
}

// Friction that is solved once a substep can do work in wedged piles (docs/design.md).
TEST_CASE("few wedged piles gain energy under penalty", "[solver]") {
  constexpr int kPiles = 512;
  Scene pile = crowd(Space::planar, 14);
  choose(pile, Solver::penalty);
  Batch heap(compile(pile), options_of(widest_tables()[0], kPiles));
  std::vector<double> energy(kPiles, std::numeric_limits<double>::infinity());
  std::vector<bool> gained(kPiles, false);
  for (int i = 0; i < 5; ++i) {
    heap.step(120);
    for (int w = 0; w < kPiles; ++w) {
      const auto k = static_cast<std::size_t>(w);
      const double now = energy_of(heap, w);
      CHECK(now < energy[k] + 1e-3 * std::abs(now));
      gained[k] = gained[k] || now > energy[k] + 1e-4 * std::abs(now);
      energy[k] = now;
    }
  }
  CHECK(std::count(gained.begin(), gained.end(), true) < kPiles / 25);
}

TEST_CASE("every solver keeps joints together", "[fast][solver]") {
  for (const Table& table : widest_tables()) {
    for (Space space : kSpaces) {
      for (Solver solver : kAllSolvers) {
        Scene scene = empty_scene(space, 10);
        choose(scene, solver);
        BodyId last;
        for (int i = 0; i < 6; ++i) {
          const Vec3 middle(0.5 + i, 0, 0);
          const BodyId body = scene.add(body_of(shape_of(box_of(space, {0.4, 0.1, 0.1})), middle));
          scene.add(joint_at(scene, last, body, at(middle - Vec3(0.5, 0, 0), hinge_axes(space)),
                             HingeJoint{}));
          last = body;
        }
        Batch batch(compile(scene), options_of(table));
        const double start = energy_of(batch, 0);
        double gap = 0, most = start;
        for (int i = 0; i < 120; ++i) {
          batch.step();
          gap = std::max(gap, worst_gap(batch, 0));
          most = std::max(most, energy_of(batch, 0));
        }
        INFO(name(table) << ' ' << to_string(solver));
        CHECK(gap < (solver == Solver::tgs_soft ? 0.02 : 0.1));
        const double fall = start - energy_of(batch, 0);
        CHECK(most - start < 0.01 * std::abs(fall) + 1e-3 * std::abs(start));
      }
    }
  }
}

TEST_CASE("four substeps turn a jointed rod as four steps do", "[fast][solver]") {
  if (!has_table(double_table())) return;
  for (Space space : kSpaces) {
    for (Solver solver : kAllSolvers) {
      const auto kept = [&](double dt, int substeps) {
        Scene scene = empty_scene(space, 0);
        scene.options.solver.method = solver;
        scene.options.dt = dt, scene.options.substeps = substeps;
        for (int i = 0; i < 2; ++i) {
          Body rod = uniform_rod(space, 1, 1, {0.5 + i, 0, 0});
          const Vec3 spin = 5 * (hinge_axes(space) * Vec3::UnitZ());
          rod.angular_velocity = spin, rod.linear_velocity = spin.cross(rod.position);
          scene.add(rod);
          scene.add(joint_at(scene, BodyId(i - 1), BodyId(i),
                             at({1.0 * i, 0, 0}, hinge_axes(space)), HingeJoint{}));
        }
        Batch batch(compile(scene), options_of(double_table()));
        const double start = kinetic_energy(batch, 0);
        batch.step(static_cast<int>(4 / dt + 0.5));
        return kinetic_energy(batch, 0) / start;
      };
      INFO(to_string(solver));
      const double fine = kept(1.0 / 240, 1);
      CHECK(fine == approx(1, 0.02));
      CHECK(kept(1.0 / 60, 4) == approx(fine, 2e-3));
    }
  }
}

TEST_CASE("what rests bears its weight, by any solver", "[fast][solver]") {
  if (!has_table(double_table())) return;
  for (Space space : kSpaces) {
    for (Solver solver : kAllSolvers) {
      for (int substeps : {1, 4}) {
        Scene scene = empty_scene(space, 10);
        scene.options.solver.method = solver, scene.options.substeps = substeps;
        scene.add(ground(space));
        scene.add(body_of(shape_of(cube_of(space, 0.5)), 0.5 * up_of(space)));
        const Vec3 peg = Vec3(3, 0, 0) + 2 * up_of(space);
        const BodyId hung = scene.add(body_of(shape_of(round_of(space, 0.1)), peg));
        scene.add(joint_at(scene, {}, hung, at(peg), FixedJoint{}));
        BatchOptions options = options_of(double_table());
        options.observe.what = {Observer::contacts, Observer::joint_loads};
        Batch batch(compile(scene), options);
        batch.step(600);
        double impulse = 0;
        for (const StepContact& c : batch.step_contacts(0)) impulse += c.normal_impulse;
        std::vector<double> force(batch.size(Observed::joint_force));
        batch.read(Observed::joint_force, 0, force);
        INFO(to_string(solver) << ", substeps " << substeps);
        const auto weight = [&](std::size_t body) {
          return 10 * mass_properties(scene, scene.bodies[body]).mass;
        };
        CHECK(impulse / scene.options.dt == Approx(weight(1)).epsilon(1e-6));
        CHECK(force[space == Space::planar ? 1 : 2] == Approx(weight(2)).epsilon(1e-6));
      }
    }
  }
}

TEST_CASE("conjugate gradients take impulses whose squares are infinite", "[fast][solver]") {
  for (const Table& table : widest_tables()) {
    Scene scene = empty_scene(Space::planar, 10);
    choose(scene, Solver::nncg);
    scene.add(ground(Space::planar));
    for (int i = 0; i < 3; ++i) {
      Body ball = body_of(shape_of(Circle{0.5}), {0, 0.5 + i, 0});
      ball.shapes[0].density = 1e25;
      scene.add(ball);
    }
    Batch batch(compile(scene), options_of(table));
    batch.step(120);
    CHECK(batch.status(0) == Status::ok);
    CHECK(position(batch, 0, 2).y() == approx(2.5, 0.01));
  }
}

TEST_CASE("every solver has the same bits on every instruction set, layout and thread count",
          "[fast][bits][solver]") {
  for (Space space : kSpaces) {
    for (Solver solver : kAllSolvers) {
      const Plan plan = compile(everything(space, solver));
      for (Precision precision : {Precision::f32, Precision::f64}) {
        std::vector<std::uint64_t> reference;
        for (const Table& table : all_tables()) {
          if (table.precision != precision) continue;
          for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
            BatchOptions options = options_of(table, 21, layout == ContactLayout::rows ? 3 : 1);
            options.layout = layout;
            INFO(name(table) << ' ' << to_string(solver));
            const auto worlds = hashes_after(plan, options, 30);
            if (reference.empty()) reference = worlds;
            CHECK(worlds == reference);
            options.worlds = 1, options.seed = 7;
            CHECK(hashes_after(plan, options, 30)[0] == reference[7]);
          }
        }
        if (!reference.empty()) CHECK(reference[0] != reference[1]);
      }
    }
  }
}

TEST_CASE("more sweeps leave smaller residuals, and looking changes nothing",
          "[fast][solver][long]") {
  if (!has_table(double_table())) return;
  for (Space space : kSpaces) {
    for (Solver solver : kAllSolvers) {
      Scene scene = everything(space, solver);
      std::vector<double> residuals;
      for (int iterations : {2, 20, 200, 2000}) {
        scene.options.solver.iterations = iterations;
        const Plan plan = compile(scene);
        BatchOptions options = options_of(double_table(), 8);
        const auto unseen = hashes_after(plan, options, 20);
        options.observe.what = {Observer::residual};
        Batch batch(plan, options);
        batch.step(20);
        CHECK(hashes(batch) == unseen);
        double worst = 0;
        for (int w = 0; w < 8; ++w) {
          double now[2];
          batch.read(Observed::residual, w, now);
          worst = std::max({worst, now[0], now[1]});
        }
        residuals.push_back(worst);
      }
      INFO(to_string(solver) << ' ' << residuals[0] << ' ' << residuals[1] << ' ' << residuals[2]
                             << ' ' << residuals[3]);
      if (solver == Solver::tgs_soft) continue;  // its last sweep is one, whatever came before
      CHECK(residuals[3] < 1e-3 * residuals[0]);
      CHECK(residuals[3] < 1e-6);
    }
  }
}

}  // namespace manyworlds::test
