# The installed package: find_package(pellucid) gives pellucid::pellucid.
include(CMakePackageConfigHelpers)
set(PELLUCID_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/pellucid)

install(TARGETS pellucid EXPORT pellucidTargets)
if(TARGET pellucid_cli)
    install(TARGETS pellucid_cli)
endif()
install(DIRECTORY include/pellucid DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT pellucidTargets NAMESPACE pellucid:: DESTINATION ${PELLUCID_CONFIG_DIR})

get_target_property(PELLUCID_LIBRARY_KIND pellucid TYPE)
configure_package_config_file(cmake/pellucidConfig.cmake.in ${PROJECT_BINARY_DIR}/pellucidConfig.cmake
                              INSTALL_DESTINATION ${PELLUCID_CONFIG_DIR})
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pellucidConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pellucidConfig.cmake ${PROJECT_BINARY_DIR}/pellucidConfigVersion.cmake
        DESTINATION ${PELLUCID_CONFIG_DIR})
