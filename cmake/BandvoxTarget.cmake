# Settings common to every target of the project: warnings and sanitizers.
function(bandvox_configure_target target)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align
        -Wimplicit-fallthrough -Wno-missing-field-initializers
        $<$<BOOL:${BANDVOX_WARNINGS_AS_ERRORS}>:-Werror>)
    if(BANDVOX_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${BANDVOX_SANITIZE}
            -fno-omit-frame-pointer -fno-sanitize-recover=all)
        target_link_options(${target} PUBLIC -fsanitize=${BANDVOX_SANITIZE})
        if(BANDVOX_SANITIZE MATCHES "thread")
            target_compile_definitions(${target} PRIVATE BANDVOX_THREAD_SANITIZER)
        endif()
    endif()
endfunction()
