#include <algorithm>
#include <cmath>

#include "base/paths.h"
#include "base/units.h"
#include "dem/load.h"
#include "gl/context.h"
#include "render/ground.h"
#include "render/programs.h"
#include "render/renderer.h"
#include "shader/snippet.h"
#include "support/device.h"
#include "support/support.h"

namespace relevo::render::test_night {
namespace {

/// A sky that is red by day and blue by night, and haze that asks for it.
const char* const kSky =
    "float owl_hoot() { return 1.0; }\n"
    "vec3 owl_on_background_radiance(in vec3 direction, in bool with_disc) {\n"
    "#if HAS_night\n"
    "    return vec3(0.0, 0.0, owl_hoot());\n"
    "#else\n"
    "    return vec3(1.0, 0.0, 0.0);\n"
    "#endif\n"
    "}\n"
    "void owl_on_atmosphere(in Surface s, in vec3 view, inout vec3 radiance) {\n"
    "    radiance = background_radiance(view, false);\n"
    "}\n";

TEST(Night, IsAProgramOfItsOwnAndNothingOfItIsInTheOthers) {
    const shader::Snippet sky = shader::parse_snippet("owl", "owl.glsl", kSky);
    const shader::FolderTexts core(share_dir() / "shaders");
    shader::StitchInput input;
    input.snippets = {&sky};
    int found = 0;
    for (const ProgramText& program : stitch_frames(core, input, {.shown = true}).programs) {
        const bool night = program.name == "background_night";
        found += night;
        EXPECT_EQ(program.stitched.fragment.text.find("float owl_hoot()") != std::string::npos,
                  night)
            << program.name;
    }
    EXPECT_EQ(found, 1);
}

TEST(Night, HasNoProgramWhereNoEffectWantsIt) {
    const shader::FolderTexts core(share_dir() / "shaders");
    const auto programs = stitch_frames(core, {}, {}).programs;
    EXPECT_TRUE(std::none_of(programs.begin(), programs.end(), [](const ProgramText& program) {
        return program.name == "background_night";
    }));
}

TEST(Night, BeginsAndEndsWithTheSunThreeDegreesBelowTheHorizonOfTheEye) {
    const dem::Heightfield dem =
        dem::load((test::source_dir() / "data/dem/jacksboro.tif").string());
    const Ground ground = make_ground(dem);
    const shader::Snippet sky = shader::parse_snippet("owl", "owl.glsl", kSky);
    shader::ParamStore values;
    values.declare(core_params());
    EffectInputs effects;
    effects.stitch.snippets = {&sky};
    effects.stitch.values = &values;
    gl::Context context({.device = test::gl_device(), .debug = true});
    Renderer renderer(context, effects, {.width_px = 32, .height_px = 32, .antialias = false});
    Terrain terrain(dem, ground.frame, {.max_array_layers = context.info().max_array_layers});
    FrameInputs inputs;
    inputs.camera = scene::heading_camera(
        {0, 0, 2000},
        ground.frame.axes(ground.frame.origin().lat_rad, ground.frame.origin().lon_rad), 0, 0,
        radians(40));
    for (const double sun_deg : {10.0, -2.9, -3.1, -40.0, -2.9, -3.1}) {
        inputs.sun.direction = {0, std::cos(radians(sun_deg)), std::sin(radians(sun_deg))};
        renderer.render_frame(terrain, ground, inputs);
        const image::ImageF picture = renderer.read_radiance();
        const bool night = sun_deg < -3;
        EXPECT_EQ(picture.at(16, 0, 0) > 0, !night) << "sky, " << sun_deg;
        EXPECT_EQ(picture.at(16, 0, 2) > 0, night) << "sky, " << sun_deg;
        EXPECT_GT(picture.at(16, 31, 0), 0) << "the ground's program has no night, " << sun_deg;
    }
}

}  // namespace
}  // namespace relevo::render::test_night
