// Contacts of recordings: what was observed is read back, the forces are those of statics, and
// damaged tables are refused.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "manyworlds/scenes.hpp"
#include "tests/record/forged.hpp"

#include "tests/support/approx.hpp"

namespace manyworlds::test {
namespace {

Scene crate_on_ground(Space space) {
  Scene scene = empty_scene(space);
  scene.add(ground(space));
  const Vec3 at = space == Space::planar ? Vec3(0, 0.5, 0) : Vec3(0, 0, 0.5);
  scene.add(body_of(shape_of(cube_of(space, 0.5)), at));
  return scene;
}

BatchOptions observing(int worlds, int threads = 1) {
  BatchOptions options = batch_options(widest_tables().front(), worlds, false, threads);
  options.observe.what = {Observer::contacts};
  return options;
}

void check_same_contacts(const std::vector<RecordedContact>& a,
                         const std::vector<RecordedContact>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK((a[i].body_a == b[i].body_a && a[i].body_b == b[i].body_b));
    CHECK((a[i].point == b[i].point && a[i].normal == b[i].normal));
    CHECK(a[i].force == b[i].force);
  }
}

}  // namespace

TEST_CASE("what a crate presses on the ground with is its weight", "[fast][record]") {
  for (const Space space : kSpaces) {
    const Folder folder;
    const Scene scene = crate_on_ground(space);
    Batch batch(compile(scene), observing(2));
    batch.step(240);
    Recorder recorder(batch, folder / "run.h5", {.contacts = 8});
    batch.step(1);
    recorder.close();
    const Recording recording = Recording::open(folder / "run.h5");
    REQUIRE(recording.has_contacts());
    const double mass = mass_properties(scene, scene.bodies[1]).mass;
    const int up = space == Space::planar ? 1 : 2;
    for (int world = 0; world < 2; ++world) {
      const auto contacts = recording.contacts(1, world);
      REQUIRE(contacts.size() == (space == Space::planar ? 2u : 4u));
      CHECK(recording.contacts_found(1, world) == static_cast<int>(contacts.size()));
      double sum = 0;
      for (const RecordedContact& c : contacts) {
        CHECK(c.body_a == BodyId(0));
        CHECK(c.body_b == BodyId(1));
        CHECK(c.normal[up] == Approx(1));
        CHECK(std::abs(c.point[up]) < 0.02);
        CHECK(c.point.norm() == approx(0.5 * std::sqrt(up), 0.02));
        sum += c.force;
      }
      CHECK(sum == Approx(10 * mass).epsilon(1e-3));
    }
    const ReplayResult result = replay(recording);
    CHECK(result.different == 0);
  }
}

TEST_CASE("recorded contacts are those that were observed, whatever batch and threads",
          "[fast][record]") {
  const Folder folder;
  const Plan plan = compile(scenes::find("bin-boxes")->make());
  const double dt = plan.scene().options.dt;
  std::vector<std::vector<RecordedContact>> seen;
  {
    Batch batch(plan, observing(5));
    Recorder recorder(batch, folder / "a.h5", {.worlds = {1, 3}, .every = 10, .contacts = 1000});
    for (int i = 0; i < 12; ++i) {
      batch.step(10);
      auto& to = seen.emplace_back();
      for (const StepContact& c : batch.step_contacts(3)) {
        if (c.normal_impulse > 0) to.push_back({c.body_a, c.body_b, c.point, c.normal, 0});
        if (c.normal_impulse > 0) to.back().force = static_cast<float>(c.normal_impulse / dt);
      }
    }
    recorder.close();
    CHECK(recorder.samples() == 13);
  }
  Batch other(plan, observing(20, 2));
  Recorder recorder(other, folder / "b.h5", {.worlds = {3}, .every = 10, .contacts = 3});
  for (int i = 0; i < 120; ++i) other.step(1);
  recorder.close();
  const Recording a = Recording::open(folder / "a.h5"), b = Recording::open(folder / "b.h5");
  std::size_t most = 0;
  CHECK(a.contacts(0, 1).empty());
  for (std::int64_t s = 1; s <= 12; ++s) {
    auto all = a.contacts(s, 1);
    check_same_contacts(all, seen[static_cast<std::size_t>(s - 1)]);
    most = std::max(most, all.size());
    // Bounded: those of the largest forces, in their order.
    const auto few = b.contacts(s, 0);
    CHECK(few.size() == std::min<std::size_t>(3, all.size()));
    CHECK(b.contacts_found(s, 0) == static_cast<int>(all.size()));
    std::vector<double> forces;
    for (const RecordedContact& c : all) forces.push_back(c.force);
    std::sort(forces.rbegin(), forces.rend());
    for (const RecordedContact& c : few) {
      CHECK(c.force >= forces[few.size() - 1]);
      CHECK(std::any_of(all.begin(), all.end(), [&](const RecordedContact& one) {
        return one.point == c.point && one.force == c.force;
      }));
    }
  }
  CHECK(most > 20);
  CHECK(replay(a).different == 0);
}

TEST_CASE("contacts are recorded of batches that observe them alone", "[fast][record]") {
  const Folder folder;
  Batch blind(compile(crate_on_ground(Space::spatial)), batch_options(widest_tables().front(), 1));
  CHECK_THROWS_WITH(Recorder(blind, folder / "run.h5", {.contacts = 4}),
                    Catch::Contains("does not observe contacts"));
  CHECK_THROWS_WITH(Recorder(blind, folder / "run.h5", {.contacts = -1}),
                    "record: contacts is -1, must be 0 to 65536");
  CHECK(folder.files().empty());
  Recorder recorder(blind, folder / "run.h5");
  blind.step(2);
  recorder.close();
  const Recording recording = Recording::open(folder / "run.h5");
  CHECK_FALSE(recording.has_contacts());
  CHECK(recording.contacts(1, 0).empty());
  CHECK(recording.contacts_found(1, 0) == 0);
  CHECK_THROWS_AS(recording.contacts(9, 0), std::invalid_argument);
  CHECK_THROWS_AS(recording.contacts(0, 1), std::invalid_argument);
}

TEST_CASE("contacts that are damaged are refused", "[fast][record]") {
  const Folder folder;
  Batch batch(compile(crate_on_ground(Space::spatial)), observing(1));
  batch.step(240);
  Recorder recorder(batch, folder / "run.h5", {.contacts = 4});
  batch.step(1);
  recorder.close();
  const Bytes whole = bytes_of(folder / "run.h5");
  const auto forged = [&](const char* name, hsize_t at, std::int64_t value) {
    const fs::path file = folder / "forged.h5";
    write_bytes(file, whole);
    const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t data = H5Dopen2(h5, (std::string("kinds/0/contacts/") + name).c_str(), H5P_DEFAULT);
    REQUIRE(data >= 0);
    const hid_t space = H5Dget_space(data);
    const hsize_t first[2] = {at, 0}, one[2] = {1, 1};
    H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, one, nullptr);
    const hid_t memory = H5Screate_simple(H5Sget_simple_extent_ndims(space), one, nullptr);
    REQUIRE(H5Dwrite(data, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, &value) >= 0);
    H5Sclose(memory), H5Sclose(space), H5Dclose(data), H5Fclose(h5);
    Bytes bytes = bytes_of(file);
    record::seal(std::span(bytes));
    return bytes;
  };
  const auto refused = [](const Bytes& bytes, const char* why) {
    CHECK_THROWS_WITH(Recording::from_bytes(bytes), Catch::Contains(why));
  };
  CHECK(Recording::from_bytes(whole).contacts(1, 0).size() == 4);
  refused(forged("end", 1, 3), "contacts: 'end' of sample 1, world 0 is 3, must be at least 4");
  refused(forged("end", 1, 9), "contacts: 'end' of sample 1, world 0 is 9");
  refused(forged("end", 0, -1), "contacts: 'end' of sample 0, world 0 is -1");
  refused(forged("found", 0, 3), "must be at least 0, and at most 3 more");
  refused(forged("end", 1, 7), "'body_a' has 8 rows, must have 7");
  refused(forged("body_b", 2, 2), "'body_b' has body 2, must be 0 to 1");
  refused(forged("body_a", 0, -1), "'body_a' has body -1");
}

}  // namespace manyworlds::test
