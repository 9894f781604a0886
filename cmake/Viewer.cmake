# The pages that show recordings and reports, viewer/: bundled by Node into a file each,
# <build>/viewer/viewer.html and report.html, which `manyworlds view` and `report` find beside the
# program.

set(mw_viewer_node_least 18)
find_program(MW_NODE node)
find_program(MW_NPM npm)
mark_as_advanced(MW_NODE MW_NPM)
if(NOT MW_NODE OR NOT MW_NPM)
  message(FATAL_ERROR "MW_VIEWER=ON wants Node ${mw_viewer_node_least} or later and npm "
                      "(Debian: nodejs npm)")
endif()
execute_process(COMMAND "${MW_NODE}" --version OUTPUT_VARIABLE mw_node_version
                OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REGEX REPLACE "^v" "" mw_node_version "${mw_node_version}")
if(mw_node_version VERSION_LESS mw_viewer_node_least)
  message(FATAL_ERROR "MW_VIEWER=ON wants Node ${mw_viewer_node_least} or later; ${MW_NODE} is "
                      "${mw_node_version}")
endif()

# Its packages are put beside a copy of what asks for them, so that the sources stay as they are.
set(mw_viewer_dir "${PROJECT_BINARY_DIR}/viewer")
set(mw_viewer_page "${mw_viewer_dir}/viewer.html")
set(mw_report_page "${mw_viewer_dir}/report.html")
set(mw_viewer_licenses "${mw_viewer_dir}/LICENSES.txt")  # of what the pages bundle
set(mw_viewer_packages "${mw_viewer_dir}/node_modules/.package-lock.json")
file(GLOB mw_viewer_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/viewer/src/*.*"
  "${PROJECT_SOURCE_DIR}/viewer/src/report/*.*" "${PROJECT_SOURCE_DIR}/viewer/*.mjs" "${PROJECT_SOURCE_DIR}/viewer/tsconfig.json")
add_custom_command(OUTPUT "${mw_viewer_packages}"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "${PROJECT_SOURCE_DIR}/viewer/package.json"
          "${PROJECT_SOURCE_DIR}/viewer/package-lock.json" "${mw_viewer_dir}"
  COMMAND ${CMAKE_COMMAND} -E env PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1
          "${MW_NPM}" ci --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch "${mw_viewer_packages}"
  WORKING_DIRECTORY "${mw_viewer_dir}"
  DEPENDS "${PROJECT_SOURCE_DIR}/viewer/package.json" "${PROJECT_SOURCE_DIR}/viewer/package-lock.json"
  COMMENT "Fetching the packages of the viewer" VERBATIM)
add_custom_command(OUTPUT "${mw_viewer_page}" "${mw_report_page}" "${mw_viewer_licenses}"
  COMMAND ${CMAKE_COMMAND} -E copy_directory "${PROJECT_SOURCE_DIR}/viewer/src" "${mw_viewer_dir}/src"
  COMMAND ${CMAKE_COMMAND} -E copy_if_different "${PROJECT_SOURCE_DIR}/viewer/build.mjs"
          "${PROJECT_SOURCE_DIR}/viewer/tsconfig.json" "${mw_viewer_dir}"
  COMMAND "${MW_NODE}" node_modules/typescript/bin/tsc --noEmit
  COMMAND "${MW_NODE}" build.mjs "${mw_viewer_dir}"
  WORKING_DIRECTORY "${mw_viewer_dir}"
  DEPENDS "${mw_viewer_packages}" ${mw_viewer_sources}
  COMMENT "Bundling the viewer" VERBATIM)
file(MAKE_DIRECTORY "${mw_viewer_dir}")
add_custom_target(mw_viewer ALL DEPENDS "${mw_viewer_page}" "${mw_report_page}" "${mw_viewer_licenses}")

if(MW_INSTALL)
  # With the library, since wheels are made of that, and with the program.
  foreach(component IN ITEMS library program)
    install(FILES "${mw_viewer_page}" DESTINATION "${CMAKE_INSTALL_DATADIR}/manyworlds"
            COMPONENT ${component})
  endforeach()
  install(FILES "${mw_report_page}" DESTINATION "${CMAKE_INSTALL_DATADIR}/manyworlds"
          COMPONENT program)
  add_dependencies(mw_libraries mw_viewer)
endif()

# The pages in a real browser, one that Debian has.
if(MW_TESTS AND TARGET manyworlds_cli AND NOT MW_SANITIZE)
  find_program(MW_CHROMIUM NAMES chromium chromium-browser google-chrome)
  mark_as_advanced(MW_CHROMIUM)
  function(mw_browser_test name timeout)
    add_test(NAME viewer_${name}
      COMMAND "${MW_NODE}" --test-reporter=spec --test "${PROJECT_SOURCE_DIR}/viewer/test/${name}.test.mjs"
      WORKING_DIRECTORY "${mw_viewer_dir}")
    set_tests_properties(viewer_${name} PROPERTIES TIMEOUT ${timeout} COST 700 ENVIRONMENT
      "MANYWORLDS_CLI=$<TARGET_FILE:manyworlds_cli>;MANYWORLDS_VIEWER=${mw_viewer_page};\
MANYWORLDS_REPORT=${mw_report_page};CHROMIUM=${MW_CHROMIUM};\
PLAYWRIGHT=${mw_viewer_dir}/node_modules/playwright-core/index.mjs")
  endfunction()
  if(MW_RECORD)
    mw_browser_test(browser 900)
    mw_browser_test(numbers 300)
    mw_browser_test(film 300)
    set_tests_properties(viewer_browser PROPERTIES COST 800)
  endif()
  if(MW_LIVE)
    mw_browser_test(live 300)
  endif()
  if(MW_REPORT)
    mw_browser_test(report 300)
  endif()
endif()
