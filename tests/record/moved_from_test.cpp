// Recorders and dumps that were moved from: each call says so, none does nothing in silence.
#include <catch2/catch.hpp>

#include <functional>
#include <utility>
#include <vector>

#include "tests/record/support.hpp"

namespace manyworlds::test {
namespace {

void check_all(const char* text, const std::vector<std::function<void()>>& calls) {
  for (const std::function<void()>& call : calls) {
    CHECK_THROWS_WITH(call(), Catch::Contains(text));
    CHECK_THROWS_AS(call(), std::invalid_argument);
  }
}

}  // namespace

// NOLINTBEGIN(bugprone-use-after-move): that is what is tried
TEST_CASE("a Recorder that was moved from says so", "[fast][record][misuse]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 2));
  {
    Recorder recorder(batch, folder / "run.h5");
    Recorder moved(std::move(recorder));
    batch.step();
    check_all("Recorder was moved from", {
                                             [&] { recorder.sample(batch); },
                                             [&] { recorder.close(); },
                                             [&] { (void)recorder.samples(); },
                                         });
    CHECK(moved.samples() == 2);
    recorder = std::move(moved);
    batch.step();
    recorder.close();
    recorder.close();  // twice is once
    CHECK(recorder.samples() == 3);
    recorder.sample(batch);
    CHECK(recorder.samples() == 3);
    check_all("Recorder was moved from", {[&] { moved.close(); }});
  }
  CHECK(Recording::open(folder / "run.h5").samples() == 3);
}

TEST_CASE("dumps of lost worlds that were moved from say so", "[fast][record][misuse]") {
  const Folder folder;
  Batch batch(compile(crowd(Space::planar)), batch_options(widest_tables().front(), 2));
  LostWorldDumps dumps(batch, folder / "lost");
  LostWorldDumps moved(std::move(dumps));
  check_all("LostWorldDumps was moved from", {[&] { dumps.close(); }});
  batch.add_force(1, batch.body_in_row(1), Vec3::Constant(std::nan("")));
  batch.step();
  dumps = std::move(moved);
  CHECK(dumps.close() == std::vector{folder / "lost" / "world_1.h5"});
  CHECK(dumps.close().empty());  // twice is once
  check_all("LostWorldDumps was moved from", {[&] { moved.close(); }});
}
// NOLINTEND(bugprone-use-after-move)

}  // namespace manyworlds::test
