#include "golden/reference_compiler.h"

#include <memory>
#include <span>

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>

namespace relevo::test {
namespace {

constexpr int kVersion = 450;

/// The compiler's tables, made once a process: they take ten times as long as a program.
struct Compiler {
    Compiler() { glslang::InitializeProcess(); }
    ~Compiler() { glslang::FinalizeProcess(); }
    Compiler(const Compiler&) = delete;
    Compiler& operator=(const Compiler&) = delete;
};

/// A stage of a program, and where its SPIR-V goes.
struct Stage {
    EShLanguage kind;
    std::string_view text;
    std::vector<std::uint32_t>* code;
};

/// @param spirv  for SPIR-V, which wants a location for whatever has none
void compile(const std::vector<Stage>& stages, bool spirv, ReferenceProgram& result) {
    const EShMessages messages = spirv ? EShMsgSpvRules : EShMsgDefault;
    std::vector<std::unique_ptr<glslang::TShader>> shaders;
    glslang::TProgram program;
    for (const Stage& stage : stages) {
        glslang::TShader& shader =
            *shaders.emplace_back(std::make_unique<glslang::TShader>(stage.kind));
        const char* const text = stage.text.data();
        const int length = static_cast<int>(stage.text.size());
        shader.setStringsWithLengths(&text, &length, 1);
        if (spirv) {
            shader.setEnvInput(glslang::EShSourceGlsl, stage.kind, glslang::EShClientOpenGL, 100);
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
    for (const Stage& stage : stages) {
        spv::SpvBuildLogger log;
        glslang::GlslangToSpv(*program.getIntermediate(stage.kind), *stage.code, &log);
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

std::vector<std::uint32_t> optimised(const std::vector<std::uint32_t>& code) {
    spvtools::Optimizer optimizer(SPV_ENV_OPENGL_4_5);
    optimizer.RegisterPerformancePasses();
    std::vector<std::uint32_t> result;
    return optimizer.Run(code.data(), code.size(), &result) ? result : code;
}

int count_operations(const std::vector<std::uint32_t>& code) {
    constexpr std::uint32_t kFunction = 54;
    bool in_functions = false;
    int count = 0;
    each_operation(code, [&](const auto& words) {
        in_functions = in_functions || (words[0] & 0xffff) == kFunction;
        count += in_functions;
    });
    return count;
}

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

namespace {

void compile_and_validate(const std::vector<Stage>& stages, ReferenceProgram& result) {
    static const Compiler compiler;
    for (const bool spirv : {false, true})
        if (result.refused.empty()) compile(stages, spirv, result);
    if (!result.refused.empty()) return;
    for (const Stage& stage : stages)
        validate(*stage.code, result);
}

}  // namespace

ReferenceProgram reference_compile(std::string_view vertex, std::string_view fragment) {
    ReferenceProgram result;
    compile_and_validate(
        {{EShLangVertex, vertex, &result.vertex}, {EShLangFragment, fragment, &result.fragment}},
        result);
    return result;
}

ReferenceProgram reference_compile_compute(std::string_view text) {
    ReferenceProgram result;
    compile_and_validate({{EShLangCompute, text, &result.compute}}, result);
    return result;
}

}  // namespace relevo::test
