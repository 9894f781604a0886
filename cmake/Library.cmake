# The library, manyworlds::manyworlds. The kernels' objects are folded into its archive.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(Qhull REQUIRED CONFIG)

mw_sources(mw_library_sources "src/*.cpp" "scenes/*.cpp")
list(FILTER mw_library_sources EXCLUDE REGEX "/src/(film|live|mjcf|page|record)/")

mw_library(manyworlds ${mw_library_sources})
add_library(manyworlds::manyworlds ALIAS manyworlds)
target_compile_features(manyworlds PUBLIC cxx_std_20)
target_include_directories(manyworlds
  PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
         "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
  PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(manyworlds PUBLIC Eigen3::Eigen PRIVATE Threads::Threads Qhull::qhull_r)
mw_precompile(manyworlds)
# These instantiate what others declare, or keep names for themselves that others do, too.
mw_unity(manyworlds ALONE src/state/worlds.cpp src/api/read_observers.cpp)

if(MW_EXECUTOR STREQUAL tbb)
  find_package(TBB 2021 REQUIRED CONFIG)
  target_link_libraries(manyworlds PRIVATE TBB::tbb)
elseif(MW_EXECUTOR STREQUAL threads)
  mw_define(src/step/for_each_group.cpp MW_EXECUTOR_THREADS=1)
else()
  message(FATAL_ERROR "MW_EXECUTOR is '${MW_EXECUTOR}'; known: tbb, threads")
endif()

# src/dispatch alone learns from MW_HAVE_<ISA>_<PRECISION> which kernel tables exist.
list(JOIN MW_KERNEL_SETS ", " mw_built)
string(REPLACE "_" " " mw_built "${mw_built}")
mw_define(src/dispatch/kernels.cpp MW_KERNELS_BUILT="${mw_built}")
if(mw_embedded)
  message(STATUS "manyworlds: kernels ${mw_built}; MW_ISAS (scalar;avx2;avx512) and MW_PRECISIONS (f32;f64) add others")
endif()
foreach(name IN LISTS MW_KERNEL_SETS)
  string(TOUPPER ${name} upper)
  mw_define(src/dispatch/kernels.cpp MW_HAVE_${upper}=1)
  target_sources(manyworlds PRIVATE $<TARGET_OBJECTS:mw_kernels_${name}>)
endforeach()
