// Stops compilers in C++17 mode with one message, where each header would cause hundreds.
#pragma once

#if __cplusplus < 202002L
#error "manyworlds needs C++20: compile with -std=c++20, in CMake CMAKE_CXX_STANDARD 20"
#include <manyworlds_needs_cxx20>  // there is none: a missing header ends the compilation here
#endif
