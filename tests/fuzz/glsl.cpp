#include <cstdlib>
#include <string>

#include "fuzz/fuzz.h"
#include "shader/conditions.h"
#include "shader/snippet.h"

namespace relevo::fuzz {

namespace {

/// What a stitcher asks of a file that it has read.
void ask(const shader::Snippet& snippet) {
    for (const shader::HookFunction& hook : snippet.hooks)
        for (const shader::Wanted& wanted : snippet.wanted)
            for (const bool is_provided : {false, true})
                shader::changes_arguments(snippet, hook, wanted.word, is_provided);
    for (const shader::Param& param : snippet.source.params) {
        shader::describe_values(param);
        shader::glsl_value(param, param.initial);
        const std::string text = shader::format_value(param, param.initial);
        attempt([&] { shader::parse_value(param, text); });
    }
}

}  // namespace

const Target kGlsl("glsl", [](std::string_view bytes) {
    attempt([&] { ask(shader::parse_snippet("haze", "haze.glsl", bytes)); });
    const shader::Source lib =
        shader::parse_source(shader::SourceKind::Lib, "core", "lib.glsl", bytes);
    shader::Macros macros{{"HAS_shadows", "1"}, {"SHOWN", ""}};
    shader::evaluate_conditions(lib, macros);
});

}  // namespace relevo::fuzz
