// Models that ask for too much, or for files that are none of theirs: refused before MuJoCo sees
// them.
// This file has over 400 lines because each attack is told in a few lines beside the others.
#include "manyworlds/mjcf.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/support/mjcf_text.hpp"
#include "tests/support/program.hpp"

namespace manyworlds {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using test::ScratchFolder;

const std::string kBall = "<body><freejoint/><geom size='.1'/></body>";
const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

std::string with_assets(const std::string& assets) {
  return test::world("", "<asset>" + assets + "</asset>");
}

fs::path write(const ScratchFolder& folder, const std::string& name, const std::string& text) {
  const fs::path path = folder / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

MjcfOptions limited(const std::string& name, std::int64_t value) {
  MjcfOptions options;
  mjcf_limit(options.limits, name) = value;
  return options;
}

std::string little(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i);
  return bytes;
}
std::string big(std::uint32_t value) {
  const std::string bytes = little(value);
  return {bytes.rbegin(), bytes.rend()};
}

}  // namespace

TEST_CASE("models that would become too large are refused, with the element and the limit",
          "[mjcf][fast]") {
  struct TooLarge {
    std::string xml;
    const char* place;
    const char* limit;
  };
  const std::string replicate = "<replicate count='100'>";
  const std::string end = "</replicate>";
  const std::vector<TooLarge> table = {
      {with_assets("<hfield name='h' nrow='30000' ncol='30000' size='1 1 1 1'/>"),
       "hfield 'h', line 1: has 30000 x 30000 samples", "samples"},
      {with_assets("<hfield name='h' nrow='1' ncol='99999999999' size='1 1 1 1'/>"), "hfield 'h'",
       "samples"},
      {test::world("<replicate count='1000000'>" + kBall + end), "replicate, line 1: makes 3000001",
       "copies"},
      {test::world("\n" + replicate + "<frame>" + replicate + replicate + kBall + end + end +
                   "</frame>" + end),
       "replicate, line 2", "copies"},
      {test::world(replicate + kBall + end + "<replicate count='1e300'>" + kBall + end),
       "replicate", "copies"},
      {test::world(replicate + kBall + kBall + kBall + kBall + kBall + kBall + kBall + end +
                   "<body>" + replicate + kBall + kBall + kBall + kBall + kBall + kBall + kBall +
                   end + "</body>" + replicate + kBall + kBall + kBall + kBall + kBall + kBall +
                   kBall + kBall + kBall + kBall + kBall + kBall + kBall + kBall + kBall + kBall +
                   kBall + kBall + kBall + kBall + kBall + kBall + kBall + kBall + end),
       "with replicate", "copies"},
      {test::world("<flexcomp name='f' type='grid' count='1000 1000 1000'/>"), "flexcomp 'f'",
       "copies"},
      {test::world("<flexcomp name='f' type='grid' count='2 2 2' cellcount='9999 9999 9999'/>"),
       "flexcomp 'f'", "copies"},
      {with_assets("<mesh name='m' builtin='supersphere' params='20000 1 1'/>"), "mesh 'm'",
       "vertices"},
      {with_assets("<mesh name='m' builtin='cone' params='100000000 1'/>"), "mesh 'm'", "vertices"},
      {with_assets("<mesh name='m' builtin='grid' params='9999 9999 9999 1 1 1'/>"), "mesh 'm'",
       "vertices"},
      {test::world(kBall) + "", "", nullptr},
      {"<mujoco><worldbody>" + kBall +
           "</worldbody><sensor><user name='u' dim='1000000000'/></sensor></mujoco>",
       "sensors", "samples"},
      {"<mujoco><worldbody>" + kBall +
           "</worldbody><sensor><clock nsample='1000000000' delay='1'/></sensor></mujoco>",
       "sensors", "samples"},
      {"<mujoco><worldbody><camera name='c' resolution='100000 100000'/></worldbody><sensor>"
       "<rangefinder camera='c'/></sensor></mujoco>",
       "sensors", "samples"},
      {test::world("<replicate count='100'><geom size='1' name='" + std::string(5000000, 'n') +
                   "'/>" + end),
       "bytes", "total_bytes"},
  };
  for (const TooLarge& large : table) {
    INFO(large.xml.substr(0, 300));
    if (large.limit == nullptr) {
      CHECK_NOTHROW(load_mjcf_string(large.xml));
      continue;
    }
    CHECK_THROWS_WITH(load_mjcf_string(large.xml),
                      Contains(large.place) && Contains("expected at most") &&
                          Contains(std::string("limit '") + large.limit + "'"));
  }
  // Keyframes hold the state of every body.
  std::string keys;
  for (int i = 0; i < 1000; ++i) keys += "<key/>";
  CHECK_THROWS_WITH(
      load_mjcf_string("<mujoco><worldbody><replicate count='3000'>" + kBall +
                       "</replicate></worldbody><keyframe>" + keys + "</keyframe></mujoco>"),
      Contains("keyframes") && Contains("limit 'samples'"));
}

TEST_CASE("every limit is where it says, and an option widens it", "[mjcf][fast]") {
  const ScratchFolder folder;
  write(folder, "m.obj", kTetrahedron);
  struct Case {
    const char* limit;
    std::int64_t just;  // one less is refused
    std::string xml;
  };
  const std::string meshes =
      test::world("<geom type='mesh' mesh='m'/>", "<asset><mesh file='m.obj'/></asset>");
  const std::vector<Case> cases = {
      {"copies", 5,
       test::world("<replicate count='2'><geom size='1'/><geom size='1'/></replicate>")},
      {"elements", 5, test::world(kBall)},
      {"depth", 4, test::world(kBall)},
      {"samples", 12, with_assets("<hfield name='h' nrow='3' ncol='4' size='1 1 1 1'/>")},
      {"vertices", 4, meshes},
      {"files", 2, meshes},
      {"file_bytes", static_cast<std::int64_t>(meshes.size()), meshes},
  };
  for (const Case& c : cases) {
    INFO(c.limit << " " << c.xml);
    const fs::path path = write(folder, "limits.xml", c.xml);
    CHECK_NOTHROW(load_mjcf(path, limited(c.limit, c.just)));
    CHECK_THROWS_WITH(load_mjcf(path, limited(c.limit, c.just - 1)),
                      Contains(std::string("limit '") + c.limit + "'"));
  }
  CHECK_THROWS_WITH(load_mjcf(write(folder, "limits.xml", meshes), limited("total_bytes", 100)),
                    Contains("limit 'total_bytes'"));
  CHECK_THROWS_AS(load_mjcf_string(test::world(kBall), limited("file_bytes", 10)), MjcfError);
  MjcfLimits limits;
  CHECK_THROWS_WITH(mjcf_limit(limits, "copys"), Contains("'copys'") && Contains("copies"));
  CHECK(mjcf_limit_names().size() == 8);
}

TEST_CASE("headers of meshes and height fields are checked before they are decoded",
          "[mjcf][fast]") {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& file, const std::string& bytes,
                           const std::string& why) {
    INFO(file << " " << why);
    write(folder, file, bytes);
    const bool field = file.ends_with(".png") || file.ends_with(".bin");
    const fs::path model =
        write(folder, "model.xml",
              with_assets(field ? "<hfield name='a' file='" + file + "' size='1 1 1 1'/>"
                                : "<mesh name='a' file='" + file + "'/>"));
    CHECK_THROWS_WITH(load_mjcf(model),
                      Contains(" 'a', line 1: ") && Contains(file) && Contains(why));
  };
  const std::string png = "\x89PNG\r\n\x1a\n" + big(13) + "IHDR" + big(30000) + big(30000);
  refused("h.png", png + "\x08" + std::string("\0\0\0\0", 4), "900000000 samples");
  refused("h.bin", little(30000) + little(30000), "limit 'samples'");
  refused("h.bin", little(2) + little(2) + "xx", "10 bytes; expected 24");
  refused("h.bin", little(0xffffffffu) + little(0xffffffffu), "limit 'samples'");
  refused("m.stl", std::string(80, ' ') + little(0xffffffffu), "limit 'vertices'");
  refused("m.stl", std::string(80, ' ') + little(3), "84 bytes; expected 234");
  refused("m.stl", "solid of text", "expected 84 by its header");
  refused("m.msh", little(0x7fffffffu) + little(0) + little(0) + little(1), "limit 'vertices'");
  refused("m.msh", little(3) + little(0) + little(0) + little(1), "16 bytes; expected 64");
  refused("m.dae", "<COLLADA/>", "of type '.dae'; expected .obj, .stl or .msh");
  refused("m", "", "of type ''");

  write(folder, "fine.bin", little(2) + little(2) + std::string(16, '\0'));
  CHECK_NOTHROW(load_mjcf(
      write(folder, "fine.xml", with_assets("<hfield name='h' file='fine.bin' size='1 1 1 1'/>"))));
}

TEST_CASE("only regular files are read, and nothing hangs on the others", "[mjcf][fast]") {
  const ScratchFolder folder;
  REQUIRE(mkfifo((folder / "fifo.xml").c_str(), 0600) == 0);
  REQUIRE(mkfifo((folder / "fifo.obj").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(load_mjcf(folder / "fifo.xml"),
                    Contains("fifo.xml: is a FIFO; expected a file"));
  CHECK_THROWS_WITH(load_mjcf("/dev/zero"), Contains("/dev/zero: is a device"));
  CHECK_THROWS_WITH(load_mjcf(folder.path()), Contains("is a directory; expected a file"));
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "a.xml", "<mujoco>\n<include file='fifo.xml'/></mujoco>")),
      Contains("a.xml: include, line 2") && Contains("is a FIFO"));
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "a.xml", with_assets("<mesh name='m' file='fifo.obj'/>"))),
      Contains("a.xml: mesh 'm', line 1") && Contains("is a FIFO"));
  // A file that is larger than any memory is not read.
  write(folder, "sparse.xml", "<mujoco/>");
  fs::resize_file(folder / "sparse.xml", std::uintmax_t{1} << 40);
  CHECK_THROWS_WITH(load_mjcf(folder / "sparse.xml"),
                    Contains("1099511627776 bytes") && Contains("limit 'file_bytes'"));
  CHECK_THROWS_WITH(load_mjcf(write(folder, "zero.xml", std::string("<mujoco/>\0x", 11))),
                    Contains("contains a NUL character"));
}

TEST_CASE("URDF is refused by name, and so is what is no model", "[mjcf][fast]") {
  CHECK_THROWS_WITH(
      load_mjcf_string("<?xml version='1.0'?>\n<robot name='r'><link name='l'/></robot>"),
      Contains("robot 'r', line 2: is a URDF file") && Contains("expected MJCF"));
  CHECK_THROWS_WITH(load_mjcf_string("<html/>"), Contains("html, line 1: is not a model"));
  const ScratchFolder folder;
  write(folder, "r.xml", "<robot name='r'><link name='l'/></robot>");
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "a.xml", with_assets("<model name='m' file='r.xml'/>"))),
      Contains("r.xml: robot 'r', line 1: is a URDF file"));
}

TEST_CASE("files outside of the model's folder are not opened, unless a root names theirs",
          "[mjcf][fast]") {
  const ScratchFolder folder;
  const std::string include = "<mujoco><worldbody>" + kBall + "</worldbody></mujoco>";
  write(folder, "outside/part.xml", include);
  write(folder, "outside/part.obj", kTetrahedron);
  write(folder, "model/in/part.xml", include);
  fs::create_symlink(folder / "outside/part.xml", folder / "model/link.xml");
  fs::create_directory_symlink(folder / "outside", folder / "model/linked");
  const std::string outside = (folder / "outside").string();
  const std::vector<std::string> models = {
      "<mujoco><include file='/etc/passwd'/></mujoco>",
      "<mujoco><include file='../outside/part.xml'/></mujoco>",
      "<mujoco><include file='in/../../outside/part.xml'/></mujoco>",
      "<mujoco><include file='..\\outside\\part.xml'/></mujoco>",
      "<mujoco><INCLUDE file='../outside/part.xml'/></mujoco>",
      "<mujoco><include file='link.xml'/></mujoco>",
      "<mujoco><include file='linked/part.xml'/></mujoco>",
      "<mujoco><include file='" + outside + "/part.xml'/></mujoco>",
      with_assets("<mesh name='m' file='../outside/part.obj'/>"),
      with_assets("<mesh name='m' file='linked/part.obj'/>"),
      with_assets("<mesh name='m' file='" + outside + "/part.obj'/>"),
      with_assets("<model name='m' file='../outside/part.xml'/>"),
      with_assets("<hfield name='h' file='/etc/passwd' size='1 1 1 1'/>"),
      "<mujoco><compiler meshdir='../outside'/><asset><mesh name='m' "
      "file='part.obj'/></asset></mujoco>",
      "<mujoco><compiler assetdir='" + outside +
          "'/><asset><mesh name='m' file='part.obj'/></asset></mujoco>",
      "<mujoco><asset><mesh name='m' file='part.obj'/></asset><compiler "
      "meshdir='linked'/></mujoco>",
  };
  for (const std::string& xml : models) {
    INFO(xml);
    const fs::path model = write(folder, "model/model.xml", xml);
    CHECK_THROWS_WITH(load_mjcf(model), Contains("model.xml: ") && Contains(", line 1: ") &&
                                            Contains("is outside the model's folder") &&
                                            Contains((folder / "model").string()));
    // MuJoCo finds <INCLUDE>, reads its file, and refuses it afterwards.
    if (xml.find("passwd") != std::string::npos || xml.find("INCLUDE") != std::string::npos)
      continue;
    MjcfOptions options;
    options.roots = {folder / "outside"};
    CHECK_NOTHROW(load_mjcf(model, options));
  }
  MjcfOptions absent;
  absent.roots = {folder / "none"};
  CHECK_THROWS_WITH(load_mjcf(folder / "model/model.xml", absent),
                    Contains("MJCF root") && Contains("none"));
  CHECK_NOTHROW(load_mjcf(
      write(folder, "model/model.xml", "<mujoco><include file='in/part.xml'/></mujoco>")));
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "model/model.xml", with_assets("<mesh name='m' file='no.obj'/>"))),
      Contains("mesh 'm', line 1: 'no.obj': no such file"));
}

TEST_CASE("a text has no folder, so it names files only with a root", "[mjcf][fast]") {
  const ScratchFolder folder;
  write(folder, "m.obj", kTetrahedron);
  const std::string xml =
      test::world("<geom type='mesh' mesh='m'/>", "<asset><mesh file='m.obj'/></asset>");
  CHECK_THROWS_WITH(load_mjcf_string(xml), Contains("MJCF string: mesh, line 1: 'm.obj'") &&
                                               Contains("MJCF string has no folder"));
  MjcfOptions options;
  options.roots = {folder.path()};
  CHECK(load_mjcf_string(xml, options).scene.bodies.size() == 1);
}

TEST_CASE("models that hold themselves are refused", "[mjcf][fast]") {
  const ScratchFolder folder;
  const auto include = [](const std::string& file) {
    return "<mujoco><include file='" + file + "'/></mujoco>";
  };
  CHECK_THROWS_WITH(load_mjcf(write(folder, "self.xml", include("self.xml"))),
                    Contains("included already"));
  CHECK_THROWS_WITH(load_mjcf(write(folder, "self.xml", include("./x/../self.xml"))),
                    Contains("self.xml"));
  write(folder, "b.xml", include("a.xml"));
  CHECK_THROWS_WITH(load_mjcf(write(folder, "a.xml", include("b.xml"))),
                    Contains("b.xml: include, line 1") && Contains("included already"));
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "m.xml", with_assets("<model name='m' file='m.xml'/>"))),
      Contains("contains itself"));
  // Ten times ten times ten models: as many files as there may be.
  std::string more;
  for (int i = 0; i < 11; ++i) more += "<model name='m" + std::to_string(i) + "' file='N.xml'/>";
  for (int level = 0; level < 4; ++level) {
    std::string text = with_assets(more);
    const std::string next = "l" + std::to_string(level + 1);
    for (std::size_t at; (at = text.find("N.xml")) != std::string::npos;) text.replace(at, 1, next);
    write(folder, "l" + std::to_string(level) + ".xml", text);
  }
  write(folder, "l4.xml", test::world(kBall));
  CHECK_THROWS_WITH(load_mjcf(folder / "l0.xml"), Contains("limit 'files'"));
}

TEST_CASE("what is attached counts as often as it is", "[mjcf][fast]") {
  const ScratchFolder folder;
  write(folder, "part.xml",
        test::world("<body name='b'><geom size='1'/><replicate count='50'><geom "
                    "size='1'/></replicate></body>"));
  const auto model = [](const std::string& content) {
    return test::world(content, "<asset><model name='p' file='part.xml'/></asset>");
  };
  const std::string attach = "<attach model='p' body='b' prefix='x'/>";
  const fs::path path = write(folder, "a.xml", model(attach));
  CHECK(load_mjcf(path).scene.bodies.at(0).shapes.size() == 51);
  CHECK_NOTHROW(load_mjcf(path, limited("copies", 60)));
  const std::string again = "<attach model='p' body='b' prefix='y'/>";
  CHECK_THROWS_WITH(load_mjcf(write(folder, "b.xml", model(attach + again)), limited("copies", 60)),
                    Contains("with replicate, attach") && Contains("limit 'copies'"));
  CHECK_THROWS_WITH(load_mjcf(write(folder, "a.xml",
                                    model("<replicate count='1000'>" + attach + "</replicate>"))),
                    Contains("a.xml: attach, line 1") || Contains("a.xml: replicate, line 1"));
}

TEST_CASE("deep nesting ends in an error, not in the stack's", "[mjcf][fast]") {
  std::string deep, ends;
  for (int i = 0; i < 100000; ++i) deep += "<body>", ends += "</body>";
  CHECK_THROWS_WITH(load_mjcf_string(test::world(deep + ends)),
                    Contains("XML parse error, line 1"));
  // Each document within what the XML library takes, together too deep.
  const ScratchFolder folder;
  deep.clear(), ends.clear();
  for (int i = 0; i < 90; ++i) deep += "<body>", ends += "</body>";
  for (int i = 0; i < 4; ++i) {
    const std::string next = i < 3 ? "<include file='d" + std::to_string(i + 1) + ".xml'/>" : "";
    write(folder, "d" + std::to_string(i) + ".xml",
          i == 0 ? test::world(deep + next + ends) : "<mujoco>" + deep + next + ends + "</mujoco>");
  }
  CHECK_THROWS_WITH(load_mjcf(folder / "d0.xml"), Contains("limit 'depth'"));
}

TEST_CASE("entities of a document type are not expanded", "[mjcf][fast]") {
  std::string bomb = "<!DOCTYPE m [<!ENTITY a0 'aaaaaaaaaa'>";
  for (int i = 1; i < 12; ++i) {
    std::string uses;
    for (int k = 0; k < 10; ++k) uses += "&a" + std::to_string(i - 1) + ";";
    bomb += "<!ENTITY a" + std::to_string(i) + " '" + uses + "'>";
  }
  bomb += "<!ENTITY f SYSTEM 'file:///etc/passwd'>]>";
  try {
    const MjcfResult result =
        load_mjcf_string(bomb +
                         "<mujoco model='&f;'><worldbody><body name='&a11;'><freejoint/>"
                         "<geom size='1'/></body></worldbody></mujoco>");
    CHECK(result.scene.bodies.at(0).name.size() < 100);
  } catch (const MjcfError& error) {
    CHECK(std::string(error.what()).find("XML parse error") != std::string::npos);
  }
}

TEST_CASE("what is only seen or only MuJoCo's costs nothing, whatever it asks for",
          "[mjcf][fast]") {
  const std::string xml =
      "<mujoco><size memory='1000G' nuserdata='2000000000' nkey='2000000000'/>"
      "<custom><numeric name='n' size='500000000' data='1'/></custom>"
      "<asset><texture name='t' type='2d' file='../../no/such.png'/>"
      "<texture type='cube' fileright='/dev/zero' name='c'/>"
      "<texture name='g' type='skybox' builtin='gradient' width='60000' height='60000'/>"
      "<material name='m' texture='t'/><material name='n' texture='c'/></asset>"
      "<worldbody><geom name='g' size='1' material='m'/>" +
      kBall +
      "</worldbody>"
      "<deformable><skin name='s' file='/etc/passwd'/></deformable></mujoco>";
  CHECK(load_mjcf_string(xml).scene.bodies.size() == 2);
}

TEST_CASE("what was read is what is compiled, whatever becomes of the files", "[mjcf][fast]") {
  const ScratchFolder folder;
  write(folder, "m.obj", kTetrahedron);
  const fs::path model =
      write(folder, "model.xml",
            test::world("<geom type='mesh' mesh='m'/>", "<asset><mesh file='m.obj'/></asset>"));
  const MjcfFiles files = MjcfFiles::read(model);
  const auto hull = [](const MjcfResult& result) {
    return std::get<Hull>(result.scene.bodies.at(0).shapes.at(0).geometry).vertices;
  };
  const auto before = hull(files.compile());
  write(folder, "m.obj",
        "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  write(folder, "model.xml", "no XML");
  CHECK(hull(files.compile()) == before);
  // Read again, the mesh of the same name is another, whatever MuJoCo remembers.
  write(folder, "model.xml",
        test::world("<geom type='mesh' mesh='m'/>", "<asset><mesh file='m.obj'/></asset>"));
  CHECK(hull(load_mjcf(model)) != before);
}

TEST_CASE("names that come from files, folders and lines are as in MuJoCo", "[mjcf][fast]") {
  const ScratchFolder folder;
  write(folder, "meshes/a/gear.obj", kTetrahedron);
  write(folder, "meshes/b/gear.obj",
        "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  write(folder, "sub/part.obj", kTetrahedron);
  write(folder, "sub/part.xml",
        "<mujoco>\n<!-- a\ncomment -->\n<asset><mesh file='part.obj'/></asset>\n<worldbody>\n"
        "<geom type='mesh' mesh='part'/>\n<body name='leg'><joint\ntype='free' damping='1'/>"
        "<geom size='.1'/></body></worldbody></mujoco>");
  const std::string meshes =
      "<mujoco><compiler meshdir='meshes'/><asset><mesh file='a/gear.obj'/>"
      "<mesh name='big' file='b/gear.obj'/></asset><worldbody><geom type='mesh' mesh='gear'/>"
      "<geom type='mesh' mesh='big'/></worldbody></mujoco>";
  const MjcfResult two = load_mjcf(write(folder, "two.xml", meshes));
  REQUIRE(two.scene.bodies.at(0).shapes.size() == 2);
  const auto extent = [&](std::size_t i) {
    double most = 0;
    for (const Vec3& v : std::get<Hull>(two.scene.bodies[0].shapes[i].geometry).vertices) {
      most = std::max(most, v.norm());
    }
    return most;
  };
  CHECK(extent(1) == Approx(2 * extent(0)));
  // MuJoCo does not keep the lines of what is included.
  CHECK_THROWS_WITH(
      load_mjcf(write(folder, "damped.xml", "<mujoco>\n<include file='sub/part.xml'/></mujoco>")),
      Contains("joint 0 of body 'leg': damping of a free joint"));
  // With strippath the name alone counts.
  CHECK_NOTHROW(load_mjcf(write(folder, "meshes/a/strip.xml",
                                "<mujoco><compiler strippath='true'/><asset>"
                                "<mesh file='C:\\old\\place\\gear.obj'/></asset></mujoco>")));
  // MuJoCo's own messages name the file on disk.
  write(folder, "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK_THROWS_WITH(load_mjcf(write(folder, "flat.xml", with_assets("<mesh file='flat.obj'/>"))),
                    Contains("flat.xml: ") && !Contains("/manyworlds/"));
}

}  // namespace manyworlds
