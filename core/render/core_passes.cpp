#include "render/core_passes.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "render/instances.h"
#include "render/pass_context.h"
#include "render/pass_texts.h"
#include "render/plain_parts.h"
#include "render/plugin_resources.h"
#include "shader/stored_varyings.h"

namespace relevo::render {
namespace {

constexpr const char* kFullscreen = "fullscreen.vert.glsl";
constexpr const char* kTerrain = "terrain.vert.glsl";
constexpr std::array<float, 4> kNothing{0, 0, 0, 0};

// Colour outputs in addition to the G-buffer: GL guarantees eight in total.
constexpr int kMaxStored = 7;

/// Pixels along a side of a texel of the ground beyond the DEM.
constexpr double kBeyond_px = 3;

/// Updates the textures of GroundLight that the frame's programs read.
/// @param with_walls  walls may be visible where the ground is not
void update_light(PassContext& frame, bool with_walls) {
    GroundLight& light = frame.terrain.light();
    const FrameInputs& inputs = frame.inputs;
    const glm::ivec2 picture = frame.picture_px();
    const LodView view =
        LodView::of_camera(inputs.camera, picture.x, picture.y, 1, inputs.exaggeration);
    // If no ground is visible, shadows of an earlier sun are kept. If there are none, the coarsest
    // are computed. While the sun stands still, tiles are a good enough answer.
    const bool has_moved = light.shadow_sun() != inputs.direct_light().direction;
    const bool sees_ground =
        frame.tiles.triangles() > 0 &&
        (with_walls || !has_moved || frame.terrain.sees_ground(frame.tiles, view));
    const double pixel_posts =
        sees_ground ? frame.tiles.nearest_m() * view.tolerance / frame.terrain.normal_spacing_m()
                    : std::numeric_limits<double>::infinity();
    if (frame.is_read("light_clearance") && (sees_ground || !light.shadow_sun()))
        light.update_shadows(inputs.direct_light(), inputs.exaggeration, pixel_posts);
    if (frame.is_read("light_sky")) light.update_sky_view(inputs.exaggeration);
    if (frame.is_read(kHeightMeansTexture)) frame.terrain.height_means().update(frame.block);
    light.describe(frame.block);
}

class Declaration {
  public:
    explicit Declaration(const FrameFacts& facts)
        : facts_(facts),
          tone_mapped_(facts.antialias ? "colour" : "output"),
          shaded_(facts.radiance ? "radiance" : tone_mapped_) {
        if (facts.deep) end_defines_.push_back({"DEEP", ""});
        if (!facts.radiance)
            end_defines_.push_back({"SHOWN", ""});
        else if (facts.overlays)
            end_defines_.push_back({"DISPLAY_OVERLAY", ""});
        if (facts.surface) end_defines_.push_back({kSurfaceDefine, has_overlay() ? "2" : "1"});
        if (facts.albedo)
            end_defines_.push_back(
                {kAlbedoDefine, std::to_string(1 + has_overlay() + facts.surface)});
    }

    CoreFrame run() {
        resources();
        prepare();
        natives();
        geometry();
        for (const shader::InstanceSet& set : facts_.instances) {
            instances(set, false);
            if (set.has_sprites()) instances(set, true);
        }
        if (casts_shadows()) instance_shadows();
        for (const shader::PluginPass& pass : facts_.plugin_passes)
            plugin_pass(pass);
        terrain();
        if (facts_.outside) side();
        if (facts_.beyond && !facts_.outside) beyond();
        background();
        if (facts_.radiance) post();
        if (facts_.antialias) antialias();
        return std::move(frame_);
    }

  private:
    void add(Pass pass) { frame_.graph.passes.push_back(std::move(pass)); }
    void add(Resource resource) { frame_.graph.resources.push_back(std::move(resource)); }
    void provided(const char* name) { add(Resource{.name = name, .lifetime = Lifetime::Provided}); }

    /// @param word  capability word in addition to those of the effects; null: none
    /// @returns the program's name, with the word as its suffix
    std::string program(const char* name, shader::ProgramRecipe recipe,
                        const char* word = nullptr) {
        if (facts_.software) recipe.defines.push_back({"EXACT_FILTERS", ""});
        const std::string full = word ? std::string(name) + "_" + word : name;
        frame_.programs.push_back({full, std::move(recipe), word ? word : ""});
        return full;
    }

    std::string plain_program(const char* name, const shader::ProgramRecipe& recipe) {
        const std::string full = program((std::string(name) + "_plain").c_str(), recipe);
        frame_.programs.back().plain = true;
        return full;
    }

    void resources() {
        using enum PixelFormat;
        const PixelFormat shown = facts_.deep ? RGBA16 : RGBA8;
        for (const char* name :
             {"tiles", "frame", "parameters", "light_clearance", "light_fraction", "light_sky",
              kHeightMeansTexture, "floor_ground"})
            provided(name);
        add(Resource{.name = "gbuffer", .format = RGBA32UI, .output = facts_.audited});
        add(Resource{.name = "depth", .format = Depth32F, .output = true});
        if (facts_.varying_targets > 0)
            add(Resource{.name = shader::StoredVaryings::kTexture,
                         .kind = ResourceKind::Texture2DArray,
                         .format = RGBA32F,
                         .size = {.depth = facts_.varying_targets}});
        if (!facts_.instances.empty()) add(Resource{.name = "instance_look", .format = RGBA16});
        if (facts_.height_steps) add(Resource{.name = kHeightStepsTexture, .format = RGBA32F});
        if (facts_.orthographic) add(Resource{.name = kGroundPlaceTexture, .format = RGBA32F});
        if (facts_.radiance)
            add(Resource{.name = "radiance", .format = RGBA16F, .linear = true, .output = true});
        if (facts_.radiance && facts_.overlays)
            add(Resource{.name = "overlay", .format = RGBA8, .linear = true});
        if (facts_.surface)
            add(Resource{
                .name = kSurfaceTexture, .format = RGBA16F, .linear = true, .output = facts_.data});
        if (facts_.albedo)
            add(Resource{
                .name = kAlbedoTexture, .format = RGBA16F, .linear = true, .output = true});
        if (facts_.audited)
            add(Resource{.name = "sun_seen", .format = RGBA32F, .linear = true, .output = true});
        if (facts_.antialias) {
            add(Resource{.name = "colour", .format = shown, .linear = true});
            add(Resource{.name = "edge_marks", .format = Stencil8});
            if (facts_.outside) add(Resource{.name = "walls", .format = R8});
        }
        add(Resource{.name = "output", .format = shown, .linear = true, .output = true});
    }

    /// Passes on the host before the first draw.
    void prepare() {
        add(Pass{.name = "select",
                 .kind = PassKind::Host,
                 .writes = {"tiles"},
                 .body = [](PassContext& frame) {
                     // All that the picture shows, also where the frame is a part of it: levels of
                     // detail, shadows and instances are then those of one large frame.
                     // Pages of maps alone are those of the part.
                     frame.tiles = frame.terrain.select_for_frame(
                         frame.inputs, frame.picture_px(), {frame.width_px, frame.height_px});
                 }});
        add(Pass{.name = "light",
                 .kind = PassKind::Host,
                 .reads = {"tiles"},
                 .writes = {"light_clearance", "light_fraction", "light_sky", kHeightMeansTexture},
                 .body = [with_walls = facts_.outside](PassContext& frame) {
                     update_light(frame, with_walls);
                 }});
        add(Pass{.name = "footprint",
                 .kind = PassKind::Host,
                 .when = When::Dem,
                 .writes = {"floor_ground"},
                 .body = [](PassContext& frame) {
                     frame.services.make_footprint(frame.ground.footprint);
                 }});
        add(Pass{.name = "frame",
                 .kind = PassKind::Host,
                 .writes = {"frame"},
                 .after = {"select", "light", "instance_shadows"},
                 .body = [](PassContext& frame) { frame.services.upload_blocks(frame.block); }});
    }

    /// Passes of native effects. Each may draw the ground's depth repeatedly and write parameters.
    void natives() {
        if (facts_.natives.empty()) return;
        shader::ProgramRecipe recipe{.vertex_main = kTerrain,
                                     .fragment_main = "depth.frag.glsl",
                                     .defines = {{"TERRAIN_DEPTH", ""}}};
        if (facts_.displaced) recipe.defines.push_back({"DISPLACED", ""});
        const std::string depth = program("depth", recipe);
        std::vector<std::string> before;
        for (const std::string& id : facts_.natives) {
            add(Pass{
                .name = id,
                .kind = PassKind::Host,
                .program = depth,
                .reads = {"tiles"},
                .updates = {"parameters"},
                .after = before,
                .body = [id](PassContext& frame) { frame.services.prepare_native(id, frame); }});
            before = {id};
        }
    }

    void geometry() {
        shader::ProgramRecipe recipe{.vertex_main = kTerrain,
                                     .fragment_main = "geometry.frag.glsl",
                                     .shaded_by = "terrain.frag.glsl"};
        ground_defines(recipe);
        stored_defines(recipe);
        Pass pass{.name = "geometry",
                  .kind = PassKind::Geometry,
                  .program = program("geometry", recipe, outside_word()),
                  .reads = {"tiles"},
                  .colours = {{"gbuffer"}},
                  .depth = Depth{"depth", DepthTest::Nearer, /*writes=*/true, /*clear=*/0.0F},
                  .clips_voids = true,
                  .body = [](PassContext& frame) {
                      frame.terrain.draw(frame.tiles, frame.inputs.camera.eye_m);
                  }};
        if (facts_.varying_targets > 0) pass.colours.push_back({shader::StoredVaryings::kTexture});
        if (facts_.height_steps) pass.colours.push_back({kHeightStepsTexture});
        if (facts_.orthographic) pass.colours.push_back({kGroundPlaceTexture, kNothing});
        add(std::move(pass));
    }

    /// Meshes on the ground, or their sprites. All are drawn into the same targets.
    void instances(const shader::InstanceSet& set, bool sprites) {
        const std::string name = set.resource + (sprites ? ".sprites" : "");
        const int look = 1 + facts_.varying_targets;
        if (look > kMaxStored)
            bad_input("render: instances: expected varyings of up to " +
                      std::to_string(4 * (kMaxStored - 1)) + " floats in addition but got " +
                      std::to_string(facts_.varying_targets) +
                      " textures of four; switch an effect off");
        shader::ProgramRecipe recipe{.vertex_main = PassTexts::name_of(set),
                                     .fragment_main = "instance.frag.glsl",
                                     .defines = {{"INSTANCE_LOOK", std::to_string(look)}},
                                     .shaded_by = "terrain.frag.glsl"};
        ground_defines(recipe);
        stored_defines(recipe);
        if (sprites)
            recipe.defines.push_back({"SPRITES", ""});
        else if (set.has_sprites() && set.casts_shadow)
            recipe.defines.push_back({"SPRITES_FOLLOW", ""});
        const bool first = covering_ == "geometry";
        Pass pass{.name = name,
                  .kind = PassKind::Geometry,
                  .program = program(name.c_str(), recipe, outside_word()),
                  .reads = {"tiles"},
                  .colours = {{.resource = "gbuffer", .updates = true}},
                  .depth = Depth{"depth", DepthTest::Nearer, /*writes=*/true},
                  .after = {covering_},
                  .body = [resource = set.resource, sprites](PassContext& frame) {
                      frame.services.instances().draw(resource, sprites, frame);
                  }};
        if (facts_.varying_targets > 0)
            pass.colours.push_back({.resource = shader::StoredVaryings::kTexture, .updates = true});
        if (first)
            pass.colours.push_back({"instance_look", kNothing});
        else
            pass.colours.push_back({.resource = "instance_look", .updates = true});
        covering_ = name;
        add(std::move(pass));
    }

    bool casts_shadows() const {
        return std::ranges::any_of(facts_.instances, &shader::InstanceSet::casts_shadow);
    }

    /// Shadow maps of instances, which are kept until the sun or the eye have moved.
    void instance_shadows() {
        using Shadows = InstanceShadows;
        constexpr const char* kMaps = "instance_shadows";
        add(Resource{.name = kMaps,
                     .format = PixelFormat::Depth32F,
                     .size = {.share = 0,
                              .width = Shadows::kSide_px,
                              .height = Shadows::kMaps * Shadows::kSide_px},
                     .lifetime = Lifetime::Kept});
        add(Pass{
            .name = kMaps,
            .kind = PassKind::Host,
            .reads = {"tiles"},
            .writes = {kMaps},
            .body = [](PassContext& frame) { frame.services.instances().place_shadows(frame); }});
        std::string before = kMaps;
        for (const shader::InstanceSet& set : facts_.instances) {
            if (!set.casts_shadow) continue;
            const std::string name = set.resource + ".shadow";
            const shader::ProgramRecipe recipe{
                .vertex_main = PassTexts::name_of(set),
                .fragment_main = "instance_shadow.frag.glsl",
                .defines = {{"SHADOW_MAP", ""},
                            {"INSTANCE_LIGHT", fmt::format("{:.6f}", set.light_through)}}};
            add(Pass{.name = name,
                     .kind = PassKind::Geometry,
                     .program = program(name.c_str(), recipe),
                     .reads = {"tiles"},
                     .depth = Depth{kMaps, DepthTest::Nearer, /*writes=*/true},
                     .after = {before},
                     .body = [resource = set.resource](PassContext& frame) {
                         frame.services.instances().draw_shadows(resource, frame);
                     }});
            before = name;
        }
    }

    void plugin_pass(const shader::PluginPass& written) {
        const When when = when_of(written.when);
        add(resource_of(written, when));
        Pass pass{.name = written.resource,
                  .when = when,
                  .parameters = written.parameters,
                  .program = program(written.resource.c_str(), PassTexts::recipe_of(written))};
        if (written.kind == shader::PluginPass::Kind::Full) {
            pass.colours = {{written.resource}};
        } else {
            pass.kind = PassKind::Compute;
            pass.writes = {written.resource};
            pass.dispatch = Dispatch{.over = size_of(written.over),
                                     .local_size = written.local_size,
                                     .work_groups = written.work_groups};
        }
        add(std::move(pass));
    }

    /// Of programs that fill the G-buffer.
    void stored_defines(shader::ProgramRecipe& recipe) const {
        if (facts_.software) recipe.defines.push_back({"NAN_SLIVERS", ""});
    }

    void ground_defines(shader::ProgramRecipe& recipe) const {
        if (facts_.vertex_normals) recipe.defines.push_back({"TERRAIN_NORMAL_VERTEX", ""});
        if (facts_.displaced) recipe.defines.push_back({"DISPLACED", ""});
        int output = 1 + facts_.varying_targets;
        const auto store = [&](const char* define, const char* what) {
            if (output > kMaxStored)
                bad_input(
                    fmt::format("render: {}: expected varyings of up to {} floats in addition "
                                "but got {} textures of four; switch an effect off",
                                what, 4 * (kMaxStored - (output - facts_.varying_targets)),
                                facts_.varying_targets));
            recipe.defines.push_back({define, std::to_string(output++)});
        };
        if (facts_.height_steps) store(kHeightStepsDefine, "height_dx_m and height_dy_m");
        if (facts_.orthographic) store(kOrthographicDefine, "--ortho");
    }

    const char* outside_word() const {
        return facts_.outside && facts_.wants_outside ? kOutsideWord : nullptr;
    }
    /// The output behind those that all shading programs of the ground have.
    int first_extra_output() const { return 1 + has_overlay() + facts_.surface + facts_.albedo; }
    bool has_overlay() const { return facts_.radiance && facts_.overlays; }

    /// Shades the pixels of the geometry pass.
    void terrain() {
        shader::ProgramRecipe recipe{.vertex_main = kFullscreen,
                                     .fragment_main = "terrain.frag.glsl",
                                     .geometry_of = kTerrain};
        ground_defines(recipe);
        if (!facts_.instances.empty()) recipe.defines.push_back({"INSTANCES", ""});
        if (casts_shadows()) recipe.defines.push_back({"INSTANCE_SHADOWS", ""});
        if (facts_.overlay_raster) recipe.defines.push_back({"OVERLAY_RASTER", ""});
        recipe.defines.insert(recipe.defines.end(), end_defines_.begin(), end_defines_.end());
        if (facts_.audited)
            recipe.defines.push_back({kAuditedDefine, std::to_string(first_extra_output())});
        Pass pass{.name = "terrain",
                  .program = program("terrain", recipe, outside_word()),
                  .colours = {{shaded_}},
                  .depth = Depth{"depth@" + covering_, DepthTest::Covered}};
        if (facts_.wants_plain && !facts_.outside && !facts_.orthographic)
            pass.plain = PlainProgram{plain_program("terrain", recipe), parts_of_ground};
        if (has_overlay()) pass.colours.push_back({"overlay", kNothing});
        if (facts_.surface) pass.colours.push_back({kSurfaceTexture, kNothing});
        if (facts_.albedo) pass.colours.push_back({kAlbedoTexture, kNothing});
        if (facts_.audited) pass.colours.push_back({"sun_seen", kNothing});
        add(std::move(pass));
    }

    /// The walls of a block, for views from outside.
    void side() {
        shader::ProgramRecipe recipe{.vertex_main = "side.vert.glsl",
                                     .fragment_main = "side.frag.glsl",
                                     .defines = end_defines_};
        if (facts_.antialias)
            recipe.defines.push_back({"WALLS_OUTPUT", std::to_string(first_extra_output())});
        Pass pass{.name = "side",
                  .kind = PassKind::Geometry,
                  .program = program("side", std::move(recipe), outside_word()),
                  .reads = {"tiles"},
                  .colours = {{.resource = shaded_, .updates = true}},
                  .depth = Depth{"depth", DepthTest::Nearer, /*writes=*/true},
                  .after = {covering_},
                  .culls = true,  // no walls behind a void are seen through it
                  .body = [](PassContext& frame) {
                      if (frame.inputs.camera.map) return;  // nothing of them is seen from above
                      frame.terrain.draw_sides(frame.tiles, frame.inputs.camera.eye_m);
                  }};
        if (has_overlay()) pass.colours.push_back({.resource = "overlay", .updates = true});
        if (facts_.surface) pass.colours.push_back({.resource = kSurfaceTexture, .updates = true});
        if (facts_.albedo) pass.colours.push_back({.resource = kAlbedoTexture, .updates = true});
        if (facts_.antialias) pass.colours.push_back({"walls", kNothing});
        add(std::move(pass));
    }

    static shader::Define beyond_px() { return {"BEYOND_PX", fmt::format("{:.1f}", kBeyond_px)}; }

    /// Level ground beyond the DEM, in views from the air: without relief it needs few texels.
    void beyond() {
        shader::ProgramRecipe recipe{.vertex_main = kFullscreen,
                                     .fragment_main = "beyond.frag.glsl",
                                     .defines = {beyond_px()}};
        const std::string name = program("beyond", std::move(recipe));
        frame_.programs.back().plain = true;
        add(Resource{.name = "beyond_ground",
                     .format = PixelFormat::RGBA16F,
                     .size = {.share = 1 / kBeyond_px},
                     .linear = true});
        add(Pass{.name = "beyond",
                 .program = name,
                 .colours = {{"beyond_ground", kNothing}},
                 .is_needed = [](const PassContext& frame) { return frame.inputs.in_the_air; }});
    }

    /// The sky, or the backdrop of a block.
    void background() {
        const char* const name = facts_.outside ? "backdrop" : "background";
        shader::ProgramRecipe recipe{.vertex_main = kFullscreen,
                                     .fragment_main = std::string(name) + ".frag.glsl",
                                     .defines = end_defines_};
        if (facts_.beyond && !facts_.outside) {
            recipe.defines.push_back({"BEYOND", ""});
            recipe.defines.push_back(beyond_px());
        }
        Pass pass{.name = "background",
                  .program = program(name, recipe, outside_word()),
                  .colours = {{.resource = shaded_, .updates = true}},
                  .depth = Depth{"depth", DepthTest::Uncovered},
                  .after = {"side"}};  // a pass of views from outside only
        if (!facts_.outside && facts_.wants_night)
            pass.program_at_night = program(name, recipe, kNightWord);
        if (!facts_.outside && !facts_.orthographic) {
            recipe.defines.push_back({"NO_MOON", ""});
            pass.plain = PlainProgram{plain_program(name, recipe), parts_of_sky};
        }
        add(std::move(pass));
    }

    /// Tone mapping of stored radiance. Without radiance, the shading programs map tones.
    void post() {
        shader::ProgramRecipe recipe{
            .vertex_main = kFullscreen, .fragment_main = "post.frag.glsl", .defines = end_defines_};
        if (facts_.pixel_hooks) recipe.defines.push_back({"PIXEL_HOOKS", ""});
        add(Pass{.name = "post",
                 .program = program("post", std::move(recipe), outside_word()),
                 .colours = {{tone_mapped_}}});
    }

    /// Two draws: the first marks the pixels of silhouettes in the stencil, the second smooths only
    /// those. A single draw over all pixels takes five times as long on a software renderer.
    void antialias() {
        add(Pass{.name = "copy",
                 .kind = PassKind::Host,
                 .reads = {"colour"},
                 .writes = {"output"},
                 .body = [](PassContext& frame) {
                     frame.texture("output").copy_from(frame.texture("colour"));
                 }});
        // Of a block also where walls begin and end.
        const auto smoothing = [&](const char* name, const char* of_block) {
            shader::ProgramRecipe recipe{.vertex_main = kFullscreen,
                                         .fragment_main = std::string(name) + ".frag.glsl"};
            if (facts_.outside) recipe.defines.push_back({"WALLS", ""});
            return program(facts_.outside ? of_block : name, std::move(recipe));
        };
        add(Pass{.name = "edges",
                 .program = smoothing("edges", "edges_of_block"),
                 .stencil = Stencil{"edge_marks", /*marks=*/true}});
        add(Pass{.name = "antialias",
                 .program = smoothing("antialias", "antialias_of_block"),
                 .colours = {{.resource = "output", .updates = true}},
                 .stencil = Stencil{"edge_marks"}});
    }

    const FrameFacts& facts_;
    std::string covering_ = "geometry";  // last pass that changes what a pixel shows of the ground
    std::string tone_mapped_;            // resource of the tonemapped colours
    std::string shaded_;  // resource that the shading passes draw into: tone_mapped_ or radiance
    std::vector<shader::Define> end_defines_;  // of the shading programs
    CoreFrame frame_;
};

}  // namespace

CoreFrame core_frame(const FrameFacts& facts) {
    return Declaration(facts).run();
}

}  // namespace relevo::render
