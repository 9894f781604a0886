# Install rules: the program, the library and its components, what find_package(manyworlds CONFIG) and
# pkg-config read. Nothing in there names the prefix, so the whole may be moved.

include(CMakePackageConfigHelpers)
# Two components, which can be installed alone: cmake --install BUILD --component library, or program.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME library)
add_custom_target(mw_libraries)
set(mw_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/manyworlds")

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/manyworlds" TYPE INCLUDE
        FILES_MATCHING PATTERN "*.hpp")

# mw_install_library(TARGET NAME): as the export set NAME-targets, one per package component: its
# dependencies are needed only where it is asked for.
function(mw_install_library target name)
  add_dependencies(mw_libraries ${target})
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS ${target} EXPORT ${name}-targets)
  install(EXPORT ${name}-targets NAMESPACE manyworlds:: FILE ${name}-targets.cmake
          DESTINATION "${mw_package_dir}")
endfunction()
mw_install_library(manyworlds manyworlds)
if(TARGET manyworlds_mjcf)
  mw_install_library(manyworlds_mjcf manyworlds-mjcf)
  # MuJoCo comes along: no Debian package has it.
  get_target_property(mw_mujoco_library MuJoCo::MuJoCo IMPORTED_LOCATION)
  cmake_path(GET mw_mujoco_library FILENAME mw_mujoco_file)
  install(FILES "${mw_mujoco_library}" TYPE LIB)
  if(MuJoCo_LICENSE)
    cmake_path(GET MuJoCo_LICENSE PARENT_PATH mw_mujoco_licenses)
    file(GLOB mw_mujoco_licenses "${mw_mujoco_licenses}/LICENSE*")
    install(FILES ${mw_mujoco_licenses} DESTINATION "${CMAKE_INSTALL_DATADIR}/licenses/mujoco")
  else()
    message(WARNING "MuJoCo's licence is not in ${MW_MUJOCO_DIR} and cannot be installed beside its "
                    "library: pass the install on with a copy of it")
  endif()
endif()
if(TARGET manyworlds_record)
  mw_install_library(manyworlds_record manyworlds-record)
endif()
if(TARGET manyworlds_live)
  mw_install_library(manyworlds_live manyworlds-live)
endif()
include(cmake/Licenses.cmake)
mw_install_licenses(manyworlds "${PROJECT_SOURCE_DIR}/LICENSE")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/manyworlds-config.cmake.in"
  "${PROJECT_BINARY_DIR}/manyworlds-config.cmake" INSTALL_DESTINATION "${mw_package_dir}"
  PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/manyworlds-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/manyworlds-config.cmake"
              "${PROJECT_BINARY_DIR}/manyworlds-config-version.cmake"
        DESTINATION "${mw_package_dir}")

# pkg-config: manyworlds, manyworlds-live, manyworlds-mjcf, manyworlds-record. An archive's own needs are its user's.
file(RELATIVE_PATH mw_pc_up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" mw_pc_up "${mw_pc_up}")
# mw_pkg_config(NAME DESCRIPTION REQUIRES PRIVATE_REQUIRES PRIVATE_LIBS): lib<NAME with _ for ->.
function(mw_pkg_config name description requires private_requires private_libs)
  string(REPLACE - _ library "${name}")
  if(NOT BUILD_SHARED_LIBS)
    string(JOIN ", " requires ${requires} ${private_requires})
    set(libs "${private_libs}")
    set(private_requires)
    set(private_libs)
  endif()
  configure_file("${PROJECT_SOURCE_DIR}/cmake/manyworlds.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc"
                 @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endfunction()
set(mw_pc_requires "qhull_r")
if(MW_EXECUTOR STREQUAL tbb)
  set(mw_pc_requires "qhull_r, tbb")
endif()
mw_pkg_config(manyworlds "${PROJECT_DESCRIPTION}" "eigen3" "${mw_pc_requires}" "-pthread")
if(TARGET manyworlds_mjcf)
  mw_pkg_config(manyworlds-mjcf "MJCF files for manyworlds" "manyworlds = ${PROJECT_VERSION}"
                "tinyxml2" "-l:${mw_mujoco_file}")
endif()
if(TARGET manyworlds_record)
  mw_pkg_config(manyworlds-record "Recordings for manyworlds" "manyworlds = ${PROJECT_VERSION}"
                "hdf5, zlib" "")
endif()
if(TARGET manyworlds_live)
  mw_pkg_config(manyworlds-live "Live pages for manyworlds" "manyworlds = ${PROJECT_VERSION}" "zlib"
                "-pthread")
endif()
