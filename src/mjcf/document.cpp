#include "src/mjcf/document.hpp"

#include <strings.h>

#include <charconv>
#include <cstddef>

#include "src/mjcf/files.hpp"

namespace manyworlds::mjcf {
namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

// "XML_ERROR_MISMATCHED_ELEMENT" as "mismatched element".
std::string error_text(const tinyxml2::XMLDocument& document) {
  std::string text = document.ErrorName();
  for (const std::string_view prefix : {"XML_ERROR_", "XML_"}) {
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  }
  for (char& c : text) {
    if (c == '_') c = ' ';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

void write_value(const char* text, std::string& out) {
  for (; *text != '\0'; ++text) {
    switch (*text) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\n': out += "&#10;"; break;
      case '\r': out += "&#13;"; break;
      default: out += *text;
    }
  }
}

void write(const XMLElement& element, std::string& out, int& line) {
  for (; line < element.GetLineNum(); ++line) out += '\n';
  out += '<';
  out += element.Name();
  for (const XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    out += std::string(" ") + a->Name() + "=\"";
    write_value(a->Value(), out);
    out += '"';
  }
  const XMLElement* child = element.FirstChildElement();
  if (child == nullptr) {
    out += "/>";
    return;
  }
  out += '>';
  for (; child != nullptr; child = child->NextSiblingElement()) write(*child, out, line);
  out += std::string("</") + element.Name() + ">";
}

}  // namespace

void parse(tinyxml2::XMLDocument& document, const std::string& bytes, const std::string& label) {
  if (bytes.empty()) refuse(label, "is an empty file");
  if (bytes.find('\0') != std::string::npos) {
    refuse(label, "contains a NUL character, at which MuJoCo would stop reading; expected XML");
  }
  document.Parse(bytes.data(), bytes.size());
  if (document.Error()) {
    refuse(label, "XML parse error, line " + std::to_string(document.ErrorLineNum()) + ": " +
                      error_text(document));
  }
  if (document.RootElement() == nullptr) refuse(label, "XML parse error: has no element");
}

std::string written_again(const tinyxml2::XMLDocument& document) {
  std::string out;
  int line = 1;
  write(*document.RootElement(), out, line);
  return out;
}

std::string place_of(const std::string& label, const XMLElement& element) {
  const std::string name = attribute(element, "name");
  return label + ": " + element.Name() + (name.empty() ? "" : " '" + name + "'") + ", line " +
         std::to_string(element.GetLineNum());
}

bool is_called(const XMLElement& element, std::string_view name) {
  return strcasecmp(element.Name(), std::string(name).c_str()) == 0;
}

std::string attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

std::vector<double> numbers(const XMLElement& element, const char* name) {
  const std::string text = attribute(element, name);
  std::vector<double> values;
  const char* at = text.data();
  const char* end = at + text.size();
  while (true) {
    while (at != end && (*at == ' ' || (*at >= '\t' && *at <= '\r'))) ++at;
    if (at != end && *at == '+') ++at;
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error == std::errc::invalid_argument || stop == at) return values;
    // Beyond the range of a double is beyond every limit, too.
    values.push_back(error == std::errc::result_out_of_range ? 1e300 : value);
    at = stop;
  }
}

}  // namespace manyworlds::mjcf
