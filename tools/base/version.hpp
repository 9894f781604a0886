// Versions that `info` and `--version` print.
#pragma once

#ifndef MW_VERSION
#define MW_VERSION "0.2.0"
#endif

namespace manyworlds::tools {

inline constexpr const char* kVersion = MW_VERSION;
#if defined(__clang__)
inline constexpr const char* kCompiler = "clang " __clang_version__;
#elif defined(__GNUC__)
inline constexpr const char* kCompiler = "gcc " __VERSION__;
#else
inline constexpr const char* kCompiler = "unknown";
#endif

}  // namespace manyworlds::tools
