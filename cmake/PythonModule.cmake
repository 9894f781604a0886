# The extension modules of the package manyworlds, for the ordinary build tree (Python.cmake) and for
# wheels (python/CMakeLists.txt): _core, and where their libraries are built, _live, _record and _mjcf, which
# alone need HDF5 with zlib and MuJoCo. Wants the target manyworlds::manyworlds.

# Within scikit-build-core, wheels of the stable ABI (wheel.py-api in pyproject.toml).
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
set(mw_stable_abi)
set(mw_nanobind nanobind-static)
if(SKBUILD_SABI_COMPONENT)
  set(mw_stable_abi STABLE_ABI)
  set(mw_nanobind nanobind-static-abi3)
endif()
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

include("${mw_root}/cmake/SharedLibrary.cmake")
include("${mw_root}/cmake/Unity.cmake")
set(mw_python_targets)
get_target_property(mw_shared_type manyworlds_shared TYPE)
get_target_property(mw_shared_imported manyworlds_shared IMPORTED)
if(mw_shared_type STREQUAL SHARED_LIBRARY AND NOT mw_shared_imported)
  set(mw_python_targets manyworlds_shared)
endif()

# mw_python_module(NAME SOURCE...): the module manyworlds.NAME.
function(mw_python_module name)
  set(target manyworlds_python${name})
  nanobind_add_module(${target} ${mw_stable_abi} NB_STATIC NB_SUPPRESS_WARNINGS ${ARGN})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} INSTALL_RPATH "$ORIGIN")
  if(mw_library_type STREQUAL SHARED_LIBRARY)
    set_target_properties(${target} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
  endif()
  target_include_directories(${target} PRIVATE "${mw_root}")
  target_compile_definitions(${target} PRIVATE MW_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${target} PRIVATE manyworlds_shared)
  # Environments and batches have methods of the same names.
  mw_unity(${target} ALONE python/src/bind_environment.cpp)
  if(MW_SANITIZE MATCHES address)
    # Half of the time to compile; what takes long is in the library, which keeps it.
    target_compile_options(${target} PRIVATE -O0)
  endif()
  set(mw_python_targets ${mw_python_targets} ${target} PARENT_SCOPE)
endfunction()

file(GLOB mw_python_sources CONFIGURE_DEPENDS "${mw_python_dir}/src/*.cpp")
mw_python_module(_core ${mw_python_sources})
set(mw_python_converters "${mw_python_dir}/src/convert.cpp" "${mw_python_dir}/src/names.cpp"
  "${mw_python_dir}/src/references.cpp")
if(TARGET manyworlds_record_shared)  # imported: beside libmanyworlds.so in a wheel
  mw_python_module(_record "${mw_python_dir}/src/record/module.cpp" ${mw_python_converters})
  target_link_libraries(manyworlds_python_record PRIVATE manyworlds_record_shared)
elseif(TARGET manyworlds::record)
  mw_python_module(_record "${mw_python_dir}/src/record/module.cpp" ${mw_python_converters})
  mw_uses(manyworlds_python_record manyworlds::record)
  target_link_libraries(manyworlds_python_record PRIVATE HDF5::HDF5 ZLIB::ZLIB)
endif()
if(TARGET manyworlds_live_shared)
  mw_python_module(_live "${mw_python_dir}/src/live/module.cpp" ${mw_python_converters})
  target_link_libraries(manyworlds_python_live PRIVATE manyworlds_live_shared)
elseif(TARGET manyworlds::live)
  mw_python_module(_live "${mw_python_dir}/src/live/module.cpp" ${mw_python_converters})
  mw_uses(manyworlds_python_live manyworlds::live)
  target_link_libraries(manyworlds_python_live PRIVATE ZLIB::ZLIB)
endif()
if(TARGET manyworlds_mjcf_shared)
  mw_python_module(_mjcf "${mw_python_dir}/src/mjcf/module.cpp" ${mw_python_converters})
  target_link_libraries(manyworlds_python_mjcf PRIVATE manyworlds_mjcf_shared)
elseif(TARGET manyworlds::mjcf)
  mw_python_module(_mjcf "${mw_python_dir}/src/mjcf/module.cpp" ${mw_python_converters})
  mw_uses(manyworlds_python_mjcf manyworlds::mjcf)
  # Not with libmujoco, whose name has a version: manyworlds/mjcf.py loads the installed one before. What
  # that one lacks is an error at import (now), not in a call.
  target_link_libraries(manyworlds_python_mjcf PRIVATE tinyxml2::tinyxml2)
  target_link_options(manyworlds_python_mjcf PRIVATE -Wl,-z,now)
endif()
# Our warnings are for our files.
set_target_properties(${mw_nanobind} PROPERTIES COMPILE_WARNING_AS_ERROR OFF)
target_compile_options(${mw_nanobind} PRIVATE -w)
