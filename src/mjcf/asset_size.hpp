// How large what a mesh or height field file holds would become, by its header, before it is
// decoded.
#pragma once

#include <string>

#include <tinyxml2.h>

#include "src/mjcf/files.hpp"

namespace manyworlds::mjcf {

// Throw MjcfError. `place` is that of the element.
void check_mesh_file(const tinyxml2::XMLElement& mesh, const File& file, const std::string& place,
                     const MjcfLimits& limits);
void check_height_field_file(const tinyxml2::XMLElement& field, const File& file,
                             const std::string& place, const MjcfLimits& limits);
// The vertices of a mesh that MuJoCo makes itself (builtin, params).
void check_builtin_mesh(const tinyxml2::XMLElement& mesh, const std::string& place,
                        const MjcfLimits& limits);

}  // namespace manyworlds::mjcf
