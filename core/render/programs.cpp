#include "render/programs.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/text.h"
#include "shader/driver_log.h"

namespace relevo::render {

namespace {

/// Whether an effect answers a hook.
bool answers(const shader::StitchInput& input, std::string_view hook) {
    return std::any_of(
        input.snippets.begin(), input.snippets.end(),
        [&](const shader::Snippet* snippet) { return snippet->find(hook) != nullptr; });
}

}  // namespace

bool has_overlay(const shader::StitchInput& input) {
    return answers(input, "display");
}

namespace {

bool wants_night(const shader::StitchInput& input) {
    return std::any_of(
        input.snippets.begin(), input.snippets.end(), [](const shader::Snippet* snippet) {
            return std::any_of(snippet->wanted.begin(), snippet->wanted.end(),
                               [](const auto& wanted) { return wanted.word == kNightWord; });
        });
}

// Outputs beside the G-buffer: GL guarantees eight.
constexpr int kMaxStored = 7;

/// Whether an effect reads how the height changes from pixel to pixel.
bool reads_height_steps(const shader::StitchInput& input) {
    for (const shader::Snippet* snippet : input.snippets) {
        const shader::Source& source = snippet->source;
        for (std::size_t i = 1; i < source.tokens.size(); ++i) {
            const std::string_view word = source.str(source.tokens[i]);
            if ((word == "height_dx_m" || word == "height_dy_m") &&
                source.str(source.tokens[i - 1]) == ".")
                return true;
        }
    }
    return false;
}

/// Where the geometry program puts them: behind the stored varyings.
shader::Define height_steps_define(const shader::Stitched& geometry) {
    if (geometry.varying_targets >= kMaxStored)
        bad_input(
            fmt::format("render: height_dx_m and height_dy_m: expected varyings of up to {} floats "
                        "beside them but got {} textures of four; switch an effect off",
                        4 * (kMaxStored - 1), geometry.varying_targets));
    return {kHeightStepsDefine, std::to_string(1 + geometry.varying_targets)};
}

}  // namespace

namespace {

std::vector<ProgramText> stitch_all(const shader::CoreTexts& core, const shader::StitchInput& input,
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
    if (answers(input, "displace"))
        for (shader::ProgramRecipe* const recipe : {&geometry, &terrain})
            recipe->defines.push_back({"DISPLACED", ""});
    std::vector<shader::Define> ends;  // what the shading programs end in
    if (options.shown)
        ends.push_back({"SHOWN", ""});
    else if (has_overlay(input))
        ends.push_back({"DISPLAY_OVERLAY", ""});
    terrain.defines.insert(terrain.defines.end(), ends.begin(), ends.end());
    std::vector<ProgramText> programs;
    if (reads_height_steps(input)) {
        const shader::Define define = height_steps_define(shader::stitch(core, geometry, input));
        geometry.defines.push_back(define);
        terrain.defines.push_back(define);
    }
    programs.push_back({"geometry", shader::stitch(core, geometry, input)});
    programs.push_back({"terrain", shader::stitch(core, terrain, input)});
    std::vector<shader::Define> depth_defines{{"TERRAIN_DEPTH", ""}};
    if (answers(input, "displace")) depth_defines.push_back({"DISPLACED", ""});
    if (options.depth)
        programs.push_back({"depth", shader::stitch(core,
                                                    {.vertex_main = "terrain.vert.glsl",
                                                     .fragment_main = "depth.frag.glsl",
                                                     .defines = depth_defines},
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

/// How to go on without what a driver refuses.
std::string remedy(const shader::Stitched& stitched, const std::string& blamed) {
    if (blamed == "core") return "";
    std::set<std::string> ids;
    if (blamed.empty())
        for (const shader::HookUse& use : stitched.hooks)
            ids.insert(use.providers.begin(), use.providers.end());
    else
        ids.insert(blamed);
    if (ids.empty()) return "";
    return fmt::format("\n--disable {} goes on without {}", fmt::join(ids, ","),
                       ids.size() == 1 ? "it" : "them");
}

}  // namespace

std::vector<ProgramText> stitch_programs(const shader::CoreTexts& core,
                                         const shader::StitchInput& input,
                                         const ProgramOptions& options) {
    try {
        return stitch_all(core, input, options);
    } catch (const shader::AuthorError& error) {
        if (error.owner() == "core") throw;
        throw Error(error.code(), fmt::format("{}; --disable {} goes on without it", error.what(),
                                              error.owner()));
    }
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
    const shader::DriverLog log = shader::parse_driver_log(failure.log, stage.lines);
    failed(fmt::format("render: program {}: {}: the driver refuses it\n{}{}", text.name, where,
                       log.text(), remedy(text.stitched, log.blamed())));
}

}  // namespace relevo::render
