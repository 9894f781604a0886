# What several programs share of tools/: tools/base, and the families of random scenes and their laws,
# which `manyworlds report invariants` and the tests run.

include_guard(GLOBAL)

find_package(fmt REQUIRED CONFIG)
find_package(Threads REQUIRED)

mw_sources(mw_tools_base_sources "tools/base/*.cpp")
add_library(manyworlds_tools_base STATIC ${mw_tools_base_sources})
mw_sources(mw_invariants_sources "tools/invariants/*.cpp")
add_library(manyworlds_invariants STATIC ${mw_invariants_sources})
foreach(library IN ITEMS manyworlds_tools_base manyworlds_invariants)
  target_include_directories(${library} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_compile_options(${library} PRIVATE -O1)
  if(MW_SANITIZE MATCHES address)
    target_compile_options(${library} PRIVATE -O0)  # half of -O1's time
  endif()
endforeach()
target_compile_definitions(manyworlds_tools_base PRIVATE MW_VERSION="${PROJECT_VERSION}")
target_link_libraries(manyworlds_tools_base PUBLIC manyworlds PRIVATE fmt::fmt)
target_link_libraries(manyworlds_invariants PUBLIC
  manyworlds manyworlds_tools_base PRIVATE Threads::Threads)
mw_precompile(manyworlds_invariants <manyworlds/batch.hpp> <scenes/builders.hpp>)
mw_unity(manyworlds_tools_base)
mw_unity(manyworlds_invariants GROUPS 2)
