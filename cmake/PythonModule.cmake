# The extension module manyworlds._core, for the ordinary build tree (Python.cmake) and for wheels
# (python/CMakeLists.txt). Wants the target manyworlds::manyworlds.

find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
if(NOT nanobind_DIR)
  execute_process(COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
                  OUTPUT_VARIABLE nanobind_DIR OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
find_package(nanobind 3.1 CONFIG)
if(NOT nanobind_FOUND)
  message(FATAL_ERROR "The Python package needs nanobind 3.1 or later, which ${Python_EXECUTABLE} "
                      "does not have: tools/test makes an environment with it in build/python "
                      "(Python_EXECUTABLE=build/python/bin/python)")
endif()

cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH mw_root)
set(mw_python_dir "${mw_root}/python")
file(GLOB mw_python_sources CONFIGURE_DEPENDS "${mw_python_dir}/src/*.cpp")
nanobind_add_module(manyworlds_python NB_STATIC NB_SUPPRESS_WARNINGS ${mw_python_sources})
set_target_properties(manyworlds_python PROPERTIES OUTPUT_NAME _core)
target_compile_features(manyworlds_python PRIVATE cxx_std_20)
target_compile_definitions(manyworlds_python PRIVATE MW_VERSION="${PROJECT_VERSION}")
target_link_libraries(manyworlds_python PRIVATE manyworlds::manyworlds)
# Our warnings are for our files.
set_target_properties(nanobind-static PROPERTIES COMPILE_WARNING_AS_ERROR OFF)
target_compile_options(nanobind-static PRIVATE -w)
