# SPDX-License-Identifier: BSD-3-Clause
include(CMakePackageConfigHelpers)
set(cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/oca)
install(EXPORT oca_targets NAMESPACE oca:: FILE oca_targets.cmake DESTINATION ${cmake_dir})
set(OCA_DATA_FOLDER ${CMAKE_INSTALL_DATADIR}/oca)
configure_package_config_file(cmake/oca-config.cmake.in oca-config.cmake
                              INSTALL_DESTINATION ${cmake_dir} PATH_VARS OCA_DATA_FOLDER)
write_basic_package_version_file(oca-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/oca-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/oca-config-version.cmake cmake/oca_packages.cmake
              cmake/oca_data_folder.cc
        DESTINATION ${cmake_dir})
install(DIRECTORY models/robots models/worlds DESTINATION ${CMAKE_INSTALL_DATADIR}/oca/models)
# One by one: install(DIRECTORY) makes the folders of the sources too, empty.
file(GLOB_RECURSE diagrams RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS diagrams/*.yaml)
foreach(diagram ${diagrams})
  cmake_path(GET diagram PARENT_PATH folder)
  install(FILES ${diagram} DESTINATION ${CMAKE_INSTALL_DATADIR}/oca/${folder})
endforeach()
