#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "atmosphere.h"
#include "base/units.h"
#include "support/support.h"
#include "textures.h"

namespace relevo::skymaker {
namespace {

const Atmosphere& air() {
    static const Atmosphere kAir;
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

TEST(Atmosphere, ShedsAsMuchLightAsClearSkiesDo) {
    // IES clear sky, 800 + 15500 sqrt(sin h) lux (IESNA RP-21); Explanatory Supplement to the
    // Astronomical Almanac (1992), p. 491: 3.4 lux at the end of civil twilight and 0.0083 at that
    // of nautical twilight, the sun's and the sky's together, a moonless night's 0.002 (Seidelmann)
    // added. Twilights differ by a factor of two from day to day; so does the model's limit.
    struct Row {
        double sun_deg, lux, share;
    };
    for (const Row& row : {Row{90, 16300, 0.1}, Row{60, 15225, 0.1}, Row{30, 11760, 0.15},
                           Row{10, 7259, 0.15}, Row{0, 800, 0.15}, Row{-6, 3.4, 0.6},
                           Row{-12, 0.0083 + 0.002, 0.6}, Row{-18, 0.0006 + 0.002, 0.3}}) {
        const double lux =
            127500 * luminance(level_irradiance(air(), std::sin(radians(row.sun_deg))));
        fmt::print("[ sky ] sun {:.0f} degrees high: {:.4g} lux, published {:.4g}\n", row.sun_deg,
                   lux, row.lux);
        EXPECT_NEAR(lux / row.lux, 1, row.share) << row.sun_deg;
    }
}

TEST(Atmosphere, IsBlueByDayAndRedAboutASettingSun) {
    const auto colour = [](double elevation_deg, double sun_deg, double azimuth_cos) {
        return colour_of(
            air()
                .radiance(std::sin(radians(elevation_deg)), std::sin(radians(sun_deg)), azimuth_cos)
                .sky);
    };
    const glm::dvec3 zenith = colour(90, 45, 0), horizon = colour(2, 45, 0),
                     sunset = colour(3, 0, 1), opposite = colour(20, 0, -1);
    EXPECT_GT(zenith.b, 1.8 * zenith.r);
    EXPECT_GT(luminance(horizon), 2 * luminance(zenith));
    EXPECT_LT(horizon.b / horizon.r, zenith.b / zenith.r);
    EXPECT_GT(sunset.r, 2 * sunset.b);
    EXPECT_GT(opposite.b, opposite.r);
    EXPECT_GT(luminance(sunset), luminance(opposite));
}

TEST(Atmosphere, PassesTheSunsLightAsAClearDayDoes) {
    // Optical depth at 550 nm, the zenith: Rayleigh 0.0973 (Hansen and Travis 1974), ozone 0.027
    // (300 DU, 4.5e-25 m2), aerosol 0.04 x 0.55^-1.3 = 0.087.
    const glm::dvec3 zenith = colour_of(air().transmittance(1));
    EXPECT_NEAR(zenith.g, std::exp(-(0.0973 + 0.027 + 0.087)), 0.015);
    EXPECT_GT(zenith.r, zenith.g);
    EXPECT_GT(zenith.g, zenith.b);
    EXPECT_EQ(colour_of(air().transmittance(std::sin(radians(-1.0)))).r, 0);
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

TEST(Textures, LightOnLevelGroundHasLuminanceOneAndSlopesLessOrTheSunsSideMore) {
    const Textures textures = make_textures(air());
    const int last = Layout::kNormals - 1;
    for (int slice = 0; slice < Layout::kSuns; ++slice) {
        const glm::dvec3 level = texel(textures.light, 0, last, slice);
        EXPECT_NEAR(luminance(level), 1, 2e-3) << slice;
        EXPECT_EQ(texel(textures.light, last, last, slice), level) << "level ground has no azimuth";
        const double towards = luminance(texel(textures.light, last, 0, slice));
        const double away = luminance(texel(textures.light, 0, 0, slice));
        EXPECT_GT(towards, away * 0.999) << slice;
        for (int y = 0; y < Layout::kUp; ++y)
            for (int x = 0; x < Layout::kAround; ++x) {
                const glm::dvec3 colour = texel(textures.radiance, x, y, slice);
                for (int c = 0; c < 3; ++c) {
                    ASSERT_GE(colour[c], 0) << x << " " << y << " " << slice;
                    ASSERT_LT(colour[c], 100) << x << " " << y << " " << slice;
                }
            }
    }
    // The zenith, the last row, is the same whatever the azimuth.
    for (int x = 0; x < Layout::kAround; ++x)
        EXPECT_EQ(texel(textures.radiance, x, Layout::kUp - 1, 20),
                  texel(textures.radiance, 0, Layout::kUp - 1, 20));
}

}  // namespace
}  // namespace relevo::skymaker
