#include "render/pass_texts.h"

#include <algorithm>

#include <fmt/format.h>

namespace relevo::render {
namespace {

/// GLSL of a texture's size. Scales are powers of two: floats are exact.
std::string size_text(const shader::PluginPass& pass) {
    if (pass.scale > 0) return fmt::format("ceil({} * frame.viewport.xy)", pass.scale);
    return fmt::format("vec2({}.0, {}.0)", pass.width, pass.height);
}

}  // namespace

std::string PassTexts::name_of(const shader::PluginPass& pass) {
    return pass.resource + ".frag.glsl";
}

const shader::PluginPass* PassTexts::find(std::string_view name) const {
    const auto found = std::ranges::find_if(
        passes_, [&](const shader::PluginPass& pass) { return name_of(pass) == name; });
    return found == passes_.end() ? nullptr : &*found;
}

std::string PassTexts::name_of(const shader::InstanceSet& set) {
    return set.resource + ".vert.glsl";
}

const shader::InstanceSet* PassTexts::find_instances(std::string_view name) const {
    const auto found = std::ranges::find_if(
        instances_, [&](const shader::InstanceSet& set) { return name_of(set) == name; });
    return found == instances_.end() ? nullptr : &*found;
}

std::optional<std::string> PassTexts::text(std::string_view name) const {
    if (const shader::InstanceSet* const set = find_instances(name)) {
        std::string main = files_.text("instance.vert.glsl").value_or("");
        constexpr std::string_view kCall = "    place_instance(";
        const std::size_t at = main.find(kCall);
        if (at != main.npos) main.replace(at, kCall.size(), "    " + set->function + "(");
        return main;
    }
    const shader::PluginPass* const pass = find(name);
    if (!pass) return files_.text(name);
    return fmt::format(
        "//! provides  the main function of the pass {}\n"
        "layout(location = 0) out vec4 texel_out;\n"
        "void main() {{\n"
        "    vec2 size_px = {};\n"
        "    texel_out = {}(Texel(gl_FragCoord.xy, gl_FragCoord.xy / size_px, size_px));\n"
        "}}\n",
        pass->resource, size_text(*pass), pass->function);
}

std::string PassTexts::file(std::string_view name) const {
    if (find_instances(name)) return files_.file("instance.vert.glsl");
    return find(name) ? std::string(name) : files_.file(name);
}

}  // namespace relevo::render
