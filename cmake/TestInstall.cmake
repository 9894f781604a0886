# Installs the built tree into a fresh prefix, moves that to PREFIX, and runs the program from there.
#   cmake -D BUILD_DIR=... -D SOURCE_DIR=... -D PREFIX=... -D BINDIR=bin -D MJCF=ON -D RECORD=ON
#         -D VIEWER=ON
#         -P TestInstall.cmake
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/RunStep.cmake")
set(first "${PREFIX}.before")
file(REMOVE_RECURSE "${first}" "${PREFIX}")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${first}")
file(RENAME "${first}" "${PREFIX}")

# Nothing that others read may name where it was made.
file(GLOB_RECURSE texts "${PREFIX}/*.cmake" "${PREFIX}/*.pc")
foreach(text IN LISTS texts)
  file(READ "${text}" content)
  foreach(place IN ITEMS "${first}" "${BUILD_DIR}" "${SOURCE_DIR}/")
    string(FIND "${content}" "${place}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${text} names ${place}")
    endif()
  endforeach()
endforeach()

set(program "${PREFIX}/${BINDIR}/manyworlds")
if(NOT PROGRAM)
  return()
endif()
set(folder "${PREFIX}.run")
file(REMOVE_RECURSE "${folder}")
file(MAKE_DIRECTORY "${folder}")
run("${program}" run ball3d --worlds 20 --steps 10 WORKING_DIRECTORY "${folder}")
if(MJCF)
  run("${program}" run "${SOURCE_DIR}/scenes/mjcf/box_pile.xml" --worlds 20 --steps 3
      WORKING_DIRECTORY "${folder}")
  if(NOT EXISTS "${PREFIX}/${DATADIR}/licenses/mujoco/LICENSE")
    message(FATAL_ERROR "MuJoCo's library was installed without its licence (tools/scripts/fetch_mujoco.sh)")
  endif()
endif()
if(RECORD)
  run("${program}" run ball3d --worlds 20 --steps 10 --record run.h5 WORKING_DIRECTORY "${folder}")
  run("${program}" replay run.h5 WORKING_DIRECTORY "${folder}")
  if(VIEWER)
    run("${program}" view run.h5 --out page.html WORKING_DIRECTORY "${folder}")
  endif()
endif()
