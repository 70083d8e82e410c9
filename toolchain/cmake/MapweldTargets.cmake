# SPDX-License-Identifier: Apache-2.0
# The three kinds of target in this project, each with its rules:
#   mapweld_agent_library(geom SOURCES a.cpp LINKS mapweld::base)   no heap, no exceptions, no RTTI
#   mapweld_host_library(merge SOURCES ... LINKS ...)               ordinary C++
#   mapweld_test(core/geom/so3_test.cpp LINKS mapweld::geom)        one GoogleTest program, found by ctest

add_library(mapweld_flags INTERFACE)
target_compile_features(mapweld_flags INTERFACE cxx_std_20)
# No fused multiply-add: the same bits from x86-64 and aarch64, and from every optimisation level.
target_compile_options(mapweld_flags INTERFACE -ffp-contract=off)
if(MAPWELD_MARCH)
  target_compile_options(mapweld_flags INTERFACE -march=${MAPWELD_MARCH})
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(mapweld_flags INTERFACE -march=x86-64-v2)
endif()
if(MAPWELD_SANITIZE)
  target_compile_options(mapweld_flags INTERFACE -fsanitize=${MAPWELD_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
  target_link_options(mapweld_flags INTERFACE -fsanitize=${MAPWELD_SANITIZE})
  if(MAPWELD_SANITIZE MATCHES undefined)
    # The agent's classes have no type information for this check to look at.
    target_compile_options(mapweld_flags INTERFACE -fno-sanitize=vptr)
  endif()
endif()
install(TARGETS mapweld_flags EXPORT mapweld)

set(MAPWELD_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wcast-align -Wcast-qual
    -Wdouble-promotion -Woverloaded-virtual -Wnon-virtual-dtor -Wvla)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # False alarm of GCC 12 on std::string at -O3 (GCC bug 105651).
  list(APPEND MAPWELD_WARNINGS -Wno-restrict)
  if(MAPWELD_SANITIZE)
    list(APPEND MAPWELD_WARNINGS -Wno-sign-conversion)  # GCC finds it in what its own instrumentation writes
  endif()
endif()
if(MAPWELD_WERROR)
  list(APPEND MAPWELD_WARNINGS -Werror)
endif()

function(_mapweld_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  if(ARG_SOURCES)
    add_library(mapweld_${name} STATIC ${ARG_SOURCES})
    set(scope PUBLIC)
    target_compile_options(mapweld_${name} PRIVATE ${MAPWELD_WARNINGS})
  else()
    add_library(mapweld_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(mapweld::${name} ALIAS mapweld_${name})
  set_target_properties(mapweld_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mapweld_${name} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/mapweld>)
  target_link_libraries(mapweld_${name} ${scope} mapweld_flags ${ARG_LINKS})
endfunction()

function(mapweld_agent_library name)
  _mapweld_library(${name} ${ARGN})
  get_target_property(type mapweld_${name} TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    target_compile_options(mapweld_${name} PRIVATE -fno-exceptions -fno-rtti -fno-threadsafe-statics
                                                   -ffunction-sections -fdata-sections)
  endif()
  install(TARGETS mapweld_${name} EXPORT mapweld)
  set_property(GLOBAL APPEND PROPERTY MAPWELD_AGENT_LIBRARIES mapweld_${name})
endfunction()

function(mapweld_host_library name)
  _mapweld_library(${name} ${ARGN})
endfunction()

# The test program's name is its path: core/geom/so3_test.cpp -> core.geom.so3_test. One ctest entry per program.
function(mapweld_test source)
  cmake_parse_arguments(ARG "" "TIMEOUT" "LINKS;LABELS;ARGS" ${ARGN})
  file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR}/${source})
  string(REGEX REPLACE "^unit/|\\.cpp$" "" name ${path})
  string(REPLACE "/" "." name ${name})
  add_executable(${name} ${source})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_compile_options(${name} PRIVATE ${MAPWELD_WARNINGS})
  target_link_libraries(${name} PRIVATE mapweld_flags ${ARG_LINKS} GTest::gmock GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} ${ARG_ARGS})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}"
                                          SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\] [0-9]+ test, listed below:.*PASSED  \\] 0 tests")
endfunction()
