# The libFuzzer targets: one program per file fuzz/*_fuzz.cpp, and one that makes their seeds.

if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
  message(FATAL_ERROR "MW_FUZZ needs clang for libFuzzer, not ${CMAKE_CXX_COMPILER_ID}")
endif()

# Recordings are changed through HDF5, which no other target needs.
if(NOT MW_RECORD)
  message(FATAL_ERROR "MW_FUZZ needs MW_RECORD: recording_fuzz reads recordings")
endif()

# Coverage of what is looked for faults in.
set(mw_covered ${MW_KERNEL_SETS})
list(TRANSFORM mw_covered PREPEND mw_kernels_)
list(APPEND mw_covered manyworlds manyworlds_record)
if(MW_MJCF)
  list(APPEND mw_covered manyworlds_mjcf)
endif()
foreach(target IN LISTS mw_covered)
  target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
endforeach()

add_library(mw_fuzz_support STATIC
  fuzz/inputs.cpp fuzz/scene_bytes.cpp fuzz/scene_members.cpp fuzz/snapshot_batches.cpp
  tests/support/crowd.cpp)
target_include_directories(mw_fuzz_support PUBLIC "${PROJECT_SOURCE_DIR}")
target_link_libraries(mw_fuzz_support PUBLIC manyworlds)

add_custom_target(fuzz_targets)

mw_sources(mw_fuzz_targets "fuzz/*_fuzz.cpp")
if(NOT MW_MJCF)
  list(FILTER mw_fuzz_targets EXCLUDE REGEX "/mjcf_fuzz")
endif()
foreach(source IN LISTS mw_fuzz_targets)
  cmake_path(GET source STEM target)
  add_executable(${target} "${source}")
  target_link_libraries(${target} PRIVATE mw_fuzz_support)
  target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzz_targets ${target})
endforeach()

target_sources(recording_fuzz PRIVATE
  fuzz/file_image.cpp fuzz/json_edit.cpp fuzz/recording_edit.cpp fuzz/recordings.cpp)
target_link_libraries(recording_fuzz PRIVATE manyworlds_record HDF5::HDF5)

if(MW_MJCF)
  target_sources(mjcf_fuzz PRIVATE fuzz/model_edit.cpp)
  target_compile_definitions(mjcf_fuzz PRIVATE MW_MODELS="${PROJECT_SOURCE_DIR}/scenes/mjcf")
  target_link_libraries(mjcf_fuzz PRIVATE manyworlds_mjcf tinyxml2::tinyxml2)
endif()

add_executable(make_seeds fuzz/make_seeds.cpp)
add_dependencies(fuzz_targets make_seeds)
target_link_libraries(make_seeds PRIVATE mw_fuzz_support)
