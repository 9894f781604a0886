# Compiles through ccache where it is installed, so that a second build of the same sources, in another
# clone or after a switch of branches, compiles nothing. Set MW_CCACHE=OFF to compile without it.
#
# Paths inside the project are hashed relative to it, which makes clones share their objects. ccache keeps
# GCC's precompiled headers too, given -fpch-preprocess. Clang's hold the folder they were made in, so
# through ccache clang compiles without: MW_PRECOMPILE says whether headers are precompiled. A launcher
# that is not ours may not know them either.

option(MW_CCACHE "Compile through ccache where it is installed" ${PROJECT_IS_TOP_LEVEL})

# The launcher's KEY=VALUE settings need a newer ccache than Debian 12's 4.7, so `env` sets them.
if(MW_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(MW_CCACHE_PROGRAM ccache)
  mark_as_advanced(MW_CCACHE_PROGRAM)
  if(MW_CCACHE_PROGRAM)
    cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH mw_ccache_base)
    set(mw_ccache env "CCACHE_BASEDIR=${mw_ccache_base}" CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros "${mw_ccache_base}/tools/scripts/ccache_launcher"
        "${MW_CCACHE_PROGRAM}")
    set(CMAKE_C_COMPILER_LAUNCHER ${mw_ccache})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${mw_ccache})
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endif()

set(MW_PRECOMPILE ON)
if(CMAKE_CXX_COMPILER_LAUNCHER AND NOT (MW_CCACHE_PROGRAM AND CMAKE_CXX_COMPILER_ID STREQUAL GNU))
  set(MW_PRECOMPILE OFF)
endif()
