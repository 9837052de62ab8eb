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
#include <sys/stat.h>

#include "base/units.h"
#include "dem/load.h"
#include "effect/abi/relevo_plugin.h"
#include "effect/native_module.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/view.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/support.h"

namespace relevo::render {
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

    /// Draws a frame in which the module does that.
    /// @returns the error that ends it
    std::string draw(const Act& act, const std::string& glsl = "") {
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
            const gl::Context context({.device = "software", .debug = true});
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
            renderer.render_frame(terrain, ground, inputs);
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

}  // namespace
}  // namespace relevo::render
