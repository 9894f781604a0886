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

if(MW_TESTS AND NOT MW_SANITIZE)
  add_test(NAME python
    COMMAND ${Python_EXECUTABLE} -m pytest -q -p no:cacheprovider "${mw_python_dir}/tests")
  set_tests_properties(python PROPERTIES TIMEOUT 900 COST 500
    ENVIRONMENT "PYTHONPATH=${mw_python_build};PYTHONDONTWRITEBYTECODE=1")
endif()
