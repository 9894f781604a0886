# A model of ours beside MuJoCo's of the same file: what `manyworlds compare` and the tests share.

mw_sources(mw_compare_sources "tools/compare/*.cpp")
add_library(manyworlds_compare STATIC ${mw_compare_sources})
target_include_directories(manyworlds_compare PUBLIC "${PROJECT_SOURCE_DIR}")
target_compile_options(manyworlds_compare PRIVATE -O1)
target_link_libraries(manyworlds_compare PUBLIC manyworlds_mjcf MuJoCo::MuJoCo)
mw_unity(manyworlds_compare)
