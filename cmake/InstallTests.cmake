# The installed package: a fresh prefix that is moved, the program in it, and users' projects against it,
# by CMake and by pkg-config.

set(mw_prefix "${PROJECT_BINARY_DIR}/examples/installed")
set(mw_has_program OFF)
if(TARGET manyworlds_cli)
  set(mw_has_program ON)
endif()
add_test(NAME installed
  COMMAND ${CMAKE_COMMAND}
          -D BUILD_DIR=${PROJECT_BINARY_DIR} -D SOURCE_DIR=${PROJECT_SOURCE_DIR}
          -D PREFIX=${mw_prefix} -D BINDIR=${CMAKE_INSTALL_BINDIR} -D DATADIR=${CMAKE_INSTALL_DATADIR}
          -D PROGRAM=${mw_has_program} -D MJCF=${MW_MJCF} -D RECORD=${MW_RECORD}
          -D LIVE=${MW_LIVE} -D EXECUTOR=${MW_EXECUTOR} -D VIEWER=${MW_VIEWER}
          -P "${PROJECT_SOURCE_DIR}/cmake/TestInstall.cmake")
set_tests_properties(installed PROPERTIES FIXTURES_SETUP installed TIMEOUT 300)

# mw_install_test(NAME SCRIPT OPTION...)
function(mw_install_test name script)
  add_test(NAME ${name}
    COMMAND ${CMAKE_COMMAND} -D BUILD_DIR=${PROJECT_BINARY_DIR} -D PREFIX=${mw_prefix}
            -D LIBDIR=${CMAKE_INSTALL_LIBDIR} -D COMPILER=${CMAKE_CXX_COMPILER}
            -D GENERATOR=${CMAKE_GENERATOR} ${ARGN}
            -P "${PROJECT_SOURCE_DIR}/cmake/${script}.cmake")
  set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED installed TIMEOUT 300)
endfunction()

set(mw_examples "${PROJECT_SOURCE_DIR}/examples")
foreach(example IN ITEMS embed lander birds arrays)
  mw_install_test(${example} TestEmbed -D SOURCE_DIR=${mw_examples}/${example})
endforeach()

find_program(MW_PKG_CONFIG NAMES pkg-config pkgconf)
mark_as_advanced(MW_PKG_CONFIG)
# mw_test_pkg_config(PACKAGE SOURCE): where there is pkg-config to ask.
function(mw_test_pkg_config package source)
  if(MW_PKG_CONFIG)
    mw_install_test(pkg_config_${package} TestPkgConfig -D PACKAGE=${package}
                    -D SOURCE=${mw_examples}/embed/${source}.cpp)
  endif()
endfunction()
mw_test_pkg_config(manyworlds main)
foreach(component IN ITEMS live mjcf record)
  if(TARGET manyworlds_${component})
    mw_install_test(embed_${component} TestEmbed -D SOURCE_DIR=${mw_examples}/embed
                    -D COMPONENTS=${component})
    mw_test_pkg_config(manyworlds-${component} ${component})
  endif()
endforeach()
