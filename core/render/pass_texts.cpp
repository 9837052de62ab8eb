#include "render/pass_texts.h"

#include <algorithm>

#include <fmt/format.h>

// The inputs of a plugin's pass follow from its samplers, and each pass writes one resource.
// Plugins declare neither inputs nor an order, so neither can be wrong. Buffers are read through
// samplerBuffer instead of storage blocks: every stage has samplers, and readers cannot write. 3-D
// textures are computed, because core GLSL 4.50 cannot draw into a layer that the vertex stage
// chooses.
namespace relevo::render {
namespace {

/// GLSL of a size. Scales are powers of two: floats are exact.
std::string size_text(const shader::PassSize& size) {
    if (size.scale > 0) return fmt::format("vec3(ceil({} * frame.viewport.xy), 1.0)", size.scale);
    return fmt::format("vec3({}.0, {}.0, {}.0)", size.width, size.height, size.depth);
}

std::string full_main(const shader::PluginPass& pass) {
    return fmt::format(
        "layout(location = 0) out vec4 texel_out;\n"
        "void main() {{\n"
        "    vec2 size_px = {}.xy;\n"
        "    texel_out = {}(Texel(gl_FragCoord.xy, gl_FragCoord.xy / size_px, size_px));\n"
        "}}\n",
        size_text(pass.size), pass.function);
}

std::string volume_main(const shader::PluginPass& pass) {
    return fmt::format(
        "void main() {{\n"
        "    ivec3 cell = ivec3(gl_GlobalInvocationID);\n"
        "    vec3 size_px = {};\n"
        "    if (any(greaterThanEqual(cell, ivec3(size_px)))) return;\n"
        "    vec3 at_px = vec3(cell) + 0.5;\n"
        "    imageStore({}, cell, {}(Voxel(at_px, at_px / size_px, size_px)));\n"
        "}}\n",
        size_text(pass.size), pass.output_name(), pass.function);
}

std::string compute_main(const shader::PluginPass& pass) {
    const auto& [x, y, z] = pass.work_groups;
    const std::string count = x > 0 ? "ivec3(gl_NumWorkGroups * gl_WorkGroupSize)"
                                    : "ivec3(" + size_text(pass.over) + ")";
    return fmt::format(
        "void main() {{\n"
        "    {}(Invocation(ivec3(gl_GlobalInvocationID), {}));\n"
        "}}\n",
        pass.function, count);
}

/// The declaration of what a pass writes.
std::string output_text(const shader::PluginPass& pass) {
    if (pass.is_buffer())
        return fmt::format(
            "layout(std430, binding = 0) coherent buffer PassOutput {{ {} {}[{}]; }};",
            pass.output == shader::PluginPass::Output::Floats ? "float" : "uint",
            pass.output_name(), pass.size.width);
    const auto format =
        std::ranges::find(shader::kPassFormats, pass.format, &shader::PassFormat::format);
    return fmt::format("layout({}, binding = 0) writeonly uniform {} {};", format->word,
                       pass.output == shader::PluginPass::Output::Texture3D ? "image3D" : "image2D",
                       pass.output_name());
}

}  // namespace

std::string PassTexts::name_of(const shader::PluginPass& pass) {
    return pass.resource +
           (pass.kind == shader::PluginPass::Kind::Full ? ".frag.glsl" : ".comp.glsl");
}

shader::ProgramRecipe PassTexts::recipe_of(const shader::PluginPass& pass) {
    using Kind = shader::PluginPass::Kind;
    if (pass.kind == Kind::Full)
        return {.vertex_main = "fullscreen.vert.glsl", .fragment_main = name_of(pass)};
    const auto& [x, y, z] = pass.local_size;
    return {
        .compute_main = name_of(pass),
        .declarations = {fmt::format("layout(local_size_x = {}, local_size_y = {}, local_size_z "
                                     "= {}) in;",
                                     x, y, z),
                         output_text(pass)},
        .output = pass.kind == Kind::Compute ? pass.output_name() : ""};
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
    using Kind = shader::PluginPass::Kind;
    if (const shader::InstanceSet* const set = find_instances(name)) {
        std::string main = files_.text("instance.vert.glsl").value_or("");
        constexpr std::string_view kCall = "    place_instance(";
        const std::size_t at = main.find(kCall);
        if (at != main.npos) main.replace(at, kCall.size(), "    " + set->function + "(");
        return main;
    }
    const shader::PluginPass* const pass = find(name);
    if (!pass) return files_.text(name);
    const std::string main = pass->kind == Kind::Full     ? full_main(*pass)
                             : pass->kind == Kind::Volume ? volume_main(*pass)
                                                          : compute_main(*pass);
    return fmt::format("//! provides  the main function of the pass {}\n{}", pass->resource, main);
}

std::string PassTexts::file(std::string_view name) const {
    if (find_instances(name)) return files_.file("instance.vert.glsl");
    return find(name) ? std::string(name) : files_.file(name);
}

}  // namespace relevo::render
