// What a native module asks of the device wrongly is refused, and leaves nothing behind.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <relevo/plugin.h>
#include <sys/stat.h>

#include "base/units.h"
#include "dem/load.h"
#include "effect/native_module.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/view.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_native_host {
namespace {

using Act = std::function<relevo_status(const relevo_host*)>;

Act* now = nullptr;

constexpr const char* kTail = "; --disable puppet goes on without it";

/// A service of the host that the module was given.
template <typename Table>
const Table& service(const relevo_host* host, const char* name) {
    return *static_cast<const Table*>(host->service(host, name, 1));
}

class NativeHostTest : public testing::Test {
  protected:
    NativeHostTest() {
        std::filesystem::create_directories(folder_);
        std::filesystem::copy(test::build_dir() / "tests/modules/puppet.so", folder_ / "puppet.so");
        manifest_.id = manifest_.module = "puppet";
        manifest_.folder = folder_;
    }

    /// Draws frames in which the module does that.
    /// @returns the error that ends it
    std::string draw(const Act& act, const std::string& glsl = "", int frames = 1) {
        const effect::NativeModule module = effect::NativeModule::load(manifest_, {});
        void* library = dlopen(module.library().c_str(), RTLD_NOW | RTLD_NOLOAD);
        *static_cast<relevo_status (**)(const relevo_host*)>(dlsym(library, "puppet_prepare")) =
            [](const relevo_host* host) { return (*now)(host); };
        Act copy = act;
        now = &copy;
        const std::string error = test::error_of([&] {
            const dem::Heightfield dem =
                dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
            const Ground ground = make_ground(dem);
            const gl::Context context({.device = test::gl_device(), .debug = true});
            const shader::Snippet snippet = shader::parse_snippet("puppet", "puppet.glsl", glsl);
            shader::ParamStore values;
            values.declare(core_params());
            EffectInputs effects;
            if (!glsl.empty()) effects.stitch.snippets = {&snippet};
            effects.stitch.values = &values;
            effects.modules = {&module};
            Renderer renderer(const_cast<gl::Context&>(context), effects,
                              {.width_px = 64, .height_px = 48});
            Terrain terrain(dem, ground.frame, {});
            FrameInputs inputs;
            const geo::Geodetic place = dem.grid.center();
            inputs.sun =
                make_sun_light(sun::position(sun::parse_time("2026-06-21T15:00Z").utc, place),
                               sun::Refraction::standard(place), ground, dem.grid);
            inputs.camera = scene::orbit_camera({180, 40, 1}, points_to_show(dem, ground, 1),
                                                radians(40), 64.0 / 48);
            for (int i = 0; i < frames; ++i)
                renderer.render_frame(terrain, ground, inputs);
            is_watched_ = renderer.is_watched();
        });
        dlclose(library);
        return error;
    }

    std::string head() const {
        return fmt::format("exit 1: render: {}: it cannot prepare a frame: ",
                           (folder_ / "puppet.so").string());
    }

    std::filesystem::path folder_ = test::scratch_dir("native_host") / "puppet";
    effect::Manifest manifest_;
    bool is_watched_ = false;  ///< after the last frame
};

relevo_texture_info texture_info(int format, int side, int levels = 1) {
    relevo_texture_info info{};
    info.size = sizeof info;
    info.format = format;
    info.width = info.height = side;
    info.levels = levels;
    return info;
}

TEST_F(NativeHostTest, TexturesHaveNoMoreLevelsThanTheirSide) {
    std::vector<int> statuses;
    const std::string error = draw([&](const relevo_host* host) {
        const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
        for (const int levels : {0, 7, 8, 99, -1}) {
            const relevo_texture_info info = texture_info(RELEVO_FORMAT_R32F, 64, levels);
            relevo_texture texture = 0;
            statuses.push_back(textures.create(textures.self, &info, &texture));
            EXPECT_EQ(texture != 0, statuses.back() == RELEVO_OK);
        }
        relevo_texture_info info = texture_info(RELEVO_FORMAT_R32F, 64);
        info.filter = 9;
        relevo_texture texture = 0;
        statuses.push_back(textures.create(textures.self, &info, &texture));
        return RELEVO_OK;
    });
    EXPECT_EQ(error, "no error");
    EXPECT_THAT(statuses, testing::ElementsAre(RELEVO_OK, RELEVO_OK, RELEVO_FAILED, RELEVO_FAILED,
                                               RELEVO_FAILED, RELEVO_FAILED));
}

/// Has the module ask for a program, and fail if it does not get it.
Act ask_for(const std::string& file) {
    return [file](const relevo_host* host) {
        const auto& draws = service<relevo_draw_1>(host, "relevo.draw");
        relevo_program program = 0;
        return draws.program(draws.self, file.c_str(), &program);
    };
}

TEST_F(NativeHostTest, ProgramsAreOfThePluginsFolder) {
    std::ofstream(folder_ / "good.glsl") << "out vec4 colour; void main() { colour = values[0]; }";
    const std::filesystem::path other = folder_.parent_path() / "other.glsl";
    std::ofstream(other) << "void main() {}";
    std::filesystem::create_symlink("../other.glsl", folder_ / "link.glsl");
    EXPECT_EQ(draw(ask_for("good.glsl")), "no error");
    for (const std::string& file :
         {std::string("../other.glsl"), std::string("link.glsl"), other.string()})
        EXPECT_EQ(draw(ask_for(file)),
                  head() +
                      fmt::format("render: {}: expected a file of the plugin's own folder but "
                                  "got {}",
                                  folder_.string(), file) +
                      kTail);
    ASSERT_EQ(mkfifo((folder_ / "pipe.glsl").c_str(), 0600), 0);
    EXPECT_EQ(draw(ask_for("pipe.glsl")),
              head() +
                  fmt::format("render: {}: cannot be read, it is not a regular file",
                              (folder_ / "pipe.glsl").string()) +
                  kTail);
}

TEST_F(NativeHostTest, WhatTheDriverRefusesOfAProgramHasFileAndLine) {
    const std::filesystem::path file = folder_ / "bad.glsl";
    std::ofstream(file)
        << "out vec4 colour;\r\n\r\nvoid main() {\r\n    colour = nowhere;\r\n}\r\n";
    const std::string error = draw(ask_for("bad.glsl"));
    EXPECT_THAT(error, testing::StartsWith(head() +
                                           fmt::format("{0}: the driver refuses it\n{0}:4: error: ",
                                                       file.string())));
    EXPECT_TRUE(error.ends_with(kTail)) << error;
}

TEST_F(NativeHostTest, ADrawHasAnInputOfItsKindForEachSamplerAndDoesNotReadItsTarget) {
    std::ofstream(folder_ / "copy.glsl")
        << "layout(binding = 0) uniform sampler2D one;\nlayout(binding = 1) uniform sampler2DArray "
           "many;\nout vec4 colour;\n"
           "void main() { colour = texture(one, vec2(0.5)) + texture(many, vec3(0.5)); }\n";
    std::vector<std::string> errors;
    for (int k = 0; k < 4; ++k)
        errors.push_back(draw([k](const relevo_host* host) {
            const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
            const auto& draws = service<relevo_draw_1>(host, "relevo.draw");
            relevo_texture_info info = texture_info(RELEVO_FORMAT_RGBA16F, 4);
            relevo_texture target = 0, flat = 0, layered = 0;
            textures.create(textures.self, &info, &target);
            textures.create(textures.self, &info, &flat);
            info.layers = 2;
            textures.create(textures.self, &info, &layered);
            const relevo_texture inputs[4][2] = {
                {flat, layered}, {target, layered}, {flat, flat}, {flat, layered}};
            relevo_draw drawn{};
            drawn.size = sizeof drawn;
            drawn.target = target;
            drawn.inputs = inputs[k];
            drawn.input_count = k == 3 ? 1 : 2;
            draws.program(draws.self, "copy.glsl", &drawn.program);
            return draws.draw(draws.self, &drawn);
        }));
    EXPECT_THAT(
        errors,
        testing::ElementsAre(
            "no error",
            head() + "relevo.draw: draw: expected a target that the same draw does not read" +
                kTail,
            head() +
                "expected a texture of the kind that many of unit 1 reads but got one of "
                "sampler2D" +
                kTail,
            head() + "expected an input for many of unit 1 but got 1 inputs" + kTail));
}

TEST_F(NativeHostTest, ATextureOfAnotherKindThanItsSamplerIsAnError) {
    const std::string error = draw(
        [](const relevo_host* host) {
            const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
            relevo_texture_info info = texture_info(RELEVO_FORMAT_R32F, 4);
            info.name = "map";
            relevo_texture texture = 0;
            return textures.create(textures.self, &info, &texture);
        },
        "uniform sampler2DArray puppet_map;\n"
        "void puppet_on_albedo(inout Surface s) {\n"
        "    s.diffuse = texture(puppet_map, vec3(0.5)).rgb;\n"
        "}\n");
    EXPECT_EQ(error,
              "exit 1: render: puppet: sampler2DArray puppet_map: expected a texture of that kind, "
              "but the module creates puppet.map as sampler2D");
}

TEST_F(NativeHostTest, OnlyFirstDrawsAreUnderAWatch) {
    // Of a module whose first draw comes in its second frame, such as shadows at sunrise.
    int frame = 0, drawn = 0;
    const Act from_the_second_on = [&](const relevo_host* host) {
        if (frame++ == 0) return RELEVO_OK;
        const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
        const auto& terrain = service<relevo_terrain_1>(host, "relevo.terrain");
        const relevo_texture_info info = texture_info(RELEVO_FORMAT_DEPTH32F, 64);
        relevo_texture texture = 0;
        textures.create(textures.self, &info, &texture);
        relevo_box box{};
        box.size = sizeof box;
        box.right[0] = box.up[1] = box.towards[2] = 1;
        terrain.bounds(terrain.self, &box);
        drawn += terrain.draw_depth(terrain.self, &box, 10, texture, nullptr) == RELEVO_OK;
        return RELEVO_OK;
    };
    EXPECT_EQ(draw(from_the_second_on, "", 1), "no error");
    EXPECT_TRUE(is_watched_);
    frame = 0;
    EXPECT_EQ(draw(from_the_second_on, "", 2), "no error");
    EXPECT_FALSE(is_watched_);
    EXPECT_EQ(drawn, 1);
}

TEST_F(NativeHostTest, AFailedDepthPassLeavesTheStateAsItWas) {
    bool drawn = true;
    std::vector<GLenum> left;
    draw(
        [&](const relevo_host* host) {
            const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
            const auto& terrain = service<relevo_terrain_1>(host, "relevo.terrain");
            const relevo_texture_info info = texture_info(RELEVO_FORMAT_DEPTH32F, 64);
            relevo_texture texture = 0;
            textures.create(textures.self, &info, &texture);
            relevo_box box{};
            box.size = sizeof box;
            box.right[0] = box.up[1] = box.towards[2] = 1;
            terrain.bounds(terrain.self, &box);
            drawn = terrain.draw_depth(terrain.self, &box, 10, texture, nullptr) == RELEVO_OK;
            for (const GLenum capability :
                 {GL_CULL_FACE, GL_CLIP_DISTANCE0, GL_DEPTH_CLAMP, GL_DEPTH_TEST})
                if (glIsEnabled(capability)) left.push_back(capability);
            return RELEVO_OK;
        },
        // The texture is never made, so that the pass cannot be drawn.
        "uniform sampler2D puppet_map;\n"
        "void puppet_on_displace(in VertexFrame v, inout vec3 position_m) {\n"
        "    position_m.z += textureLod(puppet_map, vec2(0.5), 0.0).r;\n"
        "}\n");
    EXPECT_FALSE(drawn);
    EXPECT_THAT(left, testing::IsEmpty());
}

TEST_F(NativeHostTest, ADepthPassNeedsABoxAndATolerance) {
    std::vector<relevo_status> statuses;
    const std::string error = draw([&](const relevo_host* host) {
        const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
        const auto& terrain = service<relevo_terrain_1>(host, "relevo.terrain");
        const relevo_texture_info info = texture_info(RELEVO_FORMAT_DEPTH32F, 64);
        relevo_texture texture = 0;
        textures.create(textures.self, &info, &texture);
        relevo_box box{};
        box.size = sizeof box;
        box.right[0] = box.up[1] = box.towards[2] = 1;
        terrain.bounds(terrain.self, &box);
        const auto ask = [&](double tolerance_m) {
            statuses.push_back(
                terrain.draw_depth(terrain.self, &box, tolerance_m, texture, nullptr));
        };
        ask(10);
        ask(std::nan(""));
        ask(-1);
        box.low[0] = box.high[0];
        ask(10);
        return RELEVO_OK;
    });
    EXPECT_EQ(error, "no error");
    EXPECT_THAT(statuses,
                testing::ElementsAre(RELEVO_OK, RELEVO_FAILED, RELEVO_FAILED, RELEVO_FAILED));
}

/// A frame with a module of tests/abi, which asks every service on a device what it asks the
/// stand-in.
std::string draw_with(const std::string& library) {
    const std::filesystem::path folder = test::scratch_dir("native_probe_" + library) / "probe";
    std::filesystem::copy(test::source_dir() / "tests/abi/plugin", folder);
    std::filesystem::copy(test::build_dir() / "tests/abi" / (library + ".so"), folder / "probe.so");
    effect::Manifest manifest;
    manifest.id = manifest.module = "probe";
    manifest.folder = folder;
    manifest.marks.emplace_back().name = "places";  // which the module sets
    const shader::Snippet snippet =
        shader::parse_snippet("probe", "probe.glsl",
                              "uniform float probe_size = 3.0; //@ range(0, 9)\n"
                              "uniform vec4 probe_level = vec4(0.0); //@ host\n");
    return test::error_of([&] {
        shader::ParamStore values;
        std::vector<shader::Param> params = core_params();
        params.insert(params.end(), snippet.source.params.begin(), snippet.source.params.end());
        shader::TextParam track;
        track.address = "probe.track";
        values.declare(params, {track});
        const effect::NativeModule module = effect::NativeModule::load(manifest, values);
        const dem::Heightfield dem =
            dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
        const Ground ground = make_ground(dem);
        gl::Context context({.device = test::gl_device(), .debug = true});
        EffectInputs effects;
        effects.stitch.snippets = {&snippet};
        effects.stitch.values = &values;
        effects.modules = {&module};
        Renderer renderer(context, effects, {.width_px = 64, .height_px = 48});
        Terrain terrain(dem, ground.frame, {});
        FrameInputs inputs;
        const geo::Geodetic place = dem.grid.center();
        const sun::Instant noon = sun::parse_time("2026-06-21T15:00Z").utc;
        inputs.sun = make_sun_light(sun::position(noon, place), sun::Refraction::standard(place),
                                    ground, dem.grid);
        inputs.unix_s = static_cast<double>(noon.unix_us()) * 1e-6;
        inputs.camera = scene::orbit_camera({180, 40, 1}, points_to_show(dem, ground, 1),
                                            radians(40), 64.0 / 48);
        renderer.render_frame(terrain, ground, inputs);
    });
}

TEST(NativeHost, DoesForModulesOfTheInterfaceWhatTheStandInDoes) {
    for (const char* library : {"c_module", "cpp_module", "grown_cpp_module"})
        EXPECT_EQ(draw_with(library), "no error") << library;
}

TEST_F(NativeHostTest, TellsOfTheFrameHeightsAndPlaces) {
    std::vector<std::string> wrong;
    const dem::Heightfield dem =
        dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    const std::string error = draw([&](const relevo_host* host) {
        const auto expect = [&](bool good, const char* what) {
            if (!good) wrong.push_back(what);
        };
        const auto& heights = service<relevo_heights_1>(host, "relevo.heights");
        relevo_heights about{};
        about.size = sizeof about;
        heights.describe(heights.self, &about);
        expect(about.columns == dem.grid.columns() && about.rows == dem.grid.rows(), "size");
        relevo_nodes nodes{};
        nodes.size = sizeof nodes;
        nodes.column = 17;
        nodes.row = 40;
        nodes.columns = 5;
        nodes.rows = 3;
        std::vector<float> read(15);
        expect(heights.read(heights.self, &nodes, read.data(), read.size()) == RELEVO_OK, "read");
        for (int i = 0; i < 15; ++i)
            expect(read[static_cast<std::size_t>(i)] == dem.height_m.at(17 + i % 5, 40 + i / 5),
                   "a post");

        const auto& geo = service<relevo_geo_1>(host, "relevo.geo");
        const geo::Geodetic place = dem.grid.place(100, 200);
        const double lat_lon_height[3] = {degrees(place.lat_rad), degrees(place.lon_rad), 500};
        double local[3], post[2];
        geo.to_local(geo.self, lat_lon_height, local);
        const glm::dvec3 known =
            make_ground(dem).frame.to_local({place.lat_rad, place.lon_rad, 500});
        expect(length(glm::dvec3(local[0], local[1], local[2]) - known) < 1e-6, "local");
        geo.to_post(geo.self, lat_lon_height, post);
        expect(std::abs(post[0] - 100) < 1e-6 && std::abs(post[1] - 200) < 1e-6, "post");

        // What the matrices make of a point is the picture's.
        const auto& frames = service<relevo_frame_1>(host, "relevo.frame");
        relevo_frame frame{};
        frame.size = sizeof frame;
        frames.get(frames.self, &frame);
        const auto times = [](const double(&m)[16], const glm::dvec4& v) {
            glm::dvec4 result(0);
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    result[row] += m[4 * column + row] * v[column];
            return result;
        };
        const glm::dvec3 forward(frame.forward[0], frame.forward[1], frame.forward[2]);
        const glm::dvec3 up(frame.up[0], frame.up[1], frame.up[2]);
        const double tan_y = std::tan(frame.fov_y_rad / 2);
        const glm::dvec4 upper_edge = times(
            frame.projection, times(frame.view, glm::dvec4(1000.0 * (forward + tan_y * up), 1)));
        expect(std::abs(upper_edge.y / upper_edge.w - 1) < 1e-9, "the upper edge");
        expect(std::abs(upper_edge.x) < 1e-9 && std::abs(upper_edge.w - 1000) < 1e-6, "its middle");
        expect(frame.exposure > 0.1 && frame.exposure < 10, "exposure");
        return RELEVO_OK;
    });
    EXPECT_EQ(error, "no error");
    EXPECT_THAT(wrong, testing::IsEmpty());
}

TEST_F(NativeHostTest, WrittenTexelsAreRead) {
    std::vector<float> read(16);
    const std::string error = draw([&](const relevo_host* host) {
        const auto& textures = service<relevo_texture_1>(host, "relevo.texture");
        const relevo_texture_info info = texture_info(RELEVO_FORMAT_R32F, 4);
        relevo_texture texture = 0;
        textures.create(textures.self, &info, &texture);
        const std::vector<float> zeros(16), four{1, 2, 3, 4};
        relevo_texels texels{};
        texels.size = sizeof texels;
        texels.texture = texture;
        texels.width = texels.height = 4;
        texels.texels = zeros.data();
        texels.bytes = 64;
        textures.write(textures.self, &texels);
        texels.x = 2;
        texels.y = 1;
        texels.width = texels.height = 2;
        texels.texels = four.data();
        texels.bytes = 16;
        textures.write(textures.self, &texels);
        return textures.read(textures.self, texture, 0, read.data(), read.size());
    });
    EXPECT_EQ(error, "no error");
    EXPECT_THAT(read, testing::ElementsAre(0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 3, 4, 0, 0, 0, 0));
}

}  // namespace
}  // namespace relevo::render::test_native_host
