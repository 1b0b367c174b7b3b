# Install the package so that find_package(Bandvox) works from another project.
include(CMakePackageConfigHelpers)

set(_config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Bandvox)
install(EXPORT BandvoxTargets NAMESPACE Bandvox:: DESTINATION ${_config_dir})
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
    DESTINATION ${_config_dir})
