# A compiler in C++17 mode stops at each public header with one message that says what to do.
#   cmake -D SOURCE_DIR=... -D EIGEN=... -D COMPILER=c++ -P TestCxx17.cmake
cmake_minimum_required(VERSION 3.25)

file(GLOB headers RELATIVE "${SOURCE_DIR}/include" "${SOURCE_DIR}/include/manyworlds/*.hpp")
foreach(header IN LISTS headers)
  # Lists of macros, which others include.
  if(header MATCHES "/(field_table|require_cxx20)\\.hpp$")
    continue()
  endif()
  execute_process(
    COMMAND "${COMPILER}" -std=c++17 -fsyntax-only -x c++ -include ${header} /dev/null
            -I "${SOURCE_DIR}/include" -isystem "${EIGEN}"
    RESULT_VARIABLE result ERROR_VARIABLE messages)
  string(REGEX MATCHALL "error: [^\n]*" errors "${messages}")
  list(LENGTH errors count)
  # The second one ends the compilation.
  if(result EQUAL 0 OR NOT count EQUAL 2 OR
     NOT errors MATCHES "^error: (#error )?\"?manyworlds needs C\\+\\+20: compile with -std=c\\+\\+20")
    message(FATAL_ERROR "${header} as C++17: ${messages}")
  endif()
endforeach()
