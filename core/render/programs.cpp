#include "render/programs.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"
#include "shader/driver_log.h"

namespace relevo::render {

bool has_overlay(const shader::StitchInput& input) {
    return std::any_of(
        input.snippets.begin(), input.snippets.end(), [](const shader::Snippet* snippet) {
            return std::any_of(snippet->hooks.begin(), snippet->hooks.end(),
                               [](const auto& hook) { return hook.hook->name == "display"; });
        });
}

namespace {

bool wants_night(const shader::StitchInput& input) {
    return std::any_of(
        input.snippets.begin(), input.snippets.end(), [](const shader::Snippet* snippet) {
            return std::any_of(snippet->wanted.begin(), snippet->wanted.end(),
                               [](const auto& wanted) { return wanted.word == kNightWord; });
        });
}

}  // namespace

std::vector<ProgramText> stitch_programs(const shader::CoreTexts& core,
                                         const shader::StitchInput& input,
                                         const ProgramOptions& options) {
    shader::ProgramRecipe geometry{.vertex_main = "terrain.vert.glsl",
                                   .fragment_main = "geometry.frag.glsl",
                                   .shaded_by = "terrain.frag.glsl"};
    shader::ProgramRecipe terrain{.vertex_main = "fullscreen.vert.glsl",
                                  .fragment_main = "terrain.frag.glsl",
                                  .geometry_of = "terrain.vert.glsl"};
    if (options.vertex_normals) {
        geometry.defines.push_back({"TERRAIN_NORMAL_VERTEX", ""});
        terrain.defines.push_back({"TERRAIN_NORMAL_VERTEX", ""});
    }
    std::vector<shader::Define> ends;  // what the shading programs end in
    if (options.shown)
        ends.push_back({"SHOWN", ""});
    else if (has_overlay(input))
        ends.push_back({"DISPLAY_OVERLAY", ""});
    terrain.defines.insert(terrain.defines.end(), ends.begin(), ends.end());
    std::vector<ProgramText> programs;
    programs.push_back({"geometry", shader::stitch(core, geometry, input)});
    programs.push_back({"terrain", shader::stitch(core, terrain, input)});
    if (options.depth)
        programs.push_back({"depth", shader::stitch(core,
                                                    {.vertex_main = "terrain.vert.glsl",
                                                     .fragment_main = "depth.frag.glsl",
                                                     .defines = {{"TERRAIN_DEPTH", ""}}},
                                                    input)});
    for (const std::string name : {"background", "post", "edges", "antialias"}) {
        if (name == "post" && options.shown) continue;
        shader::ProgramRecipe recipe{.vertex_main = "fullscreen.vert.glsl",
                                     .fragment_main = name + ".frag.glsl"};
        if (name == "background" || name == "post") recipe.defines = ends;
        programs.push_back({name, shader::stitch(core, recipe, input)});
        if (name == "background" && wants_night(input)) {
            shader::StitchInput night = input;
            night.capabilities.push_back(kNightWord);
            programs.push_back({"background_night", shader::stitch(core, recipe, night)});
        }
    }
    return programs;
}

void dump_programs(const std::vector<ProgramText>& programs, const std::filesystem::path& folder,
                   bool overwrite) {
    constexpr std::string_view kWho = "--dump-shaders";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        bad_input(fmt::format("{}: {}: the folder cannot be made, {}", kWho,
                              printable(folder.string()), error.message()));
    if (std::filesystem::equivalent(folder, share_dir() / "shaders", error))
        bad_input(fmt::format("{}: {}: is where the program's own shaders are; name another folder",
                              kWho, printable(folder.string())));
    for (const ProgramText& program : programs) {
        const auto dump = [&](const char* ending, const std::string& text) {
            write_text(folder / (program.name + ending), text, overwrite, kWho);
        };
        dump(".vert.glsl", program.stitched.vertex.text);
        dump(".frag.glsl", program.stitched.fragment.text);
    }
}

LinkedProgram link_program(const ProgramText& text) {
    gl::Program::Failure failure;
    auto program = gl::Program::build(text.stitched.vertex.text, text.stitched.fragment.text,
                                      text.name, failure);
    if (program) return {std::move(*program), text.stitched.textures};
    const bool vertex = failure.stage == gl::Program::Failure::Stage::Vertex;
    const shader::StageText& stage = vertex ? text.stitched.vertex : text.stitched.fragment;
    const char* where = vertex                                                   ? "vertex side"
                        : failure.stage == gl::Program::Failure::Stage::Fragment ? "fragment side"
                                                                                 : "link";
    failed(fmt::format("render: program {}: {}: the driver refuses it\n{}", text.name, where,
                       shader::parse_driver_log(failure.log, stage.lines).text()));
}

}  // namespace relevo::render
