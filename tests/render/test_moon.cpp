#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "render/frame_block.h"
#include "render/moon.h"
#include "scene/camera.h"
#include "sun/daylight.h"

namespace relevo::render::test_moon {
namespace {

glm::dvec3 direction(double azimuth_deg, double elevation_deg) {
    const double a = radians(azimuth_deg), e = radians(elevation_deg);
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
}

SunLight light_from(const glm::dvec3& towards) {
    SunLight light;
    light.direction = towards;
    light.lowest_sine = towards.z - 0.001;
    light.highest_sine = towards.z + 0.001;
    return light;
}

/// A frame with sun and moon at these elevations, both in the south.
FrameInputs inputs_with(double sun_deg, double moon_deg) {
    FrameInputs inputs;
    inputs.camera = scene::look_at_camera({0, -8000, 2000}, {0, 0, 0}, {0, 0, 1}, radians(40));
    inputs.sun = light_from(direction(180, sun_deg));
    Moon moon;
    moon.direction = direction(180, moon_deg);
    moon.semidiameter_rad = radians(0.26);
    moon.light = glm::dvec3(2.4e-6);
    moon.radiance = glm::dvec3(0.12);
    inputs.moon = moon;
    choose_direct_light(inputs, light_from(moon.direction));
    return inputs;
}

FrameBlock block_of(const FrameInputs& inputs) {
    const Ground ground{
        .frame = geo::LocalFrame(geo::geodetic_deg(47, 11, 0)), .lowest_m = 0, .highest_m = 3000};
    return make_frame_block(inputs, ground, 640, 512, 4);
}

TEST(Moon, IsTheDirectLightWhereTheSunShinesNowhere) {
    EXPECT_FALSE(inputs_with(30, 40).moonlight);
    EXPECT_FALSE(inputs_with(-0.1, 40).moonlight);
    EXPECT_FALSE(inputs_with(-30, -5).moonlight);
    const FrameInputs night = inputs_with(-30, 40);
    ASSERT_TRUE(night.moonlight);
    const FrameBlock block = block_of(night);
    EXPECT_NEAR(block.sun_direction.w, radians(40), 1e-3);
    EXPECT_NEAR(block.eye_sun.w, radians(-30), 5e-3);  // the sky's sun is where it was
    EXPECT_EQ(block.eye_moon_light.a, 1);
    EXPECT_NEAR(block.eye_moon.w, radians(0.26), 1e-6);
    // A clear air takes a quarter of it.
    EXPECT_GT(block.sun_light[0].g, 0.65 * 2.4e-6);
    EXPECT_LT(block.sun_light[0].g, 0.85 * 2.4e-6);
}

TEST(Moon, WaitsUntilTheSunHasLeftTheSummits) {
    FrameInputs inputs = inputs_with(-1.5, 40);
    EXPECT_TRUE(inputs.moonlight);
    inputs.sun.highest_m = 4400;  // its horizon is 2.1 degrees down
    choose_direct_light(inputs, light_from(inputs.moon->direction));
    EXPECT_FALSE(inputs.moonlight);
}

TEST(Moon, ThatIsDownChangesNothing) {
    FrameInputs with = inputs_with(-30, -5), without = with;
    without.moon.reset();
    const FrameBlock a = block_of(with), b = block_of(without);
    EXPECT_TRUE(a == b);
}

TEST(Moon, LightsTheSkyAndTheExposureFollows) {
    const FrameBlock moonlit = block_of(inputs_with(-30, 40));
    const FrameBlock dark = block_of(inputs_with(-30, -5));
    // 0.03 lux over 0.002.
    EXPECT_GT(moonlit.sky_irradiance.g, 8 * dark.sky_irradiance.g);
    EXPECT_LT(moonlit.exposure, dark.exposure / 10);
    // By day it is only a disc.
    const FrameBlock day = block_of(inputs_with(30, 40));
    EXPECT_EQ(day.sky_irradiance, block_of(inputs_with(30, -5)).sky_irradiance);
    EXPECT_EQ(day.eye_moon_light.a, 0);
    EXPECT_GT(day.eye_moon.w, 0);
    EXPECT_EQ(day.corona.g, 0);
}

TEST(Eclipse, TakesItsShareOfSunAndSky) {
    FrameInputs inputs = inputs_with(50, 50.1);
    const FrameBlock full = block_of(inputs);
    inputs.sun_visible = 0.25;
    inputs.sun.strength = glm::dvec3(0.25);
    const FrameBlock partial = block_of(inputs);
    EXPECT_NEAR(partial.sun_light[0].g / full.sun_light[0].g, 0.25, 1e-5);
    EXPECT_NEAR(partial.eye_sun_light.g / full.eye_sun_light.g, 0.25, 1e-5);
    EXPECT_NEAR(partial.sky_irradiance.g / full.sky_irradiance.g, 0.25, 1e-3);
    EXPECT_GT(partial.exposure, 1.5 * full.exposure);
    EXPECT_LT(partial.exposure, 4 * full.exposure);
    EXPECT_EQ(partial.corona.g, 0);
    inputs.sun_visible = 0;
    inputs.sun.strength = glm::dvec3(0);
    const FrameBlock total = block_of(inputs);
    EXPECT_EQ(total.sun_light[0].g, 0);
    EXPECT_GT(total.corona.g, 0.5);
    EXPECT_GT(total.sky_irradiance.g, 0);
}

}  // namespace
}  // namespace relevo::render::test_moon
