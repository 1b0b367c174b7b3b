# Debian's package of OpenImageIO names OpenCV's headers, which nothing of ours needs and which
# need not be there; then CMake refuses whatever links to it. Shared by the build and by the
# installed package. Takes folders away that are not there, and nothing else.
function(bandvox_mend_openimageio)
    get_target_property(imported OpenImageIO::OpenImageIO IMPORTED)
    get_target_property(folders OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
    if(NOT imported OR NOT folders)
        return()
    endif()
    set(present ${folders})
    foreach(folder IN LISTS folders)
        if(IS_ABSOLUTE "${folder}" AND NOT EXISTS "${folder}")
            list(REMOVE_ITEM present "${folder}")
        endif()
    endforeach()
    if(NOT present STREQUAL folders)
        set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
            INTERFACE_INCLUDE_DIRECTORIES "${present}")
    endif()
endfunction()
