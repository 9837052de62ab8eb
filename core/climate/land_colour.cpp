#include "climate/land_colour.h"

#include <algorithm>
#include <cmath>

namespace relevo::climate {
namespace {

constexpr std::size_t kBareLand = static_cast<std::size_t>(Land::Bare);

float part_of(double value, double from, double to) {
    return static_cast<float>(std::clamp((value - from) / (to - from), 0.0, 1.0));
}

Colour mix(const Colour& a, const Colour& b, float t) {
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// What covers reflect at a place, in the mean of the dates of the ground's map. source: chosen
/// among published albedos of each cover, and by eye
std::array<Colour, kLands> usual_colours(const CoverColumn& column, const Colour& ground) {
    const double height_m = column.normals().relief_m, mean_c = column.mean_c(height_m);
    float green = 0;
    for (const double day : {135.0, 220.0, 288.0})
        green += static_cast<float>(column.green(height_m, day)) / 3;
    const float warm = part_of(mean_c, 12, 22), hot = part_of(mean_c, 0, 18);
    const float moor = part_of(8.5 - mean_c, 0, 3) * part_of(column.dryness(height_m), 2, 4);
    const Colour needles = mix({.023F, .036F, .021F}, {.030F, .043F, .022F}, warm);
    const Colour leaves = mix(mix({.075F, .062F, .044F}, {.034F, .056F, .022F}, green),
                              mix({.085F, .070F, .040F}, {.024F, .042F, .021F}, green), warm);
    const Colour straw = mix({.150F, .125F, .070F}, {.190F, .152F, .085F}, hot);
    const Colour grass =
        mix(mix(straw, {.060F, .090F, .030F}, green), {.100F, .086F, .044F}, .55F * moor);
    const Colour shrub = mix(mix({.105F, .085F, .055F}, {.058F, .068F, .032F}, green),
                             {.066F, .050F, .034F}, .8F * moor);
    Colour soil = ground;
    for (float& band : soil)
        band = std::clamp(band, .05F, .35F);
    soil = mix({.140F, .105F, .072F}, soil, .5F);
    const Colour crop =
        mix(mix(soil, {.245F, .190F, .085F}, .45F), {.058F, .088F, .028F}, .15F + .7F * green);
    const Colour wet = mix({.085F, .075F, .045F}, {.040F, .056F, .026F}, green);
    return {needles,
            leaves,
            shrub,
            grass,
            crop,
            {.165F, .150F, .130F},
            {.165F, .152F, .140F},
            wet,
            {.62F, .66F, .70F}};
}

}  // namespace

Colour tint_of(const CoverColumn& column, const LandShares& shares, const Colour& ground) {
    const std::array<Colour, kLands> usual = usual_colours(column, ground);
    LandShares of = shares;
    of[static_cast<std::size_t>(Land::Ice)] = 0;
    float sum = 0;
    for (const float one : of)
        sum += one;
    const float bare = of[kBareLand] / std::max(sum, 1e-6F);
    // How far each cover follows the ground's colour.
    std::array<float, kLands> pull{.35F, .4F, .8F, .75F, .6F, 0, .25F, .5F, 0};
    pull[kBareLand] = .35F + .65F * part_of(bare, 0, .5);
    constexpr Colour kHaze{.000F, .003F, .010F};  // left in the map's dark green and blue; by eye
    const float all = .65F + .35F * part_of(bare, 0, .4);
    const auto mean_of = [&](std::size_t band, float tint) {
        float mean = 0;
        for (std::size_t land = 0; land < kLands; ++land)
            mean +=
                of[land] / std::max(sum, 1e-6F) * usual[land][band] * std::pow(tint, pull[land]);
        return mean;
    };
    Colour goal{}, tint{1, 1, 1};
    for (std::size_t band = 0; band < 3; ++band) {
        const float usually = std::max(mean_of(band, 1), 1e-4F);
        const float seen = std::max(ground[band] - kHaze[band] * (1 - bare), .006F);
        goal[band] = usually * std::pow(seen / usually, all);
    }
    for (int step = 0; step < 4; ++step) {
        for (std::size_t band = 0; band < 3; ++band)
            tint[band] = std::clamp(
                tint[band] * goal[band] / std::max(mean_of(band, tint[band]), .004F), .4F, 2.5F);
        const float light = .2126F * tint[0] + .7152F * tint[1] + .0722F * tint[2];
        for (float& band : tint)
            band = light * std::clamp(band / light, .7F, 1.35F);
    }
    return tint;
}

}  // namespace relevo::climate
