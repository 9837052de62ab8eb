// Hooks that run for every pixel of a picture, and the chain of the sky, in both ways of drawing:
// with stored radiance, and without.
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "scene/camera.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_picture_hooks {
namespace {

constexpr int kWidth_px = 64, kHeight_px = 48;

/// The bundled DEM, half ground and half sky, drawn with effects of a test's own.
class PictureHooks : public testing::TestWithParam<bool> {
  protected:
    struct Drawn {
        image::Image8 picture;
        int non_finite = 0;           // pixels
        std::vector<float> depths_m;  // rows from the bottom
    };

    Drawn draw(const std::vector<std::pair<std::string, std::string>>& effects) {
        std::vector<shader::Snippet> snippets;
        snippets.reserve(effects.size());
        EffectInputs inputs;
        for (const auto& [id, glsl] : effects) {
            snippets.push_back(shader::parse_snippet(id, id + ".glsl", glsl));
            inputs.stitch.snippets.push_back(&snippets.back());
        }
        shader::ParamStore values;
        values.declare(core_params());
        inputs.stitch.values = &values;
        Renderer renderer(context_, inputs,
                          RendererOptions{.width_px = kWidth_px,
                                          .height_px = kHeight_px,
                                          .antialias = false,
                                          .radiance = GetParam()});
        renderer.render_frame(terrain_, ground_, frame());
        context_.check_errors();
        Drawn drawn;
        drawn.picture = renderer.read_output(&drawn.non_finite);
        renderer.read_depths(drawn.depths_m);
        return drawn;
    }

    /// Row from the top, as pictures have it.
    static float depth_m(const Drawn& drawn, int x, int y) {
        return drawn.depths_m[static_cast<std::size_t>((kHeight_px - 1 - y) * kWidth_px + x)];
    }

    FrameInputs frame() const {
        FrameInputs inputs;
        geo::Geodetic eye = dem_.grid.center();
        eye.height_m = 2500;
        inputs.camera = scene::heading_camera(ground_.frame.to_local(eye),
                                              ground_.frame.axes(eye.lat_rad, eye.lon_rad), 300, -4,
                                              radians(40.0));
        const geo::Geodetic place = dem_.grid.center();
        inputs.sun = make_sun_light(sun::position(sun::parse_time("2026-06-21T23:30Z").utc, place),
                                    sun::Refraction::standard(place), ground_, dem_.grid);
        return inputs;
    }

    dem::Heightfield dem_ = dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    Ground ground_ = make_ground(dem_);
    gl::Context context_{{.device = test::gl_device(), .debug = true}};
    Terrain terrain_{dem_, ground_.frame, {.max_array_layers = context_.info().max_array_layers}};
};

TEST_P(PictureHooks, APixelKnowsItsPlaceItsRayAndItsDistance) {
    // What hooks get, as colours of the finished picture.
    const Drawn place = draw({{"probe",
                               "void probe_on_overlay(in Pixel p, inout vec4 over) {\n"
                               "    float far = p.distance_m > 9e8 ? 1.0 : 0.0;\n"
                               "    over = vec4(p.at, far, 1.0);\n"
                               "}\n"}});
    const Drawn distance = draw({{"probe",
                                  "void probe_on_overlay(in Pixel p, inout vec4 over) {\n"
                                  "    over = vec4(p.distance_m / 20000.0, p.direction.z + 0.5,\n"
                                  "                p.at_px.x / 100.0, 1.0);\n"
                                  "}\n"}});
    const scene::Camera camera = frame().camera;
    const double step = 2 * std::tan(camera.fov_y_rad / 2) / kHeight_px;
    int ground = 0, sky = 0;
    for (int y = 0; y < kHeight_px; ++y)
        for (int x = 0; x < kWidth_px; ++x) {
            const bool is_sky = std::isinf(depth_m(place, x, y));
            (is_sky ? sky : ground) += 1;
            EXPECT_NEAR(place.picture.at(x, y, 0), 255 * (x + 0.5) / kWidth_px, 1.01);
            EXPECT_NEAR(place.picture.at(x, y, 1), 255 * (1 - (y + 0.5) / kHeight_px), 1.01);
            EXPECT_EQ(place.picture.at(x, y, 2), is_sky ? 255 : 0);
            const glm::dvec3 ray =
                camera.forward +
                step * (x + 0.5 - kWidth_px / 2) * cross(camera.forward, camera.up) +
                step * (kHeight_px / 2 - y - 0.5) * camera.up;
            const double along_m = is_sky ? 1e9 : length(ray) * depth_m(place, x, y);
            EXPECT_NEAR(distance.picture.at(x, y, 0), std::min(255 * along_m / 20000, 255.0), 1.01);
            EXPECT_NEAR(distance.picture.at(x, y, 1), 255 * (ray.z / length(ray) + 0.5), 1.01);
            EXPECT_NEAR(distance.picture.at(x, y, 2), 255 * (x + 0.5) / 100, 1.01);
        }
    EXPECT_GT(ground, 500);
    EXPECT_GT(sky, 500);
}

TEST_P(PictureHooks, ImageIsBeforeToneMappingAndFinishBehindIt) {
    // Radiance of one half is left alone by the tone mapping; 0.25 is 137 in sRGB.
    const std::string image =
        "void probe_on_image(in Pixel p, inout vec3 radiance) {\n"
        "    radiance = vec3(0.25, 100.0, 0.0);\n"
        "}\n";
    const Drawn mapped = draw({{"probe", image}});
    const Drawn finished =
        draw({{"probe", image + "void probe_on_finish(in Pixel p, inout vec3 colour) {\n"
                                "    colour = vec3(0.25, 0.0, 1.0);\n"
                                "}\n"}});
    for (const int y : {2, kHeight_px - 3}) {  // sky and ground
        EXPECT_NEAR(finished.picture.at(20, y, 0), 137, 1);
        EXPECT_EQ(finished.picture.at(20, y, 1), 0);
        EXPECT_EQ(finished.picture.at(20, y, 2), 255);
        EXPECT_GT(mapped.picture.at(20, y, 1), 240);  // 100, bent to below 1
        EXPECT_EQ(mapped.picture.at(20, y, 2) > 200, true) << "white is where too much light goes";
    }
}

const char* const kLamp =
    "vec3 lamp_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
    "    return with_disc ? vec3(0.4) : vec3(0.1, 0.0, 0.0);\n"
    "}\n"
    "void lamp_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "    radiance = background_radiance(view, false);\n"
    "}\n"
    "void lamp_on_image(in Pixel p, inout vec3 radiance) { radiance /= frame.exposure; }\n";

TEST_P(PictureHooks, TheSkysChainDimsTheDiscAndIsSeenByTheHaze) {
    const Drawn clear = draw({{"lamp", kLamp}});
    const Drawn cloudy = draw(
        {{"cloud",
          "void cloud_on_sky(in vec3 direction, inout vec3 radiance, inout vec3 transmittance) {\n"
          "    radiance = 0.5 * radiance + vec3(0.0, 0.05, 0.0);\n"
          "    transmittance *= 0.5;\n"
          "}\n"},
         {"lamp", kLamp}});
    const auto srgb = [](double linear) {
        return 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    };
    const int sky_row = 2, ground_row = kHeight_px - 3;
    EXPECT_NEAR(clear.picture.at(20, sky_row, 0), srgb(0.4), 2);
    EXPECT_NEAR(clear.picture.at(20, sky_row, 1), srgb(0.4), 2);
    // The sky without its disc halved and lit by the cloud, and half of the disc.
    EXPECT_NEAR(cloudy.picture.at(20, sky_row, 0), srgb(0.05 + 0.5 * 0.3), 2);
    EXPECT_NEAR(cloudy.picture.at(20, sky_row, 1), srgb(0.05 + 0.5 * 0.4), 2);
    EXPECT_NEAR(clear.picture.at(20, ground_row, 0), srgb(0.1), 2);
    EXPECT_NEAR(cloudy.picture.at(20, ground_row, 0), srgb(0.05), 2);
    EXPECT_NEAR(cloudy.picture.at(20, ground_row, 1), srgb(0.05), 2);
}

TEST_P(PictureHooks, SeveralRunOneAfterAnother) {
    const auto halves = [](const std::string& id) {
        return std::pair(id, "void " + id + "_on_finish(in Pixel p, inout vec3 colour) {\n" +
                                 "    colour = 0.5 * colour + " +
                                 (id == "first" ? "vec3(0.5, 0.0, 0.0)" : "vec3(0.0, 0.0, 0.5)") +
                                 ";\n}\n");
    };
    const Drawn drawn = draw({halves("first"), halves("second")});
    for (const int y : {2, kHeight_px - 3}) {
        EXPECT_GT(drawn.picture.at(20, y, 0), 136);  // a quarter and more
        EXPECT_GT(drawn.picture.at(20, y, 2), 187);  // half and more
    }
}

TEST_P(PictureHooks, WhatIsNoNumberIsCounted) {
    const Drawn drawn = draw({{"bad",
                               "void bad_on_finish(in Pixel p, inout vec3 colour) {\n"
                               "    colour /= p.at_px.x > 10.0 ? 1.0 : frame.exposure * 0.0;\n"
                               "}\n"}});
    EXPECT_EQ(drawn.non_finite, 10 * kHeight_px);
}

INSTANTIATE_TEST_SUITE_P(, PictureHooks, testing::Bool(), [](const auto& mode) {
    return mode.param ? "WithRadiance" : "WithoutRadiance";
});

}  // namespace
}  // namespace relevo::render::test_picture_hooks
