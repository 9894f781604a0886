# Engines that are installed, as targets; one that is not has none.

find_package(box2d QUIET CONFIG)
find_package(MuJoCo QUIET)

# Bullet's own package file names folders and libraries relative to one another.
find_package(Bullet QUIET MODULE)
if(BULLET_FOUND)
  add_library(bullet INTERFACE)
  target_include_directories(bullet SYSTEM INTERFACE ${BULLET_INCLUDE_DIRS})
  target_link_libraries(bullet INTERFACE ${BULLET_LIBRARIES})
endif()
