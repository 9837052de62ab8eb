#include <algorithm>
#include <cmath>

#include "material.h"
#include "noise.h"

namespace relevo::ground {
namespace {

constexpr std::uint32_t kSnowSeed = 0x5E0F;
constexpr double kSnowTile_m = 8;

// The wind blows along (4, 1): 14 degrees off the tile's axis.
const glm::vec2 kWind = glm::vec2(4, 1) / std::sqrt(17.0f);
const Lattice kDrifts(4, 1, -3, 12);  // drawn out three to one along the wind
const Lattice kSastrugi(8, 2, -4, 16);
const Lattice kRipples(52, 13, -6, 24);  // crests across the wind, 15 cm apart

}  // namespace

// In one piece: a recipe, read from top to bottom.
Material make_snow(int n) {
    Material m;
    m.name = "snow";
    m.description = "wind-packed snow with sastrugi";
    m.tile_m = kSnowTile_m;
    m.shininess = 24;
    m.mean_albedo = {0.869f, 0.885f, 0.885f};

    // Sastrugi: whatever is hard stands, and shelters a tail that slopes down along the wind; their
    // points face the wind. Each place takes the highest tail that reaches it.
    const Field hard = make_field(n, [](float s, float t) {
        const float knobs = fractal_noise(kSnowSeed + 1, kSastrugi, s, t, 4, 0.46f);
        return 0.055f * smoothstep(-0.1f, 0.9f, knobs) +
               0.010f * fractal_noise(kSnowSeed + 2, s, t, 26, 3, 0.5f);
    });
    constexpr float kTail_m = 1.3f, kFall = 0.045f;  // length, metres down per metre
    constexpr int kSteps = 72;
    const float highest_m = *std::max_element(hard.begin(), hard.end());
    Field tails(n, n);
    for_each_texel(n, [&](int c, int r) {
        const float s = (static_cast<float>(c) + 0.5f) / static_cast<float>(n);
        const float t = (static_cast<float>(r) + 0.5f) / static_cast<float>(n);
        float height_m = -1;
        for (int i = 0; i < kSteps; ++i) {
            const float back_m = kTail_m * static_cast<float>(i) / kSteps;
            const glm::vec2 p =
                glm::vec2(s, t) - kWind * (back_m / static_cast<float>(kSnowTile_m));
            height_m = std::max(height_m, sample(hard, p.x, p.y) - kFall * back_m);
            if (highest_m - kFall * back_m < height_m) break;  // no higher tail can come
        }
        tails.at(c, r) = height_m;
    });

    const Field drifts = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSnowSeed + 3, kDrifts, s, t, 3, 0.42f); });
    const Field looseness = make_coarse_field(
        n, [](float s, float t) { return fractal_noise(kSnowSeed + 4, s, t, 11, 3, 0.55f); });
    const Field warp = make_coarse_field(
        n, [](float s, float t) { return 0.006f * fractal_noise(kSnowSeed + 5, s, t, 18, 3); });

    const Field around = blurred(tails, 0.10 * n / kSnowTile_m);
    m.height_m = Field(n, n);
    m.albedo = ColourField(n, n);
    m.gloss = Field(n, n);
    for_each_texel(n, [&](int c, int r) {
        const float s = (static_cast<float>(c) + 0.5f) / static_cast<float>(n);
        const float t = (static_cast<float>(r) + 0.5f) / static_cast<float>(n);
        const float drift = smooth_sample(drifts, s, t);
        const float loose = smoothstep(-0.3f, 0.5f, sample(looseness, s, t));
        const float ws = s + smooth_sample(warp, s, t);
        const float ripple = fractal_noise(kSnowSeed + 6, kRipples, ws, t, 2, 0.4f);
        const float grain = hash_normal(kSnowSeed + 7, c, r);
        const float fine = fractal_noise(kSnowSeed + 8, s, t, 120, 2, 0.7f);
        const float raised = tails.at(c, r) - around.at(c, r);
        m.height_m.at(c, r) = 0.045f * drift + tails.at(c, r) + 0.0040f * loose * ripple +
                              0.0007f * fine + 0.00035f * grain;

        // Light goes deep and comes back bluer from hollows; packed snow is a little darker.
        const float hollow = smoothstep(0.004f, -0.012f, raised);
        glm::vec3 colour =
            m.mean_albedo * (1 + 0.012f * (loose - 0.5f) + 0.006f * grain + 0.006f * fine);
        colour *=
            glm::mix(glm::vec3(1.004f, 1.001f, 0.998f), glm::vec3(0.950f, 0.967f, 0.985f), hollow);
        m.albedo.at(c, r) = colour;

        // Wind crust is smooth; facets of single crystals flash.
        const float crystal = hash_unit(kSnowSeed + 9, c, r) > 0.990f
                                  ? 0.35f + 0.4f * hash_unit(kSnowSeed + 10, c, r)
                                  : 0.0f;
        m.gloss.at(c, r) =
            0.42f - 0.22f * loose + 0.05f * hash_unit(kSnowSeed + 11, c, r) + crystal;
    });

    finish(m);
    return m;
}

}  // namespace relevo::ground
