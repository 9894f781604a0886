# Configures examples/fetch, which has the library as a subproject, by FetchContent: which kernels that
# builds, by default and with MW_ISAS, and that nothing else comes along. Compiles the user's own file.
#   cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D COMPILER=c++ -D GENERATOR=Ninja [-D BUILD=ON] -P TestSubproject.cmake
# With BUILD=ON it also compiles the library, in minutes, and runs the program.
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/RunStep.cmake")

# check(NAME KERNELS OPTION...): KERNELS are those that are to be built.
function(check name kernels)
  set(build "${BUILD_DIR}/examples/${name}")
  file(REMOVE_RECURSE "${build}")
  run(${CMAKE_COMMAND} -S "${SOURCE_DIR}/examples/fetch" -B "${build}" -G "${GENERATOR}"
      -D CMAKE_CXX_COMPILER=${COMPILER} ${ARGN})
  execute_process(COMMAND ${CMAKE_COMMAND} --build "${build}" --target help
                  OUTPUT_VARIABLE targets COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "mw_kernels_[a-z0-9]+_f[0-9]+" found "${targets}")
  list(REMOVE_DUPLICATES found)
  list(SORT found)
  list(TRANSFORM found REPLACE "^mw_kernels_" "")
  if(NOT found STREQUAL kernels)
    message(FATAL_ERROR "${name}: the kernels are '${found}', expected '${kernels}'")
  endif()
  if(targets MATCHES "manyworlds_(cli|tests|record|mjcf|live|python)")
    message(FATAL_ERROR "${name}: ${CMAKE_MATCH_0} is built, too")
  endif()
  set(build "${build}" PARENT_SCOPE)
endfunction()

check(subproject_isa "avx2_f32" -D MW_ISAS=avx2)
check(subproject_all "avx2_f32;avx2_f64;avx512_f32;scalar_f32;scalar_f64" -D MW_ALL_KERNELS=ON)
check(subproject "scalar_f32")
if(GENERATOR STREQUAL "Ninja")
  run(${CMAKE_COMMAND} --build "${build}" --target CMakeFiles/embed.dir${SOURCE_DIR}/examples/embed/main.cpp.o)
endif()
if(BUILD)
  run(${CMAKE_COMMAND} --build "${build}" --target embed)
  run("${build}/embed")
endif()
