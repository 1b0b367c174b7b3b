# What the library links against. Shared by the build and by the installed package, so that
# both find the same things in the same way.
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW3F REQUIRED IMPORTED_TARGET GLOBAL fftw3f)
pkg_check_modules(FFTW3 REQUIRED IMPORTED_TARGET GLOBAL fftw3)
find_package(TBB REQUIRED CONFIG)
find_package(assimp REQUIRED CONFIG)
find_package(OpenImageIO REQUIRED CONFIG)
# Debian's package names OpenCV's headers, which nothing of ours needs and which need not be there.
get_target_property(_folders OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
foreach(_folder IN LISTS _folders)
    if(IS_ABSOLUTE "${_folder}" AND NOT EXISTS "${_folder}")
        list(REMOVE_ITEM _folders "${_folder}")
    endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${_folders}")
unset(_folders)
unset(_folder)
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
