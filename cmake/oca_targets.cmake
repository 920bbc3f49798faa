# SPDX-License-Identifier: BSD-3-Clause
include(GNUInstallDirs)
include(GoogleTest)

# The one place where compiler flags live.
add_library(oca_flags INTERFACE)
target_compile_features(oca_flags INTERFACE cxx_std_20)
target_compile_options(oca_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
option(OCA_WARNINGS_AS_ERRORS "Warnings stop the build" ON)
if(OCA_WARNINGS_AS_ERRORS)
  target_compile_options(oca_flags INTERFACE -Werror)
endif()

# Includes carry the project's name, here as in an installed tree: <oca/framework/...>.
set(OCA_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${OCA_INCLUDE_DIR}/oca)
foreach(room framework models systems diagrams tools)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${room} ${OCA_INCLUDE_DIR}/oca/${room} SYMBOLIC)
endforeach()

# oca_library(NAME [FOLDERS...] [PUBLIC_HEADERS...|INTERNAL_HEADERS...] LINK... PRIVATE_LINK...) makes
# oca::NAME of the sources and headers in this folder, and in its FOLDERS. Its headers are public, and
# so installed: PUBLIC_HEADERS, or all but INTERNAL_HEADERS and those of a namespace `internal`.
# PRIVATE_LINK are the third-party libraries that no public header shows.
function(oca_library name)
  cmake_parse_arguments(arg "" "" "FOLDERS;PUBLIC_HEADERS;INTERNAL_HEADERS;LINK;PRIVATE_LINK" ${ARGN})
  set(sources)
  set(headers)
  foreach(folder . ${arg_FOLDERS})
    file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${folder}/*.cc)
    list(APPEND sources ${found})
    file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${folder}/*.h)
    list(APPEND headers ${found})
  endforeach()
  if(arg_PUBLIC_HEADERS)
    set(headers ${arg_PUBLIC_HEADERS})
  endif()
  list(REMOVE_ITEM headers "" ${arg_INTERNAL_HEADERS})
  foreach(header ${headers})
    file(STRINGS ${header} internal REGEX "^namespace oca(::[a-z]+)*::internal {")
    file(STRINGS ${header} public REGEX "^namespace oca(::[a-z]+)* {")
    if(internal AND "${public}" STREQUAL "${internal}")
      list(REMOVE_ITEM headers ${header})
    endif()
  endforeach()
  file(RELATIVE_PATH room ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  list(TRANSFORM headers PREPEND ${OCA_INCLUDE_DIR}/oca/${room}/)
  add_library(oca_${name} STATIC ${sources})
  add_library(oca::${name} ALIAS oca_${name})
  target_sources(oca_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${OCA_INCLUDE_DIR} FILES ${headers})
  target_link_libraries(oca_${name} PUBLIC ${arg_LINK}
                                    PRIVATE $<BUILD_INTERFACE:oca_flags> ${arg_PRIVATE_LINK})
  target_compile_features(oca_${name} PUBLIC cxx_std_20)
  set_target_properties(oca_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                                               VERIFY_INTERFACE_HEADER_SETS ON)
  install(TARGETS oca_${name} EXPORT oca_targets
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# oca_embed(NAME FILE CONSTANT) lets the sources of oca::NAME include <FILE.h>, where the std::string_view
# CONSTANT is the text of FILE, of this folder.
function(oca_embed name file constant)
  file(READ ${file} text)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(CONFIGURE OUTPUT embedded/${file}.h @ONLY CONTENT [[
// Made of @file@ by CMake.
#pragma once
#include <string_view>
constexpr std::string_view @constant@ = R"embedded(@text@)embedded";
]])
  target_include_directories(oca_${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/embedded)
endfunction()

# oca_test(NAME [SOURCES...] [COUNTS_ALLOCATIONS] [RUNS_SIMULATOR] [FOLDERS...] LINK...) makes one test program of
# SOURCES, or all sources in this folder and its FOLDERS; ctest runs each TEST on its own.
function(oca_test name)
  cmake_parse_arguments(arg "COUNTS_ALLOCATIONS;RUNS_SIMULATOR" "" "SOURCES;FOLDERS;LINK" ${ARGN})
  set(sources ${arg_SOURCES})
  if(NOT sources)
    foreach(folder . ${arg_FOLDERS})
      file(GLOB found CONFIGURE_DEPENDS ${folder}/*.cc)
      list(APPEND sources ${found})
    endforeach()
  endif()
  if(arg_COUNTS_ALLOCATIONS)
    list(APPEND sources ${PROJECT_SOURCE_DIR}/tests/allocation_count.cc)
  endif()
  add_executable(${name} ${sources})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${OCA_INCLUDE_DIR})
  target_link_libraries(${name} PRIVATE ${arg_LINK} oca_flags GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE OCA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(arg_RUNS_SIMULATOR)
    add_dependencies(${name} simulator)
    target_compile_definitions(${name} PRIVATE SIMULATOR="$<TARGET_FILE:simulator>")
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES)
endfunction()
