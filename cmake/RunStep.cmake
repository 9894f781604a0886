# For the tests of the installed package. What they run finds its libraries by itself or not at all.
unset(ENV{LD_LIBRARY_PATH})

# run(COMMAND...): fails when it does. May end in WORKING_DIRECTORY folder.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " line)
    message(FATAL_ERROR "failed (${result}): ${line}")
  endif()
endfunction()
