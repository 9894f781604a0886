# manyworlds::mjcf: reading MJCF files, a library of its own because it needs MuJoCo.

find_package(MuJoCo REQUIRED)

mw_sources(mw_mjcf_sources "src/mjcf/*.cpp")
add_library(manyworlds_mjcf ${mw_mjcf_sources})
add_library(manyworlds::mjcf ALIAS manyworlds_mjcf)
set_target_properties(manyworlds_mjcf PROPERTIES
  EXPORT_NAME mjcf
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_include_directories(manyworlds_mjcf PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(manyworlds_mjcf PUBLIC manyworlds PRIVATE MuJoCo::MuJoCo)
