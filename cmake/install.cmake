# `cmake --install`: the program, the library, and the package that find_package(lambent) finds.
option(LAMBENT_INSTALL "Write rules for cmake --install" ${PROJECT_IS_TOP_LEVEL})
if(NOT LAMBENT_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lambent)

install(TARGETS lambent_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS lambent EXPORT lambent ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lambent DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT lambent FILE lambent-targets.cmake NAMESPACE lambent:: DESTINATION ${package_dir})

# The library is static: who links it links what it stands on, so the package looks for the same libraries.
# Embree's major versions are not interchangeable; of the others, any version that is compatible will do.
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lambent-config.cmake.in ${PROJECT_BINARY_DIR}/lambent-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lambent-config-version.cmake
  VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lambent-config.cmake ${PROJECT_BINARY_DIR}/lambent-config-version.cmake
  DESTINATION ${package_dir})

# LICENSE.DejaVu goes wherever the font goes, and the library has it inside.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/LICENSE.DejaVu ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# For editors: completes scene files and marks their errors.
install(FILES ${PROJECT_SOURCE_DIR}/docs/lambent.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/lambent)
