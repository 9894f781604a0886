# The kernels: the same sources once per instruction set and number type, each in a namespace of
# its own, as an object library mw_kernels_<isa>_<precision>. MW_KERNEL_SETS lists those built.
#
# No -march=native: virtual machines misreport their CPU, and it may pick narrower vectors.

mw_sources(mw_kernel_sources "kernels/*.cpp")

set(mw_lanes_scalar_f32 1)
set(mw_lanes_scalar_f64 1)
set(mw_lanes_avx2_f32 8)
set(mw_lanes_avx2_f64 4)
set(mw_lanes_avx512_f32 16)
set(mw_real_f32 float)
set(mw_real_f64 double)
set(mw_flags_scalar)
set(mw_flags_avx2 -mavx2 -mfma -mbmi2)
set(mw_flags_avx512 -mavx512f -mavx512vl -mavx512dq -mavx512bw -mavx2 -mfma -mbmi2
    -mprefer-vector-width=512)
# GCC 12's AVX-512 header warns about the undefined operand of its own intrinsics.
set(mw_quiet_avx512 $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-uninitialized>)
# GCC copies structs of registers in 16-byte pieces unless told otherwise, and the whole-register
# load that follows then waits for the stores (measured: up to 2x on free motion).
set(mw_moves_avx2 $<$<CXX_COMPILER_ID:GNU>:-mmove-max=256;-mstore-max=256>)
set(mw_moves_avx512 $<$<CXX_COMPILER_ID:GNU>:-mmove-max=512;-mstore-max=512>)
# Marking the scope of every register-sized temporary makes ASan compile a kernel five times as
# long, UBSan three times. The scalar kernels, from the same sources, keep both.
if(MW_SANITIZE MATCHES address)
  set(mw_scopes_avx2 -fno-sanitize-address-use-after-scope -fno-sanitize=undefined)
  set(mw_scopes_avx512 ${mw_scopes_avx2})
endif()
# Most of GCC's time for these files goes into the search for what a load may have been stored by; it
# gives up sooner. -O1 is half the work, for what no standard scene runs.
set(mw_search $<$<CXX_COMPILER_ID:GNU>:--param=sccvn-max-alias-queries-per-access=50
    --param=dse-max-alias-queries-per-store=32>)
set(mw_cold_kernels kernels/flight/flight_planar.cpp kernels/flight/flight_spatial.cpp)
if(NOT MW_KERNEL_OPTIMIZATION)
  list(TRANSFORM mw_cold_kernels PREPEND "${PROJECT_SOURCE_DIR}/")
  set_source_files_properties(${mw_cold_kernels} PROPERTIES COMPILE_OPTIONS -O1)
endif()
set(mw_optimization_scalar -O2)
set(mw_optimization_avx2 -O3)
set(mw_optimization_avx512 -O3)

set(MW_KERNEL_SETS)
foreach(isa IN LISTS MW_ISAS)
  if(NOT DEFINED mw_optimization_${isa})
    message(FATAL_ERROR "MW_ISAS: unknown instruction set '${isa}'; known: scalar, avx2, avx512")
  endif()
  foreach(precision IN LISTS MW_PRECISIONS)
    if(NOT DEFINED mw_real_${precision})
      message(FATAL_ERROR "MW_PRECISIONS: unknown precision '${precision}'; known: f32, f64")
    endif()
    set(name ${isa}_${precision})
    if(NOT DEFINED mw_lanes_${name} OR (MW_KERNELS AND NOT name IN_LIST MW_KERNELS))
      continue()
    endif()
    list(APPEND MW_KERNEL_SETS ${name})
    set(optimization ${mw_optimization_${isa}})
    if(MW_KERNEL_OPTIMIZATION)
      set(optimization ${MW_KERNEL_OPTIMIZATION})
    endif()
    string(TOUPPER ${isa} isa_upper)

    add_library(mw_kernels_${name} OBJECT ${mw_kernel_sources})
    target_compile_definitions(mw_kernels_${name} PRIVATE
      MW_KERNEL_NAMESPACE=${name} MW_REAL=${mw_real_${precision}} MW_LANES=${mw_lanes_${name}}
      MW_ISA_${isa_upper}=1)
    target_compile_options(mw_kernels_${name} PRIVATE
      -fno-math-errno -fno-trapping-math -fno-exceptions -fno-rtti
      ${mw_flags_${isa}} ${mw_moves_${isa}} ${mw_quiet_${isa}} ${mw_scopes_${isa}}
      ${optimization} ${mw_search}
      # No exception passes through a kernel; debuggers have tables of their own where there is -g.
      $<$<CONFIG:Release>:-fno-asynchronous-unwind-tables>
      # Full debug information doubles the time to compile a kernel; line numbers are free.
      $<$<CONFIG:RelWithDebInfo>:-g1>)
    target_include_directories(mw_kernels_${name} PRIVATE "${PROJECT_SOURCE_DIR}"
      "${PROJECT_SOURCE_DIR}/include")
    if(MW_UNITY AND MW_PRECOMPILE)
      # Half of what most of these files cost are the vector headers. Without a folder in their names
      # ccache finds them again in another clone.
      target_precompile_headers(mw_kernels_${name} PRIVATE <kernels/work/stages.hpp>
        <kernels/lane/elementary.hpp> <kernels/lane/rows.hpp> <kernels/lane/solve.hpp>
        <kernels/lane/space.hpp>)
    endif()
    set_target_properties(mw_kernels_${name} PROPERTIES
      CXX_VISIBILITY_PRESET hidden
      VISIBILITY_INLINES_HIDDEN ON
      # Link-time optimisation would inline across instruction sets.
      INTERPROCEDURAL_OPTIMIZATION OFF)
  endforeach()
endforeach()

if(NOT MW_KERNEL_SETS)
  message(FATAL_ERROR "no kernels to build: MW_ISAS is '${MW_ISAS}', MW_PRECISIONS "
                      "'${MW_PRECISIONS}', MW_KERNELS '${MW_KERNELS}'")
endif()

# The objects alone, for checks that need nothing else built.
add_custom_target(mw_kernel_objects)
foreach(name IN LISTS MW_KERNEL_SETS)
  add_dependencies(mw_kernel_objects mw_kernels_${name})
endforeach()
