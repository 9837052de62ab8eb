#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::test {

/// What Khronos' reference compiler makes of a program. No device is needed.
struct ReferenceProgram {
    std::string refused;                          ///< why, a message a line; empty: it is taken
    std::vector<std::uint32_t> vertex, fragment;  ///< SPIR-V for OpenGL
    std::vector<std::uint32_t> compute;           ///< of a compute program
};

/// SPIR-V as an optimiser leaves it, without what cannot be reached.
std::vector<std::uint32_t> optimised(const std::vector<std::uint32_t>& code);

/// How many operations SPIR-V has in its functions.
int count_operations(const std::vector<std::uint32_t>& code);
/// How often SPIR-V has an operation, or a decoration, by its number there.
int count_operations(const std::vector<std::uint32_t>& code, std::uint32_t operation);
int count_decorations(const std::vector<std::uint32_t>& code, std::uint32_t decoration);

/// Compiles and links as OpenGL's GLSL, then again to SPIR-V for OpenGL 4.5, which is validated.
/// Warnings count as refusals.
ReferenceProgram reference_compile(std::string_view vertex, std::string_view fragment);
/// The same of a compute program.
ReferenceProgram reference_compile_compute(std::string_view text);

}  // namespace relevo::test
