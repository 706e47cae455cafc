# What `cmake --install` lays down: headers, both libraries, a pkg-config file and a CMake package. Every path is
# relative to the file that names it, so that an installed prefix can be moved.
include(CMakePackageConfigHelpers)

set(LIGHTBAND_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/lightband)
set(LIGHTBAND_PKGCONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lightband DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")

# Two export sets: whoever links the shared library needs none of its dependencies' packages. (pkg-config asks for them all the same:
# Requires.private.)
install(TARGETS lightband EXPORT lightbandTargets)
install(TARGETS lightband_static EXPORT lightbandStaticTargets)
install(EXPORT lightbandTargets NAMESPACE lightband:: DESTINATION ${LIGHTBAND_CMAKE_DIR})
install(EXPORT lightbandStaticTargets NAMESPACE lightband:: DESTINATION ${LIGHTBAND_CMAKE_DIR})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lightbandConfig.cmake.in
  ${PROJECT_BINARY_DIR}/lightbandConfig.cmake INSTALL_DESTINATION ${LIGHTBAND_CMAKE_DIR})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lightbandConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lightbandConfig.cmake ${PROJECT_BINARY_DIR}/lightbandConfigVersion.cmake
  DESTINATION ${LIGHTBAND_CMAKE_DIR})

cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${LIGHTBAND_PKGCONFIG_DIR}
  OUTPUT_VARIABLE LIGHTBAND_PREFIX_FROM_PKGCONFIG)
configure_file(${PROJECT_SOURCE_DIR}/pkgconfig/lightband.pc.in ${PROJECT_BINARY_DIR}/lightband.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/lightband.pc DESTINATION ${LIGHTBAND_PKGCONFIG_DIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
