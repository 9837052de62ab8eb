#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "base/units.h"
#include "render/height_light.h"
#include "render/light_by_height.h"
#include "sky/shipped.h"
#include "sun/daylight.h"

namespace relevo::render::test_height_light {
namespace {

double luminance(const glm::dvec3& c) {
    return dot(c, glm::dvec3(0.2126, 0.7152, 0.0722));
}

/// As the standard atmosphere's at sea level, roughly: Saemundsson's formula.
double refraction_rad(double elevation_rad) {
    const double deg = std::max(degrees(elevation_rad), -1.0);
    return radians(1.0 / std::tan(radians(deg + 10.3 / (deg + 5.11))) / 60);
}

/// Lit from an elevation in the south [degrees].
FrameInputs lit_from(double sun_deg, bool by_formulas = false) {
    FrameInputs inputs;
    const double sun = radians(sun_deg);
    inputs.sun.direction = {0, -std::cos(sun), std::sin(sun)};
    inputs.sun.refraction_rad = refraction_rad;
    if (!by_formulas) inputs.atmosphere = sky::atmosphere_of(sky::Air{.angstrom_beta = 0.04});
    return inputs;
}

TEST(HeightLight, IsBesideTheFormulas) {
    // What the atmosphere has of the formulas' light, at sea level and in mountains.
    for (const double height : {0.0, 1500.0, 3000.0}) {
        for (const double sun_deg : {60.0, 30.0, 10.0, 5.0, 2.0, 0.0, -1.0, -4.0, -8.0}) {
            const FrameInputs ours = lit_from(sun_deg), theirs = lit_from(sun_deg, true);
            const double sine = ours.sun.direction.z;
            const HeightLight a(ours, height), b(theirs, height);
            const glm::dvec3 direct = a.direct(ours.sun, sine), sky = a.sky(sine);
            const double formula = luminance(b.direct(theirs.sun, sine));
            fmt::print(
                "[ light ] {:.0f} m, sun {:.0f}: direct {:.3g} ({:.3g} {:.3g} {:.3g}), formulas "
                "{:.3g}; sky {:.3g}, formulas {:.3g}\n",
                height, sun_deg, luminance(direct), direct.r, direct.g, direct.b, formula,
                luminance(sky), luminance(b.sky(sine)));
            if (height > 0 || sun_deg < 10) continue;
            EXPECT_NEAR(luminance(direct) / formula, 1, 0.1);
            EXPECT_NEAR(luminance(sky) / luminance(b.sky(sine)), 1, 0.12);
        }
    }
}

TEST(HeightLight, GoesOutAtTheValleysFirst) {
    // Half an hour after sunset at the equator of a summit of 4400 m.
    const FrameInputs dusk = lit_from(-1.5);
    const double sine = dusk.sun.direction.z;
    const HeightLight valley(dusk, 600), summit(dusk, 4400);
    const glm::dvec3 glow = summit.direct(dusk.sun, sine);
    EXPECT_LT(valley.direct(dusk.sun, sine).r, 1e-3 * glow.r);
    EXPECT_GT(glow.r, 0.01);
    EXPECT_GT(glow.r, 4 * glow.g);
}

TEST(HeightLight, HasEclipsesNightsAndTheMoon) {
    FrameInputs inputs = lit_from(30);
    const double sine = inputs.sun.direction.z;
    const glm::dvec3 full = HeightLight(inputs, 0).sky(sine);
    inputs.sun_visible = 0.25;
    inputs.sun.strength = glm::dvec3(0.25);
    EXPECT_NEAR(HeightLight(inputs, 0).sky(sine).g / full.g, 0.25, 1e-3);

    FrameInputs night = lit_from(-40);
    const glm::dvec3 dark = HeightLight(night, 0).sky(night.sun.direction.z);
    EXPECT_NEAR(127500 * luminance(dark), 0.002, 0.0002);
    SunLight moon = inputs.sun;
    moon.strength = glm::dvec3(2.4e-6);
    night.moonlight = moon;
    const HeightLight moonlit(night, 0);
    EXPECT_NEAR(moonlit.sky(sine).g, dark.g + 2.4e-6 * full.g, 1e-9);
    EXPECT_NEAR(luminance(moonlit.direct(moon, sine)), 2.4e-6 * 0.7, 2.4e-7);
}

/// As lib/ground.glsl reads a layer of the texture.
glm::dvec3 read(const std::vector<glm::vec4>& texels, const FrameBlock& block, double height_m,
                double sine, std::size_t layer) {
    constexpr int kColumns = LightByHeight::kSines, kRows = LightByHeight::kHeights;
    const double x = std::clamp((sun_light_scale(sine) - block.sun_light_domain.x) *
                                    block.sun_light_domain.y / 127,
                                0.0, 1.0) *
                     (kColumns - 1),
                 y = std::clamp(double{height_m - block.height_range.x} * block.height_range.y, 0.0,
                                1.0) *
                     (kRows - 1);
    const int i = std::min(static_cast<int>(x), kColumns - 2),
              j = std::min(static_cast<int>(y), kRows - 2);
    const auto at = [&](int c, int r) {
        return glm::dvec3(
            texels[layer * kColumns * kRows + static_cast<std::size_t>(r * kColumns + c)]);
    };
    return glm::mix(glm::mix(at(i, j), at(i + 1, j), x - i),
                    glm::mix(at(i, j + 1), at(i + 1, j + 1), x - i), y - j);
}

/// Largest difference of the texture over a DEM, of the largest light there.
double worst_over(double sun_deg, double spread_deg, std::size_t layer) {
    FrameInputs inputs = lit_from(sun_deg);
    inputs.sun.lowest_sine = std::sin(radians(sun_deg - spread_deg));
    inputs.sun.highest_sine = std::sin(radians(sun_deg + spread_deg));
    FrameBlock block{};
    block.height_range = {0, 1.0 / 4400, 1, 0};
    const SunLightTable table = sun_light_table(inputs.sun, HeightLight(inputs, 2200));
    block.sun_light_domain = {table.domain.x, table.domain.y, 0, 0};
    const std::vector<glm::vec4> texels = LightByHeight::texels(inputs, block);
    double worst = 0, most = 0;
    for (double height = 30; height < 4400; height += 210) {
        const HeightLight here(inputs, std::round(height));
        for (double s = -0.97; s < 1; s += 0.13) {
            const double sine = std::sin(radians(sun_deg + s * spread_deg));
            const glm::dvec3 exact = layer ? here.sky(sine) : here.direct(inputs.sun, sine),
                             found = read(texels, block, std::round(height), sine, layer);
            most = std::max({most, exact.r, exact.g, exact.b});
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(found[c] - exact[c]));
        }
    }
    return most > 0 ? worst / most : 0;
}

TEST(LightByHeight, IsTheLightOfEachHeight) {
    for (const double sun_deg : {60.0, 10.0, 2.0, 0.0, -1.0, -4.0}) {
        // A DEM of 100 km, whose ground rises from the sea to 4400 m.
        const double direct = worst_over(sun_deg, 0.45, 0), sky = worst_over(sun_deg, 0.45, 1);
        fmt::print(
            "[ accuracy ] light by height, sun {:.0f}: worst of the largest, direct {:.2f} %, sky "
            "{:.2f} %\n",
            sun_deg, 100 * direct, 100 * sky);
        EXPECT_LT(direct, 0.02) << sun_deg;
        EXPECT_LT(sky, 0.02) << sun_deg;
    }
}

}  // namespace
}  // namespace relevo::render::test_height_light
