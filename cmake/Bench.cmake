# Micro benchmarks per shape pair, constraint and stage; whole scenes are `manyworlds bench`.

find_package(benchmark REQUIRED CONFIG)

mw_sources(mw_bench_sources "bench/*.cpp")
# Other engines: a project of its own (tools/peers).
list(FILTER mw_bench_sources EXCLUDE REGEX "/bench/peers/")
if(mw_bench_sources)
  # Robots are driven as the program drives them.
  add_executable(manyworlds_bench ${mw_bench_sources}
    "${PROJECT_SOURCE_DIR}/tools/base/random_controls.cpp")
  target_include_directories(manyworlds_bench PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(manyworlds_bench PRIVATE manyworlds benchmark::benchmark)
endif()
