#include "src/mjcf/expansion.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "src/mjcf/document.hpp"

namespace manyworlds::mjcf {
namespace {

using tinyxml2::XMLElement;

double product(const XMLElement& element, const char* name) {
  double result = 1;
  for (const double n : numbers(element, name)) result *= std::max(n, 1.0);
  return result;
}
double at_least_one(const XMLElement& element, const char* name) {
  const auto list = numbers(element, name);
  return list.empty() ? 1 : std::max(list.front(), 1.0);
}

class Scale {
 public:
  Scale(const Expansion& expansion, FileReader& reader) : expansion_(expansion), reader_(reader) {}

  // `times`: how many of the element there will be.
  Weight weigh(const XMLElement& element, const std::string& label, double times) {
    const auto included = expansion_.includes.find(&element);
    if (included != expansion_.includes.end()) {
      return children(*included->second.root, included->second.label, times);
    }
    const std::string_view kind = element.Name();
    Weight weight = own(element);
    if (kind == "replicate") {
      const double count = at_least_one(element, "count");
      const Weight once = children(element, label, times * count);
      weight.add(once, count);
      // Each copy has its number in the name.
      weight.bytes +=
          count * once.elements * static_cast<double>(attribute(element, "sep").size() + 8);
      require_copies(weight.elements * times, element, label);
    } else if (kind == "attach") {
      const auto model = expansion_.models.find(attribute(element, "model"));
      if (model != expansion_.models.end()) {
        weight.add(model->second, 1);
        weight.bytes +=
            model->second.elements * static_cast<double>(attribute(element, "prefix").size());
      }
      require_copies(weight.elements * times, element, label);
    } else {
      weight.add(children(element, label, times), 1);
      if (kind == "flexcomp") {
        const double count = product(element, "count") * product(element, "cellcount");
        weight.elements *= count;
        weight.bodies += count;
        require_copies(weight.elements * times, element, label);
      }
    }
    weight.depth += 1;
    require_depth(weight.depth, element, label);
    return weight;
  }

 private:
  // The element alone.
  static Weight own(const XMLElement& element) {
    const std::string_view kind = element.Name();
    Weight weight;
    weight.elements = 1;
    for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      weight.bytes += static_cast<double>(std::strlen(a->Value()));
    }
    weight.bodies = kind == "body" ? 1 : 0;
    weight.keys = kind == "key" ? 1 : 0;
    weight.rangefinders = kind == "rangefinder" ? 1 : 0;
    weight.tactiles = kind == "tactile" ? 1 : 0;
    weight.sensed = at_least_one(element, "dim") * at_least_one(element, "num") *
                        at_least_one(element, "actdim") * at_least_one(element, "nsample") -
                    1;
    return weight;
  }

  Weight children(const XMLElement& element, const std::string& label, double times) {
    Weight weight;
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      weight.add(weigh(*child, label, times), 1);
    }
    return weight;
  }

  void require_depth(double depth, const XMLElement& element, const std::string& label) const {
    const std::int64_t most = reader_.limits().depth;
    if (depth <= static_cast<double>(most)) return;
    refuse_size(place_of(label, element), "holds " + whole(depth) + " nested elements", most,
                "depth");
  }
  void require_copies(double elements, const XMLElement& element, const std::string& label) const {
    const std::int64_t most = reader_.limits().copies;
    if (elements <= static_cast<double>(most)) return;
    refuse_size(place_of(label, element), "makes " + whole(elements) + " elements", most, "copies");
  }

  const Expansion& expansion_;
  FileReader& reader_;
};

}  // namespace

void Weight::add(const Weight& other, double times) {
  elements += times * other.elements;
  depth = std::max(depth, other.depth);
  bytes += times * other.bytes;
  bodies += times * other.bodies;
  keys += times * other.keys;
  sensed += times * other.sensed;
  rangefinders += times * other.rangefinders;
  tactiles += times * other.tactiles;
}

Weight weigh(const XMLElement& root, const std::string& label, const Expansion& expansion,
             std::int64_t written, FileReader& reader) {
  const Weight weight = Scale(expansion, reader).weigh(root, label, 1);
  const MjcfLimits& limits = reader.limits();
  const double copies = weight.elements - static_cast<double>(written);
  if (copies > static_cast<double>(limits.copies)) {
    refuse_size(label,
                "makes " + whole(copies) + " elements with replicate, attach and similar elements",
                limits.copies, "copies");
  }
  reader.add_bytes(label, weight.bytes);
  // A keyframe has some thirteen numbers of each body.
  const double numbers = weight.sensed + weight.rangefinders * expansion.pixels +
                         3 * weight.tactiles * expansion.vertices +
                         13 * weight.keys * (weight.bodies + 1);
  if (numbers > static_cast<double>(limits.samples)) {
    refuse_size(label, "sensors, actuators and keyframes hold " + whole(numbers) + " values",
                limits.samples, "samples");
  }
  return weight;
}

}  // namespace manyworlds::mjcf
