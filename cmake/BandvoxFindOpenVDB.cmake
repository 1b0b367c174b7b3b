# Finds OpenVDB; takes REQUIRED and QUIET as find_package does. Shared by the build and by the
# installed package. A function, because OpenVDB's find module sets BUILD_SHARED_LIBS.
function(bandvox_find_openvdb)
    if(TARGET OpenVDB::openvdb)
        set(OpenVDB_FOUND TRUE PARENT_SCOPE)
        return()
    endif()
    # OpenVDB ships its find module beside its libraries, in a folder CMake does not search.
    find_path(BANDVOX_OPENVDB_MODULE_DIR FindOpenVDB.cmake
        PATHS /usr/lib /usr/local/lib ${CMAKE_PREFIX_PATH}
        PATH_SUFFIXES cmake/OpenVDB ${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB
                      lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
    mark_as_advanced(BANDVOX_OPENVDB_MODULE_DIR)
    if(BANDVOX_OPENVDB_MODULE_DIR)
        list(APPEND CMAKE_MODULE_PATH "${BANDVOX_OPENVDB_MODULE_DIR}")
    endif()
    if(NOT "REQUIRED" IN_LIST ARGN)
        # Without these the module stops CMake, even if OpenVDB need not be found.
        find_package(TBB QUIET COMPONENTS tbb)
        find_package(Boost QUIET COMPONENTS iostreams)
        if(NOT TBB_FOUND OR NOT Boost_FOUND)
            set(OpenVDB_FOUND FALSE PARENT_SCOPE)
            return()
        endif()
    endif()
    find_package(OpenVDB 10 ${ARGN} COMPONENTS openvdb)
    set(OpenVDB_FOUND ${OpenVDB_FOUND} PARENT_SCOPE)
endfunction()
