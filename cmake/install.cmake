# `cmake --install`: the program with its data, and the methods as a library for find_package(textonbench).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/textonbench)
set(data_dir ${CMAKE_INSTALL_DATADIR}/textonbench)

install(TARGETS textonbench)
install(DIRECTORY configs DESTINATION ${data_dir})
install(DIRECTORY paper_figures/templates DESTINATION ${data_dir}/paper_figures)

install(TARGETS textonbench_methods EXPORT textonbench_targets)
install(DIRECTORY methods DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/textonbench FILES_MATCHING PATTERN *.h)
install(EXPORT textonbench_targets NAMESPACE textonbench:: FILE textonbenchTargets.cmake DESTINATION ${package_dir})

configure_package_config_file(cmake/textonbenchConfig.cmake.in ${PROJECT_BINARY_DIR}/textonbenchConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/textonbenchConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/textonbenchConfig.cmake ${PROJECT_BINARY_DIR}/textonbenchConfigVersion.cmake
              cmake/dependencies.cmake
        DESTINATION ${package_dir})
