# Install rules and the package that find_package(manyworlds CONFIG) reads.

include(CMakePackageConfigHelpers)
set(mw_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/manyworlds")

install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/manyworlds" TYPE INCLUDE
        FILES_MATCHING PATTERN "*.hpp")
install(TARGETS manyworlds EXPORT manyworlds-targets)
install(EXPORT manyworlds-targets NAMESPACE manyworlds:: FILE manyworlds-targets.cmake
        DESTINATION "${mw_package_dir}")
if(TARGET manyworlds_mjcf)
  # A package component of its own: only who asks for it needs MuJoCo.
  install(TARGETS manyworlds_mjcf EXPORT manyworlds-mjcf-targets)
  install(EXPORT manyworlds-mjcf-targets NAMESPACE manyworlds:: FILE manyworlds-mjcf-targets.cmake
          DESTINATION "${mw_package_dir}")
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/FindMuJoCo.cmake" DESTINATION "${mw_package_dir}")
endif()
if(TARGET manyworlds_record)
  install(TARGETS manyworlds_record EXPORT manyworlds-record-targets)
  install(EXPORT manyworlds-record-targets NAMESPACE manyworlds:: FILE manyworlds-record-targets.cmake
          DESTINATION "${mw_package_dir}")
endif()

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/manyworlds-config.cmake.in"
  "${PROJECT_BINARY_DIR}/manyworlds-config.cmake" INSTALL_DESTINATION "${mw_package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/manyworlds-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/manyworlds-config.cmake"
              "${PROJECT_BINARY_DIR}/manyworlds-config-version.cmake"
        DESTINATION "${mw_package_dir}")
