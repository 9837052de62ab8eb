#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/renderer.h"
#include "shader/snippet.h"
#include "sun/zone.h"
#include "support/device.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::render::test_shown {
namespace {

/// The bundled DEM under the sun of a moment, and a device to draw it on.
struct Bundled {
    dem::Heightfield dem = dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    Ground ground = make_ground(dem);
    geo::Geodetic place = ground.frame.origin();
    gl::Context context{{.device = test::gl_device(), .debug = true}};
    Terrain terrain{dem, ground.frame, {.max_array_layers = context.info().max_array_layers}};
    shader::ParamStore values;
    EffectInputs effects;
    FrameInputs inputs;

    explicit Bundled(const char* utc) {
        values.declare(core_params());
        effects.stitch.values = &values;
        inputs.sun = make_sun_light(sun::position(sun::parse_time(utc).utc, place),
                                    sun::Refraction::standard(place), ground, dem.grid);
    }
    Bundled(const Bundled&) = delete;  // its members look at each other
    Bundled& operator=(const Bundled&) = delete;

    void orbit(double aspect) {
        inputs.camera = scene::orbit_camera({200, 20, 1.5}, points_to_show(dem, ground, 1),
                                            radians(40), aspect);
    }

    image::Image8 picture(Renderer& renderer) {
        renderer.render_frame(terrain, ground, inputs);
        return renderer.read_output();
    }
};

TEST(Picture, ColoursFollowTheSrgbCurve) {
    test::GpuSnippet gpu("", "lib/srgb.glsl");
    const int count = 4096;
    const auto results =
        gpu.run("result = vec4(srgb_encoded(vec3(float(x) / 4095.0)), 0.0);", count, 1);
    std::vector<double> errors;
    for (int i = 0; i < count; ++i) {
        const double linear = i / 4095.0;
        const double encoded =
            linear < 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
        errors.push_back(255 * std::abs(results[static_cast<std::size_t>(i)].r - encoded));
    }
    test::print_accuracy("sRGB, GPU against double", errors, "of 255", 0.1);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.1);
    EXPECT_NEAR(results.back().r, 1, 1e-6);  // white stays white
}

TEST(Picture, LargerThanTheDeviceDrawsIsAMessage) {
    gl::Context context({.device = test::gl_device()});
    const int most = context.info().max_picture_size;
    const auto refused = [&](int width_px, int height_px) {
        return test::error_of(
            [&] { Renderer(context, {}, {.width_px = width_px, .height_px = height_px}); });
    };
    const std::string limit =
        fmt::format(" px is more than the {} px a side that {} draws; use a smaller --size", most,
                    context.info().renderer);
    EXPECT_EQ(refused(most + 1, 8),
              fmt::format("exit 3: render: picture: {} x 8", most + 1) + limit);
    EXPECT_EQ(refused(8, most + 1),
              fmt::format("exit 3: render: picture: 8 x {}", most + 1) + limit);
}

TEST(Picture, IsTheSameWithAndWithoutKeepingItsRadiance) {
    // With it, the light is stored as half floats and tone-mapped by a pass of its own.
    Bundled bundled("2026-06-21T22:30Z");
    bundled.orbit(320.0 / 256);
    std::vector<image::Image8> pictures;
    for (const bool radiance : {true, false}) {
        Renderer renderer(bundled.context, bundled.effects,
                          {.width_px = 320, .height_px = 256, .radiance = radiance});
        pictures.push_back(bundled.picture(renderer));
    }
    EXPECT_LE(image::compare(pictures[0], pictures[1]).worst, 1);
}

TEST(Picture, ReadsNothingThatNoPassHasWritten) {
    // With NaN in all memory that the frame graph gives out, every picture is the same.
    Bundled bundled("2026-06-21T22:30Z");
    bundled.orbit(320.0 / 256);
    const shader::Snippet block = shader::parse_snippet(
        "cut", "cut.glsl",
        "vec3 cut_on_side(in Surface s, in float depth_m) { return s.diffuse * s.normal.zzz; }\n"
        "void cut_on_display(in Surface s, inout vec4 colour) { colour = vec4(0.5 * "
        "s.height_unit); }\n");
    bundled.effects.stitch.snippets = {&block};
    int frames = 0;
    for (const bool radiance : {true, false})
        for (const bool antialias : {true, false}) {
            std::vector<image::Image8> pictures;
            for (const bool poison : {false, true}) {
                Renderer renderer(bundled.context, bundled.effects,
                                  {.width_px = 320,
                                   .height_px = 256,
                                   .antialias = antialias,
                                   .radiance = radiance,
                                   .poison = poison});
                int non_finite = 0;
                bundled.picture(renderer);
                pictures.push_back(bundled.picture(renderer));
                renderer.read_output(&non_finite);
                EXPECT_EQ(non_finite, 0);
                ++frames;
            }
            EXPECT_EQ(pictures[0].values, pictures[1].values) << radiance << antialias;
        }
    EXPECT_EQ(frames, 8);
}

TEST(Picture, DithersByOneStepOfEightBits) {
    // A sky of one colour is drawn in the two numbers next to it.
    const shader::Snippet even = shader::parse_snippet(
        "even", "even.glsl",
        "vec3 even_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
        "    return vec3(0.1012, 0.2, 0.3) / frame.exposure;\n"
        "}\n");
    Bundled bundled("2026-06-21T15:30Z");
    bundled.effects.stitch.snippets = {&even};
    bundled.inputs.camera = scene::heading_camera(
        {0, 0, 5000}, bundled.ground.frame.axes(bundled.place.lat_rad, bundled.place.lon_rad), 0,
        60, radians(40));
    Renderer renderer(bundled.context, bundled.effects,
                      {.width_px = 64, .height_px = 64, .radiance = false});
    const image::Image8 picture = bundled.picture(renderer);
    for (int channel = 0; channel < 3; ++channel) {
        int low = 255, high = 0;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                const int value = picture.row(y)[3 * x + channel];
                low = std::min(low, value);
                high = std::max(high, value);
            }
        EXPECT_EQ(high - low, 1) << channel;
    }
}

TEST(Picture, HasColoursOfEightBitsAsTheyAre) {
    // Also where a device rounds them a little too early or too late, as GPUs do.
    const shader::Snippet flat =
        shader::parse_snippet("flat", "flat.glsl",
                              "void flat_on_overlay(in Pixel p, inout vec4 over) {\n"
                              "    over = vec4(vec3(99.97, 100.03, 255.0) / 255.0, 1.0);\n"
                              "}\n");
    Bundled bundled("2026-06-21T15:30Z");
    bundled.orbit(1);
    bundled.effects.stitch.snippets = {&flat};
    Renderer renderer(bundled.context, bundled.effects,
                      {.width_px = 64, .height_px = 64, .radiance = false});
    const image::Image8 picture = bundled.picture(renderer);
    for (std::size_t i = 0; i < picture.values.size(); ++i)
        ASSERT_EQ(picture.values[i], i % 3 == 2 ? 255 : 100) << i;
}

TEST(Picture, OfALargeFirstFrameIsWhole) {
    // It is drawn in bands under a watch, the next one at once.
    constexpr int kSide_px = 1500;
    Bundled bundled("2026-06-21T15:30Z");
    bundled.orbit(1);
    Renderer renderer(bundled.context, bundled.effects,
                      {.width_px = kSide_px, .height_px = kSide_px});
    const image::Image8 first = bundled.picture(renderer);
    EXPECT_EQ(first.values, bundled.picture(renderer).values);
    // Nothing of it is as the device left its memory.
    int black = 0;
    for (int y = 0; y < kSide_px; ++y)
        black += first.row(y)[0] == 0 && first.row(y)[1] == 0 && first.row(y)[2] == 0;
    EXPECT_EQ(black, 0);
}

}  // namespace
}  // namespace relevo::render::test_shown
