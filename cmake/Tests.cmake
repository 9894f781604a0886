# The tests: Catch2 cases one by one, the fast ones again per forced instruction set, and the checks
# of the tree itself (floors, kernel symbols, headers, format, embedding).

find_package(Catch2 2.13 REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
include(Catch)

# What all test programs share: options, and what tests may include.
function(mw_test_target target)
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}")
  # Catch2 is slow to compile, and most of all its main function.
  target_compile_options(${target} PRIVATE -O1 $<$<CONFIG:RelWithDebInfo>:-g1>)
  # UBSan is for the library; it doubles the time to compile a test.
  if(MW_SANITIZE MATCHES undefined)
    target_compile_options(${target} PRIVATE -fno-sanitize=undefined)
  endif()
  target_link_libraries(${target} PRIVATE
    manyworlds Catch2::Catch2 fmt::fmt nlohmann_json::nlohmann_json Threads::Threads)
  # Scenes and batches are what nearly every test includes.
  mw_precompile(${target} <catch2/catch.hpp> <manyworlds/batch.hpp> <scenes/builders.hpp>)
  if(TARGET manyworlds_cli)
    target_compile_definitions(${target} PRIVATE MW_HAVE_CLI=1)
  endif()
endfunction()

# main() and tests/support/, compiled once.
file(GLOB mw_test_support CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/support/*.cpp")
add_library(manyworlds_test_support OBJECT "${PROJECT_SOURCE_DIR}/tests/main.cpp"
  ${mw_test_support})
mw_test_target(manyworlds_test_support)
set_source_files_properties("${PROJECT_SOURCE_DIR}/tests/main.cpp" PROPERTIES
  COMPILE_OPTIONS -O0 SKIP_PRECOMPILE_HEADERS ON)
# It asks Catch2 for more than what is precompiled.
set_source_files_properties("${PROJECT_SOURCE_DIR}/tests/support/one_thread.cpp" PROPERTIES
  SKIP_PRECOMPILE_HEADERS ON)
mw_unity(manyworlds_test_support ALONE tests/main.cpp tests/support/one_thread.cpp)
set(mw_test_paths MW_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
if(TARGET manyworlds_cli)
  list(APPEND mw_test_paths MW_CLI_PATH="$<TARGET_FILE:manyworlds_cli>")
  # Preloaded into the program.
  add_library(manyworlds_failing_threads MODULE
    "${PROJECT_SOURCE_DIR}/tests/preload/failing_threads.cpp")
  target_link_libraries(manyworlds_failing_threads PRIVATE ${CMAKE_DL_LIBS})
  list(APPEND mw_test_paths MW_FAILING_THREADS="$<TARGET_FILE:manyworlds_failing_threads>")
endif()
set_source_files_properties("${PROJECT_SOURCE_DIR}/tests/support/paths.cpp" PROPERTIES
  COMPILE_DEFINITIONS "${mw_test_paths}")

# mw_test_program(TARGET SOURCE...): one executable whose Catch2 cases are ctest entries. Those of
# recordings go first: under sanitizers some take minutes, and at the end would take them alone.
function(mw_test_program target)
  add_executable(${target} ${ARGN} $<TARGET_OBJECTS:manyworlds_test_support>)
  mw_test_target(${target})
  # Half of -O1's time to compile. What tests work out at length is in tests/support, which keeps it.
  if(MW_SANITIZE MATCHES address)
    target_compile_options(${target} PRIVATE -O0)
  endif()
  if(TARGET manyworlds_cli)
    add_dependencies(${target} manyworlds_cli manyworlds_failing_threads)
  endif()
  mw_unity(${target})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # GCC 12 wrongly takes an optional that is moved for uninitialised: precompiled, <optional> is no
    # system header.
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
  endif()
  set(cost 0)
  if(target MATCHES "_record_")
    set(cost 100)
  endif()
  catch_discover_tests(${target} TEST_SPEC ${MW_TEST_FILTER} PROPERTIES TIMEOUT 900 COST ${cost})
endfunction()

mw_sources(mw_test_sources "tests/*.cpp")
list(REMOVE_ITEM mw_test_sources "${PROJECT_SOURCE_DIR}/tests/main.cpp" ${mw_test_support})
set(mw_mjcf_test_sources ${mw_test_sources})
list(FILTER mw_mjcf_test_sources INCLUDE REGEX "/tests/mjcf/")
set(mw_record_test_sources ${mw_test_sources})
list(FILTER mw_record_test_sources INCLUDE REGEX "/tests/record/")
set(mw_live_test_sources ${mw_test_sources})
list(FILTER mw_live_test_sources INCLUDE REGEX "/tests/live/")
list(FILTER mw_test_sources EXCLUDE REGEX "/tests/(live|mjcf|preload|record)/")
if(MW_TEST_SOURCES)
  list(FILTER mw_test_sources INCLUDE REGEX "/(${MW_TEST_SOURCES})_test")
endif()
include("${CMAKE_CURRENT_LIST_DIR}/Invariants.cmake")
# It has an operator new of its own, which GCC would inline into others.
set_source_files_properties("${PROJECT_SOURCE_DIR}/tests/record/faults.cpp" PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON)
mw_test_program(manyworlds_tests ${mw_test_sources})
target_link_libraries(manyworlds_tests PRIVATE manyworlds_invariants)
if(MW_MJCF AND mw_mjcf_test_sources)
  mw_test_program(manyworlds_mjcf_tests ${mw_mjcf_test_sources})
  target_link_libraries(manyworlds_mjcf_tests PRIVATE manyworlds_compare MuJoCo::MuJoCo)
endif()
if(MW_RECORD)
  mw_test_program(manyworlds_record_tests ${mw_record_test_sources}
    "${PROJECT_SOURCE_DIR}/tools/report/report_files.cpp")
  target_link_libraries(manyworlds_record_tests PRIVATE manyworlds_record HDF5::HDF5 ZLIB::ZLIB)
endif()

if(MW_LIVE)
  mw_test_program(manyworlds_live_tests ${mw_live_test_sources})
  target_link_libraries(manyworlds_live_tests PRIVATE manyworlds_live)
endif()

# The fast tests with each narrower instruction set forced. They repeat others: AVX2 kernels run these
# tests under AddressSanitizer, scalar ones under ThreadSanitizer, and all have the same bits ([bits]).
if(NOT MW_SANITIZE)
  foreach(isa IN LISTS MW_ISAS)
    add_test(NAME fast_tests_forced_${isa}
      COMMAND ${CMAKE_COMMAND} -D ISA=${isa} -D "ISAS=${MW_ISAS}" -D PROGRAM=$<TARGET_FILE:manyworlds_tests>
              -P "${PROJECT_SOURCE_DIR}/cmake/RunOnIsa.cmake")
    set_tests_properties(fast_tests_forced_${isa} PROPERTIES
      SKIP_REGULAR_EXPRESSION "^skipped: " TIMEOUT 1800 COST 1000 LABELS exhaustive)
  endforeach()
endif()

# What is below holds or not whatever threads do; the builds beside TSan's have checked it.
if(MW_SANITIZE MATCHES thread)
  return()
endif()

# The C++ of README and docs compiles without a warning, by this build's compiler and by clang.
get_target_property(mw_eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
set(mw_docs_compilers "${CMAKE_CXX_COMPILER}")
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  list(APPEND mw_docs_compilers clang++-14)
endif()
foreach(compiler IN LISTS mw_docs_compilers)
  cmake_path(GET compiler FILENAME name)
  add_test(NAME docs_code_${name}
    COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tools/scripts/check_docs_code.py"
            --compiler "${compiler}" --include "${mw_eigen_include}" "${PROJECT_SOURCE_DIR}")
  set_tests_properties(docs_code_${name} PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped: ")
endforeach()

# The checks below do not depend on a sanitizer; there they would only repeat themselves.
if(MW_SANITIZE)
  return()
endif()

add_test(NAME check_floors
  COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tools/scripts/check_floors.py"
          "${PROJECT_SOURCE_DIR}")

add_test(NAME check_unity_names
  COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tools/scripts/check_unity_names.py"
          "${PROJECT_SOURCE_DIR}")

# tools/run and tools/test build what they need, .ci/run sums up its stages, README and docs/cli.md
# describe the program that is there, and the site and the tables of docs are written as they should be.
foreach(name IN ITEMS run ci docs site tables)
  add_test(NAME tools_${name}
    COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tests/tools/${name}_test.py")
endforeach()

# Completion in shells, JSON as docs/cli-json.md says, help and terminals.
if(TARGET manyworlds_cli)
  foreach(name IN ITEMS completion cli_json cli_terminal)
    add_test(NAME ${name}
      COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tests/tools/${name}_test.py"
              $<TARGET_FILE:manyworlds_cli>)
    set_tests_properties(${name} PROPERTIES TIMEOUT 300)
  endforeach()
endif()

foreach(name IN LISTS MW_KERNEL_SETS)
  add_test(NAME check_kernel_symbols_${name}
    COMMAND Python3::Interpreter "${PROJECT_SOURCE_DIR}/tools/scripts/check_kernel_symbols.py"
            --nm ${CMAKE_NM} ${name}
            $<FILTER:$<TARGET_OBJECTS:mw_kernels_${name}>,EXCLUDE,[.]gch$>
    COMMAND_EXPAND_LISTS)
endforeach()

# Each public header compiles alone, under our warnings.
file(GLOB mw_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/manyworlds/*.hpp")
foreach(header IN LISTS mw_headers)
  cmake_path(GET header STEM stem)
  add_test(NAME header_alone_${stem}
    COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow
            -Wconversion -Werror
            -I "${PROJECT_SOURCE_DIR}/include" -isystem ${mw_eigen_include}
            -include ${header} -x c++ /dev/null)
endforeach()

# As C++17 each stops with one message.
add_test(NAME headers_cxx17
  COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${PROJECT_SOURCE_DIR} -D EIGEN=${mw_eigen_include}
          -D COMPILER=${CMAKE_CXX_COMPILER} -P "${PROJECT_SOURCE_DIR}/cmake/TestCxx17.cmake")

# Every version of clang-format decides differently; Debian 12's is the one that counts.
find_program(MW_CLANG_FORMAT NAMES clang-format-14 clang-format)
mark_as_advanced(MW_CLANG_FORMAT)
if(MW_CLANG_FORMAT)
  execute_process(COMMAND "${MW_CLANG_FORMAT}" --version OUTPUT_VARIABLE version ERROR_QUIET)
  if(version MATCHES "version 14\\.")
    add_test(NAME clang_format COMMAND "${PROJECT_SOURCE_DIR}/tools/scripts/lint" --format-only)
    set_tests_properties(clang_format PROPERTIES
      ENVIRONMENT "CLANG_FORMAT=${MW_CLANG_FORMAT}")
  endif()
endif()

# Users' projects, against the installed package, which all of them share.
if(MW_INSTALL)
  include(cmake/InstallTests.cmake)
endif()
