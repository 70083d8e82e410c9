# SPDX-License-Identifier: Apache-2.0
# `find_package(mapweld CONFIG)` gives mapweld::core, mapweld::drivers and the message types.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/mapweld)
install(EXPORT mapweld NAMESPACE mapweld:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/toolchain/cmake/mapweld-config.cmake.in
                              ${PROJECT_BINARY_DIR}/mapweld-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mapweld-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mapweld-config.cmake ${PROJECT_BINARY_DIR}/mapweld-config-version.cmake
              ${PROJECT_SOURCE_DIR}/toolchain/cmake/FindCcd.cmake
        DESTINATION ${package_dir})
install(DIRECTORY core drivers DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mapweld FILES_MATCHING PATTERN "*.hpp")
