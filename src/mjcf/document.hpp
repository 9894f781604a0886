// XML documents: parsed by tinyxml2, as MuJoCo does itself, and written again for MuJoCo.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

namespace manyworlds::mjcf {

// Throws MjcfError: no XML, a character 0, nested too deeply for the XML library (100 elements).
void parse(tinyxml2::XMLDocument& document, const std::string& bytes, const std::string& label);

// The elements with their attributes, each on the line that it was on, so that what MuJoCo says of
// lines stays true. Comments, text and declarations are gone, and with them all that two parsers
// might read differently.
std::string written_again(const tinyxml2::XMLDocument& document);

// "pile.xml: mesh 'gear', line 3"; an element without a name is "mesh, line 3".
std::string place_of(const std::string& label, const tinyxml2::XMLElement& element);

// MuJoCo finds <include> and <compiler> in any case.
bool is_called(const tinyxml2::XMLElement& element, std::string_view name);

// The attribute, or an empty text.
std::string attribute(const tinyxml2::XMLElement& element, const char* name);
// The numbers of an attribute up to the first that is none, which MuJoCo then complains about.
std::vector<double> numbers(const tinyxml2::XMLElement& element, const char* name);

}  // namespace manyworlds::mjcf
