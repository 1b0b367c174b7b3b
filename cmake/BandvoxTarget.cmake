# Settings common to every target of the project: warnings and sanitizers.
function(bandvox_configure_target target)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
        -Wimplicit-fallthrough -Wno-missing-field-initializers
        $<$<BOOL:${BANDVOX_WARNINGS_AS_ERRORS}>:-Werror>)
    if(BANDVOX_FUZZ)
        target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
    if(BANDVOX_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${BANDVOX_SANITIZE}
            -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_link_options(${target} PUBLIC -fsanitize=${BANDVOX_SANITIZE})
        if(BANDVOX_SANITIZE MATCHES "thread")
            target_compile_definitions(${target} PRIVATE BANDVOX_THREAD_SANITIZER)
        endif()
    endif()
endfunction()

# Under BANDVOX_UNITY_BUILD compiles up to seven sources of a folder as one: loading OpenVDB's
# precompiled header takes longer than most of them. Not more, so that a change stays cheap.
function(bandvox_unite target)
    if(NOT BANDVOX_UNITY_BUILD)
        return()
    endif()
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    set(folders "")
    foreach(source IN LISTS sources)
        get_filename_component(folder ${source} DIRECTORY)
        get_filename_component(folder ${folder} NAME)
        list(APPEND folders ${folder})
        list(APPEND sources_${folder} ${source})
    endforeach()
    list(REMOVE_DUPLICATES folders)
    foreach(folder IN LISTS folders)
        # Spread them evenly.
        list(LENGTH sources_${folder} count)
        math(EXPR batches "(${count} + 6) / 7")
        set(index 0)
        foreach(source IN LISTS sources_${folder})
            math(EXPR batch "${index} * ${batches} / ${count}")
            set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${batch})
            math(EXPR index "${index} + 1")
        endforeach()
    endforeach()
    # This warning takes sources for headers when they are included.
    target_compile_options(${target} PRIVATE
        $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
