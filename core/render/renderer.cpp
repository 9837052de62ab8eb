#include "render/renderer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/units.h"
#include "gl/texture.h"
#include "render/air_textures.h"
#include "render/background_linker.h"
#include "render/eye_post.h"
#include "render/footprint_texture.h"
#include "render/frame_runner.h"
#include "render/ground_probe.h"
#include "render/instances.h"
#include "render/light_by_height.h"
#include "render/native_host.h"
#include "render/programs.h"
#include "render/readback.h"
#include "sky/path.h"
#include "sun/time.h"

namespace relevo::render {
namespace {

/// @throws Error (Failed) if a texture's kind differs from its sampler's, which would read black
void check_kind(const gl::Texture& texture, const shader::TextureUnit& unit) {
    const std::string_view kind = gl::sampler_name(texture.kind());
    // "usampler2DArray" ends with it as well.
    if (unit.type.ends_with(kind) || unit.type == fmt::format("{}Shadow", kind)) return;
    failed(fmt::format(
        "render: {}: {} {}: expected a texture of that kind, but the module creates {} as {}",
        unit.owner, unit.type, unit.name, unit.resource, kind));
}

constexpr unsigned kFrameBinding = 0;
constexpr unsigned kParamsBinding = 1;

/// Greatest ratio of a pixel footprint's sides. Anisotropic filters resolve it. Without one, slight
/// aliasing is preferable to blur.
constexpr double kFootprintWithoutAnisotropy = 2.5;
constexpr double kAnisotropy = 8;

/// Day of the year, 0 to 364.
int day_of(double unix_s) {
    const sun::Date date = (sun::Instant() + unix_s).utc().date;
    return climate::day_of_year(date.month, date.day);
}

}  // namespace

struct Renderer::Impl : FrameServices {
    gl::Context& context;
    RendererOptions options;
    double anisotropy;
    std::optional<SharedResources> own;  // unless shared ones are given
    SharedResources& shared;
    StitchedFrames frames;
    WatchedPrograms programs;
    EffectTextures effect_textures;
    LineTextures line_textures;
    gl::RingBuffer blocks{"frame blocks"};
    gl::RingBuffer::Place frame_block;  // last upload
    gl::Buffer params_block;
    std::vector<effect::DisplaceSpec> displaces;
    shader::ParamStore values;  // as given; native modules also write host parameters
    Instances plugin_instances;
    double exposure = 1;  // of the last frame
    TileSelection tiles;  // of the last frame
    GroundProbe probe;
    AirTextures air;
    LightByHeight light;
    gl::Texture footprint;  // of the last ground that was seen from outside
    std::vector<NativeHost> natives;
    bool native_is_made = false;     // prepared in an earlier frame
    bool native_is_current = false;  // prepared for the last frame of any renderer
    bool outside;                    // the graph for eyes outside is in use
    FrameRunner runner;
    std::vector<const shader::Snippet*> snippets;
    std::optional<BackgroundLinker> linker;  // last member: its thread reads the snippets

    Impl(gl::Context& c, const EffectInputs& effects, const RendererOptions& o)
        : context(c),
          options(o),
          // Software renderers pay for each tap: anisotropy would quadruple the frame's time.
          anisotropy(c.info().device.software ? 1 : std::min(kAnisotropy, c.info().max_anisotropy)),
          own(o.shared ? std::nullopt : std::optional<SharedResources>(std::in_place)),
          shared(o.shared ? *o.shared : *own),
          frames(stitch(effects, c.info(), o)),
          programs(frames, shared.programs, effects.stitch.snippets),
          effect_textures(effects.textures, anisotropy, shared.textures),
          line_textures(effects.lines),
          displaces(effects.displaces),
          plugin_instances(effects.stitch.instances, values),
          outside(o.outside && shows_block()),
          runner(
              c, frames, programs, shared.targets,
              [this](const shader::TextureUnit& unit, const Terrain& terrain) {
                  return find_texture(unit, terrain);
              },
              values),
          snippets(effects.stitch.snippets) {
        if (effects.stitch.values) {
            values = *effects.stitch.values;
            const std::vector<std::byte> params = shader::pack(layout(), values);
            if (!params.empty()) params_block = gl::Buffer(params, "parameters");
        }
        runner.set_poison(options.poison);
        runner.arrange(outside, options.width_px, options.height_px);
        link();
        for (const effect::NativeModule* module : effects.modules)
            natives.emplace_back(
                *module, context,
                [this](const Terrain& terrain, const auto& draw) { draw_depth(terrain, draw); },
                values, options.width_px, options.height_px);
    }

    bool shows_block() const { return frames.outside.has_value(); }
    const shader::BlockLayout& layout() const { return frames.programs.front().stitched.params; }

    /// Links the first frame's programs, so that driver errors are reported now.
    void link() {
        std::vector<std::string> names;
        for (const Plan::Step& step : runner.plan().steps) {
            const Pass& pass = runner.graph().passes[static_cast<std::size_t>(step.pass)];
            if (!pass.program.empty()) names.push_back(pass.program);
        }
        for (const std::string& name : names)
            programs.begin(name);
        for (const std::string& name : names)
            programs.link(name);
    }

    /// Links programs of later frames in the background: for night, and for the other graph.
    void link_rest() {
        if (linker) return;
        std::vector<ProgramText> rest;
        for (const ProgramText& text : frames.programs)
            if (!shared.programs.find(text)) rest.push_back(text);
        linker.emplace(context, std::move(rest), snippets);
        runner.leave_plain_programs();
    }

    /// Adds programs that were linked in the background.
    void take_linked() {
        if (!linker) return;
        for (auto& [hash, program] : linker->take())
            shared.programs.add(hash, std::move(program));
    }

    void move(bool is_outside) {
        const bool wanted = is_outside && shows_block();
        if (outside == wanted && runner.is_arranged()) return;
        runner.arrange(wanted, options.width_px, options.height_px);
        plugin_instances.forget_shadows();
        outside = wanted;
    }

    void upload_blocks(const FrameBlock& block) override {
        frame_block =
            blocks.write(std::as_bytes(std::span(&block, 1)), gl::RingBuffer::uniform_alignment());
        frame_block.bind_uniform(kFrameBinding);
        if (params_block.size() > 0) params_block.bind_uniform(kParamsBinding);
    }

    void make_footprint(const Footprint& of) override { footprint = footprint_texture(of); }

    Instances& instances() override { return plugin_instances; }

    void prepare_native(const std::string& id, PassContext& frame) override {
        if (frame.inputs.freeze_native && native_is_current) return;
        NativeHost& native = *std::ranges::find(natives, id, &NativeHost::id);
        const auto prepare = [&] {
            native.prepare(frame.terrain, frame.ground, frame.inputs, frame.block, frame.tiles);
        };
        // The first call is watched: the module draws with its own programs as well.
        if (native_is_made)
            prepare();
        else
            programs.draw_watched("depth", depth_parts(), prepare);
        if (native.take_changes() && params_block.size() > 0)
            params_block.write(shader::pack(layout(), values));
        frame_block.bind_uniform(kFrameBinding);
    }

    /// Called by native effects. Their first frame is already watched.
    void draw_depth(const Terrain& terrain, const std::function<void()>& draw) {
        runner.use("depth", terrain);
        if (!native_is_made) return draw();
        programs.draw("depth", depth_parts(), draw);
        programs.set_proven("depth");
    }

    /// At least twice the time limit of a native effect, so that a module that hangs is reported by
    /// its own deadline.
    double depth_parts() const {
        constexpr double kMapParts = 4e6;
        return std::max(pixels(), kMapParts);
    }

    double pixels() const { return double{1} * options.width_px * options.height_px; }

    const gl::Texture* find_texture(const shader::TextureUnit& unit, const Terrain& terrain) const {
        if (unit.resource == "floor_ground") return &footprint;
        if (const gl::Texture* const found = air.texture(unit.resource)) return found;
        if (const gl::Texture* const found = light.texture(unit.resource)) return found;
        if (const gl::Texture* const found = terrain.texture(unit.resource)) return found;
        if (const gl::Texture* const found = effect_textures.find(unit.resource)) return found;
        if (const gl::Texture* const found = line_textures.find(unit.resource)) return found;
        for (const NativeHost& native : natives)
            if (const gl::Texture* const found = native.find(unit.resource)) {
                check_kind(*found, unit);
                return found;
            }
        return nullptr;
    }

    bool reads(std::string_view resource) const { return runner.plan().reads(resource); }

    /// Makes the frame block, and sets `inputs.displacement` and `inputs.atmosphere`.
    FrameBlock prepare(Terrain& terrain, const Ground& ground, FrameInputs& inputs) {
        inputs.displacement = displacement_of(displaces, values);
        inputs.atmosphere = ground_air_of(values);
        terrain.displace(inputs.displacement);
        line_textures.update(terrain.grid(), terrain.serial(), shared.lines);
        const double limit = anisotropy > 1 ? anisotropy : kFootprintWithoutAnisotropy;
        FrameBlock block =
            make_frame_block(inputs, ground, options.width_px, options.height_px, limit);
        write_eye_post(terrain.grid(), ground.frame.to_geodetic(inputs.camera.eye_m), block);
        return block;
    }

    /// Creates the page layers that programs read, and fills in the terrain's part of the block.
    void describe(Terrain& terrain, const FrameInputs& inputs, FrameBlock& block) {
        if (reads("surface_pages")) terrain.require_surface_pages();
        if (reads("water_pages")) terrain.require_water_pages();
        if (reads("house_pages")) terrain.require_house_pages();
        terrain.write(block);
        write_places(terrain);
        if (reads(kLightByHeightTexture)) light.update(inputs, block);
        update_air(inputs, block);
        if (reads(kClimateTexture)) terrain.natural().update_climate(day_of(inputs.unix_s), block);
        if (reads(kLandAroundTexture)) terrain.natural().update_land(block);
    }

    /// Makes the tables of the air that programs read. Of a block the sky is seen in water alone,
    /// which mirrors what is over the ground and not what is over an eye beyond the air.
    void update_air(const FrameInputs& inputs, FrameBlock& block) {
        AirView view{.height_m = outside ? inputs.sun.ground_height_m : double{block.eye_m.w},
                     .parts = {.sky = reads(kAirSkyTexture), .between = reads(kAirBetweenTexture)}};
        if (!view.parts.sky && !view.parts.between) return;
        view.light = air_light(inputs, outside ? glm::dvec3(0, 0, 1) : glm::dvec3(block.eye_up));
        air.update(air_of(values), view, block);
        if (outside)
            block.eye_up.w = static_cast<float>(sky::horizon_sine(std::max(view.height_m, 0.0)));
    }

    /// Writes where effects' rasters and fields lie, for the functions of effect::raster_glsl() and
    /// effect::field_glsl().
    void write_places(const Terrain& terrain) {
        bool changed = false;
        const auto write = [&](const std::string& address, const glm::vec4& to) {
            const shader::ParamValue value{to.x, to.y, to.z, to.w};
            if (!values.find(address) || values.value(address) == value) return;
            values.write_host(address, value);
            changed = true;
        };
        for (const auto& [name, raster] : terrain.rasters().all()) {
            const RasterPlace at = terrain.rasters().place(name);
            write(name + "_place", at.place);
            write(name + "_shape", at.shape);
        }
        for (const auto& [name, field] : terrain.fields().all()) {
            const FieldPlace at = terrain.fields().place(name);
            write(name + "_place", at.place);
            write(name + "_shape", at.shape);
        }
        if (changed && params_block.size() > 0) params_block.write(shader::pack(layout(), values));
    }

    const std::string& geometry_program() const {
        return std::ranges::find(runner.graph().passes, "geometry", &Pass::name)->program;
    }

    std::optional<double> probe_height_m(Terrain& terrain, const Ground& ground,
                                         const FrameInputs& inputs, FrameBlock block) {
        describe(terrain, inputs, block);
        probe.aim(inputs, ground, block);
        const glm::ivec2 picture = picture_px(inputs, options.width_px, options.height_px);
        const TileSelection below = terrain.select_below(inputs, picture);
        upload_blocks(block);
        const std::string& program = geometry_program();
        runner.use(program, terrain);
        return probe.height_m(terrain.has_voids(), [&] {
            programs.draw(program, below.triangles(),
                          [&] { terrain.draw(below, inputs.camera.eye_m); });
        });
    }

    void draw(Terrain& terrain, const Ground& ground, const FrameInputs& inputs, FrameBlock block,
              PassTimes* times) {
        move(is_outside(ground, inputs));
        describe(terrain, inputs, block);
        PassContext frame{.terrain = terrain,
                          .ground = ground,
                          .inputs = inputs,
                          .block = block,
                          .tiles = tiles,
                          .width_px = options.width_px,
                          .height_px = options.height_px,
                          .plan = runner.plan(),
                          .targets = runner.targets(),
                          .services = *this};
        const bool night = block.eye_sun.w < radians(kNight_deg);
        runner.run(frame, night, times);
        native_is_made = native_is_current = true;
        context.check_errors();
    }
};

namespace {

void check_size(const gl::Context& context, int width_px, int height_px) {
    const int most = context.info().max_picture_size;
    if (width_px > most || height_px > most)
        bad_input(
            fmt::format("render: picture: {} x {} px is more than the {} px a side that {} "
                        "draws; use a smaller --size",
                        width_px, height_px, most, context.info().renderer));
}

}  // namespace

Renderer::Renderer(gl::Context& context, const EffectInputs& effects,
                   const RendererOptions& options) {
    check_size(context, options.width_px, options.height_px);
    impl_ = std::make_unique<Impl>(context, effects, options);
}

Renderer::~Renderer() = default;

const std::vector<ProgramText>& Renderer::texts() const {
    return impl_->frames.programs;
}

void Renderer::render_frame(Terrain& terrain, const Ground& ground, const FrameInputs& frame,
                            PassTimes* times) {
    FrameInputs inputs = frame;
    const FrameBlock block = impl_->prepare(terrain, ground, inputs);
    impl_->exposure = block.exposure;
    impl_->take_linked();
    impl_->draw(terrain, ground, inputs, block, times);
}

double Renderer::exposure() const {
    return impl_->exposure;
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
        impl_->params_block.write(shader::pack(impl_->layout(), impl_->values));
}

void Renderer::link_rest() {
    impl_->link_rest();
}

void Renderer::release_targets() {
    impl_->runner.release();
    impl_->take_linked();
    if (impl_->linker) impl_->linker->stop();
    impl_->native_is_current = false;
}

void Renderer::resize(int width_px, int height_px) {
    const bool same = width_px == impl_->options.width_px && height_px == impl_->options.height_px;
    if (same && impl_->runner.is_arranged()) return;
    check_size(impl_->context, width_px, height_px);
    impl_->runner.arrange(impl_->outside, width_px, height_px);
    impl_->plugin_instances.forget_shadows();
    impl_->options.width_px = width_px;
    impl_->options.height_px = height_px;
    for (NativeHost& native : impl_->natives)
        native.resize(width_px, height_px);
}

std::shared_ptr<const effect::ModuleMarks> Renderer::module_marks(const std::string& id,
                                                                  const std::string& list) const {
    const auto native = std::ranges::find(impl_->natives, id, &NativeHost::id);
    return native == impl_->natives.end() ? nullptr : native->marks(list);
}

const gl::Texture& Renderer::output() const {
    return impl_->runner.texture("output");
}

const gl::Texture& Renderer::depth() const {
    return impl_->runner.texture("depth");
}

void Renderer::read_depths(std::vector<float>& depths_m) const {
    depths_m = render::read_depths(depth());
}

std::vector<SunSeen> Renderer::read_sun_seen() const {
    assert(impl_->options.audited);
    return render::read_sun_seen(impl_->runner.texture("sun_seen"),
                                 impl_->runner.texture("gbuffer"), impl_->runner.texture("depth"));
}

bool Renderer::is_animated() const {
    static constexpr std::string_view kSeconds = "frame.seconds";
    return std::ranges::any_of(impl_->frames.programs, [](const ProgramText& text) {
        return std::ranges::any_of(text.stitched.stages(), [](const shader::StageText* stage) {
            return stage->text.find(kSeconds) != std::string::npos;
        });
    });
}

bool Renderer::reads_climate() const {
    return impl_->reads(kClimateTexture);
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

bool Renderer::is_watched() const {
    return impl_->programs.is_watching();
}

int Renderer::triangles() const {
    return impl_->tiles.triangles();
}

image::Image8 Renderer::read_output(int* non_finite) const {
    return render::read_output(output(), non_finite);
}

image::Image16 Renderer::read_output16(int* non_finite) const {
    assert(impl_->options.deep);
    return render::read_output16(output(), non_finite);
}

PixelData Renderer::read_data() const {
    assert(impl_->options.data);
    const gl::Texture* const albedo =
        impl_->options.albedo ? &impl_->runner.texture(kAlbedoTexture) : nullptr;
    return render::read_data(impl_->runner.texture(kSurfaceTexture), depth(), albedo);
}

NonFinite Renderer::non_finite() const {
    return find_non_finite(output());
}

image::ImageF Renderer::read_radiance(int* non_finite) const {
    assert(impl_->options.radiance);
    return render::read_radiance(impl_->runner.texture("radiance"), impl_->exposure, non_finite);
}

}  // namespace relevo::render
