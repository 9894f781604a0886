// Files that are cut, damaged, foreign or forged are refused with a reason, and never more.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

#include "tests/record/forged.hpp"

namespace manyworlds::test {
namespace {

// Where a run of bytes stands in the file; the file holds it once.
std::size_t find(const Bytes& bytes, const Bytes& part) {
  const auto at = std::search(bytes.begin(), bytes.end(), part.begin(), part.end());
  REQUIRE(at != bytes.end());
  CHECK(std::search(at + 1, bytes.end(), part.begin(), part.end()) == bytes.end());
  return static_cast<std::size_t>(at - bytes.begin());
}
Bytes bytes_of_text(const std::string& text) {
  const auto raw = std::as_bytes(std::span(text));
  return {raw.begin(), raw.end()};
}

// The honest file with a dataset's first bytes overwritten, and a right checksum.
Bytes forged(const std::string& dataset, std::size_t element, const void* value, hid_t type) {
  const Folder folder;
  const fs::path file = folder / "forged.h5";
  write_bytes(file, honest());
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t data = H5Dopen2(h5, dataset.c_str(), H5P_DEFAULT);
  REQUIRE(data >= 0);
  const hid_t space = H5Dget_space(data);
  hsize_t dims[4] = {1, 1, 1, 1}, at[4] = {}, one[4] = {1, 1, 1, 1};
  const int rank = H5Sget_simple_extent_dims(space, dims, nullptr);
  for (int d = rank - 1; d >= 0; --d) {
    at[d] = element % dims[d];
    element /= dims[d];
  }
  REQUIRE(element == 0);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, at, nullptr, one, nullptr);
  const hid_t memory = H5Screate_simple(rank, one, nullptr);
  REQUIRE(H5Dwrite(data, type, memory, space, H5P_DEFAULT, value) >= 0);
  H5Sclose(memory), H5Sclose(space), H5Dclose(data), H5Fclose(h5);
  Bytes bytes = bytes_of(file);
  record::seal(std::span(bytes));
  return bytes;
}
Bytes forged(const std::string& dataset, std::size_t element, std::int64_t value) {
  return forged(dataset, element, &value, H5T_NATIVE_INT64);
}

void refused(const Bytes& bytes, const char* why) {
  CHECK_THROWS_WITH(Recording::from_bytes(bytes), Catch::Contains(why));
}

}  // namespace

TEST_CASE("a recording is read from memory as from its file", "[fast][record]") {
  const Recording recording = Recording::from_bytes(honest());
  CHECK(recording.samples() == 4);
  CHECK(recording.inputs() == 3);
  const ReplayResult result = replay(recording);
  CHECK(result.compared == 8);
  CHECK(result.different == 0);
  // Two at a time are two.
  const float far = 7.5f;
  const Recording other =
      Recording::from_bytes(forged("kinds/0/position", 6, &far, H5T_NATIVE_FLOAT));
  CHECK(other.read(Field::position, 1, 1)[0] == 7.5);
  CHECK(recording.read(Field::position, 1, 1)[0] != 7.5);
}

TEST_CASE("a recording that is cut or changed anywhere is refused", "[fast][record]") {
  const Bytes& whole = honest();
  for (std::size_t n = 0; n < whole.size(); n += n < 1024 ? 1 : 509) {
    CHECK_THROWS_AS(Recording::from_bytes(std::span(whole).first(n)), RecordError);
  }
  for (std::size_t i = 0; i < whole.size(); i += i < 1024 ? 1 : 509) {
    Bytes bad = whole;
    bad[i] ^= std::byte{0x10};
    CHECK_THROWS_AS(Recording::from_bytes(bad), RecordError);
  }
  Bytes longer = whole;
  longer.push_back(std::byte{0});
  refused(longer, "bytes long, must be");
}

TEST_CASE("files that are no recordings are refused by name", "[fast][record]") {
  const Folder folder;
  const auto refused_file = [&](const fs::path& file, const char* why) {
    CHECK_THROWS_WITH(Recording::open(file),
                      Catch::Contains("'" + file.string() + "'") && Catch::Contains(why));
  };
  refused_file(folder / "absent.h5", "No such file");
  refused_file(folder.path(), "is a directory");
  write_bytes(folder / "empty.h5", {});
  refused_file(folder / "empty.h5", "too short");
  write_bytes(folder / "text.h5", bytes_of_text(std::string(2000, 'x')));
  refused_file(folder / "text.h5", "is not a manyworlds recording");
  // Another program's HDF5 file, and an empty one in our frame.
  const hid_t h5 =
      H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(h5);
  refused_file(folder / "other.h5", "is not a manyworlds recording");
  Bytes framed(512);
  const Bytes foreign = bytes_of(folder / "other.h5");
  framed.insert(framed.end(), foreign.begin(), foreign.end());
  record::seal(std::span(framed));
  refused(framed, "has no attribute 'format'");
  framed[8] = std::byte{1};  // of 0.1, whose scenes had options without groups
  refused(framed, "has format version 1, must be 2");
  Bytes junk(4096, std::byte{0x5a});
  record::seal(std::span(junk));
  refused(junk, "cannot be opened");
}

// A right checksum over wrong numbers: every one that is used is looked at.
TEST_CASE("a forged recording is refused", "[fast][record]") {
  refused(forged("step", 1, 5), "input 1 is at step 4, must be at 5 or later");
  refused(forged("step", 0, -1), "sample 0 is at step -1");
  refused(forged("step", 3, 7), "must be at 8 or later");
  refused(forged("inputs_before", 1, 4), "comes after 4 inputs of 3");
  refused(forged("inputs_before", 2, -1), "comes after -1 inputs");
  refused(forged("inputs/step", 0, 1), "must be at");
  refused(forged("inputs/call_steps", 0, 5), "must be at 5 or later");
  refused(forged("inputs/call_steps", 1, 1), "input 1: acts for 1 steps");
  refused(forged("inputs/call_steps", 0, -4), "input 0: acts for -4 steps");
  refused(forged("inputs/input", 0, kInputCount),
          ("input 0: has unknown type " + std::to_string(kInputCount)).c_str());
  refused(forged("inputs/input", 0, 2), "input 0: has 3 values, must have 6");
  refused(forged("inputs/world", 1, 2), "input 1: is for world 2 of 2");
  refused(forged("inputs/body", 1, 1), "input 1: is for body 1 of 1");
  refused(forged("inputs/body", 2, 0), "input 2: is for body 0 of 1");
  refused(forged("inputs/begin", 1, 4), "input 1: has values out of range");
  refused(forged("inputs/begin", 0, -1), "input 0: has values out of range");
  refused(forged("inputs/count", 0, std::int64_t{1} << 62), "input 0: has values out of range");
  refused(forged("start", 3, 0), "is not a manyworlds snapshot");
  refused(forged("start", 70, 99), "checksum does not match");
}

TEST_CASE("a recording of another make is refused", "[fast][record]") {
  refused(rebuilt([](hid_t h5) { H5Adelete(h5, "precision"); }), "has no attribute 'precision'");
  refused(rebuilt([](hid_t h5) { H5Ldelete(h5, "kinds/0/position", H5P_DEFAULT); }),
          "kind 0: has no 'position'");
  refused(rebuilt([](hid_t h5) { H5Ldelete(h5, "kinds/0", H5P_DEFAULT); }), "has 0 kinds");
  refused(rebuilt([](hid_t h5) { H5Ldelete(h5, "inputs", H5P_DEFAULT); }), "has no 'inputs'");
  refused(rebuilt([](hid_t h5) {
            H5Ldelete(h5, "start", H5P_DEFAULT);
            H5Lcreate_soft("/step", h5, "start", H5P_DEFAULT, H5P_DEFAULT);
          }),
          "'start' is int64, must be uint8");
  refused(rebuilt([](hid_t h5) {
            const hid_t data = H5Dopen2(h5, "kinds/0/hash", H5P_DEFAULT);
            const hsize_t dims[] = {5, 2};
            H5Dset_extent(data, dims);
            H5Dclose(data);
          }),
          "kind 0: 'hash' ");
  // A dataset that says that it is huge, and has nothing.
  refused(rebuilt([](hid_t h5) {
            const hid_t data = H5Dopen2(h5, "step", H5P_DEFAULT);
            const hsize_t dims[] = {hsize_t{1} << 50};
            H5Dset_extent(data, dims);
            H5Dclose(data);
          }),
          "'step' is incomplete");
  // What lies in another file is not looked for.
  const Folder folder;
  const std::string other = folder / "other.h5";
  write_bytes(other, honest());
  refused(rebuilt([&](hid_t h5) {
            H5Ldelete(h5, "step", H5P_DEFAULT);
            H5Lcreate_external(other.c_str(), "step", h5, "step", H5P_DEFAULT, H5P_DEFAULT);
          }),
          "'step' is a link to another file, must be in this one");
  refused(rebuilt([&](hid_t h5) {
            H5Ldelete(h5, "kinds", H5P_DEFAULT);
            H5Lcreate_external(other.c_str(), "kinds", h5, "kinds", H5P_DEFAULT, H5P_DEFAULT);
          }),
          "'kinds' is a link to another file");
  refused(rebuilt([&](hid_t h5) {
            H5Ldelete(h5, "kinds/0/scene", H5P_DEFAULT);
            const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), type = H5Tcopy(H5T_C_S1);
            H5Tset_size(type, 100);
            H5Pset_external(creation, other.c_str(), 0, 100);
            const hid_t space = H5Screate(H5S_SCALAR);
            const hid_t data =
                H5Dcreate2(h5, "kinds/0/scene", type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
            H5Dclose(data), H5Sclose(space), H5Tclose(type), H5Pclose(creation);
          }),
          "'scene' is compressed or stored outside the file");
  // Another scene than the one whose plan was recorded.
  Bytes heavier = honest();
  const std::size_t at = find(heavier, bytes_of_text("\"density\":1000.0"));
  heavier[at + 10] = std::byte{'3'};
  record::seal(std::span(heavier));
  refused(heavier, "compiles the scene to another plan");
  Bytes misspelt = honest();
  misspelt[at + 1] = std::byte{'D'};
  record::seal(std::span(misspelt));
  refused(misspelt, "scene: /options: has no member 'density'");
}

TEST_CASE("a replay tells the first world, step and body that differ", "[fast][record]") {
  const auto difference = [](const Bytes& bytes) {
    const ReplayResult result = replay(Recording::from_bytes(bytes));
    REQUIRE(result.difference);
    CHECK(result.different == 1);
    return *result.difference;
  };
  const float far = 7.5f;
  const Difference moved = difference(forged("kinds/0/position", 6, &far, H5T_NATIVE_FLOAT));
  CHECK(moved.world == 1);
  CHECK(moved.step == 4);
  CHECK(moved.body == BodyId(1));  // on the ground
  CHECK_THAT(moved.what, Catch::Contains("position.x is") && Catch::Contains("recorded 7.5"));
  const Difference hashed = difference(forged("kinds/0/hash", 4, 0));
  CHECK(hashed.world == 0);
  CHECK(hashed.step == 8);
  CHECK(hashed.body == BodyId());
  CHECK_THAT(hashed.what, Catch::Contains("recorded 0000000000000000"));
  const Difference lost = difference(forged("kinds/0/status", 7, 4));
  CHECK(lost.what == "status is ok, recorded out_of_bounds");
  // An input that was not: all samples after it differ.
  const double hard = 1e4;
  const ReplayResult changed_force =
      replay(Recording::from_bytes(forged("inputs/values", 0, &hard, H5T_NATIVE_DOUBLE)));
  REQUIRE(changed_force.difference);
  CHECK(changed_force.difference->world == 1);
  CHECK(changed_force.difference->step == 4);
  CHECK(changed_force.different == 2);  // the world is reset before the last sample
}

}  // namespace manyworlds::test
