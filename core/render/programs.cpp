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
    return std::ranges::any_of(input.snippets, [&](const shader::Snippet* snippet) {
        return snippet->find(hook) != nullptr;
    });
}

}  // namespace

bool shows_block(const shader::StitchInput& input) {
    return answers(input, "side") || answers(input, "backdrop");
}

bool has_overlay(const shader::StitchInput& input, bool draped) {
    return draped || answers(input, "display");
}

namespace {

bool wants(const shader::StitchInput& input, std::string_view word) {
    return std::ranges::any_of(input.snippets, [&](const shader::Snippet* snippet) {
        return std::ranges::any_of(snippet->wanted,
                                   [&](const auto& wanted) { return wanted.word == word; });
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
                        "in addition but got {} textures of four; switch an effect off",
                        4 * (kMaxStored - 1), geometry.varying_targets));
    return {kHeightStepsDefine, std::to_string(1 + geometry.varying_targets)};
}

}  // namespace

namespace {

/// The recipes of one frame's programs, and what they have in common.
class Stitcher {
  public:
    Stitcher(const shader::CoreTexts& core, const shader::StitchInput& input,
             const ProgramOptions& options)
        : core_(core), input_(input), options_(options), displaced_(answers(input, "displace")) {
        if (options.shown)
            ends_.push_back({"SHOWN", ""});
        else if (overlays())
            ends_.push_back({"DISPLAY_OVERLAY", ""});
    }

    std::vector<ProgramText> run() {
        ground(input_, "");
        if (shows_block(input_)) block();
        if (options_.depth) {
            std::vector<shader::Define> defines{{"TERRAIN_DEPTH", ""}};
            if (displaced_) defines.push_back({"DISPLACED", ""});
            add("depth", {.vertex_main = "terrain.vert.glsl",
                          .fragment_main = "depth.frag.glsl",
                          .defines = defines});
        }
        for (const std::string name : {"background", "post", "edges", "antialias"}) {
            if (name == "post" && options_.shown) continue;
            shader::ProgramRecipe recipe{.vertex_main = "fullscreen.vert.glsl",
                                         .fragment_main = name + ".frag.glsl"};
            if (name == "background" || name == "post") recipe.defines = ends_;
            add(name, recipe);
            if (name == "background" && wants(input_, kNightWord)) {
                shader::StitchInput night = input_;
                night.capabilities.push_back(kNightWord);
                programs_.push_back({"background_night", shader::stitch(core_, recipe, night)});
            }
        }
        return std::move(programs_);
    }

  private:
    /// Whether the ground's programs write an overlay beside the light.
    bool overlays() const { return !options_.shown && has_overlay(input_, options_.draped); }

    void add(const std::string& name, const shader::ProgramRecipe& recipe) {
        programs_.push_back({name, shader::stitch(core_, recipe, input_)});
    }

    /// The two programs of the ground.
    void ground(const shader::StitchInput& input, const std::string& ending) {
        shader::ProgramRecipe geometry{.vertex_main = "terrain.vert.glsl",
                                       .fragment_main = "geometry.frag.glsl",
                                       .shaded_by = "terrain.frag.glsl"};
        shader::ProgramRecipe terrain{.vertex_main = "fullscreen.vert.glsl",
                                      .fragment_main = "terrain.frag.glsl",
                                      .geometry_of = "terrain.vert.glsl"};
        if (options_.vertex_normals) {
            geometry.defines.push_back({"TERRAIN_NORMAL_VERTEX", ""});
            terrain.defines.push_back({"TERRAIN_NORMAL_VERTEX", ""});
        }
        if (displaced_)
            for (shader::ProgramRecipe* const recipe : {&geometry, &terrain})
                recipe->defines.push_back({"DISPLACED", ""});
        if (options_.draped) terrain.defines.push_back({"DRAPED", ""});
        terrain.defines.insert(terrain.defines.end(), ends_.begin(), ends_.end());
        if (options_.audited) terrain.defines.push_back({kAuditedDefine, overlays() ? "2" : "1"});
        if (reads_height_steps(input)) {
            const shader::Define define =
                height_steps_define(shader::stitch(core_, geometry, input));
            geometry.defines.push_back(define);
            terrain.defines.push_back(define);
        }
        programs_.push_back({"geometry" + ending, shader::stitch(core_, geometry, input)});
        programs_.push_back({"terrain" + ending, shader::stitch(core_, terrain, input)});
    }

    /// What is seen from outside alone.
    void block() {
        if (wants(input_, kOutsideWord)) {
            shader::StitchInput outside = input_;
            outside.capabilities.push_back(kOutsideWord);
            ground(outside, kOutsideEnding);
        }
        add("side",
            {.vertex_main = "side.vert.glsl", .fragment_main = "side.frag.glsl", .defines = ends_});
        add("backdrop", {.vertex_main = "fullscreen.vert.glsl",
                         .fragment_main = "backdrop.frag.glsl",
                         .defines = ends_});
    }

    const shader::CoreTexts& core_;
    const shader::StitchInput& input_;
    const ProgramOptions& options_;
    bool displaced_;
    std::vector<shader::Define> ends_;  // what the shading programs end in
    std::vector<ProgramText> programs_;
};

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
        return Stitcher(core, input, options).run();
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
