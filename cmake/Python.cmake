# The Python package in the build tree: PYTHONPATH=build/<preset>/python. Wheels are built by
# pyproject.toml and python/CMakeLists.txt.

include(cmake/PythonModule.cmake)
set(mw_python_build "${PROJECT_BINARY_DIR}/python")
set_target_properties(${mw_python_targets} PROPERTIES
  LIBRARY_OUTPUT_DIRECTORY "${mw_python_build}/manyworlds")

# The Python files stand beside the extension as links, so that editing them needs no build.
file(GLOB_RECURSE mw_python_files CONFIGURE_DEPENDS RELATIVE "${mw_python_dir}/manyworlds"
  "${mw_python_dir}/manyworlds/*.py" "${mw_python_dir}/manyworlds/*.pyi"
  "${mw_python_dir}/manyworlds/py.typed")
foreach(file IN LISTS mw_python_files)
  cmake_path(GET file PARENT_PATH folder)
  file(MAKE_DIRECTORY "${mw_python_build}/manyworlds/${folder}")
  file(CREATE_LINK "${mw_python_dir}/manyworlds/${file}" "${mw_python_build}/manyworlds/${file}"
       SYMBOLIC)
endforeach()

# Those of files that are not there any more.
file(GLOB_RECURSE mw_python_links "${mw_python_build}/manyworlds/*.py" "${mw_python_build}/manyworlds/*.pyi")
foreach(link IN LISTS mw_python_links)
  if(IS_SYMLINK "${link}" AND NOT EXISTS "${link}")
    file(REMOVE "${link}")
  endif()
endforeach()

if(TARGET mw_viewer)
  file(CREATE_LINK "${mw_viewer_page}" "${mw_python_build}/manyworlds/viewer.html" SYMBOLIC)
endif()

if(TARGET manyworlds_cli)  # for python -m manyworlds
  file(MAKE_DIRECTORY "${mw_python_build}/manyworlds/bin")
  file(CREATE_LINK "${PROJECT_BINARY_DIR}/bin/manyworlds" "${mw_python_build}/manyworlds/bin/manyworlds" SYMBOLIC)
endif()

if(NOT MW_TESTS)
  return()
endif()
set(mw_pytest ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider)
set(mw_python_environment PYTHONPATH=${mw_python_build} PYTHONDONTWRITEBYTECODE=1)
if(TARGET manyworlds_cli AND MW_MJCF)
  list(APPEND mw_python_environment MANYWORLDS_CLI=$<TARGET_FILE:manyworlds_cli>)
endif()
if(NOT MW_SANITIZE)
  add_test(NAME python COMMAND ${mw_pytest} "${mw_python_dir}/tests")
elseif(MW_SANITIZE MATCHES address AND CMAKE_CXX_COMPILER_ID MATCHES Clang)
  # Python itself is not instrumented, so the sanitizer's library has to be there before anything
  # else, and what Python never frees is no leak of ours. The examples would test JAX, the types mypy
  # and node, searches NumPy, SciPy and pyarrow, actors Ray, whose servers would be preloaded with it. The program
  # is linked with a runtime of its own, and refuses the preloaded one.
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libclang_rt.asan-x86_64.so
                  OUTPUT_VARIABLE mw_asan_library OUTPUT_STRIP_TRAILING_WHITESPACE)
  add_test(NAME python COMMAND ${mw_pytest} "${mw_python_dir}/tests"
           --ignore "${mw_python_dir}/tests/test_program.py"
           --ignore "${mw_python_dir}/tests/test_ray.py"
           --ignore "${mw_python_dir}/tests/test_rl_examples.py"
           --ignore-glob "${mw_python_dir}/tests/test_search*.py"
           --ignore "${mw_python_dir}/tests/test_types.py")
  list(APPEND mw_python_environment LD_PRELOAD=${mw_asan_library} PYTHONMALLOC=malloc
       ASAN_OPTIONS=detect_leaks=0 MW_PRECISIONS=${MW_PRECISIONS})
else()
  return()
endif()
set_tests_properties(python PROPERTIES TIMEOUT 900 COST 500 ENVIRONMENT "${mw_python_environment}")
