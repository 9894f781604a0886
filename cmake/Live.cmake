# manyworlds::live: a batch in a browser while it steps. A library of its own because it needs Boost (its
# headers alone: Asio and Beast, for HTTP and WebSocket).

find_package(Boost 1.74 QUIET)
if(NOT Boost_FOUND)
  message(FATAL_ERROR "MW_LIVE=ON wants the headers of Boost 1.74 or later (Debian: libboost-dev)")
endif()
find_package(nlohmann_json REQUIRED CONFIG)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)

mw_sources(mw_live_sources "src/live/*.cpp" "src/page/*.cpp")
mw_library(manyworlds_live ${mw_live_sources})
add_library(manyworlds::live ALIAS manyworlds_live)
set_target_properties(manyworlds_live PROPERTIES EXPORT_NAME live)
target_include_directories(manyworlds_live PRIVATE "${PROJECT_SOURCE_DIR}")
target_include_directories(manyworlds_live SYSTEM PRIVATE "${Boost_INCLUDE_DIRS}")
target_compile_definitions(manyworlds_live PRIVATE BOOST_ERROR_CODE_HEADER_ONLY BOOST_ASIO_NO_DEPRECATED)
if(MW_SANITIZE MATCHES thread)
  # GCC refuses fences there, which TSan does not know; Asio's locks order what they do as well.
  target_compile_definitions(manyworlds_live PRIVATE BOOST_ASIO_DISABLE_FENCED_BLOCK)
endif()
# Nothing here is hot, and Beast is slow to compile.
target_compile_options(manyworlds_live PRIVATE -O1)
target_link_libraries(manyworlds_live PUBLIC manyworlds
  PRIVATE Threads::Threads ZLIB::ZLIB $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
mw_precompile(manyworlds_live)
mw_unity(manyworlds_live)
