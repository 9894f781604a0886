# manyworlds_shared: all of manyworlds as one shared library, libmanyworlds.so, which the extension modules of
# Python and the program of a wheel share, so that what one makes another can use. An archive is linked into
# one as a whole; a manyworlds that is a shared library already (BUILD_SHARED_LIBS=ON) is that itself.
# Needs the target manyworlds::manyworlds.

get_target_property(mw_library manyworlds::manyworlds ALIASED_TARGET)
if(NOT mw_library)
  set(mw_library manyworlds::manyworlds)
endif()

# mw_interface(TARGET): what those who link it compile with.
function(mw_interface target)
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_include_directories(${target} INTERFACE
    "$<TARGET_PROPERTY:${mw_library},INTERFACE_INCLUDE_DIRECTORIES>")
  target_link_libraries(${target} INTERFACE Eigen3::Eigen)
endfunction()

# mw_uses(TARGET LIBRARY [SHARED]): links an archive of a component, and instead of the archive of manyworlds
# that it is linked with, manyworlds_shared or SHARED.
function(mw_uses target library)
  set(shared manyworlds_shared)
  if(ARGC GREATER 2)
    set(shared ${ARGV2})
  endif()
  get_target_property(type ${library} TYPE)
  if(type STREQUAL SHARED_LIBRARY)
    target_link_libraries(${target} PRIVATE ${library})
  endif()
  target_link_libraries(${target} PRIVATE "$<TARGET_FILE:${library}>" ${shared})
  add_dependencies(${target} ${library})
endfunction()

get_target_property(mw_library_type ${mw_library} TYPE)
if(TARGET manyworlds_shared)
  # Made before, or imported.
elseif(mw_library_type STREQUAL SHARED_LIBRARY)
  add_library(manyworlds_shared INTERFACE)
  target_link_libraries(manyworlds_shared INTERFACE ${mw_library})
else()
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/manyworlds_shared.cpp" CONTENT "")
  add_library(manyworlds_shared SHARED "${CMAKE_CURRENT_BINARY_DIR}/manyworlds_shared.cpp")
  set_target_properties(manyworlds_shared PROPERTIES OUTPUT_NAME manyworlds)
  target_link_libraries(manyworlds_shared PRIVATE "$<LINK_LIBRARY:WHOLE_ARCHIVE,${mw_library}>")
  target_link_options(manyworlds_shared PRIVATE -Wl,-Bsymbolic-functions)
  mw_interface(manyworlds_shared)
endif()
