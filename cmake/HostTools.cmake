# Programs of this project that run while it is built (relevo_make_ground, relevo_make_sky). Built for another
# machine they cannot: RELEVO_HOST_TOOLS then names a folder with those of a native build, or
# CMAKE_CROSSCOMPILING_EMULATOR runs them.
set(RELEVO_HOST_TOOLS "" CACHE PATH "Folder with relevo_make_ground and relevo_make_sky for the machine that builds")
add_custom_target(relevo_host_tools)

# relevo_maker(<target> OUTPUT <files>... ARGUMENTS <words>... [DEPENDS <files>...] COMMENT <text>)
#
# Makes files with a program of this build, or with the one of RELEVO_HOST_TOOLS that has its name.
function(relevo_maker target)
    cmake_parse_arguments(MAKER "" "COMMENT" "OUTPUT;ARGUMENTS;DEPENDS" ${ARGN})
    add_dependencies(relevo_host_tools ${target})
    set(program ${target})
    if(RELEVO_HOST_TOOLS)
        set(program ${RELEVO_HOST_TOOLS}/${target}${CMAKE_HOST_EXECUTABLE_SUFFIX})
        if(NOT EXISTS ${program})
            message(FATAL_ERROR "RELEVO_HOST_TOOLS: ${program} is not there; build the target relevo_host_tools natively")
        endif()
        set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
    elseif(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
        message(FATAL_ERROR "${target} runs while Relevo is built, and this build is for another machine; build the "
            "target relevo_host_tools natively and pass -DRELEVO_HOST_TOOLS=<its bin folder>, or set "
            "CMAKE_CROSSCOMPILING_EMULATOR")
    endif()
    add_custom_command(OUTPUT ${MAKER_OUTPUT}
        COMMAND ${program} ${MAKER_ARGUMENTS}
        DEPENDS ${program} ${MAKER_DEPENDS}
        COMMENT ${MAKER_COMMENT}
        VERBATIM)
endfunction()
