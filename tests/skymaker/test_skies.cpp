#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "base/units.h"
#include "sky/atmosphere.h"
#include "support/support.h"
#include "textures.h"

namespace relevo::skymaker {
namespace {

const sky::Atmosphere& air() {
    static const sky::Atmosphere kAir;
    return kAir;
}

/// A texel of a texture of half floats.
glm::dvec3 texel(const image::TextureData& texture, int x, int y, int z) {
    const std::size_t index =
        static_cast<std::size_t>((z * texture.height() + y) * texture.width() + x);
    glm::dvec3 colour;
    for (int c = 0; c < 3; ++c) {
        std::uint16_t half = 0;
        std::memcpy(&half, texture.level(0).data() + 8 * index + 2 * static_cast<std::size_t>(c),
                    2);
        colour[c] = glm::unpackHalf1x16(half);
    }
    return colour;
}

TEST(Textures, AreOfTheAtmospheresLightOnLevelGround) {
    for (const double sun_deg : {60.0, 30.0, 10.0, 2.0, -2.0, -6.0}) {
        const double sine = std::sin(radians(sun_deg));
        const double summed = luminance(level_irradiance(air(), sine)),
                     expected = luminance(sky::colour_of(air().sky_irradiance(0, sine)));
        fmt::print("[ sky ] sun {:.0f}: sum of directions {:.4g}, irradiance {:.4g}\n", sun_deg,
                   summed, expected);
        // Texels are too wide for the aureole of a high sun.
        EXPECT_NEAR(summed / expected, 1, 0.1) << sun_deg;
    }
    // A moonless night.
    EXPECT_NEAR(127500 * luminance(level_irradiance(air(), -0.5)), 0.002, 0.0002);
}

TEST(Layout, SlicesGoBackAndForth) {
    for (const double deg : {-18.0, -6.0, -0.5, 0.0, 0.5, 10.0, 45.0, 90.0}) {
        const double sine = std::sin(radians(deg));
        const double slice = Layout::slice_of(sine);
        EXPECT_GE(slice, -1e-12) << deg;
        EXPECT_LE(slice, 1 + 1e-12) << deg;
        EXPECT_NEAR(Layout::sun_sine_of(slice), sine, 1e-12) << deg;
    }
    // Dense where the sky changes fast: below half a degree of the sun about the horizon.
    const double step = 1.0 / (Layout::kSuns - 1);
    const double at_horizon = Layout::slice_of(0);
    EXPECT_LT(degrees(std::asin(Layout::sun_sine_of(at_horizon + step))), 0.5);
}

TEST(Textures, LightOnLevelGroundIsOneAndSlopesHaveLessOrTheSunsSideMore) {
    const image::TextureData light = light_texture(air());
    const int last = Layout::kNormals - 1;
    for (int slice = 0; slice < Layout::kSuns; ++slice) {
        EXPECT_EQ(texel(light, 0, last, slice), glm::dvec3(1)) << slice;
        EXPECT_EQ(texel(light, last, last, slice), glm::dvec3(1)) << "level ground has no azimuth";
        const double towards = luminance(texel(light, last, 0, slice));
        const double away = luminance(texel(light, 0, 0, slice));
        EXPECT_GT(towards, away * 0.999) << slice;
    }
}

}  // namespace
}  // namespace relevo::skymaker
