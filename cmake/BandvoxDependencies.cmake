# What the build links against. BandvoxConfig.cmake.in finds the same for the installed package.
include(BandvoxFindOpenVDB)
include(BandvoxMendOpenImageIO)

# A project that adds this one as a folder links to them as well, from outside of it.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(PkgConfig REQUIRED)
pkg_check_modules(FFTW3F REQUIRED IMPORTED_TARGET GLOBAL fftw3f)
pkg_check_modules(FFTW3 REQUIRED IMPORTED_TARGET GLOBAL fftw3)
# CGAL is headers alone; its own description would set options for all that includes it.
find_path(BANDVOX_CGAL_INCLUDE_DIR CGAL/version.h REQUIRED)
# So is Eigen, which CGAL solves sparse systems with.
find_path(BANDVOX_EIGEN_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
pkg_check_modules(GMP REQUIRED IMPORTED_TARGET GLOBAL gmp)
pkg_check_modules(MPFR REQUIRED IMPORTED_TARGET GLOBAL mpfr)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET GLOBAL epoxy)
find_package(TBB REQUIRED CONFIG)
find_package(assimp REQUIRED CONFIG)
find_package(OpenEXR REQUIRED CONFIG)
find_package(ZLIB REQUIRED)
find_package(OpenImageIO REQUIRED CONFIG)
find_package(DCMTK REQUIRED CONFIG)
bandvox_mend_openimageio()
bandvox_find_openvdb(REQUIRED)

# Open CASCADE's own description asks for all of its libraries, down to those of its test harness.
if(BANDVOX_WITH_OPENCASCADE)
    find_path(BANDVOX_OPENCASCADE_INCLUDE_DIR STEPControl_Reader.hxx
        PATH_SUFFIXES opencascade REQUIRED)
    set(BANDVOX_OPENCASCADE_LIBRARIES "")
    foreach(_name TKSTEP TKSTEPBase TKIGES TKXSBase TKTopAlgo TKBRep TKGeomAlgo TKGeomBase TKG3d
        TKG2d TKMath TKernel)
        find_library(BANDVOX_OPENCASCADE_${_name} ${_name} REQUIRED)
        mark_as_advanced(BANDVOX_OPENCASCADE_${_name})
        list(APPEND BANDVOX_OPENCASCADE_LIBRARIES ${BANDVOX_OPENCASCADE_${_name}})
    endforeach()
endif()
