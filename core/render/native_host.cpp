#include "render/native_host.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/text.h"
#include "base/units.h"
#include "effect/module_services.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/draw_scope.h"
#include "render/native_textures.h"
#include "shader/driver_hints.h"
#include "shader/tokenizer.h"

namespace relevo::render {
namespace {

constexpr unsigned kFrameBlockBinding = 0;

glm::dvec3 vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void write_vector(const glm::dvec3& from, double (&to)[3]) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

void write_matrix(const glm::dmat4& from, double (&to)[16]) {
    for (int i = 0; i < 16; ++i)
        to[i] = from[i / 4][i % 4];
}

glm::dmat3 axes_of(const relevo_box& box) {
    return {vector_of(box.right), vector_of(box.up), vector_of(box.towards)};
}

/// Inputs of the frame that is being prepared.
struct FrameState {
    Terrain& terrain;
    const Ground& ground;
    const FrameInputs& inputs;
    const FrameBlock& block;
    const TileSelection& tiles;
};

}  // namespace

struct NativeHost::Impl : effect::ModuleServices {
    const effect::NativeModule& module;
    gl::Context& context;
    DrawDepth draw_ground;
    shader::ParamStore& values;
    int width_px, height_px;

    NativeTextures textures;
    struct OwnProgram {
        gl::Program program;
        std::vector<gl::Program::Sampler> samplers;
    };
    std::map<relevo_program, OwnProgram> programs;
    gl::VertexArray no_inputs;
    gl::Buffer frame_block{sizeof(FrameBlock), "sun frame block"};
    std::map<std::string, std::shared_ptr<const effect::ModuleMarks>> marks;
    std::optional<FrameState> state;
    bool changed = true;
    void* instance = nullptr;

    Impl(const effect::NativeModule& m, gl::Context& c, DrawDepth d, shader::ParamStore& v,
         int width, int height)
        : module(m),
          context(c),
          draw_ground(std::move(d)),
          values(v),
          width_px(width),
          height_px(height),
          textures(m.id()) {
        offer_all();
    }
    ~Impl() override {
        if (!instance) return;
        const effect::ModuleCall call(module.process(), "destroy()");
        try {
            module.functions().destroy(instance);
        } catch (...) {
            log::warning(module.process().message("destroy()", "threw an exception"));
        }
    }

    std::shared_ptr<void> device_at_work() override {
        return std::make_shared<effect::ModuleCall::Pause>();
    }

    void log(int level, const char* text) override { effect::log_of_module(level, text); }

    // ---- parameters

    Value parameter(const char* address) override {
        const shader::ParamValue known = values.value(address);
        Value value{};
        std::copy(known.begin(), known.end(), value.begin());
        return value;
    }

    void set_parameter(const char* address, const Value& value) override {
        const shader::ParamValue wanted{value[0], value[1], value[2], value[3]};
        const shader::ParamValue before = values.value(address);
        values.write_host(address, wanted);
        changed = changed || before != wanted;
    }

    std::string text(const char* address) override { return values.text(address); }

    void set_marks(const char* list, effect::ModuleMarks given) override {
        if (std::ranges::count(module.mark_lists(), list) == 0)
            throw std::invalid_argument(effect::no_list_text(list));
        marks[list] = std::make_shared<const effect::ModuleMarks>(std::move(given));
    }

    // ---- textures

    int max_texture_side() const override { return context.info().max_texture_size; }
    int max_texture_layers() const override { return context.info().max_array_layers; }
    void create_texture(relevo_texture texture, const effect::ModuleTexture& info) override {
        textures.create(texture, info);
    }
    void destroy_texture(relevo_texture texture) override { textures.destroy(texture); }
    void write_texture(const relevo_texels& texels) override { textures.write(texels); }
    void make_mipmaps(relevo_texture texture) override { textures.get(texture).make_mipmaps(); }
    void read_texture(relevo_texture texture, int layer, std::span<float> out) override {
        textures.read(texture, layer, out);
    }

    // ---- the frame and its programs

    bool in_frame() const override { return state.has_value(); }

    relevo_frame frame() override {
        const FrameState& drawn = *state;
        const scene::Camera& camera = drawn.inputs.camera;
        relevo_frame full{};
        const glm::ivec2 picture = picture_px(drawn.inputs, width_px, height_px);
        full.width_px = picture.x;
        full.height_px = picture.y;
        full.software_device = context.info().device.software ? 1 : 0;
        full.ground = drawn.terrain.serial();
        full.unix_s = drawn.inputs.unix_s;
        write_vector(camera.eye_m, full.eye_m);
        write_vector(cross(camera.forward, camera.up), full.right);
        write_vector(camera.up, full.up);
        write_vector(camera.forward, full.forward);
        full.fov_y_rad = camera.fov_y_rad;
        full.pixel_rad = length(glm::dvec3(drawn.block.pixel_ray_dx));
        write_matrix(view_matrix(camera), full.view);
        write_matrix(projection_matrix(camera, picture.x, picture.y), full.projection);
        full.exposure = static_cast<double>(drawn.block.exposure);
        write_vector(drawn.inputs.direct_light().direction, full.sun);
        write_vector(normalize(glm::dvec3(drawn.block.sun_apparent)), full.sun_apparent);
        full.exaggeration = drawn.inputs.exaggeration;
        full.lowest_m = drawn.ground.lowest_m;
        full.highest_m = drawn.ground.highest_m;
        full.post_spacing_m = drawn.terrain.normal_spacing_m();
        full.afresh = drawn.inputs.deterministic ? 1 : 0;
        return full;
    }

    void create_program(relevo_program id, const char* name) override {
        const auto path = file_inside(module.folder(), name);
        if (!path)
            failed(fmt::format("render: {}: expected a file of the plugin's own folder but got {}",
                               module.folder().string(), name));
        const std::string file = path->string();
        const std::string own = shader::unix_lines(read_text(*path, "render"));
        const NativeProgramText text = native_program_text(own);
        gl::Program::Failure failure;
        auto program =
            gl::Program::build(text.vertex, text.fragment, path->filename().string(), failure);
        if (!program) {
            shader::LineMap lines(2);  // lines of the preamble
            for (int line = 1; line <= 1 + std::ranges::count(own, '\n'); ++line)
                lines.push_back({module.id(), file, line});
            failed(fmt::format(
                "{}: the driver refuses it\n{}", file,
                shader::brief_text(shader::parse_driver_log(failure.log, lines), {own, {}, {}})));
        }
        std::vector<gl::Program::Sampler> samplers = program->samplers();
        programs.emplace(id, OwnProgram{std::move(*program), std::move(samplers)});
    }

    void destroy_program(relevo_program program) override { programs.erase(program); }

    void check_inputs(const OwnProgram& program, const relevo_draw& draw) {
        const std::span inputs(draw.inputs, static_cast<std::size_t>(draw.input_count));
        for (const gl::Program::Sampler& sampler : program.samplers) {
            if (sampler.unit >= draw.input_count)
                failed(fmt::format("expected an input for {} of unit {} but got {} inputs",
                                   sampler.name, sampler.unit, draw.input_count));
            const gl::TextureKind kind =
                textures.get(inputs[static_cast<std::size_t>(sampler.unit)]).kind();
            if (sampler.kind != kind)
                failed(
                    fmt::format("expected a texture of the kind that {} of unit {} reads but "
                                "got one of {}",
                                sampler.name, sampler.unit, gl::sampler_name(kind)));
        }
    }

    void draw(const relevo_draw& draw) override {
        const OwnProgram& program = programs.at(draw.program);
        check_inputs(program, draw);
        const gl::Framebuffer& framebuffer =
            textures.colour_framebuffer(draw.target, draw.level, draw.layer);
        program.program.use();
        for (int i = 0; i < draw.input_count; ++i)
            textures.get(draw.inputs[i]).bind(static_cast<unsigned>(i));
        if (draw.value_count > 0) glUniform4fv(0, draw.value_count, draw.values);
        const DrawScope scope(framebuffer, {});
        no_inputs.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    // ---- the ground

    bool fill_box(relevo_box& box, const TileSelection* selection, double nearer_than_m) const {
        const FrameState& drawn = *state;
        const auto extent =
            drawn.terrain.extent(axes_of(box), drawn.inputs.exaggeration, selection, nearer_than_m);
        if (!extent) return false;
        write_vector(extent->low, box.low);
        write_vector(extent->high, box.high);
        return true;
    }

    void fill_bounds(relevo_box& box) override {
        if (!fill_box(box, nullptr, 0)) failed("this DEM has no ground");
    }
    bool fill_visible_bounds(double nearer_than_m, relevo_box& box) override {
        return fill_box(box, &state->tiles, nearer_than_m);
    }

    int draw_depth(const relevo_box& box, double tolerance_m, relevo_texture target) override {
        const FrameState& drawn = *state;
        const gl::Texture& depth_texture = textures.get(target);
        const glm::dmat3 axes = axes_of(box);
        const glm::dvec3 low = vector_of(box.low), high = vector_of(box.high);
        const glm::dvec3 origin_m = axes * (0.5 * (low + high));

        LodView view;
        view.tolerance = tolerance_m;
        view.exaggeration = drawn.inputs.exaggeration;
        for (int i = 0; i < 2; ++i) {
            view.planes.emplace_back(axes[i], -low[i]);
            view.planes.emplace_back(-axes[i], high[i]);
        }
        const TileSelection tiles = drawn.terrain.select(view, &drawn.tiles);

        FrameInputs inputs = drawn.inputs;
        inputs.camera.eye_m = origin_m;
        FrameBlock block = make_frame_block(inputs, drawn.ground, depth_texture.extent().width,
                                            depth_texture.extent().height, 1);
        const glm::dvec3 scale = 1.0 / (high - low);
        glm::dmat4 matrix(0);
        for (int i = 0; i < 3; ++i) {
            matrix[i][0] = 2 * scale.x * axes[0][i];
            matrix[i][1] = 2 * scale.y * axes[1][i];
            matrix[i][2] = scale.z * axes[2][i];
        }
        matrix[3][2] = 0.5;
        matrix[3][3] = 1;
        block.view_projection = glm::mat4(matrix);
        frame_block.write(std::as_bytes(std::span(&block, 1)));
        frame_block.bind_uniform(kFrameBlockBinding);

        const gl::Framebuffer& framebuffer = textures.depth_framebuffer(target);
        DrawState drawing{
            .depth = Depth{"depth", DepthTest::Nearer, /*writes=*/true, /*clear=*/0.0F},
            .clips_voids = drawn.terrain.has_voids(),
            .clamps_depth = true};
        // Light hits the upper side of ground first, except under voids.
        if (!drawn.terrain.has_voids())
            drawing.winds_counterclockwise = drawn.terrain.winds_counterclockwise();
        const DrawScope scope(framebuffer, drawing);
        draw_ground(drawn.terrain, [&] { drawn.terrain.draw(tiles, origin_m); });
        return tiles.finest_level();
    }

    relevo_heights heights() override {
        const dem::Pyramid& pyramid = state->terrain.pyramid();
        relevo_heights heights{};
        heights.columns = pyramid.columns();
        heights.rows = pyramid.rows();
        heights.levels = pyramid.levels();
        return heights;
    }

    void read_heights(const relevo_nodes& nodes, std::span<float> heights_m) override {
        const dem::Pyramid& pyramid = state->terrain.pyramid();
        const glm::ivec2 size = pyramid.size(nodes.level);
        if (nodes.column > size.x || nodes.row > size.y || nodes.column < -size.x ||
            nodes.row < -size.y || nodes.columns > 3 * size.x || nodes.rows > 3 * size.y)
            failed(fmt::format("expected nodes on a level of {} x {} or near it", size.x, size.y));
        const dem::Pyramid::Block block =
            pyramid.block(nodes.level, {nodes.column, nodes.row}, nodes.columns, nodes.rows);
        float* to = heights_m.data();
        for (int row = 0; row < nodes.rows; ++row)
            for (int column = 0; column < nodes.columns; ++column)
                *to++ = block.coverage.at(column, row) > 0
                            ? block.height_m.at(column, row)
                            : std::numeric_limits<float>::quiet_NaN();
    }

    // ---- places

    Point to_local(const Point& at) override {
        const glm::dvec3 local =
            state->ground.frame.to_local(geo::geodetic_deg(at[0], at[1], at[2]));
        return {local.x, local.y, local.z};
    }
    Point from_local(const Point& local_m) override {
        const geo::Geodetic at =
            state->ground.frame.to_geodetic({local_m[0], local_m[1], local_m[2]});
        return {degrees(at.lat_rad), degrees(at.lon_rad), at.height_m};
    }
    Pair to_post(const Pair& at) override {
        const glm::dvec2 post = state->terrain.grid().post(geo::geodetic_deg(at[0], at[1], 0));
        return {post.x, post.y};
    }
    Pair from_post(const Pair& post) override {
        const geo::Geodetic at = state->terrain.grid().place(post[0], post[1]);
        return {degrees(at.lat_rad), degrees(at.lon_rad)};
    }

    /// Calls a function of the module.
    /// @param what  describes a failure in the message
    /// @throws Error (Failed) if it returns an error or throws
    template <typename Body>
    void call(const char* function, const char* what, const Body& body) {
        clear_reason();
        std::string reason;
        bool good = false;
        try {
            const effect::ModuleCall guard(module.process(), function);
            good = body() == RELEVO_OK;
        } catch (const std::exception& error) {
            reason = fmt::format("its {} threw an exception: {}", function, error.what());
        } catch (...) {
            reason = fmt::format("its {} threw an exception", function);
        }
        if (reason.empty()) reason = this->reason();
        if (!good)
            failed(fmt::format("render: {}: {}: {}; --disable {} goes on without it",
                               module.library().string(), what,
                               reason.empty() ? "no reason given" : reason, module.id()));
    }
};

NativeProgramText native_program_text(std::string_view own) {
    return {
        "#version 450 core\n"
        "void main() {\n"
        "    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0,\n"
        "                       gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);\n"
        "}\n",
        fmt::format("#version 450 core\nlayout(location = 0) uniform vec4 values[{}];\n{}",
                    RELEVO_MAX_VALUES, own)};
}

NativeHost::NativeHost(const effect::NativeModule& module, gl::Context& context,
                       DrawDepth draw_depth, shader::ParamStore& values, int width_px,
                       int height_px)
    : impl_(std::make_unique<Impl>(module, context, std::move(draw_depth), values, width_px,
                                   height_px)) {
    impl_->call("create()", "it cannot start",
                [&] { return module.functions().create(impl_->host(), &impl_->instance); });
}

NativeHost::NativeHost(NativeHost&&) noexcept = default;
NativeHost& NativeHost::operator=(NativeHost&&) noexcept = default;
NativeHost::~NativeHost() = default;

void NativeHost::prepare(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                         const FrameBlock& block, const TileSelection& tiles) {
    const auto& functions = impl_->module.functions();
    if (!functions.prepare) return;
    impl_->state.emplace(FrameState{terrain, ground, inputs, block, tiles});
    const struct EndOfFrame {
        Impl& impl;
        ~EndOfFrame() { impl.state.reset(); }
    } end_of_frame{*impl_};
    impl_->call("prepare()", "it cannot prepare a frame",
                [&] { return functions.prepare(impl_->instance); });
}

void NativeHost::resize(int width_px, int height_px) {
    impl_->width_px = width_px;
    impl_->height_px = height_px;
}

const gl::Texture* NativeHost::find(std::string_view resource) const {
    return impl_->textures.find(resource);
}

std::shared_ptr<const effect::ModuleMarks> NativeHost::marks(const std::string& list) const {
    const auto found = impl_->marks.find(list);
    return found == impl_->marks.end() ? nullptr : found->second;
}

const std::string& NativeHost::id() const {
    return impl_->module.id();
}

bool NativeHost::take_changes() {
    return std::exchange(impl_->changed, false);
}

}  // namespace relevo::render
