# manyworlds::record: recordings in HDF5 files, a library of its own because it needs HDF5.

# CMake's own module asks the compiler wrapper h5cc, which speaks C.
enable_language(C)
find_package(HDF5 1.10 REQUIRED COMPONENTS C)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(ZLIB REQUIRED)

mw_sources(mw_record_sources "src/film/*.cpp" "src/page/*.cpp" "src/record/*.cpp")
mw_library(manyworlds_record ${mw_record_sources})
add_library(manyworlds::record ALIAS manyworlds_record)
set_target_properties(manyworlds_record PROPERTIES EXPORT_NAME record)
target_compile_definitions(manyworlds_record PRIVATE MW_VERSION="${PROJECT_VERSION}")
target_include_directories(manyworlds_record PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(manyworlds_record PUBLIC manyworlds
  PRIVATE HDF5::HDF5 ZLIB::ZLIB $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
mw_precompile(manyworlds_record)
mw_unity(manyworlds_record)
