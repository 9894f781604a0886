# What a Python wheel holds besides the extension modules, which are compiled per Python
# (python/CMakeLists.txt): the library, recordings, the program and the pages. All of it is made of the
# objects of the ordinary build. tools/scripts/prebuilt installs the component `wheel`:
#   wheel/libmanyworlds.so, wheel/libmanyworlds_record.so, wheel/bin/manyworlds, wheel/*.html

set(MW_HDF5_DIR "" CACHE PATH
    "What tools/scripts/build_hdf5.sh made, for wheels; empty: the system's HDF5")
if(BUILD_SHARED_LIBS)
  message(STATUS "MW_WHEEL is ignored with BUILD_SHARED_LIBS=ON: wheels are made of archives")
  return()
endif()
include(cmake/SharedLibrary.cmake)
add_custom_target(mw_wheel)
if(TARGET mw_libraries)
  add_dependencies(mw_wheel mw_libraries)
endif()
set(mw_wheel_dir "${PROJECT_BINARY_DIR}/wheel")

# mw_wheel_target(TARGET FOLDER RPATH): compiled for `mw_wheel` alone.
function(mw_wheel_target target folder rpath)
  set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON INSTALL_RPATH "${rpath}"
    RUNTIME_OUTPUT_DIRECTORY "${mw_wheel_dir}/${folder}" LIBRARY_OUTPUT_DIRECTORY "${mw_wheel_dir}/${folder}")
  target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tools/program/older_symbols.cpp")
  if(NOT target STREQUAL "manyworlds_mjcf_shared")  # which needs what the program or Python has of MuJoCo
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  add_dependencies(mw_wheel ${target})
  install(TARGETS ${target} COMPONENT wheel EXCLUDE_FROM_ALL
          RUNTIME DESTINATION "wheel/${folder}" LIBRARY DESTINATION "wheel/${folder}")
endfunction()

# A set of kernels is a sixth of a wheel. Every CPU with AVX2 prefers avx2_f64 to scalar_f64.
set(mw_wheel_kernels ${MW_KERNEL_SETS})
if("avx2_f64" IN_LIST mw_wheel_kernels)
  list(REMOVE_ITEM mw_wheel_kernels scalar_f64)
endif()
list(JOIN mw_wheel_kernels ", " mw_built)
string(REPLACE "_" " " mw_built "${mw_built}")
set(mw_dispatch "${PROJECT_BINARY_DIR}/wheel_kernels.cpp")
file(CONFIGURE OUTPUT "${mw_dispatch}" CONTENT "#include \"src/dispatch/kernels.cpp\"\n")
set_property(SOURCE "${mw_dispatch}" APPEND PROPERTY COMPILE_DEFINITIONS MW_KERNELS_BUILT="${mw_built}")
add_library(manyworlds_wheel SHARED "${mw_dispatch}"
  "$<FILTER:$<TARGET_OBJECTS:manyworlds>,EXCLUDE,src/dispatch/kernels>")
foreach(name IN LISTS mw_wheel_kernels)
  string(TOUPPER ${name} upper)
  set_property(SOURCE "${mw_dispatch}" APPEND PROPERTY COMPILE_DEFINITIONS MW_HAVE_${upper}=1)
  target_sources(manyworlds_wheel PRIVATE $<TARGET_OBJECTS:mw_kernels_${name}>)
endforeach()
set_target_properties(manyworlds_wheel PROPERTIES OUTPUT_NAME manyworlds)
target_include_directories(manyworlds_wheel PRIVATE "${PROJECT_SOURCE_DIR}" "${PROJECT_SOURCE_DIR}/include")
target_link_libraries(manyworlds_wheel PRIVATE Eigen3::Eigen Threads::Threads Qhull::qhull_r)
if(MW_EXECUTOR STREQUAL tbb)
  target_link_libraries(manyworlds_wheel PRIVATE TBB::tbb)
endif()
target_link_options(manyworlds_wheel PRIVATE -Wl,-Bsymbolic-functions)
mw_interface(manyworlds_wheel)
mw_wheel_target(manyworlds_wheel . "$ORIGIN")

# mw_wheel_component(NAME LIBRARY...): the archive of a component as a shared library, for the program and for
# the module _NAME.
function(mw_wheel_component name)
  set(target manyworlds_${name}_shared)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${target}.cpp" CONTENT "")
  add_library(${target} SHARED "${PROJECT_BINARY_DIR}/${target}.cpp")
  target_link_libraries(${target} PRIVATE
    -Wl,--whole-archive "$<TARGET_FILE:manyworlds_${name}>" -Wl,--no-whole-archive manyworlds_wheel ${ARGN})
  add_dependencies(${target} manyworlds_${name})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME manyworlds_${name})
  mw_wheel_target(${target} . "$ORIGIN")
endfunction()

# Recordings, for the program and for the module _record. HDF5's headers have to be those of the library
# that is linked, so src/record is compiled again for another HDF5. Its symbols are hidden: a process
# may also have the HDF5 of h5py.
if(MW_RECORD)
  if(MW_HDF5_DIR)
    add_library(manyworlds_record_shared SHARED ${mw_record_sources})
    target_compile_definitions(manyworlds_record_shared PRIVATE MW_VERSION="${PROJECT_VERSION}")
    target_include_directories(manyworlds_record_shared PRIVATE "${PROJECT_SOURCE_DIR}")
    target_include_directories(manyworlds_record_shared SYSTEM PRIVATE "${MW_HDF5_DIR}/include")
    target_link_libraries(manyworlds_record_shared PRIVATE nlohmann_json::nlohmann_json
      "${MW_HDF5_DIR}/lib/libhdf5.a")
    target_link_options(manyworlds_record_shared PRIVATE -Wl,--exclude-libs,libhdf5.a -Wl,--gc-sections)
    mw_precompile(manyworlds_record_shared)
    mw_unity(manyworlds_record_shared)
    target_link_libraries(manyworlds_record_shared PRIVATE manyworlds_wheel ZLIB::ZLIB ${CMAKE_DL_LIBS} m)
    set_target_properties(manyworlds_record_shared PROPERTIES OUTPUT_NAME manyworlds_record)
    mw_wheel_target(manyworlds_record_shared . "$ORIGIN")
    install(FILES "${MW_HDF5_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/licenses/HDF5" COMPONENT wheel
            EXCLUDE_FROM_ALL)
  else()
    mw_wheel_component(record HDF5::HDF5 ZLIB::ZLIB)
  endif()
endif()

if(MW_LIVE)
  mw_wheel_component(live ZLIB::ZLIB Threads::Threads)
endif()
if(MW_MJCF)
  mw_wheel_component(mjcf tinyxml2::tinyxml2 -Wl,-z,now)  # what libmujoco lacks is an error at import
endif()

if(NOT TARGET manyworlds_cli)
  return()
endif()
# The program, which uses the library beside the package. MuJoCo's library is opened when a model is read:
# without it, everything else works.
add_executable(manyworlds_program $<TARGET_OBJECTS:manyworlds_cli>)
set_target_properties(manyworlds_program PROPERTIES OUTPUT_NAME manyworlds LINKER_LANGUAGE CXX)
if(MW_MJCF)
  target_sources(manyworlds_program PRIVATE "${PROJECT_SOURCE_DIR}/tools/program/mujoco.cpp")
  target_include_directories(manyworlds_program PRIVATE "${PROJECT_SOURCE_DIR}"
    "$<TARGET_PROPERTY:MuJoCo::MuJoCo,INTERFACE_INCLUDE_DIRECTORIES>")
  mw_uses(manyworlds_program manyworlds_compare manyworlds_wheel)
  target_link_libraries(manyworlds_program PRIVATE manyworlds_mjcf_shared)
  # For that library: MuJoCo's functions (mujoco.cpp).
  target_link_options(manyworlds_program PRIVATE "-Wl,--export-dynamic-symbol=mj*")
endif()
if(MW_REPORT)
  # The families are half a megabyte of a wheel, and for those who work on the engine.
  target_sources(manyworlds_program PRIVATE "${PROJECT_SOURCE_DIR}/tools/cli/no_invariants.cpp"
    "${PROJECT_SOURCE_DIR}/tools/invariants/names.cpp")
  target_include_directories(manyworlds_program PRIVATE "${PROJECT_SOURCE_DIR}"
    "${PROJECT_SOURCE_DIR}/tools/cli")
endif()
mw_uses(manyworlds_program manyworlds_tools_base manyworlds_wheel)
if(MW_LIVE)
  target_link_libraries(manyworlds_program PRIVATE manyworlds_live_shared)
endif()
if(MW_RECORD)
  target_link_libraries(manyworlds_program PRIVATE manyworlds_record_shared)
endif()
target_link_libraries(manyworlds_program PRIVATE
  manyworlds_wheel fmt::fmt Threads::Threads ${CMAKE_DL_LIBS})
mw_wheel_target(manyworlds_program bin "$ORIGIN/..")

if(TARGET mw_viewer)
  add_dependencies(mw_wheel mw_viewer)
  install(FILES "${mw_viewer_page}" "${mw_report_page}" DESTINATION wheel COMPONENT wheel EXCLUDE_FROM_ALL)
endif()
if(mw_completion)
  add_dependencies(mw_wheel manyworlds_cli)  # which writes them
  install(FILES "${mw_completion}/manyworlds" "${mw_completion}/_manyworlds" DESTINATION completion COMPONENT wheel
          EXCLUDE_FROM_ALL)
endif()
