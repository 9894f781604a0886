// A model is read in three passes: its documents with all that they include; the files of its
// assets; its size when all copies are made. Then it is written again with names of files that only
// the virtual file system knows.
#include "src/mjcf/vet.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <set>
#include <utility>

#include <tinyxml2.h>

#include "src/base/hash.hpp"
#include "src/mjcf/asset_size.hpp"
#include "src/mjcf/document.hpp"
#include "src/mjcf/expansion.hpp"
#include "src/mjcf/files.hpp"

namespace manyworlds::mjcf {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLElement;

// What only a picture or MuJoCo's own simulation would need. Textures stay, one pixel large,
// because materials name them.
constexpr std::array<const char*, 3> kLeftOut = {"skin", "size", "custom"};

struct Document {
  std::string label;
  fs::path folder;   // where its relative names begin
  std::string name;  // in the virtual file system; empty for the outermost
  tinyxml2::XMLDocument xml;
};

// What all models of one load share.
struct Load {
  FileReader reader;
  std::vector<VirtualFile> files;
  std::vector<fs::path> open_models;  // inside one another: an attached model may not hold itself
  std::int64_t elements = 0;
};

// MuJoCo keeps decoded assets by name for the life of the process: names say what is in the file.
std::string virtual_name(const std::string& bytes, const std::string& stem) {
  Hasher hasher;
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    word = word << 8 | static_cast<unsigned char>(bytes[i]);
    if (i % 8 == 7) hasher.add(word);
  }
  hasher.add(word);
  std::array<char, 64> folder{};
  std::snprintf(folder.data(), folder.size(), "/manyworlds/%016llx-%zu/",
                static_cast<unsigned long long>(hasher.value()), bytes.size());
  return folder.data() + stem;
}

// The name of a file as it is written, with the separators of every system.
std::string file_attribute(const XMLElement& element) {
  std::string file = attribute(element, "file");
  std::replace(file.begin(), file.end(), '\\', '/');
  return file;
}

class ModelReader {
 public:
  ModelReader(Load& load, std::size_t depth) : load_(load), depth_(depth) {}

  // Throws MjcfError. Returns the outermost document, ready for MuJoCo; the others are in
  // load.files.
  std::string vet(const std::string& bytes, const std::string& label, const fs::path& folder) {
    Document& document = add(bytes, label, folder);
    XMLElement& root = *document.xml.RootElement();
    if (is_called(root, "robot")) {
      refuse(place_of(label, root),
             "is a URDF file, which is not read yet; expected MJCF, whose root is <mujoco>");
    }
    if (!is_called(root, "mujoco")) {
      refuse(place_of(label, root), "is not a model; expected the root <mujoco>");
    }
    expand(document, root, depth_);
    for (std::size_t i = 0; i < assets_.size(); ++i) prepare(*assets_[i].first, *assets_[i].second);
    weight_ = weigh(root, label, expansion_, load_.elements, load_.reader);
    // Innermost last: a document's text holds the names of those that it includes, not their text.
    for (std::size_t i = 1; i < documents_.size(); ++i) {
      const Document& inner = *documents_[i];
      load_.files.push_back({inner.name, inner.label, written_again(inner.xml)});
    }
    return written_again(document.xml);
  }
  const Weight& weight() const { return weight_; }

 private:
  Document& add(const std::string& bytes, const std::string& label, const fs::path& folder) {
    documents_.push_back(std::make_unique<Document>());
    Document& document = *documents_.back();
    document.label = label, document.folder = folder;
    parse(document.xml, bytes, label);
    return document;
  }

  // First pass: every element, through includes.
  void expand(Document& document, XMLElement& element, std::size_t depth) {
    const MjcfLimits& limits = load_.reader.limits();
    const auto place = [&] { return place_of(document.label, element); };
    if (++load_.elements > limits.elements) {
      refuse_size(place(), "is element " + std::to_string(load_.elements) + " of the model",
                  limits.elements, "elements");
    }
    if (static_cast<std::int64_t>(depth) > limits.depth) {
      refuse_size(place(), "lies " + std::to_string(depth) + " elements deep", limits.depth,
                  "depth");
    }
    if (is_called(element, "include")) return include(document, element, depth);
    if (is_called(element, "compiler")) read_compiler(element);
    const std::string_view kind = element.Name();
    if (kind == "mesh" || kind == "hfield" || kind == "texture" || kind == "model" ||
        kind == "flexcomp" || kind == "camera") {
      assets_.emplace_back(&document, &element);
    } else if (element.Attribute("file") != nullptr) {
      refuse(place(),
             "names a file; expected a file only in include, mesh, hfield, texture and model");
    }
    for (XMLElement *child = element.FirstChildElement(), *next; child != nullptr; child = next) {
      next = child->NextSiblingElement();
      const bool left_out = std::any_of(kLeftOut.begin(), kLeftOut.end(),
                                        [&](const char* name) { return is_called(*child, name); });
      if (left_out) {
        element.DeleteChild(child);
      } else {
        expand(document, *child, depth + 1);
      }
    }
  }

  void include(Document& document, XMLElement& element, std::size_t depth) {
    const std::string place = place_of(document.label, element);
    if (!element.NoChildren()) refuse(place, "has elements inside; expected none");
    const std::string written = file_attribute(element);
    const File file = load_.reader.read_part(
        {documents_[0]->folder / written, document.folder / written}, written, place);
    if (!included_.insert(file.real).second || load_.open_models.back() == file.real) {
      refuse(place, "'" + written + "' is included already; expected each file once");
    }
    Document& inner = add(file.bytes, file.label, fs::path(file.label).parent_path());
    inner.name = virtual_name(file.bytes + std::to_string(documents_.size()), "include.xml");
    XMLElement& root = *inner.xml.RootElement();
    if (is_called(root, "include"))
      refuse(place_of(inner.label, root), "is the root; expected <mujoco>");
    expansion_.includes[&element] = {&root, inner.label};
    expand(inner, root, depth);
    element.SetAttribute("file", inner.name.c_str());
  }

  // MuJoCo, too, lets the last one count, wherever it is.
  void read_compiler(XMLElement& element) {
    const auto take = [&](const char* name, std::string& value) {
      if (element.Attribute(name) == nullptr) return;
      value = attribute(element, name);
      std::replace(value.begin(), value.end(), '\\', '/');
      element.DeleteAttribute(name);
    };
    std::string strip;
    std::string textures;
    take("assetdir", asset_folder_);
    take("meshdir", mesh_folder_);
    take("texturedir", textures);
    take("strippath", strip);
    if (!strip.empty()) strip_path_ = strip == "true";
  }

  // Second pass.
  void prepare(const Document& document, XMLElement& element) {
    const std::string place = place_of(document.label, element);
    const std::string_view kind = element.Name();
    const MjcfLimits& limits = load_.reader.limits();
    const bool names_file = element.Attribute("file") != nullptr;
    if (kind == "texture") return shrink_texture(element);
    if (kind == "camera") {
      double pixels = 1;
      for (const double n : numbers(element, "resolution")) pixels *= std::max(n, 1.0);
      expansion_.pixels = std::max(expansion_.pixels, pixels);
      return;
    }
    if (kind == "flexcomp") {
      if (names_file)
        refuse(place, "reads a file, and flexes are not simulated yet; expected none");
      return;
    }
    if (kind == "model") {
      if (names_file) attach(document, element, place);
      return;
    }
    if (kind == "mesh") {
      check_builtin_mesh(element, place, limits);
      const double written = static_cast<double>(numbers(element, "vertex").size()) / 3;
      if (written > static_cast<double>(limits.vertices)) {
        refuse_size(place,
                    "has " + std::to_string(static_cast<std::int64_t>(written)) + " vertices",
                    limits.vertices, "vertices");
      }
      expansion_.vertices = static_cast<double>(limits.vertices);
    } else {
      double samples = 1;
      for (const char* edge : {"nrow", "ncol"}) {
        for (const double n : numbers(element, edge)) samples *= std::max(n, 1.0);
      }
      if (samples > static_cast<double>(limits.samples)) {
        refuse_size(
            place,
            "has " + attribute(element, "nrow") + " x " + attribute(element, "ncol") + " samples",
            limits.samples, "samples");
      }
    }
    if (!names_file) return;
    const File file = read_asset(document, element, kind == "mesh" ? mesh_folder_ : "", place);
    if (kind == "mesh") {
      check_mesh_file(element, file, place, limits);
    } else {
      check_height_field_file(element, file, place, limits);
    }
    const std::string name =
        virtual_name(file.bytes, fs::path(file_attribute(element)).filename().string());
    element.SetAttribute("file", name.c_str());
    keep(name, file.label, file.bytes);
  }

  // Beside the outermost document first, as MuJoCo looks, or beside the one that includes it.
  File read_asset(const Document& document, const XMLElement& element, const std::string& folder,
                  const std::string& place) {
    std::string written = file_attribute(element);
    if (strip_path_) written = fs::path(written).filename().string();
    const fs::path below = fs::path(folder.empty() ? asset_folder_ : folder) / written;
    const fs::path& outermost = documents_[0]->folder;
    return load_.reader.read_part(
        {outermost / below, document.folder / below, document.folder / written}, written, place);
  }

  void attach(const Document& document, XMLElement& element, const std::string& place) {
    const File file = read_asset(document, element, "", place);
    const auto& open = load_.open_models;
    if (std::find(open.begin(), open.end(), file.real) != open.end()) {
      refuse(place, "'" + file.label + "' contains itself; expected another model");
    }
    load_.open_models.push_back(file.real);
    ModelReader inner(load_, depth_ + 1);
    const std::string xml = inner.vet(file.bytes, file.label, fs::path(file.label).parent_path());
    load_.open_models.pop_back();
    const std::string model_name = attribute(*inner.documents_[0]->xml.RootElement(), "model");
    const std::string name = attribute(element, "name");
    expansion_.models[name.empty() ? model_name : name] = inner.weight();
    const std::string virtual_file = virtual_name(xml, "model.xml");
    element.DeleteAttribute("content_type");
    element.SetAttribute("file", virtual_file.c_str());
    keep(virtual_file, file.label, xml);
  }

  // Nothing is drawn: no file of a texture is opened. Its name is needed, which may be the file's.
  static void shrink_texture(XMLElement& element) {
    std::string name = attribute(element, "name");
    if (name.empty()) name = fs::path(file_attribute(element)).stem().string();
    const std::string type = attribute(element, "type");
    while (element.FirstAttribute() != nullptr) {
      element.DeleteAttribute(element.FirstAttribute()->Name());
    }
    if (!name.empty()) element.SetAttribute("name", name.c_str());
    if (!type.empty()) element.SetAttribute("type", type.c_str());
    element.SetAttribute("builtin", "flat");
    element.SetAttribute("width", 1);
    element.SetAttribute("height", type == "2d" ? 1 : 6);
  }

  void keep(const std::string& name, const std::string& label, const std::string& bytes) {
    const bool known = std::any_of(load_.files.begin(), load_.files.end(),
                                   [&](const VirtualFile& file) { return file.name == name; });
    if (!known) load_.files.push_back({name, label, bytes});
  }

  Load& load_;
  std::size_t depth_;
  std::vector<std::unique_ptr<Document>> documents_;  // the outermost first
  std::vector<std::pair<const Document*, XMLElement*>> assets_;
  std::set<fs::path> included_;
  Expansion expansion_;
  std::string asset_folder_, mesh_folder_;
  bool strip_path_ = false;
  Weight weight_;
};

}  // namespace

Vetted vet_file(const fs::path& path, const MjcfOptions& options) {
  Load load{FileReader(options), {}, {}, 0};
  const File file = load.reader.read_model(path);
  load.open_models.push_back(file.real);
  std::string xml = ModelReader(load, 1).vet(file.bytes, file.label, path.parent_path());
  return {std::move(xml), std::move(load.files)};
}

Vetted vet_string(std::string_view xml, const std::string& label, const MjcfOptions& options) {
  Load load{FileReader(options), {}, {}, 0};
  const std::string text(xml);
  if (text.size() >
      static_cast<std::size_t>(std::max<std::int64_t>(options.limits.file_bytes, 0))) {
    refuse_size(label, "has " + std::to_string(text.size()) + " bytes", options.limits.file_bytes,
                "file_bytes");
  }
  load.reader.add_bytes(label, static_cast<double>(text.size()));
  load.open_models.emplace_back();
  std::string vetted = ModelReader(load, 1).vet(text, label, load.reader.first_root());
  return {std::move(vetted), std::move(load.files)};
}

}  // namespace manyworlds::mjcf
