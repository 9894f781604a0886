// Joints and the laws: the same bits whatever the lane, threads, instruction set and layout, after
// snapshots, beside worlds that go wrong, and when asleep.
#include <catch2/catch.hpp>

#include <limits>
#include <vector>

#include "tests/support/contraption.hpp"
#include "tests/support/hashes.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {
namespace {

std::vector<Plan> plans() {
  std::vector<Plan> out;
  for (const Space space : kSpaces) {
    for (const Scene& scene : {contraption(space), joint_trees(space)})
      out.push_back(compile(scene));
  }
  return out;
}

void add_loose_bodies(Scene& scene) {
  const Space space = scene.space;
  for (int i = 0; i < 12; ++i) {
    const Shape ball = space == Space::planar ? shape_of(Circle{0.15}) : shape_of(Sphere{0.15});
    const Shape loose = i % 2 == 0 ? ball : shape_of(box_of(space, {0.15, 0.1, 0.1}));
    Body body =
        body_of(loose, Vec3(0.5 * (i % 6) - 0.2, 0, 0) + (1.4 + 0.4 * (i / 6)) * up_of(space));
    body.jitter.position = Vec3::UnitX() * 0.2;
    body.jitter.angle = 1;
    scene.add(body);
  }
}

}  // namespace

TEST_CASE("joints have the same bits on every instruction set, layout and thread count",
          "[fast][bits][joint]") {
  for (const Plan& plan : plans()) {
    for (Precision precision : {Precision::f32, Precision::f64}) {
      std::vector<std::uint64_t> reference;
      for (const Table& table : all_tables()) {
        if (table.precision != precision) continue;
        for (ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
          for (int threads : {1, 3}) {
            BatchOptions options = options_of(table, 21, threads);
            options.layout = layout;
            options.seed = 5;
            INFO(name(table) << " threads " << threads);
            const auto hashes = hashes_after(plan, options, 40);
            if (reference.empty()) reference = hashes;
            CHECK(hashes == reference);
          }
        }
      }
      if (reference.empty()) continue;
      CHECK(reference[0] != reference[1]);
      // In some worlds joints break, in others they hold.
      Batch batch(plan, options_of({Isa::scalar, precision}, 21));
      batch.step(40);
      int broken = 0;
      for (int w = 0; w < 21; ++w) broken += has(batch.status(w), Status::joint_broken) ? 1 : 0;
      CHECK(broken > 0);
      CHECK(broken < 21);
    }
  }
}

TEST_CASE("a jointed world has its bits wherever it is in a batch",
          "[fast][bits][joint][one_thread]") {
  for (const Plan& plan : plans()) {
    const Table table = widest_tables().front();
    BatchOptions options = options_of(table, 20);
    const auto reference = hashes_after(plan, options, 30);
    for (int first = 0; first < 20; ++first) {
      options.worlds = 1 + first % 3;
      options.seed = static_cast<std::uint64_t>(first);
      CHECK(hashes_after(plan, options, 30)[0] == reference[static_cast<std::size_t>(first)]);
    }
  }
}

// In rows a block holds contacts of trees in some worlds and of loose bodies in others, in the
// dense layout it does not.
TEST_CASE("loose bodies have the same bits beside contacts of trees", "[fast][bits][joint]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 9.81);
    scene.options.joint.method = JointMethod::tree;
    scene.add(ground(space));
    const Vec3 up = up_of(space);
    BodyId last;
    for (int i = 0; i < 4; ++i) {
      const BodyId link =
          scene.add(body_of(shape_of(box_of(space, {0.3, 0.1, 0.1})), Vec3(0.7 * i, 0, 0) + up));
      if (last) {
        scene.add(joint_at(scene, last, link,
                           at(Vec3(0.7 * i - 0.35, 0, 0) + up, hinge_axes(space)), HingeJoint{}));
      }
      last = link;
    }
    add_loose_bodies(scene);
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 37);
      options.layout = ContactLayout::dense;
      const auto dense = hashes_after(plan, options, 60);
      options.layout = ContactLayout::rows;
      CHECK(hashes_after(plan, options, 60) == dense);
    }
  }
}

// The groups of a batch share memory, and the layout may change from one to the next.
TEST_CASE("what hangs on a rod has the same bits beside any contacts", "[fast][bits][joint]") {
  for (const Space space : kSpaces) {
    Scene scene = empty_scene(space, 9.81);
    scene.add(ground(space));
    const Vec3 up = up_of(space);
    const BodyId bob = scene.add(lump(space, 1, Vec3::Constant(0.1), Vec3(-3, 0, 0) + 3 * up));
    scene.add(joint_at(scene, {}, bob, at(Vec3(-3.5, 0, 0) + 3.5 * up), DistanceJoint{}));
    scene.joints.back().frame_b.position = Vec3::UnitX() * 0.1;
    add_loose_bodies(scene);
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      BatchOptions options = options_of(table, 70);
      options.layout = ContactLayout::dense;
      const auto dense = hashes_after(plan, options, 90);
      for (const ContactLayout layout : {ContactLayout::rows, ContactLayout::automatic}) {
        options.layout = layout;
        CHECK(hashes_after(plan, options, 90) == dense);
      }
    }
  }
}

TEST_CASE("jointed worlds go on from snapshots and copies bit by bit",
          "[fast][bits][joint][one_thread]") {
  for (const Plan& plan : plans()) {
    for (const bool sleep : {false, true}) {
      INFO(plan.scene().joints.size() << " joints, sleep " << sleep);
      BatchOptions options = options_of(widest_tables().front(), 11);
      options.sleep = sleep;
      Batch batch(plan, options);
      batch.step(50);
      const Snapshot saved = batch.save();
      batch.copy_world(3, 8);
      batch.step(50);
      CHECK(batch.hash(3) == batch.hash(8));
      const std::uint64_t hash = batch.hash(5);
      batch.restore(saved);
      batch.step(50);
      CHECK(batch.hash(5) == hash);
      Batch scalar(plan, [&] {
        BatchOptions o = options;
        o.isa = Isa::scalar;
        return o;
      }());
      scalar.restore(saved);
      scalar.step(50);
      CHECK(scalar.hash() == batch.hash());
    }
  }
}

TEST_CASE("a jointed world that goes wrong leaves its neighbours alone",
          "[fast][bits][joint][one_thread]") {
  for (const Plan& plan : plans()) {
    for (const Table& table : all_tables()) {
      INFO(name(table));
      Batch spoilt(plan, options_of(table, 9)), sound(plan, options_of(table, 9));
      spoilt.step(5), sound.step(5);
      std::vector<double> v = values(spoilt, Field::linear_velocity, 4);
      v[3] = std::numeric_limits<double>::quiet_NaN();
      spoilt.write(Field::linear_velocity, 4, v);
      spoilt.step(30), sound.step(30);
      CHECK(frozen(spoilt.status(4)));
      for (int w = 0; w < 9; ++w) {
        if (w != 4) CHECK(spoilt.hash(w) == sound.hash(w));
      }
    }
  }
}

TEST_CASE("a disabled body lets go of its joints", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    for (int i = 0; i < 2; ++i) {
      scene.add(uniform_rod(space, 1, 1, Vec3(0.5 + i, 0, 0)));
      scene.add(joint_at(scene, BodyId(i - 1), BodyId(i),
                         at({static_cast<double>(i), 0, 0}, hinge_axes(space)), HingeJoint{}));
    }
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      Batch batch(plan, options_of(table, 3));
      batch.set_enabled(1, batch.body_in_row(0), false);
      batch.step(60);
      INFO(name(table));
      CHECK(velocity(batch, 1, 1).dot(up_of(space)) == Approx(-10).epsilon(1e-5));
      CHECK(std::abs(velocity(batch, 0, 1).dot(up_of(space)) + 10) > 0.1);
      CHECK(batch.hash(0) == batch.hash(2));
    }
  }
}

TEST_CASE("what hung on a disabled body's joint is not thrown up", "[fast][joint]") {
  for (Space space : kSpaces) {
    Scene scene = empty_scene(space, 10);
    const Vec3 up = up_of(space);
    for (int i = 0; i < 2; ++i) {  // a light rod, and a weight of 1 t on it
      Body rod = uniform_rod(space, i == 0 ? 1 : 1000, 1, (-0.5 - i) * up);
      rod.rotation = rotation_to(Vec3::UnitX(), up);
      scene.add(rod);
      scene.add(joint_at(scene, BodyId(i - 1), BodyId(i),
                         at(-static_cast<double>(i) * up, hinge_axes(space)), HingeJoint{}));
    }
    const Plan plan = compile(scene);
    for (const Table& table : widest_tables()) {
      INFO(name(table));
      Batch batch(plan, options_of(table));
      batch.step(60);
      batch.set_enabled(0, batch.body_in_row(1), false);
      for (int i = 0; i < 30; ++i) {
        batch.step();
        CHECK(velocity(batch, 0, 0).norm() < 0.05);
      }
    }
  }
}

TEST_CASE("jointed bodies fall asleep and wake together", "[fast][sleep][joint]") {
  for (Space space : kSpaces) {
    for (const bool contacts : {false, true}) {
      Scene scene = empty_scene(space, 10);
      if (contacts) scene.add(ground(space));
      for (int i = 0; i < 3; ++i) {
        Body link = uniform_rod(space, 1, 1, 6 * up_of(space) - (i + 0.5) * up_of(space));
        link.angular_drag = link.linear_drag = 2;
        const BodyId body = scene.add(link);
        scene.add(joint_at(scene, BodyId(i == 0 ? -1 : body.index() - 1), body,
                           at((6.0 - i) * up_of(space), hinge_axes(space)), HingeJoint{}));
      }
      BatchOptions options = options_of(widest_tables().front(), 2);
      options.sleep = true;
      Batch batch(compile(scene), options);
      batch.step(300);
      CHECK(batch.asleep(0));
      const std::uint64_t at_rest = batch.hash(0);
      batch.step(60);
      CHECK(batch.hash(0) == at_rest);
      batch.add_impulse(0, batch.body_in_row(2), Vec3(1, 0, 0));
      batch.step(20);
      CHECK(std::abs(spin(batch, 0, 0).norm()) > 1e-3);
      CHECK(batch.asleep(1));
      CHECK(batch.hash(1) == at_rest);
    }
  }
}

}  // namespace manyworlds::test
