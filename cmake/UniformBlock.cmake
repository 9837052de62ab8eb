# relevo_uniform_block(<struct> <shader> <header>)
#
# Writes the C++ struct of the one std140 block that a shader declares, so that both sides have one
# list: members of float, vec4, mat4 and arrays of these, each at the offset that std140 gives it.
function(relevo_uniform_block struct shader header)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shader})
    # Semicolons divide lists of CMake.
    file(READ ${shader} text)
    string(REPLACE ";" "@" text "${text}")
    string(REGEX MATCH "uniform [A-Za-z_]+ {\n([^}]*)}" block "${text}")
    string(REPLACE "\n" ";" lines "${CMAKE_MATCH_1}")

    set(bytes_float 4)
    set(bytes_vec4 16)
    set(bytes_mat4 64)
    set(type_float "float")
    set(type_vec4 "glm::vec4")
    set(type_mat4 "glm::mat4")
    set(offset 0)
    foreach(line IN LISTS lines)
        if(line MATCHES "^ *(//.*)?$")
            continue()
        endif()
        if(NOT line MATCHES "^ *(float|vec4|mat4) ([a-z_0-9]+)(\\[([0-9]+)\\])?@")
            message(FATAL_ERROR "${shader}: expected a float, vec4 or mat4 but got: ${line}")
        endif()
        set(name ${CMAKE_MATCH_2})
        set(type ${type_${CMAKE_MATCH_1}})
        set(bytes ${bytes_${CMAKE_MATCH_1}})
        set(count "${CMAKE_MATCH_4}")
        if(NOT CMAKE_MATCH_1 STREQUAL "float")
            math(EXPR misaligned "${offset} % 16")
            if(misaligned)
                message(FATAL_ERROR "${shader}: ${name}: expected floats in fours before it")
            endif()
        elseif(count)
            message(FATAL_ERROR "${shader}: ${name}: an array of floats takes 16 bytes for each in std140")
        endif()
        if(count)
            math(EXPR bytes "${bytes} * ${count}")
            set(type "std::array<${type}, ${count}>")
        endif()
        string(APPEND members "    ${type} ${name};\n")
        string(APPEND checks "static_assert(offsetof(${struct}, ${name}) == ${offset});\n")
        math(EXPR offset "${offset} + ${bytes}")
    endforeach()
    if(offset EQUAL 0)
        message(FATAL_ERROR "${shader}: expected a uniform block")
    endif()

    cmake_path(GET shader FILENAME from)
    file(CONFIGURE OUTPUT ${header} @ONLY CONTENT "// Made from ${from} by cmake/UniformBlock.cmake.
#pragma once

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace relevo::render {

/// The uniform block of ${from} (std140), which says what its members are.
struct ${struct} {
${members}};
${checks}static_assert(sizeof(${struct}) == ${offset});

}  // namespace relevo::render
")
endfunction()
