# Runs the test program PROGRAM's [fast] tests with MANYWORLDS_ISA=ISA, or says "skipped: ..." when
# this CPU cannot. cmake -D ISA=avx512 -D PROGRAM=... -P RunOnIsa.cmake

set(needs_scalar)
set(needs_avx2 avx2 fma bmi2)
set(needs_avx512 avx512f avx512vl avx512dq avx512bw)
if(EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  foreach(flag IN LISTS needs_${ISA})
    if(NOT " ${flags} " MATCHES " ${flag} ")
      message("skipped: this CPU has no ${flag}, so the ${ISA} kernels cannot run here")
      return()
    endif()
  endforeach()
endif()

set(ENV{MANYWORLDS_ISA} ${ISA})
execute_process(COMMAND "${PROGRAM}" "[fast]" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the fast tests failed with MANYWORLDS_ISA=${ISA}")
endif()
