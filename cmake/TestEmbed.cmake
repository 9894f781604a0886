# Configures, builds and runs the project SOURCE_DIR, whose program has the name of its folder, against
# the package installed in PREFIX; with COMPONENTS also PROGRAM_<component> for each of them.
#   cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D PREFIX=... -D LIBDIR=lib [-D COMPONENTS=mjcf]
#         -D COMPILER=c++ -D GENERATOR=Ninja -P TestEmbed.cmake
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/RunStep.cmake")
cmake_path(GET SOURCE_DIR FILENAME program)
string(JOIN "_" name ${program} ${COMPONENTS})
set(build "${BUILD_DIR}/examples/${name}")
file(REMOVE_RECURSE "${build}")

set(components)
set(targets ${program})
if(COMPONENTS)
  set(components -D "COMPONENTS=${COMPONENTS}")
  set(targets ${COMPONENTS})
  list(TRANSFORM targets PREPEND "${program}_")
endif()
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${build}" -G "${GENERATOR}"
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Release
    -D manyworlds_DIR=${PREFIX}/${LIBDIR}/cmake/manyworlds ${components})
run(${CMAKE_COMMAND} --build "${build}" --target ${targets})
foreach(target IN LISTS targets)
  run("${build}/${target}" WORKING_DIRECTORY "${build}")
endforeach()
