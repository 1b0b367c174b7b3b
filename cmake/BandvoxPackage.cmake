# `cpack` in a build folder makes packages for Debian of what is installed: the library, what is
# needed to build with it, the command and the Python package. scripts/check-debs tries them.
set(BANDVOX_PACKAGE_CONTACT "Bandvox maintainers <maintainers@bandvox.example>" CACHE STRING
    "Who answers for the packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bandvox)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_CONTACT "${BANDVOX_PACKAGE_CONTACT}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL library development)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(_full_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(_this_library
    "libbandvox${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} (= ${_full_version})")
# The first line of all descriptions is the project's.
set(_about "Bandvox turns meshes, formulas, points and scans into OpenVDB volumes that\n\
hold nothing finer than their voxels can carry, and draws pictures of them.\n\n")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libbandvox${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "libegl1, libopengl0, libgl1-mesa-dri")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_GENERATE_SHLIBS OFF)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA
    ${PROJECT_BINARY_DIR}/debian/shlibs ${PROJECT_BINARY_DIR}/debian/triggers)
# Who is linked to the library depends on its package. The module for images has a name, too.
set(_provided "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} \
${CPACK_DEBIAN_LIBRARY_PACKAGE_NAME} (>= ${PROJECT_VERSION})")
file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs
    "libbandvox ${_provided}\nlibbandvox-images ${_provided}\n")
file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "${_about}\
This is the library that the other packages work with.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbandvox-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "${_this_library}, libopenvdb-dev (>= 10), libtbb-dev, libimath-dev, \
libblosc-dev, libboost-iostreams-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "${_about}\
These are the headers and the descriptions for CMake and pkg-config.")

if(BANDVOX_BUILD_APPS)
    list(APPEND CPACK_COMPONENTS_ALL tools)
    set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME bandvox)
    set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
    set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
    set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "${_this_library}")
    set(CPACK_DEBIAN_TOOLS_DESCRIPTION "${_about}\
This is the command bandvox, with its manual pages and completion for shells.")
endif()

if(BANDVOX_BUILD_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-bandvox)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
    # A module is made for one version of Python alone.
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    math(EXPR _next "${Python3_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${_this_library}, python3-numpy, \
python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}~), \
python3 (<< ${Python3_VERSION_MAJOR}.${_next})")
    # bandvox.distributed runs the command on the workers of a Dask cluster.
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "bandvox (= ${_full_version}), python3-distributed")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
        ${PROJECT_SOURCE_DIR}/cmake/debian/postinst ${PROJECT_SOURCE_DIR}/cmake/debian/prerm)
    set(CPACK_DEBIAN_PYTHON_DESCRIPTION "${_about}\
This is the Python module bandvox, which works on NumPy's arrays.")
endif()

# The libraries of this project are found where they were built, and are in no package yet.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)

# What every package has beside its files, and what none may have.
set(BANDVOX_DEBIAN_DIR ${PROJECT_SOURCE_DIR}/cmake/debian)
configure_file(cmake/BandvoxPackageFiles.cmake.in ${PROJECT_BINARY_DIR}/BandvoxPackageFiles.cmake
    @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/BandvoxPackageFiles.cmake)
include(CPack)
