# manyworlds::mjcf: reading MJCF files, a library of its own because it needs MuJoCo, and tinyxml2 to
# check files before MuJoCo sees them.

find_package(MuJoCo REQUIRED)
find_package(tinyxml2 REQUIRED CONFIG)

mw_sources(mw_mjcf_sources "src/mjcf/*.cpp")
mw_library(manyworlds_mjcf ${mw_mjcf_sources})
add_library(manyworlds::mjcf ALIAS manyworlds_mjcf)
set_target_properties(manyworlds_mjcf PROPERTIES EXPORT_NAME mjcf)
target_include_directories(manyworlds_mjcf PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(manyworlds_mjcf PUBLIC manyworlds PRIVATE MuJoCo::MuJoCo tinyxml2::tinyxml2)
mw_unity(manyworlds_mjcf)
