#include "render/native_host.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"
#include "base/text.h"
#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "render/native_textures.h"
#include "shader/driver_log.h"
#include "shader/tokenizer.h"

namespace relevo::render {
namespace {

constexpr unsigned kFrameBinding = 0;

/// Writes as much of `full` as the other side knows of.
template <typename Struct>
void copy_out(const Struct& full, Struct* to) {
    const std::uint32_t size = std::min<std::uint32_t>(to->size, sizeof full);
    std::memcpy(to, &full, size);
    to->size = size;
}

/// What the other side knows of, the rest at zero.
template <typename Struct>
Struct copy_in(const Struct* from) {
    Struct full{};
    std::memcpy(&full, from, std::min<std::size_t>(from->size, sizeof full));
    return full;
}

glm::dvec3 vector_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void write_vector(const glm::dvec3& from, double (&to)[3]) {
    for (int i = 0; i < 3; ++i)
        to[i] = from[i];
}

glm::dmat3 axes_of(const relevo_box& box) {
    return {vector_of(box.right), vector_of(box.up), vector_of(box.towards)};
}

/// Switches off at its end, however that comes, what draw_depth() switches on.
struct DepthState {
    DepthState() = default;
    DepthState(const DepthState&) = delete;
    DepthState& operator=(const DepthState&) = delete;
    ~DepthState() {
        for (const GLenum capability :
             {GL_CULL_FACE, GL_CLIP_DISTANCE0, GL_DEPTH_CLAMP, GL_DEPTH_TEST})
            glDisable(capability);
    }
};

/// What relevo_frame says beside the ground.
struct FrameState {
    Terrain& terrain;
    const Ground& ground;
    const FrameInputs& inputs;
    const FrameBlock& block;
    const TileSelection& picture;
};

}  // namespace

struct NativeHost::Impl {
    const effect::NativeModule& module;
    gl::Context& context;
    UseDepth use_depth;
    shader::ParamStore& values;
    int width_px, height_px;

    /// What the module is handed, and back from there.
    struct OwnHost : relevo_host {
        Impl* owner = nullptr;
    };
    OwnHost host{};
    relevo_log_1 log_table{};
    relevo_params_1 params_table{};
    relevo_frame_1 frame_table{};
    relevo_texture_1 texture_table{};
    relevo_draw_1 draw_table{};
    relevo_terrain_1 terrain_table{};

    NativeTextures textures;
    std::vector<gl::Program> programs;
    gl::VertexArray no_inputs;
    gl::Buffer frame_block{sizeof(FrameBlock), "sun frame block"};
    std::optional<FrameState> frame;
    std::string reason;
    bool changed = true;
    void* instance = nullptr;

    Impl(const effect::NativeModule& m, gl::Context& c, UseDepth d, shader::ParamStore& v,
         int width, int height)
        : module(m),
          context(c),
          use_depth(std::move(d)),
          values(v),
          width_px(width),
          height_px(height),
          textures(m.id(), c.info()) {
        host.size = sizeof(relevo_host);
        host.owner = this;
        host.abi_version = RELEVO_ABI_VERSION;
        host.service = &Impl::service;
        host.fail = [](const relevo_host* h, const char* text) {
            of(h).reason = text ? text : "no reason given";
        };
        fill_tables();
    }
    ~Impl() {
        if (!instance) return;
        const effect::ModuleCall call(module.process(), "destroy()");
        try {
            module.functions().destroy(instance);
        } catch (...) {
            log::warning(module.process().message("destroy()", "threw an exception"));
        }
    }

    static Impl& of(const relevo_host* h) { return *static_cast<const OwnHost*>(h)->owner; }
    static Impl& of(void* self) { return *static_cast<Impl*>(self); }

    static const void* service(const relevo_host* h, const char* name, std::uint32_t version) {
        Impl& impl = of(h);
        const std::pair<std::string_view, const void*> tables[] = {
            {"relevo.log", &impl.log_table},     {"relevo.params", &impl.params_table},
            {"relevo.frame", &impl.frame_table}, {"relevo.texture", &impl.texture_table},
            {"relevo.draw", &impl.draw_table},   {"relevo.terrain", &impl.terrain_table},
        };
        if (version != 1) return nullptr;
        for (const auto& [known, table] : tables)
            if (known == name) return table;
        return nullptr;
    }

    /// Runs a service's body; nothing that it throws reaches the module.
    template <typename Body>
    static relevo_status serve(void* self, const Body& body) noexcept {
        Impl& impl = of(self);
        try {
            body(impl);
            return RELEVO_OK;
        } catch (const std::bad_alloc&) {
            impl.reason = "there is not enough memory";
        } catch (const std::exception& error) {
            impl.reason = error.what();
        }
        return RELEVO_FAILED;
    }

    /// The same for a body that draws or waits for the device, whose time is not the module's.
    template <typename Body>
    static relevo_status serve_device(void* self, const Body& body) noexcept {
        const effect::ModuleCall::Pause pause;
        return serve(self, body);
    }

    [[noreturn]] void refuse(const std::string& what) const { failed(what); }

    const FrameState& now() const {
        if (!frame) refuse("no frame is drawn now; ask inside prepare()");
        return *frame;
    }

    void fill_tables() {
        log_table = {sizeof log_table, this, [](void*, std::int32_t level, const char* text) {
                         if (level >= RELEVO_LOG_WARNING)
                             log::warning(text);
                         else if (level == RELEVO_LOG_INFO)
                             log::info(text);
                         else
                             log::debug(text);
                     }};
        params_table = {
            sizeof params_table, this,
            [](void* self, const char* address, double value[4]) {
                return serve(self, [&](Impl& impl) {
                    const shader::ParamValue known = impl.values.value(address);
                    std::copy(known.begin(), known.end(), value);
                });
            },
            [](void* self, const char* address, const double value[4]) {
                return serve(self, [&](Impl& impl) {
                    const shader::ParamValue wanted{value[0], value[1], value[2], value[3]};
                    if (impl.values.value(address) == wanted) return;
                    impl.values.write_host(address, wanted);
                    impl.changed = true;
                });
            }};
        frame_table = {sizeof frame_table, this, [](void* self, relevo_frame* out) {
                           return serve(self, [&](Impl& impl) { impl.describe_frame(out); });
                       }};
        texture_table = {sizeof texture_table,
                         this,
                         [](void* self, const relevo_texture_info* info, relevo_texture* out) {
                             return serve_device(self, [&](Impl& impl) {
                                 *out = impl.textures.create(copy_in(info));
                             });
                         },
                         [](void* self, relevo_texture name) {
                             const effect::ModuleCall::Pause pause;
                             of(self).textures.destroy(name);
                         },
                         [](void* self, relevo_texture name) {
                             return serve_device(
                                 self, [&](Impl& impl) { impl.textures.get(name).make_mipmaps(); });
                         },
                         [](void* self, relevo_texture name, std::int32_t layer, float* out,
                            std::uint64_t count) {
                             return serve_device(self, [&](Impl& impl) {
                                 impl.textures.read(name, layer, out, count);
                             });
                         }};
        draw_table = {sizeof draw_table, this,
                      [](void* self, const char* file, relevo_program* out) {
                          return serve_device(self,
                                              [&](Impl& impl) { *out = impl.make_program(file); });
                      },
                      [](void* self, const relevo_draw* draw) {
                          return serve_device(self, [&](Impl& impl) { impl.run(copy_in(draw)); });
                      }};
        terrain_table = {sizeof terrain_table, this,
                         [](void* self, relevo_box* box) {
                             return serve_device(self, [&](Impl& impl) {
                                 if (!impl.fill_box(box, nullptr, 0))
                                     impl.refuse("this DEM has no ground");
                             });
                         },
                         [](void* self, double nearer_than_m, relevo_box* box) {
                             bool any = false;
                             const relevo_status status = serve_device(self, [&](Impl& impl) {
                                 any = impl.fill_box(box, &impl.now().picture, nearer_than_m);
                             });
                             return any ? status : RELEVO_FAILED;
                         },
                         [](void* self, const relevo_box* box, double tolerance_m,
                            relevo_texture target, std::int32_t* level) {
                             return serve_device(self, [&](Impl& impl) {
                                 const int drawn =
                                     impl.draw_depth(copy_in(box), tolerance_m, target);
                                 if (level) *level = drawn;
                             });
                         }};
    }

    // ---- services

    void describe_frame(relevo_frame* out) const {
        const FrameState& state = now();
        relevo_frame full{};
        full.width_px = width_px;
        full.height_px = height_px;
        write_vector(state.inputs.camera.eye_m, full.eye_m);
        write_vector(state.inputs.camera.forward, full.forward);
        full.pixel_rad = length(glm::dvec3(state.block.pixel_ray_dx));
        write_vector(state.inputs.sun.direction, full.sun);
        write_vector(normalize(glm::dvec3(state.block.sun_apparent)), full.sun_apparent);
        full.exaggeration = state.inputs.exaggeration;
        full.lowest_m = state.ground.lowest_m;
        full.highest_m = state.ground.highest_m;
        full.post_spacing_m = state.terrain.normal_spacing_m();
        full.ground = state.terrain.serial();
        full.software_device = context.info().device.software ? 1 : 0;
        copy_out(full, out);
    }

    relevo_program make_program(const char* name) {
        const auto path = file_inside(module.folder(), name);
        if (!path)
            refuse(fmt::format("render: {}: expected a file of the plugin's own folder but got {}",
                               module.folder().string(), name));
        const std::string file = path->string();
        const std::string vertex =
            "#version 450 core\n"
            "void main() {\n"
            "    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0,\n"
            "                       gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);\n"
            "}\n";
        const std::string head =
            fmt::format("#version 450 core\nlayout(location = 0) uniform vec4 values[{}];\n",
                        RELEVO_MOST_VALUES);
        const std::string own = shader::unix_lines(read_text(*path, "render"));
        gl::Program::Failure failure;
        auto program = gl::Program::build(vertex, head + own, path->filename().string(), failure);
        if (!program) {
            shader::LineMap lines(2);
            for (int line = 1; line <= 1 + std::count(own.begin(), own.end(), '\n'); ++line)
                lines.push_back({module.id(), file, line});
            refuse(fmt::format("{}: the driver refuses it\n{}", file,
                               shader::parse_driver_log(failure.log, lines).text()));
        }
        programs.push_back(std::move(*program));
        return static_cast<relevo_program>(programs.size());
    }

    void run(const relevo_draw& draw) {
        if (draw.program < 1 || draw.program > programs.size())
            refuse(fmt::format("there is no program {}", draw.program));
        if (draw.input_count < 0 || draw.input_count > RELEVO_MOST_INPUTS || draw.value_count < 0 ||
            draw.value_count > RELEVO_MOST_VALUES)
            refuse(fmt::format("expected up to {} inputs and {} values but got {} and {}",
                               RELEVO_MOST_INPUTS, RELEVO_MOST_VALUES, draw.input_count,
                               draw.value_count));
        const gl::Texture& target = textures.get(draw.target);
        if (draw.layer < 0 || draw.layer >= target.extent().depth || draw.level < 0 ||
            draw.level >= target.levels() || target.format() == gl::Format::Depth32F)
            refuse("expected a layer and a level of a colour texture");
        const gl::Framebuffer framebuffer(target, draw.level, draw.layer, module.id());
        programs[draw.program - 1].use();
        for (int i = 0; i < draw.input_count; ++i)
            textures.get(draw.inputs[i]).bind(static_cast<unsigned>(i));
        if (draw.value_count > 0) glUniform4fv(0, draw.value_count, draw.values);
        glDisable(GL_DEPTH_TEST);
        framebuffer.bind();
        no_inputs.bind();
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

    bool fill_box(relevo_box* out, const TileSelection* selection, double nearer_than_m) const {
        const FrameState& state = now();
        relevo_box box = copy_in(out);
        const auto extent =
            state.terrain.extent(axes_of(box), state.inputs.exaggeration, selection, nearer_than_m);
        if (!extent) return false;
        write_vector(extent->low, box.low);
        write_vector(extent->high, box.high);
        copy_out(box, out);
        return true;
    }

    int draw_depth(const relevo_box& box, double tolerance_m, relevo_texture target) {
        const FrameState& state = now();
        const gl::Texture& depth_texture = textures.get(target);
        if (depth_texture.format() != gl::Format::Depth32F ||
            depth_texture.kind() != gl::TextureKind::D2)
            refuse("expected a target of RELEVO_FORMAT_DEPTH32F without layers");
        const glm::dmat3 axes = axes_of(box);
        const glm::dvec3 low = vector_of(box.low), high = vector_of(box.high);
        if (!(low.x < high.x && low.y < high.y && low.z < high.z))
            refuse("expected a box whose sides are longer than nothing");
        if (!(tolerance_m >= 0))
            refuse(fmt::format("expected a tolerance of 0 m or more but got {}", tolerance_m));
        const glm::dvec3 origin_m = axes * (0.5 * (low + high));

        LodView view;
        view.tolerance = tolerance_m;
        view.exaggeration = state.inputs.exaggeration;
        for (int i = 0; i < 2; ++i) {
            view.planes.emplace_back(axes[i], -low[i]);
            view.planes.emplace_back(-axes[i], high[i]);
        }
        const TileSelection tiles = state.terrain.select(view, &state.picture);

        FrameInputs inputs = state.inputs;
        inputs.camera.eye_m = origin_m;
        FrameBlock block = make_frame_block(inputs, state.ground, depth_texture.extent().width,
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
        frame_block.bind_uniform(kFrameBinding);

        const gl::Framebuffer framebuffer({}, &depth_texture, module.id());
        framebuffer.bind();
        const DepthState left_as_found;
        glEnable(GL_DEPTH_TEST);
        glDepthMask(GL_TRUE);
        framebuffer.clear_depth(0);
        glDepthFunc(GL_GREATER);
        glEnable(GL_DEPTH_CLAMP);
        if (state.terrain.has_holes()) {
            glEnable(GL_CLIP_DISTANCE0);
        } else {
            // Light meets the ground's upper side first. Under a hole it may meet the lower one.
            glEnable(GL_CULL_FACE);
            glFrontFace(state.terrain.turns_left() ? GL_CCW : GL_CW);
        }
        use_depth(state.terrain);
        state.terrain.draw(tiles, origin_m);
        return tiles.finest_level();
    }

    /// Calls a function of the module.
    /// @param what  as a message says that it fails
    /// @throws Error (Failed) if it does, or throws
    template <typename Body>
    void call(const char* function, const char* what, const Body& body) {
        reason.clear();
        bool good = false;
        try {
            const effect::ModuleCall guard(module.process(), function);
            good = body() == RELEVO_OK;
        } catch (const std::exception& error) {
            reason = fmt::format("its {} threw an exception: {}", function, error.what());
        } catch (...) {
            reason = fmt::format("its {} threw an exception", function);
        }
        if (!good)
            failed(fmt::format("render: {}: {}: {}; --disable {} goes on without it",
                               module.library().string(), what,
                               reason.empty() ? "no reason given" : reason, module.id()));
    }
};

NativeHost::NativeHost(const effect::NativeModule& module, gl::Context& context, UseDepth use_depth,
                       shader::ParamStore& values, int width_px, int height_px)
    : impl_(std::make_unique<Impl>(module, context, std::move(use_depth), values, width_px,
                                   height_px)) {
    impl_->call("create()", "it cannot start",
                [&] { return module.functions().create(&impl_->host, &impl_->instance); });
}

NativeHost::NativeHost(NativeHost&&) noexcept = default;
NativeHost& NativeHost::operator=(NativeHost&&) noexcept = default;
NativeHost::~NativeHost() = default;

void NativeHost::prepare(Terrain& terrain, const Ground& ground, const FrameInputs& inputs,
                         const FrameBlock& block, const TileSelection& picture) {
    const auto& functions = impl_->module.functions();
    if (!functions.prepare) return;
    impl_->frame.emplace(FrameState{terrain, ground, inputs, block, picture});
    const struct EndOfFrame {
        Impl& impl;
        ~EndOfFrame() { impl.frame.reset(); }
    } end_of_frame{*impl_};
    impl_->call("prepare()", "it cannot prepare a frame",
                [&] { return functions.prepare(impl_->instance); });
}

const gl::Texture* NativeHost::find(std::string_view resource) const {
    return impl_->textures.find(resource);
}

const std::string& NativeHost::id() const {
    return impl_->module.id();
}

bool NativeHost::take_changes() {
    return std::exchange(impl_->changed, false);
}

}  // namespace relevo::render
