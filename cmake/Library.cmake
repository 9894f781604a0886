# The library, manyworlds::manyworlds. The kernels' objects are folded into its archive.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(Qhull REQUIRED CONFIG)

mw_sources(mw_library_sources "src/*.cpp" "scenes/*.cpp")
list(FILTER mw_library_sources EXCLUDE REGEX "/src/(mjcf|record)/")

add_library(manyworlds ${mw_library_sources})
add_library(manyworlds::manyworlds ALIAS manyworlds)
target_compile_features(manyworlds PUBLIC cxx_std_20)
target_include_directories(manyworlds
  PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
         "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>"
  PRIVATE "${PROJECT_SOURCE_DIR}")
target_link_libraries(manyworlds PUBLIC Eigen3::Eigen PRIVATE Threads::Threads Qhull::qhull_r)
set_target_properties(manyworlds PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_definitions(manyworlds PRIVATE MW_VERSION="${PROJECT_VERSION}")
mw_precompile(manyworlds)

if(MW_EXECUTOR STREQUAL tbb)
  find_package(TBB 2021 REQUIRED CONFIG)
  target_link_libraries(manyworlds PRIVATE TBB::tbb)
elseif(MW_EXECUTOR STREQUAL threads)
  target_compile_definitions(manyworlds PRIVATE MW_EXECUTOR_THREADS=1)
else()
  message(FATAL_ERROR "MW_EXECUTOR is '${MW_EXECUTOR}'; known: tbb, threads")
endif()

# src/dispatch learns from MW_HAVE_<ISA>_<PRECISION> which kernel tables exist.
foreach(name IN LISTS MW_KERNEL_SETS)
  string(TOUPPER ${name} upper)
  target_compile_definitions(manyworlds PRIVATE MW_HAVE_${upper}=1)
  target_sources(manyworlds PRIVATE $<TARGET_OBJECTS:mw_kernels_${name}>)
endforeach()
