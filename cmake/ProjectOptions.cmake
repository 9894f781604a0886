# Settings that every target of the project shares.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# Bindings link the static library into shared modules.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
endif()

# Fused multiply-adds are written out where they are wanted. Left to the compiler they differ from
# one instruction set to the next, and so would the bits of a world.
add_compile_options(-ffp-contract=off)

if(MW_WARNINGS)
  # Designated initialisers name what differs from the default; what they leave out is meant.
  add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion
                      -Wno-missing-field-initializers)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # Wrongly warns about "text" + std::string at -O3 (GCC bug 105651).
    add_compile_options(-Wno-restrict)
  endif()
endif()

if(MW_SANITIZE)
  add_compile_options(-fsanitize=${MW_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${MW_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Sanitizers' checks between an assignment and a use make GCC see uninitialised values where
    # there are none (its manual says so, under -fsanitize=); the other builds keep the warning.
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
endif()

include("${CMAKE_CURRENT_LIST_DIR}/Ccache.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/Unity.cmake")

# mw_precompile(TARGET [HEADER...]): reads once what most files of a target include: these headers,
# Eigen and parts of the standard library.
function(mw_precompile target)
  if(MW_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <Eigen/Geometry> <algorithm> <functional> <map>
      <memory> <optional> <string> <utility> <variant> <vector> ${ARGN})
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # Precompiled, GCC's own strings no longer count as a system's, and warn of what is not so.
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-stringop-overflow)
    endif()
  endif()
endfunction()

# mw_library(TARGET SOURCE...): an archive, or with BUILD_SHARED_LIBS a shared library, of the same
# objects.
function(mw_library target)
  add_library(${target} ${ARGN})
  set_target_properties(${target} PROPERTIES DEFINE_SYMBOL ""
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
endfunction()

# mw_define(FILE DEFINITION...): for one file. What the whole target need not know does not compile it
# anew when it changes, so a build that gets more kernels or parts keeps its objects.
function(mw_define file)
  set_property(SOURCE "${PROJECT_SOURCE_DIR}/${file}" APPEND PROPERTY COMPILE_DEFINITIONS ${ARGN})
endfunction()

# mw_sources(VARIABLE PATTERN...): the source files that match, relative to the project.
function(mw_sources variable)
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/")
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${ARGN})
  set(${variable} "${files}" PARENT_SCOPE)
endfunction()
