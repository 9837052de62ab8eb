# relevo_uniform_block(<struct> <shader> <header>)
#
# Writes the C++ structs of the one std140 block that a shader declares, so that both sides have one
# list: members of float, vec4, mat4 and arrays of the latter two, aligned as in std140. A line
# `/// Eye: ...` begins a part, the struct EyeBlock, with a vec4 or mat4, so that all parts are aligned
# alike. <struct> is derived from the parts: members have the same names on both sides.
function(relevo_uniform_block struct shader header)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shader})
    # Semicolons divide lists of CMake.
    file(READ ${shader} text)
    string(REPLACE ";" "@" text "${text}")
    string(REGEX MATCH "uniform [A-Za-z_]+ {\n([^}]*)}" block "${text}")
    string(REPLACE "\n" ";" lines "${CMAKE_MATCH_1}")

    set(begins FALSE)
    foreach(line IN LISTS lines)
        if(line MATCHES "^ */// ([A-Z][a-z]+): (.*)$")
            list(APPEND parts ${CMAKE_MATCH_1}Block)
            string(APPEND structs "${end}/// ${CMAKE_MATCH_2}\nstruct ${CMAKE_MATCH_1}Block {
    bool operator==(const ${CMAKE_MATCH_1}Block&) const = default;\n")
            set(end "};\n\n")
            set(begins TRUE)
            continue()
        elseif(line MATCHES "^ *(//.*)?$")
            continue()
        elseif(line MATCHES "^ *(vec4|mat4) ([a-z_0-9]+)@")
            string(APPEND structs "    alignas(16) glm::${CMAKE_MATCH_1} ${CMAKE_MATCH_2}{};\n")
        elseif(line MATCHES "^ *(vec4|mat4) ([a-z_0-9]+)\\[([0-9]+)\\]@")
            string(APPEND structs "    alignas(16) std::array<glm::${CMAKE_MATCH_1}, ${CMAKE_MATCH_3}> ${CMAKE_MATCH_2}{};\n")
        elseif(line MATCHES "^ *float ([a-z_0-9]+)@" AND NOT begins)
            string(APPEND structs "    float ${CMAKE_MATCH_1} = 0;\n")
        else()
            message(FATAL_ERROR "${shader}: expected a vec4 or mat4, or after one of these a float, but got: ${line}")
        endif()
        set(begins FALSE)
    endforeach()
    if(NOT parts)
        message(FATAL_ERROR "${shader}: expected a uniform block of parts, /// Name: meaning")
    endif()
    list(JOIN parts ", " parts)

    cmake_path(GET shader FILENAME from)
    file(CONFIGURE OUTPUT ${header} @ONLY CONTENT "// Made from ${from} by cmake/UniformBlock.cmake.
#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace relevo::render {

${structs}};

/// The uniform block of ${from} (std140), which says what its members are.
struct ${struct} : ${parts} {
    bool operator==(const ${struct}&) const = default;
};

}  // namespace relevo::render
")
endfunction()
