# Runs the test program PROGRAM's [fast] tests with MANYWORLDS_ISA=ISA, or says "skipped: ..." when
# this CPU cannot, or when ISA is the widest of the build's ISAS that it can: all tests take that by
# themselves. cmake -D ISA=avx2 -D ISAS=scalar;avx2;avx512 -D PROGRAM=... -P RunOnIsa.cmake

cmake_minimum_required(VERSION 3.25)

set(needs_scalar)
set(needs_avx2 avx2 fma bmi2)
set(needs_avx512 avx512f avx512vl avx512dq avx512bw)

# What this CPU lacks for an instruction set, in `out`; empty: nothing.
function(missing_for isa out)
  set(${out} "" PARENT_SCOPE)
  if(NOT EXISTS /proc/cpuinfo)
    return()
  endif()
  file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  foreach(flag IN LISTS needs_${isa})
    if(NOT " ${flags} " MATCHES " ${flag} ")
      set(${out} ${flag} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

missing_for(${ISA} lacks)
if(lacks)
  message("skipped: this CPU has no ${lacks}, so the ${ISA} kernels cannot run here")
  return()
endif()
foreach(isa IN ITEMS scalar avx2 avx512)
  missing_for(${isa} lacks)
  if(isa IN_LIST ISAS AND NOT lacks)
    set(widest ${isa})
  endif()
endforeach()
if(ISA STREQUAL widest)
  message("skipped: all tests take ${ISA} here by themselves")
  return()
endif()

set(ENV{MANYWORLDS_ISA} ${ISA})
set(tests "[fast]")
if(ISA STREQUAL scalar)
  # What of bits starts threads runs on scalar kernels under ThreadSanitizer. How worlds fare over
  # [long] times hangs on their bits alone, which are those of the widest instruction set.
  set(tests "[fast]~[bits]~[long],[fast][bits][one_thread]")
endif()
execute_process(COMMAND "${PROGRAM}" "${tests}" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the fast tests failed with MANYWORLDS_ISA=${ISA}")
endif()
