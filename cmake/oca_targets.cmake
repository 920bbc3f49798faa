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

# oca_library(NAME SOURCES... HEADERS... LINK... PRIVATE_LINK...) makes oca::NAME.
# PRIVATE_LINK are the third-party libraries that no public header shows.
function(oca_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;LINK;PRIVATE_LINK" ${ARGN})
  add_library(oca_${name} STATIC ${arg_SOURCES})
  add_library(oca::${name} ALIAS oca_${name})
  target_sources(oca_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}
                                                   FILES ${arg_HEADERS})
  target_link_libraries(oca_${name} PUBLIC ${arg_LINK}
                                    PRIVATE $<BUILD_INTERFACE:oca_flags> ${arg_PRIVATE_LINK})
  target_compile_features(oca_${name} PUBLIC cxx_std_20)
  set_target_properties(oca_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
                                               VERIFY_INTERFACE_HEADER_SETS ON)
  install(TARGETS oca_${name} EXPORT oca_targets
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/oca)
endfunction()

# oca_test(NAME SOURCES... LINK...) makes one test program; ctest runs each TEST on its own.
function(oca_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} oca_flags GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE OCA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES)
endfunction()
