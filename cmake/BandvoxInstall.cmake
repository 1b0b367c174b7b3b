# Install the package so that find_package(Bandvox) works from another project.
include(CMakePackageConfigHelpers)

set(_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Bandvox)
install(EXPORT BandvoxTargets NAMESPACE Bandvox:: DESTINATION ${_config_dir}
    COMPONENT development)
get_target_property(BANDVOX_LIBRARY_TYPE bandvox TYPE)
configure_package_config_file(cmake/BandvoxConfig.cmake.in
    ${CMAKE_CURRENT_BINARY_DIR}/BandvoxConfig.cmake INSTALL_DESTINATION ${_config_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/BandvoxConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES
    ${CMAKE_CURRENT_BINARY_DIR}/BandvoxConfig.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/BandvoxConfigVersion.cmake
    cmake/BandvoxFindOpenVDB.cmake
    cmake/BandvoxMendOpenImageIO.cmake
    DESTINATION ${_config_dir} COMPONENT development)

# And for those that build without CMake. A static library needs more than can be said there.
if(BANDVOX_LIBRARY_TYPE STREQUAL "SHARED_LIBRARY")
    file(RELATIVE_PATH BANDVOX_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
    string(REGEX REPLACE "/$" "" BANDVOX_PC_TO_PREFIX "${BANDVOX_PC_TO_PREFIX}")
    configure_file(cmake/bandvox.pc.in ${CMAKE_CURRENT_BINARY_DIR}/bandvox.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/bandvox.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()
