#include "manyworlds/mjcf.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "src/base/float_mode.hpp"
#include "src/mjcf/convert.hpp"
#include "src/mjcf/files_access.hpp"
#include "src/mjcf/model.hpp"
#include "src/mjcf/mujoco_library.hpp"
#include "src/mjcf/support.hpp"
#include "src/mjcf/vet.hpp"

namespace manyworlds {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// The only files that MuJoCo sees.
class VirtualFiles {
 public:
  explicit VirtualFiles(const std::vector<mjcf::VirtualFile>& files) {
    mj_defaultVFS(&files_);
    for (const mjcf::VirtualFile& file : files) {
      mj_addBufferVFS(&files_, file.name.c_str(), file.bytes.data(),
                      static_cast<int>(file.bytes.size()));
    }
  }
  ~VirtualFiles() { mj_deleteVFS(&files_); }
  VirtualFiles(const VirtualFiles&) = delete;
  VirtualFiles& operator=(const VirtualFiles&) = delete;
  const mjVFS* get() const { return &files_; }

 private:
  mjVFS files_{};
};

// A message of MuJoCo's, with files named as they are on disk.
std::string with_real_names(std::string text, const std::vector<mjcf::VirtualFile>& files) {
  for (const mjcf::VirtualFile& file : files) {
    for (std::size_t at = text.find(file.name); at != std::string::npos;
         at = text.find(file.name, at + file.label.size())) {
      text.replace(at, file.name.size(), file.label);
    }
  }
  return text;
}

// Versions whose structs have one layout and with which the tests pass
// (tools/scripts/check_mujoco_versions). Any of them may be loaded where headers of another were
// used.
constexpr std::array kTestedVersions = {4000000, 4000001};

bool is_tested(int version) {
  return std::find(kTestedVersions.begin(), kTestedVersions.end(), version) !=
         kTestedVersions.end();
}

void check_version() {
  const int found = mj_version();
  if (found == mjVERSION_HEADER || (is_tested(found) && is_tested(mjVERSION_HEADER))) return;
  throw mjcf::MujocoFailure("MuJoCo's library is version " + std::to_string(found) + "; expected " +
                            std::to_string(mjVERSION_HEADER));
}

mjcf::Model compile_model(const std::string& xml, const mjVFS* files) {
  check_version();
  std::array<char, 2048> error{};
  mjcf::SpecPtr spec(
      mj_parseXMLString(xml.c_str(), files, error.data(), static_cast<int>(error.size())));
  if (!spec) throw mjcf::MujocoFailure(mjcf::one_line(error.data()));
  spec->compiler.usethread = false;  // a compiler thread could not pass its error to us
  mjcf::ModelPtr compiled(mj_compile(spec.get(), files));
  if (!compiled) throw mjcf::MujocoFailure(mjcf::one_line(mjs_getError(spec.get())));
  return {std::move(spec), std::move(compiled)};
}

}  // namespace

MjcfError::MjcfError(std::vector<std::string> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

struct MjcfFiles::Impl {
  std::string label;  // of messages
  std::string scene_name;
  mjcf::Vetted vetted;
};

MjcfFiles MjcfFiles::read(const std::filesystem::path& file, const MjcfOptions& options) {
  return MjcfFiles(std::make_shared<const Impl>(
      Impl{file.string(), file.stem().string(), mjcf::vet_file(file, options)}));
}

MjcfFiles MjcfFiles::of_string(std::string_view xml, const MjcfOptions& options) {
  const std::string label = "MJCF string";
  return MjcfFiles(
      std::make_shared<const Impl>(Impl{label, "mjcf", mjcf::vet_string(xml, label, options)}));
}

MjcfResult MjcfFiles::compile() const {
  const std::string& label = impl_->label;
  const VirtualFiles files(impl_->vetted.files);
  mjcf::LogCapture log;
  try {
    const mjcf::Model model = compile_model(impl_->vetted.xml, files.get());
    std::vector<std::string> problems = mjcf::unsupported(model);
    if (!problems.empty()) {
      for (std::string& problem : problems) problem.insert(0, label + ": ");
      throw MjcfError(std::move(problems));
    }
    MjcfResult result{mjcf::make_scene(model, impl_->scene_name), log.warnings()};
    for (std::string& warning : mjcf::differences(model)) {
      result.warnings.push_back(std::move(warning));
    }
    return result;
  } catch (const mjcf::MujocoFailure& failure) {
    throw MjcfError({label + ": " + with_real_names(failure.what(), impl_->vetted.files)});
  } catch (const MjcfError&) {
    throw;
  } catch (...) {
    // MuJoCo has a C++ library of its own, whose exceptions are none of ours.
    throw MjcfError({label + ": needs more memory than is available, or MuJoCo failed otherwise"});
  }
}

mjcf::ModelPtr mjcf::FilesAccess::mujoco_model(const MjcfFiles& from) {
  const VirtualFiles files(from.impl_->vetted.files);
  const LogCapture log;
  try {
    return std::move(compile_model(from.impl_->vetted.xml, files.get()).compiled);
  } catch (const MujocoFailure& failure) {
    throw MjcfError(
        {from.impl_->label + ": " + with_real_names(failure.what(), from.impl_->vetted.files)});
  }
}

MjcfResult load_mjcf(const std::filesystem::path& file, const MjcfOptions& options) {
  const FloatMode mode;
  return MjcfFiles::read(file, options).compile();
}

MjcfResult load_mjcf_string(std::string_view xml, const MjcfOptions& options) {
  const FloatMode mode;
  return MjcfFiles::of_string(xml, options).compile();
}

}  // namespace manyworlds
