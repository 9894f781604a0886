# Installs the built tree into a prefix inside BUILD_DIR, then configures, builds and runs the
# project SOURCE_DIR, whose program has the name of its folder, against it.
#   cmake -D BUILD_DIR=... -D SOURCE_DIR=... -P TestEmbed.cmake

cmake_path(GET SOURCE_DIR FILENAME program)
set(prefix "${BUILD_DIR}/examples/${program}/prefix")
set(build "${BUILD_DIR}/examples/${program}/build")
file(REMOVE_RECURSE "${BUILD_DIR}/examples/${program}")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " line)
    message(FATAL_ERROR "failed (${result}): ${line}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${prefix}")
run(${CMAKE_COMMAND} -S "${SOURCE_DIR}" -B "${build}" -G "${GENERATOR}"
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_BUILD_TYPE=Release
    -D manyworlds_DIR=${prefix}/${LIBDIR}/cmake/manyworlds)
run(${CMAKE_COMMAND} --build "${build}")
run("${build}/${program}")
