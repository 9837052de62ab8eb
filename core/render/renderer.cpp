#include "render/renderer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/units.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "gl/vertex_array.h"
#include "render/draw_watch.h"
#include "render/footprint_texture.h"
#include "render/ground_probe.h"
#include "render/native_host.h"
#include "render/programs.h"
#include "shader/stored_varyings.h"
#include "sun/time.h"

namespace relevo::render {
namespace {

/// @throws Error (Failed) for a texture of another kind than its sampler is: that would be black
void check_kind(const gl::Texture& texture, const shader::TextureUnit& unit) {
    const std::string_view kind = gl::sampler_name(texture.kind());
    // Of "usampler2DArray" the letter does not matter.
    if (unit.type.ends_with(kind) || unit.type == fmt::format("{}Shadow", kind)) return;
    failed(fmt::format(
        "render: {}: {} {}: expected a texture of that kind but the module makes {} one of {}",
        unit.owner, unit.type, unit.name, unit.resource, kind));
}

constexpr unsigned kFrameBinding = 0;
constexpr unsigned kParamsBinding = 1;

/// Longest to shortest side of a pixel's footprint. An anisotropic filter resolves it; without one
/// a little aliasing at a slant looks better than blur.
constexpr double kFootprintWithoutAnisotropy = 2.5;
constexpr double kAnisotropy = 8;

/// Pixels that are drawn at once under a watch: as many as a usual picture has.
constexpr double kMaxWatched_px = 1 << 21;

/// Draws reach no pixel outside while this lives.
struct Scissor {
    Scissor(int x, int y, int width, int height) {
        glScissor(x, y, width, height);
        glEnable(GL_SCISSOR_TEST);
    }
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;
    ~Scissor() { glDisable(GL_SCISSOR_TEST); }
};

constexpr const char* kVaryings = shader::StoredVaryings::kTexture;

/// The day of the year of a moment.
int day_of(double unix_s) {
    const sun::Date date = (sun::Instant() + unix_s).utc().date;
    return climate::day_of_year(date.month, date.day);
}

constexpr const char* kNormalAddress = "terrain.normal";

}  // namespace

std::vector<shader::Param> core_params() {
    shader::Param normal;
    normal.name = "terrain_normal";
    normal.address = kNormalAddress;
    normal.type = shader::ParamType::Int;
    normal.words = {"fragment", "vertex"};
    normal.is_static = true;
    normal.label = "Normals";
    normal.description = "Per fragment at the DEM's full resolution, or per vertex as in the paper";
    return {normal};
}

struct Renderer::Impl {
    gl::Context& context;
    RendererOptions options;
    double anisotropy;
    std::vector<ProgramText> texts;
    std::optional<DrawWatch> watch;               // until the first frame is drawn
    std::map<std::string, LinkedProgram> linked;  // by name, as they are needed
    LinkedProgram depth_only;
    bool outside;  // of the DEM, and that makes a difference
    EffectTextures effect_textures;
    gl::Buffer frame_block;
    std::vector<effect::DisplaceSpec> displaces;
    bool has_overlay;
    shader::ParamStore values;  // as given; native modules write host parameters
    double exposure = 1;        // of the last frame
    gl::Buffer params_block;
    gl::VertexArray no_inputs;
    TileSelection tiles;  // of the last frame
    GroundProbe probe;
    bool reads_surface = false, reads_climate = false, reads_sun = false, reads_sky = false,
         reads_water = false;

    gl::Texture gbuffer, depth, radiance, overlay, tone_mapped, edge_marks, picture;
    gl::Texture varyings, height_steps, sun_seen;
    gl::Texture footprint;           // of the ground that was last seen from outside ...
    std::uint64_t footprint_of = 0;  // ... which is Terrain::serial()
    // Light is the radiance, or at once the picture's colours.
    gl::Framebuffer geometry_target, light_target, side_target, ground_target, post_target,
        picture_target;
    std::vector<NativeHost> natives;
    bool native_is_made = false;  // by a frame before

    Impl(gl::Context& c, const EffectInputs& effects, const RendererOptions& o)
        : context(c),
          options(o),
          // A software renderer pays for every tap of an anisotropic filter (four times the frame).
          anisotropy(c.info().device.software ? 1 : std::min(kAnisotropy, c.info().max_anisotropy)),
          texts(stitch(effects, c.info().max_texture_units, o)),
          watch(std::in_place, effects.stitch.snippets),
          outside(o.outside && render::shows_block(effects.stitch)),
          effect_textures(effects.textures, anisotropy),
          frame_block(sizeof(FrameBlock), "frame block"),
          displaces(effects.displaces),
          has_overlay(render::has_overlay(effects.stitch, o.draped)) {
        if (effects.stitch.values) {
            values = *effects.stitch.values;
            const std::vector<std::byte> params =
                shader::pack(texts.front().stitched.params, values);
            if (!params.empty()) params_block = gl::Buffer(params, "parameters");
        }
        for (const char* name : {"geometry", "terrain", "background"})
            program(here(name));
        for (const char* name : {"side", "post", "edges", "antialias"})
            if (find_text(name) && (outside || std::string_view(name) != "side")) program(name);
        make_targets();
        if (!effects.modules.empty()) depth_only = link("depth");
        for (const effect::NativeModule* module : effects.modules)
            natives.emplace_back(
                *module, context, [this](const Terrain& ground) { bind(depth_only, ground); },
                values, options.width_px, options.height_px);
    }

    bool shows_block() const { return find_text("side") != nullptr; }

    /// Of a frame; fills in what effects displace.
    FrameBlock prepare(Terrain& terrain, const Ground& ground, FrameInputs& inputs);

    /// The name of a pass's program where the eye is.
    std::string here(const char* pass) const {
        if (outside && std::string_view(pass) == "background") return "backdrop";
        const std::string name = std::string(pass) + kOutsideEnding;
        return outside && find_text(name) ? name : pass;
    }

    const LinkedProgram& program(const std::string& name) {
        const auto known = linked.find(name);
        if (known != linked.end()) return known->second;
        return linked.emplace(name, link(text(name))).first->second;
    }

    void move(bool is_outside) {
        if (outside == (is_outside && shows_block())) return;
        outside = !outside;
        make_targets();
    }

    /// What is drawn into, in the picture's size.
    void make_targets() {
        reads_surface = reads("surface_pages");
        reads_climate = reads(kClimateTexture);
        reads_sun = reads("light_margins");
        reads_sky = reads("light_sky");
        reads_water = false;
        for (const char* const pass : {"geometry", "terrain", "side", "depth"})
            reads_water |= reads("water_pages", pass);
        const gl::Extent size{options.width_px, options.height_px, 1};
        const auto target = [&](gl::Format format, const char* label) {
            gl::Texture texture(gl::TextureKind::D2, format, size, 1, label);
            texture.set_sampling(gl::Filter::Linear, gl::Wrap::Clamp);
            return texture;
        };
        gbuffer = target(gl::Format::RGBA32UI, "gbuffer");
        gbuffer.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
        depth = target(gl::Format::Depth32F, "depth");
        if (options.radiance) radiance = target(gl::Format::RGBA16F, "radiance");
        tone_mapped = target(gl::Format::RGBA8, "tone mapped");
        edge_marks = gl::Texture(gl::TextureKind::D2, gl::Format::Stencil8, size, 1, "edge marks");
        depth.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
        picture = target(gl::Format::RGBA8, "picture");
        std::vector<const gl::Texture*> outputs{&gbuffer};
        if (const int layers = text(here("geometry")).stitched.varying_targets; layers > 0) {
            varyings = gl::Texture(gl::TextureKind::D2Array, gl::Format::RGBA32F,
                                   {size.width, size.height, layers}, 1, kVaryings);
            varyings.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
            outputs.push_back(&varyings);
        }
        if (reads(kHeightStepsTexture)) {
            height_steps = target(gl::Format::RG32F, kHeightStepsTexture);
            height_steps.set_sampling(gl::Filter::Nearest, gl::Wrap::Clamp);
            outputs.push_back(&height_steps);
        }
        geometry_target = gl::Framebuffer(outputs, &depth, "geometry");
        const gl::Texture& end = options.antialias ? tone_mapped : picture;
        light_target = gl::Framebuffer({options.radiance ? &radiance : &end}, &depth, "light");
        if (options.radiance) {
            post_target = gl::Framebuffer({&end}, nullptr, "post");
            if (has_overlay) overlay = target(gl::Format::RGBA8, "overlay");
        }
        std::vector<const gl::Texture*> of_ground{options.radiance ? &radiance : &end};
        if (overlay.name() != 0) of_ground.push_back(&overlay);
        side_target = gl::Framebuffer(of_ground, &depth, "light of sides");
        if (options.audited) {
            sun_seen = target(gl::Format::RGBA32F, "sun seen");
            of_ground.push_back(&sun_seen);
        }
        ground_target = gl::Framebuffer(of_ground, &depth, "light of the ground");
        picture_target = gl::Framebuffer({&picture}, &edge_marks, "picture");
    }

    /// Whether the program of a pass reads a texture.
    bool reads(std::string_view resource, const char* pass = "terrain") const {
        const ProgramText* const found = find_text(here(pass));
        if (!found) return false;
        const std::vector<shader::TextureUnit>& textures = found->stitched.textures;
        return std::any_of(textures.begin(), textures.end(), [&](const shader::TextureUnit& unit) {
            return unit.resource == resource;
        });
    }

    static std::vector<ProgramText> stitch(const EffectInputs& effects, int max_texture_units,
                                           const RendererOptions& options) {
        shader::StitchInput input = effects.stitch;
        input.max_texture_units = max_texture_units;
        const shader::FolderTexts core(share_dir() / "shaders");
        const bool vertex_normals = input.values && input.values->find(kNormalAddress) &&
                                    input.values->value(kNormalAddress)[0] == 1;
        if (vertex_normals && options.draped)
            bad_input(
                fmt::format("render: {}: expected fragment, with which rasters lie on the ground, "
                            "but got vertex; remove the overlay or pass --set {}=fragment",
                            kNormalAddress, kNormalAddress));
        std::vector<ProgramText> texts = stitch_programs(core, input,
                                                         {.vertex_normals = vertex_normals,
                                                          .depth = !effects.modules.empty(),
                                                          .draped = options.draped,
                                                          .shown = !options.radiance,
                                                          .audited = options.audited});
        if (options.stitched) options.stitched(texts);
        for (const ProgramText& text : texts)
            log::debug(units_text(text, max_texture_units));
        return texts;
    }

    /// "render: terrain: 13 of 16 texture units; bump.rock also serves as layering.rock"
    static std::string units_text(const ProgramText& program, int max_texture_units) {
        std::string text = fmt::format("render: {}: {} of {} texture units", program.name,
                                       program.stitched.textures.size(), max_texture_units);
        for (const shader::TextureUnit& unit : program.stitched.textures)
            if (!unit.also.empty())
                text += fmt::format("; {} also serves as {}", unit.resource,
                                    fmt::join(unit.also, ", "));
        return text;
    }

    const ProgramText* find_text(const std::string& name) const {
        const auto found =
            std::find_if(texts.begin(), texts.end(),
                         [&](const ProgramText& program) { return program.name == name; });
        return found == texts.end() ? nullptr : &*found;
    }

    const ProgramText& text(const std::string& name) const {
        const ProgramText* const found = find_text(name);
        assert(found);
        return *found;
    }

    /// @param block  of the frame
    std::string background_of(const FrameBlock& block) const {
        const bool night = !outside && block.eye_sun.w < radians(kNight_deg);
        return night && find_text("background_night") ? "background_night" : here("background");
    }

    LinkedProgram link(const char* name) { return link(text(name)); }

    LinkedProgram link(const ProgramText& program) {
        const DrawWatch::Turn turn(watch, program, 0);
        return link_program(program);
    }

    /// Draws, in the first frame under a watch.
    /// @param parts  pixels and triangles
    template <typename Draw>
    void watched(const std::string& name, double parts, const Draw& draw) {
        const DrawWatch::Turn turn(watch, text(name), parts);
        draw();
        if (watch) context.finish();
    }

    double pixels() const { return double{1} * options.width_px * options.height_px; }

    /// Draws the ground. In the first frame of a large picture its vertices come alone before, so
    /// that those that never end are found as soon as in a small one.
    void draw_ground(Terrain& ground, const FrameInputs& inputs) {
        const auto draw_tiles = [&] { ground.draw(tiles, inputs.camera.eye_m); };
        if (watch && pixels() > kMaxWatched_px) {
            const Scissor corner(0, 0, 1, 1);
            watched(here("geometry"), tiles.triangles(), draw_tiles);
        }
        watched(here("geometry"), pixels() + tiles.triangles(), draw_tiles);
    }

    /// Draws a program over the picture, in the first frame piece by piece for the same reason.
    void draw_picture(const std::string& name) {
        if (!watch || pixels() <= kMaxWatched_px)
            return watched(name, pixels(), [&] { draw_fullscreen(); });
        const int rows = std::max(1, static_cast<int>(kMaxWatched_px / options.width_px));
        for (int y = 0; y < options.height_px; y += rows) {
            const Scissor band(0, y, options.width_px, rows);
            watched(name, kMaxWatched_px, [&] { draw_fullscreen(); });
        }
    }

    /// Binds what a program reads, by the units that the stitcher gave out.
    void bind(const LinkedProgram& program, const Terrain& ground) {
        program.program.use();
        for (const shader::TextureUnit& unit : program.textures) {
            const gl::Texture* texture = core_texture(unit.resource, ground);
            if (!texture) texture = effect_textures.find(unit.resource);
            for (const NativeHost& native : natives) {
                if (texture) break;
                texture = native.find(unit.resource);
                if (texture) check_kind(*texture, unit);
            }
            if (!texture)
                failed(fmt::format("render: the texture {} of {} does not exist", unit.resource,
                                   unit.owner));
            texture->bind(static_cast<unsigned>(unit.unit));
        }
    }

    const gl::Texture* core_texture(const std::string& name, const Terrain& ground) const {
        if (name == "gbuffer") return &gbuffer;
        if (name == kHeightStepsTexture) return &height_steps;
        if (name == "radiance") return &radiance;
        if (name == "overlay") return &overlay;
        if (name == "floor_ground") return &footprint;
        if (name == "colour") return &tone_mapped;
        if (name == "depth") return &depth;
        if (const gl::Texture* const pages = ground.texture(name)) return pages;
        if (name == kVaryings) return &varyings;
        return nullptr;
    }

    void draw_fullscreen() const {
        no_inputs.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    /// Has the light by place be there that the programs read.
    void light(Terrain& ground, const FrameInputs& inputs, FrameBlock& block) const {
        const double pixel_rad = length(glm::dvec3(block.pixel_ray_dx));
        // Where no ground is in sight the light of whatever sun there is does, else the coarsest.
        const bool sees_ground = tiles.triangles() > 0;
        const double pixel_posts = sees_ground
                                       ? tiles.nearest_m() * pixel_rad / ground.normal_spacing_m()
                                       : std::numeric_limits<double>::infinity();
        if (reads_sun && (sees_ground || !ground.light().followed()))
            ground.light().follow(inputs.sun, inputs.exaggeration, pixel_posts);
        if (reads_sky) ground.light().look_up(inputs.exaggeration);
        if (reads_sun || reads_sky) ground.light().describe(block);
    }

    /// Has the layers of pages be there that the programs read, and says in the block what they
    /// read of the ground.
    void describe(Terrain& ground, const FrameInputs& inputs, FrameBlock& block) const {
        if (reads_surface) ground.keep_surface();
        if (reads_water) ground.keep_water();
        block.normal_levels = static_cast<float>(ground.normal_levels());
        block.normal_texels_per_m = static_cast<float>(1 / ground.normal_spacing_m());
        if (reads_climate) ground.keep_climate(day_of(inputs.unix_s)).write(block);
        const dem::Pyramid& posts = ground.pyramid();
        block.posts = {posts.columns(), posts.rows(), 1.0F / static_cast<float>(posts.columns()),
                       1.0F / static_cast<float>(posts.rows())};
    }

    void bind_blocks(const FrameBlock& block) {
        frame_block.write(std::as_bytes(std::span(&block, 1)));
        frame_block.bind_uniform(kFrameBinding);
        if (params_block.size() > 0) params_block.bind_uniform(kParamsBinding);
    }

    std::optional<double> probe_height_m(Terrain& ground, const Ground& about,
                                         const FrameInputs& inputs, FrameBlock block) {
        describe(ground, inputs, block);
        probe.aim(inputs, about, block);
        const TileSelection below = ground.select_below(
            inputs.camera, options.width_px, options.height_px, inputs.exaggeration, inputs.afresh);
        bind_blocks(block);
        probe.bind();
        if (ground.has_holes()) glEnable(GL_CLIP_DISTANCE0);
        bind(program(here("geometry")), ground);
        watched(here("geometry"), below.triangles(),
                [&] { ground.draw(below, inputs.camera.eye_m); });
        glDisable(GL_CLIP_DISTANCE0);
        glDisable(GL_DEPTH_TEST);
        return probe.height_m();
    }

    // In one piece: the passes of a frame in their order.
    void draw(Terrain& ground, const Ground& about, const FrameInputs& inputs, FrameBlock block,
              PassTimes* times) {
        move(is_outside(about, inputs.camera.eye_m, inputs.exaggeration));
        describe(ground, inputs, block);

        auto began = std::chrono::steady_clock::now();
        const auto passed = [&](const char* name) {
            if (!times) return;
            context.finish();
            const auto now = std::chrono::steady_clock::now();
            times->emplace_back(name,
                                std::chrono::duration<double, std::milli>(now - began).count());
            began = now;
        };

        if (outside && footprint_of != ground.serial()) {
            footprint = footprint_texture(about.footprint);
            footprint_of = ground.serial();
        }
        tiles = ground.select_for_picture(inputs.camera, options.width_px, options.height_px,
                                          inputs.exaggeration, inputs.loading, inputs.afresh);
        passed("select");

        light(ground, inputs, block);
        if (reads_sun || reads_sky) passed("light");
        bind_blocks(block);

        if (!natives.empty()) {
            for (NativeHost& native : natives) {
                if (inputs.keep_native && native_is_made) continue;
                // Twice its patience at least: a module that hangs by itself is named by its own
                // deadline, not by this one.
                constexpr double kMapParts = 4e6;
                watched("depth", std::max(pixels(), kMapParts),
                        [&] { native.prepare(ground, about, inputs, block, tiles); });
                if (native.take_changes() && params_block.size() > 0)
                    params_block.write(shader::pack(texts.front().stitched.params, values));
                passed(native.id().c_str());
            }
            native_is_made = true;
            frame_block.bind_uniform(kFrameBinding);
        }

        geometry_target.bind();
        glEnable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);  // clearing obeys it too
        geometry_target.clear_depth(0);
        glDepthFunc(GL_GREATER);
        if (ground.has_holes()) glEnable(GL_CLIP_DISTANCE0);
        bind(program(here("geometry")), ground);
        draw_ground(ground, inputs);
        glDisable(GL_CLIP_DISTANCE0);
        passed("geometry");

        // The full-screen triangle lies at depth 0, the far end: "less" lets it through where
        // something nearer was drawn, "equal" where nothing was.
        const bool overlaid = overlay.name() != 0;
        ground_target.bind();
        if (overlaid) ground_target.clear_colour(1, glm::vec4(0));
        if (options.audited) ground_target.clear_colour(overlaid ? 2 : 1, glm::vec4(0));
        glDepthMask(GL_FALSE);
        glDepthFunc(GL_LESS);
        bind(program(here("terrain")), ground);
        draw_picture(here("terrain"));
        passed("terrain");
        if (outside) {
            glDepthMask(GL_TRUE);
            glDepthFunc(GL_GREATER);
            side_target.bind();
            bind(program("side"), ground);
            watched("side", pixels(), [&] { ground.draw_sides(tiles, inputs.camera.eye_m); });
            glDepthMask(GL_FALSE);
            passed("side");
        }
        light_target.bind();
        glDepthFunc(GL_EQUAL);
        const std::string behind = background_of(block);
        bind(program(behind), ground);
        draw_picture(behind);
        glDisable(GL_DEPTH_TEST);
        passed("background");

        if (find_text("post")) {
            post_target.bind();
            bind(program("post"), ground);
            draw_picture("post");
            passed("post");
        }
        if (options.antialias) {
            // Two draws: the first marks the few pixels of silhouettes, the second works on those.
            picture.copy_from(tone_mapped);
            picture_target.bind();
            picture_target.clear_stencil(0);
            glEnable(GL_STENCIL_TEST);
            glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
            glStencilFunc(GL_ALWAYS, 1, 0xff);
            glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
            bind(program("edges"), ground);
            draw_fullscreen();
            glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
            glStencilFunc(GL_EQUAL, 1, 0xff);
            glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
            bind(program("antialias"), ground);
            draw_fullscreen();
            glDisable(GL_STENCIL_TEST);
            passed("antialias");
        }
        context.check_errors();
        watch.reset();
    }
};

namespace {

void check_size(const gl::Context& context, int width_px, int height_px) {
    const int most = context.info().max_picture_size;
    if (width_px > most || height_px > most)
        bad_input(
            fmt::format("render: picture: expected a width and a height of up to {} px, "
                        "which {} draws at once, but got {} x {}; take a smaller --size",
                        most, context.info().renderer, width_px, height_px));
}

}  // namespace

Renderer::Renderer(gl::Context& context, const EffectInputs& effects,
                   const RendererOptions& options) {
    check_size(context, options.width_px, options.height_px);
    impl_ = std::make_unique<Impl>(context, effects, options);
}

Renderer::~Renderer() = default;

const std::vector<ProgramText>& Renderer::texts() const {
    return impl_->texts;
}

FrameBlock Renderer::Impl::prepare(Terrain& terrain, const Ground& ground, FrameInputs& inputs) {
    inputs.displacement = displacement_of(displaces, values);
    terrain.displace(inputs.displacement);
    const double limit = anisotropy > 1 ? anisotropy : kFootprintWithoutAnisotropy;
    return make_frame_block(inputs, ground, options.width_px, options.height_px, limit);
}

void Renderer::render_frame(Terrain& terrain, const Ground& ground, const FrameInputs& frame,
                            PassTimes* times) {
    FrameInputs inputs = frame;
    const FrameBlock block = impl_->prepare(terrain, ground, inputs);
    impl_->exposure = block.exposure;
    impl_->draw(terrain, ground, inputs, block, times);
}

std::optional<double> Renderer::drawn_height_m(Terrain& terrain, const Ground& ground,
                                               const FrameInputs& frame) {
    FrameInputs inputs = frame;
    const FrameBlock block = impl_->prepare(terrain, ground, inputs);
    return impl_->probe_height_m(terrain, ground, inputs, block);
}

void Renderer::set_values(const shader::ParamStore& values) {
    for (const shader::Param* param : impl_->values.params()) {
        const shader::Param* const given = values.find(param->address);
        if (!given || given->type != param->type || param->is_static || param->is_host) continue;
        impl_->values.set(param->address, values.value(param->address));
    }
    if (impl_->params_block.size() > 0)
        impl_->params_block.write(
            shader::pack(impl_->texts.front().stitched.params, impl_->values));
}

void Renderer::resize(int width_px, int height_px) {
    if (width_px == impl_->options.width_px && height_px == impl_->options.height_px) return;
    check_size(impl_->context, width_px, height_px);
    impl_->options.width_px = width_px;
    impl_->options.height_px = height_px;
    impl_->make_targets();
    for (NativeHost& native : impl_->natives)
        native.resize(width_px, height_px);
}

const gl::Texture& Renderer::picture() const {
    return impl_->picture;
}

void Renderer::read_depths(std::vector<float>& depths_m) const {
    depths_m.resize(static_cast<std::size_t>(impl_->pixels()));
    impl_->depth.read(0, std::as_writable_bytes(std::span(depths_m)));
    const auto near_m = static_cast<float>(kNear_m);
    for (float& depth : depths_m)
        depth = near_m / depth;
}

std::vector<SunSeen> Renderer::read_sun_seen() const {
    assert(impl_->options.audited);
    const auto pixels = static_cast<std::size_t>(impl_->pixels());
    std::vector<glm::vec4> seen(pixels);
    impl_->sun_seen.read(0, std::as_writable_bytes(std::span(seen)));
    std::vector<glm::uvec4> what(pixels);
    impl_->gbuffer.read(0, std::as_writable_bytes(std::span(what)));
    std::vector<float> depths_m;
    read_depths(depths_m);
    std::vector<SunSeen> result;
    for (std::size_t i = 0; i < pixels; ++i) {
        const glm::vec4& v = seen[i];
        // Walls of a block are drawn over ground behind them.
        const float ground_m = std::bit_cast<float>(what[i].w);
        if (v.w == 0 || depths_m[i] < 0.999F * ground_m) continue;
        result.push_back({.post = {v.x, v.y},
                          .share = v.z,
                          .pixel_posts = std::abs(double{v.w}),
                          .faces = v.w > 0,
                          .moved = v.z < 0});
    }
    return result;
}

bool Renderer::reads_climate() const {
    return impl_->reads_climate;
}

Displacement Renderer::displacement() const {
    return displacement_of(impl_->displaces, impl_->values);
}

bool Renderer::shows_block() const {
    return impl_->shows_block();
}

const shader::ParamStore& Renderer::values() const {
    return impl_->values;
}

int Renderer::triangles() const {
    return impl_->tiles.triangles();
}

int count_not_numbers(std::span<const std::uint8_t> rgba) {
    int count = 0;
    for (std::size_t alpha = 3; alpha < rgba.size(); alpha += 4)
        count += rgba[alpha] != 255;
    return count;
}

image::Image8 Renderer::read_picture(int* not_numbers) const {
    const int width = impl_->options.width_px, height = impl_->options.height_px;
    std::vector<std::uint8_t> texels(static_cast<std::size_t>(width) *
                                     static_cast<std::size_t>(height) * 4);
    impl_->picture.read(0, std::as_writable_bytes(std::span(texels)));
    if (not_numbers) *not_numbers = count_not_numbers(texels);
    return image::from_device(width, height, texels);
}

image::ImageF Renderer::read_radiance(int* not_numbers) const {
    assert(impl_->options.radiance);
    const int width = impl_->options.width_px, height = impl_->options.height_px;
    std::vector<float> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                              4);
    impl_->radiance.read_floats(texels);
    if (not_numbers) {
        *not_numbers = 0;
        for (std::size_t alpha = 3; alpha < texels.size(); alpha += 4)
            *not_numbers += texels[alpha] != 1;
    }
    // The passes store exposed light.
    const auto scale = static_cast<float>(1 / impl_->exposure);
    image::ImageF picture(width, height, 3);
    for (int y = 0; y < height; ++y) {
        const float* from = texels.data() + static_cast<std::size_t>(height - 1 - y) *
                                                static_cast<std::size_t>(width) * 4;
        float* to = picture.row(y);
        for (int x = 0; x < width; ++x, from += 4, to += 3)
            std::transform(from, from + 3, to, [&](float value) { return value * scale; });
    }
    return picture;
}

}  // namespace relevo::render
