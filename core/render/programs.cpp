#include "render/programs.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/output_file.h"
#include "base/paths.h"
#include "base/sha256.h"
#include "base/text.h"
#include "render/air_textures.h"
#include "render/graph/plan.h"
#include "render/pass_texts.h"
#include "render/renderer.h"
#include "shader/driver_hints.h"

namespace relevo::render {

namespace {

/// True if an effect implements a hook.
bool answers(const shader::StitchInput& input, std::string_view hook) {
    return std::ranges::any_of(input.snippets, [&](const shader::Snippet* snippet) {
        return snippet->find(hook) != nullptr;
    });
}

}  // namespace

bool shows_block(const shader::StitchInput& input) {
    return answers(input, "side") || answers(input, "backdrop");
}

namespace {

bool wants(const shader::StitchInput& input, std::string_view word) {
    return std::ranges::any_of(input.snippets, [&](const shader::Snippet* snippet) {
        return std::ranges::any_of(snippet->wanted,
                                   [&](const auto& wanted) { return wanted.word == word; });
    });
}

/// True if an effect reads screen-space derivatives of height, or the DEM's height.
bool reads_height_steps(const shader::StitchInput& input) {
    for (const shader::Snippet* snippet : input.snippets) {
        const shader::Source& source = snippet->source;
        for (std::size_t i = 1; i < source.tokens.size(); ++i) {
            const std::string_view word = source.str(source.tokens[i]);
            if ((word == "height_dx_m" || word == "height_dy_m" || word == "dem_height_m" ||
                 word == "dem_step_m") &&
                source.str(source.tokens[i - 1]) == ".")
                return true;
        }
    }
    return false;
}

/// True if an effect has a sampler of a texture.
bool reads(const shader::StitchInput& input, std::string_view resource) {
    return std::ranges::any_of(input.snippets, [&](const shader::Snippet* snippet) {
        return std::ranges::find(snippet->source.samplers, resource, &shader::Sampler::resource) !=
               snippet->source.samplers.end();
    });
}

/// Stitches the programs of a frame graph and sets what its passes read.
class Stitcher {
  public:
    Stitcher(const shader::CoreTexts& core, const shader::StitchInput& input,
             const ProgramOptions& options)
        : core_(core, input.passes, input.instances), input_(input) {
        // The eye of a map is beyond the range of instances.
        if (!options.orthographic) facts_.instances = input.instances;
        facts_.orthographic = options.orthographic;
        facts_.plugin_passes = input.passes;
        facts_.radiance = !options.shown || reads(input, "core.radiance");
        facts_.antialias = options.antialias;
        facts_.pixel_hooks =
            answers(input, "image") || answers(input, "finish") || answers(input, "overlay");
        facts_.overlays = options.overlay_raster || answers(input, "display");
        facts_.overlay_raster = options.overlay_raster;
        facts_.surface = options.data || reads(input, "core.normal") || reads(input, "core.shadow");
        facts_.data = options.data;
        facts_.albedo = options.albedo;
        facts_.deep = options.deep;
        facts_.audited = options.audited;
        facts_.vertex_normals = options.vertex_normals;
        facts_.displaced = answers(input, "displace");
        facts_.software = options.software;
        facts_.natives = options.natives;
        facts_.wants_night = wants(input, kNightWord);
        facts_.wants_outside = wants(input, kOutsideWord);
        facts_.beyond =
            answers(input, "beyond") && answers(input, "atmosphere") && !options.orthographic;
        facts_.wants_plain = wants(input, kWaterWord) || wants(input, kNearWord);
    }

    StitchedFrames run() {
        result_.within = graph();
        if (shows_block(input_)) {
            facts_.outside = true;
            result_.outside = graph();
        }
        return std::move(result_);
    }

  private:
    FrameGraph graph() {
        facts_.varying_targets = 0;
        facts_.height_steps = false;
        const bool steps = reads_height_steps(input_);
        if (steps || facts_.orthographic || !facts_.instances.empty()) {
            // Other targets follow the varyings, whose number the geometry program determines.
            const CoreFrame without = core_frame(facts_);
            facts_.varying_targets = stitched(geometry_of(without)).varying_targets;
            facts_.height_steps = steps;
        }
        CoreFrame frame = core_frame(facts_);
        for (const ProgramRecipe& recipe : frame.programs)
            if (!result_.find(recipe.name))
                result_.programs.push_back(ProgramText::of(recipe.name, stitched(recipe)));
        facts_.varying_targets = result_.find(geometry_of(frame).name)->stitched.varying_targets;
        frame = core_frame(facts_);
        for (Pass& pass : frame.graph.passes) {
            add_reads(frame.graph, pass, pass.program);
            add_reads(frame.graph, pass, pass.program_at_night);
            if (pass.plain) add_reads(frame.graph, pass, pass.plain->name);
        }
        return std::move(frame.graph);
    }

    shader::Stitched stitched(const ProgramRecipe& recipe) const {
        shader::StitchInput input = input_;
        if (!recipe.word.empty()) input.capabilities.push_back(recipe.word);
        if (!recipe.plain)
            for (const char* const word : {kWaterWord, kNearWord})
                input.capabilities.push_back(word);
        shader::Stitched stitched = shader::stitch(core_, recipe.recipe, input);
        for (shader::TextureUnit& unit : stitched.textures)
            for (const shader::CoreTexture& texture : shader::kCoreTextures)
                if (unit.resource == texture.name) {
                    check_ready(recipe.name, unit);
                    unit.resource = texture.resource;
                }
        return stitched;
    }

    /// Hooks of ground and sky come before the picture that they make.
    void check_ready(std::string_view program, const shader::TextureUnit& unit) const {
        if (unit.resource == "core.ground_depth") return;
        const auto is = [&](std::string_view name) { return program.starts_with(name); };
        if (!is("terrain") && !is("side") && !is("background") && !is("backdrop")) return;
        for (const shader::Snippet* snippet : input_.snippets)
            for (const shader::Sampler& sampler : snippet->source.samplers)
                if (sampler.name == unit.name)
                    throw shader::AuthorError(
                        snippet->id,
                        fmt::format(
                            "shader: {}:{}: {}: hooks of the ground and the sky cannot read "
                            "{}, which they make; read it in image, finish, overlay or a "
                            "pass",
                            sampler.file, sampler.line, sampler.name, unit.resource));
    }

    static const ProgramRecipe& geometry_of(const CoreFrame& frame) {
        return *std::ranges::find_if(frame.programs, [](const ProgramRecipe& program) {
            return !program.recipe.shaded_by.empty();
        });
    }

    void add_reads(FrameGraph& graph, Pass& pass, const std::string& program) const {
        if (program.empty()) return;
        const auto add = [&](const std::string& resource) {
            for (const Access& access : accesses(pass))
                if (access.mode == Access::Mode::Read && access.version == Version::of(resource))
                    return;
            pass.reads.push_back(resource);
        };
        add("frame");
        if (pass.kind != PassKind::Host) add("parameters");
        for (const shader::TextureUnit& unit : result_.find(program)->stitched.textures) {
            if (!graph.find(Version::of(unit.resource).resource)) provide(graph, unit.resource);
            // Host passes may draw with textures of native effects, which `after` orders: no read
            // is declared.
            if (pass.kind != PassKind::Host || !made_by_native(unit.resource)) add(unit.resource);
        }
    }

    static std::string owner_of(const std::string& resource) {
        return resource.substr(0, resource.find('.'));
    }

    bool made_by_native(const std::string& resource) const {
        return std::ranges::find(facts_.natives, owner_of(resource)) != facts_.natives.end();
    }

    /// Declares a resource. A native effect writes those that start with its id.
    void provide(FrameGraph& graph, const std::string& resource) const {
        graph.resources.push_back({.name = resource, .lifetime = Lifetime::Provided});
        if (!made_by_native(resource)) return;
        std::ranges::find(graph.passes, owner_of(resource), &Pass::name)
            ->writes.push_back(resource);
    }

    PassTexts core_;
    const shader::StitchInput& input_;
    FrameFacts facts_;
    StitchedFrames result_;
};

/// How to disable what a driver rejects.
std::string remedy(const shader::Stitched& stitched, const std::string& blamed) {
    if (blamed == "core") return "";
    std::set<std::string> ids;
    if (blamed.empty())
        ids.insert(stitched.plugins.begin(), stitched.plugins.end());
    else
        ids.insert(blamed);
    if (ids.empty()) return "";
    return fmt::format("\n--disable {} goes on without {}", fmt::join(ids, ","),
                       ids.size() == 1 ? "it" : "them");
}

}  // namespace

ProgramText ProgramText::of(std::string name, shader::Stitched stitched) {
    std::string texts;
    for (const shader::StageText* stage : stitched.stages())
        texts += stage->text + '\0';
    std::string hash = sha256_of_text(texts);
    return {std::move(name), std::move(stitched), std::move(hash)};
}

const ProgramText* StitchedFrames::find(std::string_view program) const {
    const auto found = std::ranges::find(programs, program, &ProgramText::name);
    return found == programs.end() ? nullptr : &*found;
}

namespace {

/// Checks that passes of plugins can be ordered.
void check_order(const FrameGraph& graph, const std::vector<shader::PluginPass>& passes) {
    if (passes.empty()) return;
    try {
        plan(graph);
    } catch (const Error& error) {
        std::set<std::string> ids;
        for (const shader::PluginPass& pass : passes)
            ids.insert(pass.resource.substr(0, pass.resource.find('.')));
        bad_input(
            fmt::format("{}; see Passes in docs/plugin-guide.md; --disable {} goes on "
                        "without {}",
                        error.what(), fmt::join(ids, ","), ids.size() == 1 ? "it" : "them"));
    }
}

}  // namespace

StitchedFrames stitch_frames(const shader::CoreTexts& core, const shader::StitchInput& input,
                             const ProgramOptions& options) {
    try {
        StitchedFrames frames = Stitcher(core, input, options).run();
        check_order(frames.within, input.passes);
        if (frames.outside) check_order(*frames.outside, input.passes);
        return frames;
    } catch (const shader::AuthorError& error) {
        if (error.owner() == "core") throw;
        throw Error(error.code(), fmt::format("{}; --disable {} goes on without it", error.what(),
                                              error.owner()));
    }
}

std::string graph_text(const StitchedFrames& frames) {
    std::string text = dot_text(frames.within, plan(frames.within), "frame");
    if (frames.outside)
        text += dot_text(*frames.outside, plan(*frames.outside), "frame from outside");
    return text;
}

void dump_programs(const StitchedFrames& frames, const std::filesystem::path& folder,
                   bool overwrite) {
    constexpr std::string_view kWho = "--dump-shaders";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        bad_input(fmt::format("{}: {}: the folder cannot be created, {}", kWho,
                              printable(folder.string()), error.message()));
    if (std::filesystem::equivalent(folder, share_dir() / "shaders", error))
        bad_input(fmt::format("{}: {}: is Relevo's own shader folder; name another one", kWho,
                              printable(folder.string())));
    write_text(folder / "frame.dot", graph_text(frames), overwrite, kWho);
    for (const ProgramText& program : frames.programs) {
        const auto dump = [&](const char* ending, const shader::StageText& stage) {
            if (!stage.text.empty())
                write_text(folder / (program.name + ending), stage.text, overwrite, kWho);
        };
        dump(".vert.glsl", program.stitched.vertex);
        dump(".frag.glsl", program.stitched.fragment);
        dump(".comp.glsl", program.stitched.compute);
    }
}

gl::Program link_program(const ProgramText& text) {
    return finish_program(begin_program(text), text);
}

gl::Program::Pending begin_program(const ProgramText& text) {
    if (!text.stitched.compute.text.empty())
        return gl::Program::begin_compute(text.stitched.compute.text, text.name);
    return gl::Program::begin(text.stitched.vertex.text, text.stitched.fragment.text, text.name);
}

namespace {

/// Name and text of the stage that a driver refuses.
std::pair<const char*, const shader::StageText*> failed_stage(const gl::Program::Failure& failure,
                                                              const shader::Stitched& stitched) {
    using Stage = gl::Program::Failure::Stage;
    switch (failure.stage) {
        case Stage::Vertex:
            return {"vertex side", &stitched.vertex};
        case Stage::Fragment:
            return {"fragment side", &stitched.fragment};
        case Stage::Compute:
            return {"compute program", &stitched.compute};
        default:
            return {"link", stitched.compute.text.empty() ? &stitched.fragment : &stitched.compute};
    }
}

}  // namespace

gl::Program finish_program(gl::Program::Pending pending, const ProgramText& text) {
    gl::Program::Failure failure;
    auto program = gl::Program::finish(std::move(pending), failure);
    if (program) return std::move(*program);
    const auto [where, stage] = failed_stage(failure, text.stitched);
    const shader::DriverLog log = shader::parse_driver_log(failure.log, stage->lines);
    failed(fmt::format(
        "render: program {}: {}: the driver refuses it\n{}{}", text.name, where,
        shader::brief_text(log, {stage->text, text.stitched.names, text.stitched.values}),
        remedy(text.stitched, log.blamed())));
}

std::vector<shader::Param> core_params() {
    shader::Param normal;
    normal.name = "terrain_normal";
    normal.address = kNormalAddress;
    normal.type = shader::ParamType::Int;
    normal.words = {"fragment", "vertex"};
    normal.is_static = true;
    normal.label = "Normals";
    normal.description = "Per fragment at the DEM's full resolution, or per vertex as in the paper";
    std::vector<shader::Param> params = air_params();
    params.insert(params.begin(), normal);
    return params;
}

}  // namespace relevo::render
