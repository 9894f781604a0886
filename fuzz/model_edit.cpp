#include "fuzz/model_edit.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

#include "fuzz/check.hpp"

namespace manyworlds::fuzz {
namespace {

const char* const kSmall[] = {
    "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body pos='0 0 1'><joint axis='0 1 0'/>"
    "<geom size='.1'/><body pos='.3 0 0'><joint type='ball'/><geom type='box' size='.1 .1 .1'/>"
    "</body></body></worldbody></mujoco>",
    "<mujoco><option integrator='RK4'/><worldbody><body><freejoint/><geom size='.1'/></body>"
    "<body pos='0 0 .3'><joint type='slide' axis='0 0 1' range='-.1 .1' limited='true'/>"
    "<geom type='capsule' size='.05 .1'/></body></worldbody></mujoco>",
    "<mujoco><worldbody><body name='a'><joint name='x' type='slide' stiffness='9'/>"
    "<joint name='y' damping='1' axis='0 1 0'/><geom size='.1'/><site name='s'/></body></worldbody>"
    "<tendon><fixed name='t' limited='true' range='-1 1'><joint joint='x' coef='2'/>"
    "<joint joint='y' coef='-1'/></fixed></tendon><actuator><general joint='x' gainprm='2'/>"
    "<velocity joint='y' kv='3' ctrlrange='-1 1'/></actuator></mujoco>",
    "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><body>"
    "<joint/><geom type='mesh' mesh='m'/></body></worldbody><contact><exclude body1='world' "
    "body2='world'/></contact><equality/><sensor/><keyframe><key/></keyframe></mujoco>",
};

// What may stand for what, and with what: MuJoCo's schema refuses the rest before anything is
// looked at, so that most changes keep to it.
struct Kind {
  std::vector<const char*> tags, attributes;
};
const std::vector<Kind> kKinds = {
    {{"joint", "freejoint"},
     {"type",
      "pos",
      "axis",
      "range",
      "limited",
      "ref",
      "springref",
      "stiffness",
      "damping",
      "armature",
      "frictionloss",
      "margin",
      "solreflimit",
      "solimplimit",
      "solreffriction",
      "actuatorfrcrange",
      "actuatorfrclimited",
      "springdamper",
      "coef",
      "joint",
      "name"}},
    {{"geom", "site"}, {"type",   "pos",        "quat",         "euler",   "size",    "fromto",
                        "condim", "friction",   "priority",     "solmix",  "solref",  "solimp",
                        "margin", "gap",        "mass",         "density", "contype", "conaffinity",
                        "name",   "fluidshape", "shellinertia", "mesh"}},
    {{"body", "frame", "replicate"},
     {"pos", "quat", "euler", "axisangle", "gravcomp", "mocap", "childclass", "name", "count",
      "offset"}},
    {{"motor", "position", "velocity", "general", "damper", "intvelocity", "adhesion", "muscle"},
     {"joint",     "jointinparent", "tendon",     "site",         "body",     "gear",
      "ctrlrange", "ctrllimited",   "forcerange", "forcelimited", "kp",       "kv",
      "dampratio", "gainprm",       "biasprm",    "gaintype",     "biastype", "dyntype",
      "dynprm",    "actlimited",    "actrange",   "timeconst",    "name"}},
    {{"fixed", "spatial"}, {"range", "limited", "stiffness", "damping", "frictionloss", "margin"}},
    {{"connect", "weld", "joint"},
     {"body1", "body2", "joint1", "joint2", "anchor", "active", "solref", "solimp"}},
    {{"exclude", "pair"}, {"body1", "body2", "geom1", "geom2", "condim", "friction", "margin"}},
    {{"option"},
     {"timestep", "integrator", "cone", "solver", "iterations", "ls_iterations", "tolerance",
      "ls_tolerance", "impratio", "gravity", "wind", "viscosity", "density", "o_margin",
      "magnetic"}},
    {{"flag"},
     {"constraint", "equality", "limit", "contact", "spring", "damper", "gravity", "clampctrl",
      "warmstart", "filterparent", "actuation", "refsafe", "eulerdamp", "override", "energy"}},
    {{"compiler"},
     {"angle", "autolimits", "coordinate", "eulerseq", "inertiafromgeom", "boundmass",
      "boundinertia", "settotalmass", "balanceinertia", "fusestatic", "discardvisual"}},
    {{"inertial"}, {"pos", "quat", "mass", "diaginertia", "fullinertia"}},
    {{"mesh", "hfield"}, {"vertex", "scale", "refpos", "inertia", "builtin", "params"}},
};
const std::vector<const char*> kWords = {
    "free",     "ball",         "hinge",     "slide",    "plane",     "sphere", "capsule",
    "box",      "mesh",         "hfield",    "cylinder", "ellipsoid", "Euler",  "RK4",
    "implicit", "implicitfast", "pyramidal", "elliptic", "true",      "false",  "auto",
    "affine",   "fixed",        "none",      "muscle",   "user",      "radian", "degree",
    "disable",  "enable",       "",          "world"};
template <class T>
const T& any_of(const std::vector<T>& list, FuzzedDataProvider& in) {
  return list[in.ConsumeIntegralInRange<std::size_t>(0, list.size() - 1)];
}

std::string number(FuzzedDataProvider& in) {
  static const std::vector<const char*> kNumbers = {
      "0",   "1",    "-1",    "2",     "3",   "0.5", "-0.5", "1e-3",       "1e-9", "1e-300",
      "1e3", "1e10", "1e300", "-1e10", "nan", "inf", "-inf", "2147483648", "64",   "100"};
  if (in.ConsumeBool()) return any_of(kNumbers, in);
  return std::to_string(in.ConsumeFloatingPointInRange<double>(-4, 4));
}

// Mostly the one that the element is of.
const Kind& kind_for(const char* tag, FuzzedDataProvider& in) {
  const bool other = in.ConsumeIntegralInRange(0, 9) == 9;
  for (const Kind& kind : kKinds) {
    const auto is_tag = [&](const char* one) { return std::strcmp(one, tag) == 0; };
    if (!other && std::any_of(kind.tags.begin(), kind.tags.end(), is_tag)) return kind;
  }
  return any_of(kKinds, in);
}

std::vector<std::string> words_of(const char* text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

const std::vector<std::string>& models() {
  static const std::vector<std::string> kAll = [] {
    std::vector<std::string> all(std::begin(kSmall), std::end(kSmall));
    std::vector<std::filesystem::path> files;
    for (const auto& file : std::filesystem::directory_iterator(MW_MODELS)) {
      if (file.path().extension() == ".xml") files.push_back(file.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files) {
      std::stringstream text;
      text << std::ifstream(file).rdbuf();
      all.push_back(text.str());
    }
    return all;
  }();
  return kAll;
}

ModelEdit::ModelEdit(const std::string& xml) {
  require(document_.Parse(xml.c_str()) == tinyxml2::XML_SUCCESS, "a model to begin with is no XML");
}

std::string ModelEdit::xml() const {
  tinyxml2::XMLPrinter printer;
  document_.Print(&printer);
  return printer.CStr();
}

ModelEdit::Element* ModelEdit::any_element(FuzzedDataProvider& in) { return any_of(elements_, in); }

void ModelEdit::edit(FuzzedDataProvider& in) {
  elements_.clear();
  const std::function<void(Element*)> collect = [&](Element* element) {
    elements_.push_back(element);
    for (Element* e = element->FirstChildElement(); e; e = e->NextSiblingElement()) collect(e);
  };
  collect(document_.RootElement());
  Element& element = *any_element(in);
  const bool is_root = &element == document_.RootElement();
  switch (in.ConsumeIntegralInRange(0, 9)) {
    case 0:
    case 1:
    case 2: return change_number(element, in);
    case 3:
    case 4: return set_attribute(element, in);
    case 5: return remove_attribute(element, in);
    case 6: return take_attribute(element, *any_element(in), in);
    case 7:
      if (!is_root) element.SetName(any_of(kind_for(element.Name(), in).tags, in));
      return;
    case 8:
      if (!is_root) move(element, *any_element(in), in.ConsumeBool());
      return;
    default:
      if (is_root) return;
      if (in.ConsumeBool()) return move(element, *element.Parent()->ToElement(), true);
      document_.DeleteNode(&element);
  }
}

// Of one of the numbers of an attribute.
void ModelEdit::change_number(Element& element, FuzzedDataProvider& in) {
  std::vector<const tinyxml2::XMLAttribute*> attributes;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) attributes.push_back(a);
  if (attributes.empty()) return;
  const auto* attribute = any_of(attributes, in);
  std::vector<std::string> words = words_of(attribute->Value());
  if (words.empty()) return;
  words[in.ConsumeIntegralInRange<std::size_t>(0, words.size() - 1)] = number(in);
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  element.SetAttribute(attribute->Name(), text.c_str());
}

void ModelEdit::set_attribute(Element& element, FuzzedDataProvider& in) {
  const char* name = any_of(kind_for(element.Name(), in).attributes, in);
  std::string text;
  if (in.ConsumeBool()) {
    text = any_of(kWords, in);
  } else {
    text = number(in);
    for (int more = in.ConsumeIntegralInRange(-6, 6); more > 0; --more) text += ' ' + number(in);
  }
  element.SetAttribute(name, text.c_str());
}

void ModelEdit::remove_attribute(Element& element, FuzzedDataProvider& in) {
  std::vector<std::string> names;
  for (const auto* a = element.FirstAttribute(); a; a = a->Next()) names.emplace_back(a->Name());
  if (!names.empty()) element.DeleteAttribute(any_of(names, in).c_str());
}

void ModelEdit::take_attribute(Element& element, const Element& from, FuzzedDataProvider& in) {
  std::vector<const tinyxml2::XMLAttribute*> attributes;
  for (const auto* a = from.FirstAttribute(); a; a = a->Next()) attributes.push_back(a);
  if (attributes.empty()) return;
  const auto* attribute = any_of(attributes, in);
  const std::string text = attribute->Value();  // which may be the element's own
  element.SetAttribute(attribute->Name(), text.c_str());
}

// With all that is in it, to be the last child of another that is not inside of it.
void ModelEdit::move(Element& element, Element& to, bool keep) {
  for (const tinyxml2::XMLNode* at = &to; at; at = at->Parent()) {
    if (at == &element) return;
  }
  to.InsertEndChild(element.DeepClone(&document_));
  if (!keep) document_.DeleteNode(&element);
}

}  // namespace manyworlds::fuzz
