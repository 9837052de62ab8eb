#include "golden/reference_compiler.h"

#include <array>
#include <span>

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/libspirv.hpp>

namespace relevo::test {
namespace {

constexpr std::array kStages = {EShLangVertex, EShLangFragment};
constexpr int kVersion = 450;

/// The compiler's tables, made once a process: they take ten times as long as a program.
struct Compiler {
    Compiler() { glslang::InitializeProcess(); }
    ~Compiler() { glslang::FinalizeProcess(); }
    Compiler(const Compiler&) = delete;
    Compiler& operator=(const Compiler&) = delete;
};

/// @param spirv  for SPIR-V, which wants a location for whatever has none
void compile(const std::array<std::string_view, 2>& texts, bool spirv, ReferenceProgram& result) {
    const EShMessages messages = spirv ? EShMsgSpvRules : EShMsgDefault;
    glslang::TShader vertex(kStages[0]), fragment(kStages[1]);
    glslang::TProgram program;
    for (std::size_t i = 0; i < kStages.size(); ++i) {
        glslang::TShader& shader = i == 0 ? vertex : fragment;
        const char* const text = texts[i].data();
        const int length = static_cast<int>(texts[i].size());
        shader.setStringsWithLengths(&text, &length, 1);
        if (spirv) {
            shader.setEnvInput(glslang::EShSourceGlsl, kStages[i], glslang::EShClientOpenGL, 100);
            shader.setEnvClient(glslang::EShClientOpenGL, glslang::EShTargetOpenGL_450);
            shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
            shader.setAutoMapLocations(true);
            shader.setAutoMapBindings(true);
        }
        shader.parse(GetDefaultResources(), kVersion, false, messages);
        result.refused += shader.getInfoLog();
        program.addShader(&shader);
    }
    if (!result.refused.empty()) return;
    if (program.link(messages) && spirv) program.mapIO();
    result.refused += program.getInfoLog();
    if (!spirv || !result.refused.empty()) return;
    for (std::size_t i = 0; i < kStages.size(); ++i) {
        spv::SpvBuildLogger log;
        glslang::GlslangToSpv(*program.getIntermediate(kStages[i]),
                              i == 0 ? result.vertex : result.fragment, &log);
        result.refused += log.getAllMessages();
    }
}

void validate(const std::vector<std::uint32_t>& code, ReferenceProgram& result) {
    spvtools::SpirvTools tools(SPV_ENV_OPENGL_4_5);
    tools.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
            result.refused += fmt::format("SPIR-V, word {}: {}\n", at.index, message);
        });
    if (!tools.Validate(code) && result.refused.empty()) result.refused = "SPIR-V is not valid\n";
}

/// Calls `visit(words)` for each operation. The first of its words has its length and its number.
template <typename Visit>
void each_operation(std::span<const std::uint32_t> code, const Visit& visit) {
    constexpr std::size_t kHeader = 5;
    for (std::size_t at = kHeader; at < code.size() && code[at] >> 16 > 0; at += code[at] >> 16)
        visit(code.subspan(at, code[at] >> 16));
}

}  // namespace

int count_operations(const std::vector<std::uint32_t>& code, std::uint32_t operation) {
    int count = 0;
    each_operation(code, [&](const auto& words) { count += (words[0] & 0xffff) == operation; });
    return count;
}

int count_decorations(const std::vector<std::uint32_t>& code, std::uint32_t decoration) {
    constexpr std::uint32_t kDecorate = 71, kMemberDecorate = 72;
    int count = 0;
    each_operation(code, [&](const auto& words) {
        const std::uint32_t operation = words[0] & 0xffff;
        count += operation == kDecorate && words[2] == decoration;
        count += operation == kMemberDecorate && words[3] == decoration;
    });
    return count;
}

ReferenceProgram reference_compile(std::string_view vertex, std::string_view fragment) {
    static const Compiler compiler;
    ReferenceProgram result;
    for (const bool spirv : {false, true})
        if (result.refused.empty()) compile({vertex, fragment}, spirv, result);
    if (!result.refused.empty()) return result;
    validate(result.vertex, result);
    validate(result.fragment, result);
    return result;
}

}  // namespace relevo::test
