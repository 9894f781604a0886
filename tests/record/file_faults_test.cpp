// The n-th call of the system fails, for every n, while a text, a snapshot, the files of a report
// or dumps of lost worlds are written, or a snapshot is read: no crash, and never half a file under
// the good name.
#include <catch2/catch.hpp>

#include <algorithm>

#include "src/base/output_file.hpp"
#include "tests/record/fault_sweep.hpp"
#include "tools/report/report_files.hpp"

namespace manyworlds::test {
namespace {

// Both sweeps of `work`, in a child.
template <class Work, class Check>
void check_sweeps(const fs::path& named, Work work, Check check) {
  CHECK(in_child([&](const Progress& say) { return sweep_calls(say, named, work, check); }) == "");
  if (!kAllocationsFail) return;
  CHECK(in_child([&](const Progress& say) { return sweep_memory(say, named, work, check); }) == "");
}

// What is wrong where `file` was to become `whole`: it is that or as before, which only an error
// excuses.
std::string check_file(const fs::path& file, bool existed, const std::string& whole, bool failed) {
  if (!fs::exists(file)) return failed && !existed ? "" : "no file";
  const std::string found = read_text(file);
  if (found == whole) return {};
  if (!existed || found != kOld) return "half of " + file.string();
  return failed ? "" : "not written: " + file.string();
}

// As before the next fault. Returns what else lies in the folder.
std::string put_back(const Folder& folder, const std::vector<fs::path>& files, bool existed) {
  for (const fs::path& file : files) {
    fs::remove(file);
    if (existed) write_file(file, kOld);
  }
  return folder.files().size() == (existed ? files.size() : 0) ? "" : "a file is left";
}

Snapshot three_worlds() {
  Scene scene = empty_scene(Space::planar);
  scene.add(body_of(shape_of(Circle{0.4}), Vec3(0, 0.6, 0)));
  return Batch(compile(scene), batch_options(widest_tables().front(), 3)).save();
}

// Dumps of so many lost worlds into `folder`.
std::size_t dump_lost(const Plan& plan, int worlds, const fs::path& folder) {
  Batch batch(plan, batch_options(widest_tables().front(), worlds));
  LostWorldDumps dumps(batch, folder);
  batch.step(2);
  return dumps.close().size();
}

// What is wrong with the files in `folder`, which it removes.
std::string check_dumps(const fs::path& folder, std::size_t least) {
  std::size_t there = 0;
  if (fs::exists(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const ReplayResult result = replay(Recording::open(entry.path()));
      if (result.different != 0 || result.lost_worlds != 1) return "another replay";
      ++there;
    }
  }
  fs::remove_all(folder);
  return there < least ? "not all dumped" : "";
}

}  // namespace

TEST_CASE("whatever fails while a text or a snapshot is written, it is whole or as before",
          "[fast][record][faults]") {
  const bool existed = GENERATE(false, true);
  const Folder folder;
  const fs::path file = folder / "file";
  const std::string text(100, 'x');
  const auto check_whole = [&](const std::string& whole) {
    return [&, whole](const std::string& message) {
      const std::string problem = check_file(file, existed, whole, !message.empty());
      const std::string left = put_back(folder, {file}, existed);
      return problem.empty() ? left : problem;
    };
  };
  put_back(folder, {file}, existed);
  check_sweeps(
      file, [&] { write_file(file, text); }, check_whole(text));
  const Snapshot snapshot = three_worlds();
  const auto& bytes = snapshot.bytes();
  const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  put_back(folder, {file}, existed);
  check_sweeps(
      file, [&] { snapshot.save(file); }, check_whole(whole));
}

TEST_CASE("whatever fails while a snapshot is read, it is an error or the whole of it",
          "[fast][record][faults]") {
  const Folder folder;
  const fs::path file = folder / "start.mws";
  const Snapshot whole = three_worlds();
  whole.save(file);
  Snapshot found;
  const auto load = [&] {
    found = Snapshot();
    found = Snapshot::load(file);
  };
  check_sweeps(file, load, [&](const std::string& message) -> std::string {
    if (message.empty() ? found.bytes() == whole.bytes() : found.worlds() == 0) return {};
    return "another snapshot";
  });
}

TEST_CASE("whatever fails while a report is written, both files are whole or as before",
          "[fast][record][faults]") {
  const bool existed = GENERATE(false, true);
  const Folder folder;
  const fs::path page = folder / "plan.html", json = folder / "plan.json";
  const std::string new_page(100, 'p'), new_json(100, 'j');
  const auto write = [&] {
    report::ReportFiles(folder.path(), "plan", true).write(new_json, new_page);
  };
  put_back(folder, {page, json}, existed);
  check_sweeps(folder.path(), write, [&](const std::string& message) {
    const bool failed = !message.empty();
    std::string problem = check_file(page, existed, new_page, failed);
    if (problem.empty()) problem = check_file(json, existed, new_json, failed);
    // A new JSON has its page beside it.
    if (problem.empty() && fs::exists(json) && read_text(json) == new_json &&
        (!fs::exists(page) || read_text(page) != new_page)) {
      problem = "a JSON without its page";
    }
    const std::string left = put_back(folder, {page, json}, existed);
    return problem.empty() ? left : problem;
  });
}

TEST_CASE("whatever fails while lost worlds are dumped, what is there replays",
          "[fast][record][faults]") {
  Scene scene = empty_scene(Space::planar);
  scene.options.dt = 1e12;  // a body of 1 m/s leaves the range of 1e10 m
  scene.add(body_of(shape_of(Circle{0.4}), Vec3(0, 0.6, 0)));
  const Plan plan = compile(scene);
  const Folder folder;
  const fs::path lost = folder / "lost";
  CHECK(dump_lost(plan, 2, lost) == 2);
  fs::remove_all(lost);
  const auto sweep_dumps = [&](int worlds, auto sweep) {
    return in_child([&](const Progress& say) {
      return sweep(
          say, lost, [&] { dump_lost(plan, worlds, lost); },
          [&](const std::string& message) {
            return check_dumps(lost, message.empty() ? static_cast<std::size_t>(worlds) : 0);
          });
    });
  };
  CHECK(sweep_dumps(2, [](auto&&... all) { return sweep_calls(all...); }) == "");
  if (!kAllocationsFail) return;
  CHECK(sweep_dumps(1, [](auto&&... all) { return sweep_memory(all...); }) == "");
}

}  // namespace manyworlds::test
