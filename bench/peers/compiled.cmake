# Engines that are compiled here for speed, from the sources in crates (PEER_CRATES_DIR), for the
# instruction sets that PEER_ISA names. A crate that is not there leaves its engine out.

# catto_library(NAME FOLDER PREFIX): Box2D 3 and Box3D, which are built alike.
function(catto_library name folder prefix)
  if(NOT EXISTS "${folder}/src/physics_world.c")
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS "${folder}/src/*.c")
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES C_STANDARD 17 C_EXTENSIONS ON)
  target_include_directories(${name} SYSTEM PUBLIC "${folder}/include")
  # As many worlds as a batch has at once; the default is 128.
  target_compile_definitions(${name} PUBLIC ${prefix}_MAX_WORLDS=8192)
  target_compile_options(${name} PRIVATE -O3)
  if(NOT PEER_ISA STREQUAL baseline)
    target_compile_options(${name} PRIVATE ${avx2_flags})
  endif()
  target_link_libraries(${name} PUBLIC m)
  if(UNIX)
    find_package(Threads REQUIRED)
    target_link_libraries(${name} PUBLIC Threads::Threads)
  endif()
endfunction()
catto_library(box2d3 "${PEER_CRATES_DIR}/boxdd-sys/third-party/box2d" B2)
catto_library(box3d "${PEER_CRATES_DIR}/box3d-sys/vendor/box3d" B3)

# Chipmunk with the flags of its own build and in float32, which is faster. cpHastySpace, its solver
# with threads, does not compile with today's C library.
set(chipmunk_dir "${PEER_CRATES_DIR}/chipmunk-sys/chipmunk")
if(EXISTS "${chipmunk_dir}/src/cpSpace.c")
  file(GLOB sources CONFIGURE_DEPENDS "${chipmunk_dir}/src/*.c")
  list(FILTER sources EXCLUDE REGEX "/cpHastySpace\\.c$")
  add_library(chipmunk STATIC ${sources})
  set_target_properties(chipmunk PROPERTIES C_STANDARD 99 C_EXTENSIONS ON)
  target_include_directories(chipmunk SYSTEM PUBLIC "${chipmunk_dir}/include")
  target_compile_definitions(chipmunk PUBLIC CP_USE_DOUBLES=0)
  target_compile_options(chipmunk PRIVATE -O3 -ffast-math -w)
  target_link_libraries(chipmunk PUBLIC m)
endif()

# Jolt by its own build: its defaults are AVX2 with FMA, link-time optimisation and no determinism
# across platforms. What its Release adds for debugging is left out, as in its Distribution.
set(jolt_dir "${PEER_CRATES_DIR}/joltc-sys/JoltC/JoltPhysics")
if(EXISTS "${jolt_dir}/Build/CMakeLists.txt")
  set(GENERATE_DEBUG_SYMBOLS OFF)
  set(ENABLE_ALL_WARNINGS OFF)
  set(DEBUG_RENDERER_IN_DEBUG_AND_RELEASE OFF)
  set(PROFILER_IN_DEBUG_AND_RELEASE OFF)
  if(PEER_ISA STREQUAL avx512)
    set(USE_AVX512 ON)
  elseif(PEER_ISA STREQUAL baseline)
    foreach(set IN ITEMS SSE4_1 SSE4_2 AVX AVX2 LZCNT TZCNT F16C FMADD)
      set(USE_${set} OFF)
    endforeach()
  endif()
  add_subdirectory("${jolt_dir}/Build" jolt EXCLUDE_FROM_ALL SYSTEM)
endif()

# Rapier by cargo, where there is one that is new enough: a static library for each dimension.
set(PEER_CARGO "" CACHE FILEPATH "cargo of Rust 1.86 or later; empty: no Rapier")
if(PEER_CARGO)
  set(rust_flags "")
  if(NOT PEER_ISA STREQUAL baseline)
    set(rust_flags "-C target-feature=+avx2,+fma,+bmi1,+bmi2,+lzcnt,+popcnt")
  endif()
  set(crate "${PROJECT_SOURCE_DIR}/rapier")
  foreach(dimension IN ITEMS 2 3)
    set(folder "${PROJECT_BINARY_DIR}/rapier/dim${dimension}")
    set(library "${folder}/release/libpeer_rapier.a")
    add_custom_command(OUTPUT "${library}"
      COMMAND "${CMAKE_COMMAND}" -E env "RUSTFLAGS=${rust_flags}" "CARGO_TARGET_DIR=${folder}"
        "${PEER_CARGO}" build --quiet --release --locked --features "dim${dimension}"
        --manifest-path "${crate}/Cargo.toml"
      DEPENDS "${crate}/Cargo.toml" "${crate}/Cargo.lock" "${crate}/src/lib.rs"
      COMMENT "Building Rapier in ${dimension}D with cargo" VERBATIM)
    add_custom_target(rapier${dimension}d_library DEPENDS "${library}")
    add_library(rapier${dimension}d STATIC IMPORTED)
    set_target_properties(rapier${dimension}d PROPERTIES IMPORTED_LOCATION "${library}")
    add_dependencies(rapier${dimension}d rapier${dimension}d_library)
    find_package(Threads REQUIRED)
    target_link_libraries(rapier${dimension}d INTERFACE Threads::Threads ${CMAKE_DL_LIBS} m)
  endforeach()
endif()
