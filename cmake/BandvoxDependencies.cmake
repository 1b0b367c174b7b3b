# What the library links against. Shared by the build and by the installed package, so that
# both find the same things in the same way.
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW3F REQUIRED IMPORTED_TARGET GLOBAL fftw3f)
pkg_check_modules(FFTW3 REQUIRED IMPORTED_TARGET GLOBAL fftw3)
find_package(TBB REQUIRED CONFIG)
find_package(assimp REQUIRED CONFIG)
find_package(OpenImageIO REQUIRED CONFIG)
if(NOT TARGET OpenVDB::openvdb)
    # OpenVDB ships its find module beside its libraries, in a folder CMake does not search.
    find_path(BANDVOX_OPENVDB_MODULE_DIR FindOpenVDB.cmake
        PATHS /usr/lib /usr/local/lib ${CMAKE_PREFIX_PATH}
        PATH_SUFFIXES cmake/OpenVDB ${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB
                      lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB
        REQUIRED)
    mark_as_advanced(BANDVOX_OPENVDB_MODULE_DIR)
    list(APPEND CMAKE_MODULE_PATH "${BANDVOX_OPENVDB_MODULE_DIR}")
    find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
    list(REMOVE_ITEM CMAKE_MODULE_PATH "${BANDVOX_OPENVDB_MODULE_DIR}")
endif()
