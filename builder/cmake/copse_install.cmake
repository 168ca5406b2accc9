# `cmake --install`: the program, both libraries with their headers, and the package that find_package(copse) reads.
include(CMakePackageConfigHelpers)

set(copse_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/copse)
install(TARGETS copse_builder copse_scene copse_generators copse_tracer copse_bench EXPORT copse_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS copse RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT copse_targets NAMESPACE copse:: DESTINATION ${copse_package_dir} FILE copse-targets.cmake)
# Under include/copse as here, so that an installed header finds the others by the names that it has for them.
install(DIRECTORY builder DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/copse FILES_MATCHING PATTERN "*.h")
foreach(room IN ITEMS accel bench generators image integrators lights materials report scene session)
  install(DIRECTORY tracer/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/copse/tracer FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY scenes configs DESTINATION ${CMAKE_INSTALL_DATADIR}/copse FILES_MATCHING PATTERN "*.toml")

configure_package_config_file(builder/cmake/copse-config.cmake.in ${PROJECT_BINARY_DIR}/copse-config.cmake
                              INSTALL_DESTINATION ${copse_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/copse-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/copse-config.cmake ${PROJECT_BINARY_DIR}/copse-config-version.cmake
              builder/cmake/copse_image_test.cmake builder/cmake/copse_image_test_run.cmake
        DESTINATION ${copse_package_dir})
