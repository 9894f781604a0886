# The program manyworlds, build/<preset>/bin/manyworlds.

find_package(CLI11 REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)

include("${CMAKE_CURRENT_LIST_DIR}/Invariants.cmake")
mw_sources(mw_cli_sources "tools/report/*.cpp" "tools/cli/*.cpp")
list(FILTER mw_cli_sources EXCLUDE REGEX "/cli/no_invariants\\.cpp$")  # of wheels
if(MW_REPORT)
  list(FILTER mw_cli_sources EXCLUDE REGEX "/cli/no_reports\\.cpp$")
else()
  list(FILTER mw_cli_sources EXCLUDE REGEX "/tools/report/|/cli/(report_command|invariant_world)\\.cpp$")
endif()
add_executable(manyworlds_cli ${mw_cli_sources})
set_target_properties(manyworlds_cli PROPERTIES OUTPUT_NAME manyworlds)
target_include_directories(manyworlds_cli PRIVATE "${PROJECT_SOURCE_DIR}")
# Nothing here is hot, and CLI11 is slow to compile.
target_compile_options(manyworlds_cli PRIVATE -O1)
if(MW_SANITIZE MATCHES address)
  target_compile_options(manyworlds_cli PRIVATE -O0)  # half of -O1's time
endif()
target_compile_definitions(manyworlds_cli PRIVATE MW_VERSION="${PROJECT_VERSION}")
target_link_libraries(manyworlds_cli PRIVATE
  manyworlds manyworlds_tools_base CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json
  Threads::Threads)
if(MW_REPORT)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_invariants)
endif()
mw_precompile(manyworlds_cli <fmt/format.h>)
mw_unity(manyworlds_cli GROUPS 2)
if(MW_MJCF)
  mw_define(tools/cli/mjcf_file.cpp MW_HAVE_MJCF=1)
  mw_define(tools/cli/compare_command.cpp MW_HAVE_MJCF=1)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_mjcf manyworlds_compare)
endif()
if(MW_RECORD)
  mw_define(tools/cli/recording.cpp MW_HAVE_RECORD=1)
  mw_define(tools/cli/replay_command.cpp MW_HAVE_RECORD=1)
  mw_define(tools/cli/view_command.cpp MW_HAVE_RECORD=1)
  mw_define(tools/cli/view_frames.cpp MW_HAVE_RECORD=1)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_record)
endif()
if(MW_LIVE)
  mw_define(tools/cli/live_command.cpp MW_HAVE_LIVE=1)
  target_link_libraries(manyworlds_cli PRIVATE manyworlds_live)
endif()
# Scripts that complete the program's commands in shells, made by itself.
if(NOT CMAKE_CROSSCOMPILING)
  set(mw_completion "${PROJECT_BINARY_DIR}/completion")
  file(MAKE_DIRECTORY "${mw_completion}")
  add_custom_command(TARGET manyworlds_cli POST_BUILD
    COMMAND manyworlds_cli completion bash > "${mw_completion}/manyworlds"
    COMMAND manyworlds_cli completion zsh > "${mw_completion}/_manyworlds"
    VERBATIM)
  if(MW_INSTALL)
    install(FILES "${mw_completion}/manyworlds" COMPONENT program
            DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
    install(FILES "${mw_completion}/_manyworlds" COMPONENT program
            DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions")
  endif()
endif()
if(MW_INSTALL)
  # From where it stands to the libraries that are installed with it.
  file(RELATIVE_PATH mw_to_libraries "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
  set_target_properties(manyworlds_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${mw_to_libraries}")
  install(TARGETS manyworlds_cli COMPONENT program)
endif()
