# Compiles SOURCE with what pkg-config says of PACKAGE in PREFIX, and runs it.
#   cmake -D SOURCE=... -D PACKAGE=manyworlds -D PREFIX=... -D LIBDIR=lib -D BUILD_DIR=... -D COMPILER=c++
#         -P TestPkgConfig.cmake
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/RunStep.cmake")
find_program(PKG_CONFIG NAMES pkg-config pkgconf REQUIRED)
set(ENV{PKG_CONFIG_PATH} "${PREFIX}/${LIBDIR}/pkgconfig")
execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs "${PACKAGE}" OUTPUT_VARIABLE flags
                RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "pkg-config does not know ${PACKAGE}")
endif()
separate_arguments(flags UNIX_COMMAND "${flags}")
set(folder "${BUILD_DIR}/examples/pkg_config_${PACKAGE}")
file(REMOVE_RECURSE "${folder}")
file(MAKE_DIRECTORY "${folder}")
run("${COMPILER}" -std=c++20 -O1 "${SOURCE}" -o "${folder}/program" ${flags})
run("${folder}/program" WORKING_DIRECTORY "${folder}")
