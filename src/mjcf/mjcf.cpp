#include "manyworlds/mjcf.hpp"

#include <array>
#include <system_error>
#include <utility>

#include "src/mjcf/convert.hpp"
#include "src/mjcf/model.hpp"
#include "src/mjcf/mujoco_library.hpp"
#include "src/mjcf/support.hpp"

namespace manyworlds {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// `parse(error, size)` returns a spec, or null with a message in `error`.
template <typename Parse>
mjcf::Model compile_model(const std::string& label, Parse parse) {
  if (mj_version() != mjVERSION_HEADER) {
    throw MjcfError({label + ": MuJoCo's library is version " + std::to_string(mj_version()) +
                     "; expected " + std::to_string(mjVERSION_HEADER)});
  }
  std::array<char, 2048> error{};
  mjcf::SpecPtr spec(parse(error.data(), static_cast<int>(error.size())));
  if (!spec) throw MjcfError({label + ": " + mjcf::one_line(error.data())});
  spec->compiler.usethread = false;  // a compiler thread could not pass its error to us
  mjcf::ModelPtr compiled(mj_compile(spec.get(), nullptr));
  if (!compiled) throw MjcfError({label + ": " + mjcf::one_line(mjs_getError(spec.get()))});
  return {std::move(spec), std::move(compiled)};
}

template <typename Parse>
MjcfResult load(const std::string& label, const std::string& scene_name, Parse parse) {
  mjcf::LogCapture log;
  try {
    const mjcf::Model model = compile_model(label, parse);
    std::vector<std::string> problems = mjcf::unsupported(model);
    if (!problems.empty()) {
      for (std::string& problem : problems) problem.insert(0, label + ": ");
      throw MjcfError(std::move(problems));
    }
    MjcfResult result{mjcf::make_scene(model, scene_name), log.warnings()};
    for (std::string& warning : mjcf::differences(model)) {
      result.warnings.push_back(std::move(warning));
    }
    return result;
  } catch (const mjcf::MujocoFailure& failure) {
    throw MjcfError({label + ": " + failure.what()});
  }
}

}  // namespace

MjcfError::MjcfError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

MjcfResult load_mjcf(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    const bool exists = std::filesystem::exists(file, ignored);
    throw MjcfError({file.string() + ": " + (exists ? "is not a file" : "no such file")});
  }
  return load(file.string(), file.stem().string(), [&](char* error, int size) {
    return mj_parseXML(file.string().c_str(), nullptr, error, size);
  });
}

MjcfResult load_mjcf_string(std::string_view xml) {
  const std::string text(xml);
  if (text.find('\0') != std::string::npos) {
    throw MjcfError({"MJCF string: holds a character 0, where MuJoCo would stop to read"});
  }
  return load("MJCF string", "mjcf", [&](char* error, int size) {
    return mj_parseXMLString(text.c_str(), nullptr, error, size);
  });
}

}  // namespace manyworlds
