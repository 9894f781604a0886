#include "src/mjcf/asset_size.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "src/mjcf/document.hpp"

namespace manyworlds::mjcf {
namespace {

// Four bytes of the file, or 0 beyond its end.
std::uint32_t word(const File& file, std::size_t at, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t from = at + (big_endian ? i : 3 - i);
    const auto byte = from < file.bytes.size() ? static_cast<unsigned char>(file.bytes[from]) : 0u;
    value = value << 8 | byte;
  }
  return value;
}
std::uint32_t little(const File& file, std::size_t at) { return word(file, at, false); }

// The file's kind by content_type or else by the end of its name, as MuJoCo decides it.
std::string content_kind(const tinyxml2::XMLElement& element, const File& file) {
  std::string kind = attribute(element, "content_type");
  if (kind.empty()) kind = std::filesystem::path(file.label).extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return kind;
}

void require_count(const std::string& place, const File& file, double count, const char* what,
                   std::int64_t most, const char* limit) {
  if (count <= static_cast<double>(most)) return;
  refuse_size(place, "'" + file.label + "' declares " + whole(count) + " " + what, most, limit);
}

void require_length(const std::string& place, const File& file, double expected) {
  const auto found = static_cast<double>(file.bytes.size());
  if (found == expected) return;
  refuse(place, "'" + file.label + "' has " + whole(found) + " bytes; expected " + whole(expected) +
                    " by its header");
}

// Lines that begin with the word.
double lines_of(std::string_view text, char kind) {
  double count = 0;
  for (std::size_t at = 0; at < text.size();) {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\t')) ++at;
    if (at + 1 < text.size() && text[at] == kind && (text[at + 1] == ' ' || text[at + 1] == '\t')) {
      ++count;
    }
    at = text.find_first_of("\r\n", at);
    if (at == std::string_view::npos) break;
    ++at;
  }
  return count;
}

}  // namespace

void check_mesh_file(const tinyxml2::XMLElement& mesh, const File& file, const std::string& place,
                     const MjcfLimits& limits) {
  const std::string kind = content_kind(mesh, file);
  const auto vertices = [&](double count) {
    require_count(place, file, count, "vertices", limits.vertices, "vertices");
  };
  if (kind == ".obj" || kind == "model/obj") {
    vertices(lines_of(file.bytes, 'v'));
    // A closed surface has two triangles for each vertex.
    require_count(place, file, lines_of(file.bytes, 'f') / 3, "thirds of faces", limits.vertices,
                  "vertices");
  } else if (kind == ".stl" || kind == "model/stl") {
    const double faces = little(file, 80);
    vertices(3 * faces);
    require_length(place, file, 84 + 50 * faces);
  } else if (kind == ".msh" || kind == "model/vnd.mujoco.msh") {
    const double points = little(file, 0), normals = little(file, 4), texture = little(file, 8),
                 faces = little(file, 12);
    vertices(std::max({points, normals / 3, texture / 3, faces / 3}));
    require_length(place, file, 16 + 12 * (points + normals + faces) + 8 * texture);
  } else {
    refuse(place, "'" + file.label + "' is of type '" + kind + "'; expected .obj, .stl or .msh");
  }
}

void check_height_field_file(const tinyxml2::XMLElement& field, const File& file,
                             const std::string& place, const MjcfLimits& limits) {
  const std::string kind = content_kind(field, file);
  const bool png = kind == ".png" || kind == "image/png";
  // PNG: signature, then the chunk IHDR with width and height. Otherwise rows, columns, floats.
  const double rows = png ? word(file, 20, true) : little(file, 0);
  const double columns = png ? word(file, 16, true) : little(file, 4);
  require_count(place, file, rows * columns, "samples", limits.samples, "samples");
  if (!png) require_length(place, file, 8 + 4 * rows * columns);
}

void check_builtin_mesh(const tinyxml2::XMLElement& mesh, const std::string& place,
                        const MjcfLimits& limits) {
  const std::string kind = attribute(mesh, "builtin");
  if (kind.empty() || kind == "none") return;
  const std::vector<double> params = numbers(mesh, "params");
  const auto points = [&](std::size_t i) {
    return i < params.size() ? std::max(std::abs(params[i]) + 1, 1.0) : 1.0;
  };
  // Along three edges, along two, or one resolution for both directions of a surface.
  double vertices = points(0) * points(0);
  if (kind == "wedge" || kind == "plate") {
    vertices = points(0) * points(1);
  } else if (kind == "cone") {
    vertices = 2 * points(0);
  } else if (kind != "sphere" && kind != "hemisphere" && !kind.starts_with("super")) {
    vertices = points(0) * points(1) * points(2);
  }
  if (vertices <= static_cast<double>(limits.vertices)) return;
  refuse_size(place, "builtin " + kind + " makes " + whole(vertices) + " vertices", limits.vertices,
              "vertices");
}

}  // namespace manyworlds::mjcf
