# The program manyworlds, build/<preset>/bin/manyworlds.

find_package(CLI11 REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)

mw_sources(mw_cli_sources "tools/base/*.cpp" "tools/report/*.cpp" "tools/cli/*.cpp")
add_executable(manyworlds_cli ${mw_cli_sources})
set_target_properties(manyworlds_cli PROPERTIES OUTPUT_NAME manyworlds)
target_include_directories(manyworlds_cli PRIVATE "${PROJECT_SOURCE_DIR}")
# Nothing here is hot, and CLI11 is slow to compile.
target_compile_options(manyworlds_cli PRIVATE -O1)
target_compile_definitions(manyworlds_cli PRIVATE MW_VERSION="${PROJECT_VERSION}")
target_link_libraries(manyworlds_cli PRIVATE
  manyworlds CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json Threads::Threads)
mw_precompile(manyworlds_cli <fmt/format.h>)
if(MW_MJCF)
  target_compile_definitions(manyworlds_cli PRIVATE MW_HAVE_MJCF=1)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_mjcf)
endif()
if(MW_RECORD)
  target_compile_definitions(manyworlds_cli PRIVATE MW_HAVE_RECORD=1)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_record)
endif()
if(MW_INSTALL)
  install(TARGETS manyworlds_cli)
endif()
