# Finds MuJoCo's headers and shared library and defines the imported target MuJoCo::MuJoCo.
#
# Input:  MW_MUJOCO_DIR   folder with include/mujoco/mujoco.h and lib/libmujoco.so, as
#                         tools/scripts/fetch_mujoco.sh makes it
# Output: MuJoCo_FOUND, MuJoCo_VERSION ("4.0.1"), MuJoCo_INCLUDE_DIR, MuJoCo_LIBRARY,
#         MuJoCo_LICENSE (only where it lies in MW_MUJOCO_DIR)
set(MW_MUJOCO_DIR "" CACHE PATH "Folder with MuJoCo's include and lib (tools/scripts/fetch_mujoco.sh)")

find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h HINTS "${MW_MUJOCO_DIR}/include")
find_library(MuJoCo_LIBRARY mujoco HINTS "${MW_MUJOCO_DIR}/lib")
find_file(MuJoCo_LICENSE LICENSE PATHS "${MW_MUJOCO_DIR}" NO_DEFAULT_PATH)
mark_as_advanced(MuJoCo_INCLUDE_DIR MuJoCo_LIBRARY MuJoCo_LICENSE)

# The header has the version as one number, 4000001 for 4.0.1.
set(MuJoCo_VERSION "")
if(MuJoCo_INCLUDE_DIR)
  file(STRINGS "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h" _mujoco_line
       REGEX "^#define mjVERSION_HEADER [0-9]+")
  if(_mujoco_line MATCHES "mjVERSION_HEADER ([0-9]+)")
    math(EXPR _mujoco_major "${CMAKE_MATCH_1} / 1000000")
    math(EXPR _mujoco_minor "${CMAKE_MATCH_1} / 1000 % 1000")
    math(EXPR _mujoco_patch "${CMAKE_MATCH_1} % 1000")
    set(MuJoCo_VERSION "${_mujoco_major}.${_mujoco_minor}.${_mujoco_patch}")
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCo
  REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR
  VERSION_VAR MuJoCo_VERSION
  REASON_FAILURE_MESSAGE "set MW_MUJOCO_DIR to the folder that tools/scripts/fetch_mujoco.sh filled")

if(MuJoCo_FOUND AND NOT TARGET MuJoCo::MuJoCo)
  # The real file behind the libmujoco.so link: its name is what the loader asks for.
  file(REAL_PATH "${MuJoCo_LIBRARY}" _mujoco_file)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES
    IMPORTED_LOCATION "${_mujoco_file}"
    INTERFACE_INCLUDE_DIRECTORIES "${MuJoCo_INCLUDE_DIR}")
  get_filename_component(_mujoco_soname "${_mujoco_file}" NAME)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES IMPORTED_SONAME "${_mujoco_soname}")
endif()
